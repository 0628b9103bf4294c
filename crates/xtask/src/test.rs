//! `cargo xtask test`: everything that can be tested on this machine, and a list of what could not.

use std::time::Instant;

use crate::tools::{self, CARGO_TEST, CONFORMANCE, Trouble};
use crate::{conformance, program};

/// One part of the tests.
struct Step {
    name: &'static str,
    run: fn() -> Result<(), Trouble>,
}

const STEPS: [Step; 2] =
    [Step { name: CARGO_TEST, run: cargo_test }, Step { name: CONFORMANCE, run: conformance::quick }];

/// Runs every step whose packages are there, then sums up. Where nobody watches, a step that could not run counts as failed.
pub(crate) fn all(install: bool) -> Result<(), Trouble> {
    let missing = tools::provide_packages(install);
    let mut lines = Vec::new();
    let (mut failed, mut not_run) = (0, 0);
    for step in &STEPS {
        let lacking: Vec<&str> = missing
            .iter()
            .filter(|package| package.needed_for == step.name)
            .map(|package| package.name)
            .collect();
        let started = Instant::now();
        let outcome =
            if lacking.is_empty() { (step.run)() } else { Err(Trouble::Missing(lacking.join(", "))) };
        let seconds = started.elapsed().as_secs();
        lines.push(match outcome {
            Ok(()) => format!("passed   {} ({seconds} s)", step.name),
            Err(Trouble::Failed(why)) => {
                failed += 1;
                format!("FAILED   {} ({seconds} s): {why}", step.name)
            }
            Err(Trouble::Missing(what)) => {
                not_run += 1;
                format!("NOT RUN  {}: missing {what}", step.name)
            }
        });
    }
    println!("\n{}", lines.join("\n"));
    if failed > 0 || (not_run > 0 && tools::in_ci()) {
        return Err(Trouble::Failed(format!("{failed} failed, {not_run} not run, of {}", STEPS.len())));
    }
    Ok(())
}

/// Unit tests, integration tests and the examples in the documentation, all in the optimised dev profile.
fn cargo_test() -> Result<(), Trouble> {
    let all = ["test", "--workspace", "--no-fail-fast"];
    tools::run(tools::cargo(&all).env("FOTON_PROGRAM", program::foton("debug")))
}
