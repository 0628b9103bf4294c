//! `cargo xtask ci`: what must hold before a change is merged. Stops at the first fault; the quickest checks come first.

use crate::test;
use crate::tools::{self, Trouble};

/// Formatting, lints, documentation, tests.
pub(crate) fn all() -> Result<(), Trouble> {
    tools::run(&mut tools::cargo(&["fmt", "--all", "--check"]))?;
    let lints = ["clippy", "--locked", "--workspace", "--all-targets", "--", "-D", "warnings"];
    tools::run(&mut tools::cargo(&lints))?;
    let documentation = ["doc", "--workspace", "--no-deps", "--document-private-items"];
    tools::run(tools::cargo(&documentation).env("RUSTDOCFLAGS", "-D warnings"))?;
    test::all(false)
}
