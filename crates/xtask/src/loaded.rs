//! `cargo xtask loaded`: the tests that wait for threads, windows and other programs, on a machine that has no time for them.

use std::process::Child;

use crate::program;
use crate::tools::{self, Trouble};

/// Loops that keep processors busy meanwhile: fourfold load on two processors.
const LOOPS: u32 = 8;

/// Times that the tests of threads and windows run.
const TIMES: u32 = 10;

/// The tests that wait for something: the engine's and session's, those of the panels, and the window's on a display in memory.
const WAITING: [&[&str]; 3] = [
    &["--package", "foton-session"],
    &["--package", "foton-preview"],
    &["--package", "foton-tests", "--test", "window", "--test", "editing"],
];

/// Runs those tests ten times beside eight busy loops, then all tests once.
///
/// # Errors
/// The first run that fails, with its number.
pub(crate) fn all() -> Result<(), Trouble> {
    // Built first, so that the load is the tests' and not the compiler's.
    tools::run(&mut tools::cargo(&["test", "--workspace", "--no-run"]))?;
    for packages in WAITING {
        // Fewer packages ask for fewer features of what they share, so that much of it is built anew.
        tools::run(tools::cargo(&["test", "--no-run"]).args(packages))?;
    }
    let _load = Load::begin()?;
    for time in 1..=TIMES {
        println!("time {time} of {TIMES}");
        for packages in WAITING {
            test(packages)
                .map_err(|trouble| Trouble::Failed(format!("time {time} of {TIMES}: {trouble}")))?;
        }
    }
    test(&["--workspace", "--no-fail-fast"])
}

fn test(what: &[&str]) -> Result<(), Trouble> {
    tools::run(tools::cargo(&["test"]).args(what).env("FOTON_PROGRAM", program::foton("debug")))
}

/// Processes that do nothing, as fast as they can, until this is dropped.
struct Load(Vec<Child>);

impl Load {
    fn begin() -> Result<Self, Trouble> {
        let mut load = Self(Vec::new());
        for _ in 0..LOOPS {
            // A program of its own: a thread here would have the share of one process only.
            let busy = std::env::current_exe().and_then(|program| {
                std::process::Command::new(program).arg("busy").stdin(std::process::Stdio::piped()).spawn()
            });
            load.0.push(busy.map_err(|cause| Trouble::Failed(format!("no busy loop: {cause}")))?);
        }
        Ok(load)
    }
}

impl Drop for Load {
    fn drop(&mut self) {
        for child in &mut self.0 {
            // What has ended by itself needs no killing.
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

/// What a busy loop does: nothing, until whoever started it is gone and its end of the pipe with it.
pub(crate) fn busy() -> Result<(), Trouble> {
    let parent = std::thread::spawn(|| std::io::copy(&mut std::io::stdin(), &mut std::io::sink()));
    while !parent.is_finished() {
        for number in 0..1_000_000_u64 {
            std::hint::black_box(number);
        }
    }
    Ok(())
}
