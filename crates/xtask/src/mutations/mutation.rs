//! A protection that can be taken out.

use crate::tools::Trouble;

/// A protection, how it is taken out, and what must notice.
pub(super) struct Mutation {
    /// What is taken out, as docs/robustness.md has it.
    pub(super) what: &'static str,
    /// Where, from the root of the repository.
    pub(super) file: &'static str,
    /// What stands there once, and what comes in its place.
    pub(super) from: &'static str,
    pub(super) to: &'static str,
    /// The arguments of `cargo test` that find the test.
    pub(super) target: &'static str,
    /// The test that must fail.
    pub(super) test: &'static str,
}

impl Mutation {
    /// The file's text without the protection.
    pub(super) fn applied_to(&self, text: &str) -> Result<String, Trouble> {
        match text.matches(self.from).count() {
            1 => Ok(text.replacen(self.from, self.to, 1)),
            n => Err(Trouble::Failed(format!("{}: `{}` is there {n} times", self.file, self.from))),
        }
    }
}
