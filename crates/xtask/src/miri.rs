//! `cargo xtask miri`: tests under Miri, the interpreter that knows what memory may be used for. foton's own code has no `unsafe`, so
//! what is watched is what the libraries below do with our inputs.
//!
//! Miri is a hundred to a thousand times slower than a machine. What does not run, and why, stands in [`PARTS`] and [`LEFT_OUT`],
//! and nowhere else.

use std::process::Command;

use crate::tools::{self, Trouble};

/// The machine's files and clocks may be used, and rounding is that of the machine: Miri else rounds `powi` and its like at random.
const FLAGS: &str = "-Zmiri-disable-isolation -Zmiri-deterministic-floats";

/// Tests of a package that run.
struct Part {
    /// Arguments that choose them.
    tests: &'static str,
    /// Words in the names of those that do not, and why.
    skipped: &'static [(&'static str, &'static str)],
}

const PARTS: &[Part] = &[
    Part { tests: "-p foton-math --lib", skipped: &[] },
    Part { tests: "-p foton-input --lib", skipped: &[] },
    Part {
        tests: "-p foton-format --lib",
        skipped: &[
            ("linear_time", "inputs of hundreds of thousands of things: hours"),
            ("deep_nesting", "200,000 elements within each other: hours"),
            ("any_bytes", "20,000 inputs: hours; `small` has some of them"),
            ("too_many_corners", "polygons of tens of thousands of corners: hours"),
            ("numbers_read_back_to_the_same_bits", "a hundred thousand numbers: hours"),
            ("values_that_double", "megabytes of text: hours"),
        ],
    },
    Part { tests: "-p foton-format --test small", skipped: &[] },
];

/// What runs not at all, and why.
const LEFT_OUT: &[(&str, &str)] = &[
    ("foton-input --test kinds", "makes pipes by another program, and polls them, which Miri does not"),
    ("foton-format, other tests", "the same readers on larger inputs; `small` has each of them once"),
    ("foton-film", "its encoders take minutes a picture; its readers are reached through foton-format"),
    (
        "foton-scene",
        "half of its tests take more than 45 s each; 12 of 26 were run by hand, and nothing was found",
    ),
    (
        "foton-integrator, foton-session, foton-measure, foton",
        "begin threads of Rayon, where Miri stops in crossbeam-epoch at the experimental rules of Stacked Borrows",
    ),
    ("foton-preview", "calls the window system and the driver of the graphics card"),
];

/// Runs all parts, and lists what does not run.
pub(crate) fn all() -> Result<(), Trouble> {
    if !tools::succeeds(&["rustup", "run", "nightly", "cargo", "miri", "--version"]) {
        return Err(Trouble::Missing(
            "Miri: rustup toolchain install nightly && rustup component add miri rust-src --toolchain nightly".to_owned(),
        ));
    }
    for part in PARTS {
        println!("== {}", part.tests);
        let mut command = Command::new("rustup");
        command.args(["run", "nightly", "cargo", "miri", "test", "--locked"]);
        command.args(part.tests.split(' ')).arg("--");
        // Else the compiler of this task would be taken.
        for name in ["CARGO", "RUSTC", "RUSTDOC", "RUSTUP_TOOLCHAIN"] {
            command.env_remove(name);
        }
        command.env("MIRIFLAGS", FLAGS);
        for (word, why) in part.skipped {
            println!("not run: {word}: {why}");
            command.args(["--skip", word]);
        }
        tools::run(&mut command)?;
    }
    for (what, why) in LEFT_OUT {
        println!("not run: {what}: {why}");
    }
    Ok(())
}
