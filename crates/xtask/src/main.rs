//! Developer tasks: `cargo xtask test`, `ci`, `conformance`, `versus`, `assets`, `pictures`, `lecture`, `screenshots`, `bench`, `monkey`, `soak`, `kills`,
//! `limits`, `loaded`, `mutations`, `miri`.
//!
//! Nothing here is part of the program; what a task does is in the module of its name.
#![allow(clippy::print_stdout, reason = "these tasks talk to the person who started them")]

mod assets;
mod ci;
mod conformance;
mod lecture;
mod loaded;
mod miri;
mod mutations;
mod pictures;
mod program;
mod test;
mod tools;
mod versus;

use std::process::ExitCode;

use tools::Trouble;

const USAGE: &str = "\
cargo xtask test [--install]        all tests, and a small comparison with Mitsuba 3;
                                    --install fetches missing system packages with sudo
cargo xtask ci                      formatting, lints, documentation, then the tests
cargo xtask conformance [WHAT]      the whole comparison with Mitsuba 3 (30 minutes and more); --quick: a small one;
                                    --plugins: plugins and dialects alone, and docs/plugin-checks.md, which shows them
cargo xtask versus [--seconds N]    foton, Mitsuba 3 and LuxCore on one scene for N (30) seconds each, as a table and pictures
cargo xtask calibrate [WHAT]        whether the live error can be believed; stops: where --error does; slopes: how fast noise and bias fall;
                                    rules: what adaptive radii gain; floors: what the smallest radius costs; kernels: how other kernels compare with the box (many minutes)
cargo xtask assets                  writes the generated meshes in assets/ again
cargo xtask pictures [--window]     renders every scene in assets/ to docs/pictures, and the window (some minutes); or it alone
cargo xtask lecture                 pictures for a lecture, each by one command, and docs/lecture.md, which shows them (some minutes)
cargo xtask screenshots [FOLDER]    the window in each state of its panels, both themes and several sizes (target/screenshots), to look at
cargo xtask bench [WHAT]            how fast, on a quiet machine: whole (the benchmark box, stage by stage), parts (by criterion), scaling,
                                    wide, accuracy (error a processor second), answers (commands within a
                                    long pass), first-light (the window's first seconds), census (what
                                    leaving parts out saves), instances (many shapes of one mesh), loading
                                    (opening a mesh of 2 M triangles), to-error (processor time that one foton needs
                                    to the error of another, scene by scene)
cargo xtask monkey [--minutes N]    random clicks and keys in the window for N (10) minutes: no error, no memory that grows
cargo xtask soak [MINUTES]          one small render for MINUTES (20): no memory that grows, no drift of the mean, no NaN
cargo xtask kills [N]               kills N (200) renders at random moments: all checkpoints open, no file is half of one
cargo xtask limits                  renders in as little memory as --memory accepts, under a hard limit of the system
cargo xtask loaded                  tests of threads and windows ten times, then all tests, beside eight busy loops (an hour and more)
cargo xtask mutations [WORD,…]      removes protections from a copy of the tree, one by one: does their test notice? (many minutes)
cargo xtask miri                    readers of files and pure crates under Miri, where a nightly has it; says what does not run (some minutes)";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let outcome = match arguments.as_slice() {
        ["test"] => test::all(false),
        ["test", "--install"] => test::all(true),
        ["ci"] => ci::all(),
        ["conformance"] => conformance::full(),
        ["conformance", "--quick"] => conformance::quick(),
        ["conformance", "--plugins"] => conformance::plugins(),
        ["versus"] => versus::run("30"),
        ["versus", "--seconds", seconds] => versus::run(seconds),
        ["bench", "parts"] => {
            tools::run(&mut tools::cargo(&["bench", "--manifest-path", "benches/Cargo.toml"]))
        }
        ["bench", "census"] => example("census", &[]),
        ["bench", rest @ ..] => example("bench", rest),
        ["calibrate", rest @ ..] => example("calibrate", rest),
        ["assets"] => assets::write_all(&tools::root().join("assets"))
            .map_err(|cause| Trouble::Failed(cause.to_string())),
        ["pictures"] => pictures::render_all(),
        ["pictures", "--window"] => pictures::of_window(),
        ["lecture"] => lecture::make(),
        ["screenshots"] => program::screenshots(&tools::target_dir().join("screenshots")),
        ["screenshots", folder] => program::screenshots(folder.as_ref()),
        ["monkey"] => program::monkey("10"),
        ["monkey", "--minutes", minutes] => program::monkey(minutes),
        ["kills"] => program::kills("200"),
        ["kills", count] => program::kills(count),
        ["limits"] => program::limits(),
        ["loaded"] => loaded::all(),
        ["busy"] => loaded::busy(),
        ["mutations"] => mutations::run(""),
        ["miri"] => miri::all(),
        ["mutations", word] => mutations::run(word),
        ["soak", minutes @ ..] if minutes.len() <= 1 => tools::run(
            tools::cargo(&["run", "--package", "foton-tests", "--example", "soak", "--"]).args(minutes),
        ),
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(trouble) => {
            eprintln!("{trouble}");
            ExitCode::FAILURE
        }
    }
}

/// Runs a program of the test crate, optimised.
fn example(name: &str, arguments: &[&str]) -> Result<(), Trouble> {
    let mut command =
        tools::cargo(&["run", "--release", "--package", "foton-tests", "--example", name, "--"]);
    tools::run(command.args(arguments))
}
