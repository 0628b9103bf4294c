//! How fast, by whole runs. `cargo xtask bench [WHAT]` runs it; docs/performance.md records what it prints.
//!
//! `whole` (also without a word): stages, rates, efficiency and memory of the benchmark box. `scaling`: a pass over triangles, photons
//! and hit points. `wide`: scenes that ask for more. `accuracy`: error a processor second. `answers`: commands within a long
//! pass. Figures are medians over passes of the wall's time: they mean little on a machine that does anything else. `first-light`: what the
//! window shows in its first seconds of processor time. `loading`: what it takes to open a large mesh.
//! `instances`: memory, edits and rays of many shapes that share a mesh. `to-error`: the processor time that one foton needs to the error of another.
#![allow(clippy::print_stdout, reason = "a program that prints tables")]

mod accuracy;
mod answers;
mod first_light;
mod instances;
mod loading;
mod rig;
mod scaling;
mod to_error;
mod whole;
mod wide;

fn main() {
    match std::env::args().nth(1).as_deref() {
        None | Some("whole") => whole::print(),
        Some("scaling") => scaling::print(),
        Some("wide") => wide::print(),
        Some("accuracy") => accuracy::print(),
        Some("answers") => answers::print(),
        Some("first-light") => first_light::print(),
        Some("instances") => instances::print(),
        Some("loading") => loading::print(std::env::args().nth(2).as_deref()),
        Some("to-error") => to_error::print(&std::env::args().skip(2).collect::<Vec<_>>()),
        Some(other) => {
            eprintln!(
                "no benchmark \"{other}\": whole, scaling, wide, accuracy, answers, first-light, instances, loading, to-error"
            );
            std::process::exit(2);
        }
    }
}
