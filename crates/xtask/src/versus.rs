//! `cargo xtask versus`: foton beside other programs on the same scene for the same time, by the scripts in `tests/versus`.
//!
//! Mitsuba 3 comes from the environment of the conformance tests. LuxCore has one of its own under `target/`, for it asks for
//! other versions of the same packages; where it cannot be installed, the comparison goes without it and says so.

use std::path::PathBuf;
use std::process::Command;

use crate::conformance;
use crate::tools::{self, Trouble};

const LUXCORE: &str = "pyluxcore==2.11.2";

/// Renders and prints the table.
pub(crate) fn run(seconds: &str) -> Result<(), Trouble> {
    if !seconds.parse::<f64>().is_ok_and(|s| s > 0.0) {
        return Err(Trouble::Failed(format!("\"{seconds}\" is no number of seconds")));
    }
    let python = conformance::environment()?;
    tools::run(&mut tools::cargo(&["build", "--release", "--package", "foton"]))?;
    let target = tools::target_dir();
    let mut command = Command::new(python);
    command.env("PYTHONDONTWRITEBYTECODE", "1").env("PYTHONUTF8", "1").arg("tests/versus");
    let foton = target.join("release/foton").with_extension(std::env::consts::EXE_EXTENSION);
    command.arg("--foton").arg(foton).arg("--repository").arg(tools::root());
    command.arg("--out").arg(target.join("versus")).args(["--seconds", seconds]);
    if let Some(luxcore) = luxcore() {
        command.arg("--luxcore").arg(luxcore);
    }
    tools::run(&mut command)
}

/// A Python that has LuxCore, if it can be had.
fn luxcore() -> Option<PathBuf> {
    let folder = tools::target_dir().join("luxcore-venv");
    let python = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    if !python.exists() {
        let system_python = if cfg!(windows) { "python" } else { "python3" };
        tools::run(Command::new(system_python).args(["-m", "venv"]).arg(&folder)).ok()?;
    }
    let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "numpy", LUXCORE];
    tools::run(Command::new(&python).args(install)).ok()?;
    Some(python)
}
