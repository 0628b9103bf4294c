//! `cargo xtask conformance`: makes a Python environment with Mitsuba 3 under `target/`, builds foton, and runs `tests/conformance`.
//!
//! What is compared and how closely is written there.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::tools::{self, Trouble};

const SCRIPTS: &str = "tests/conformance";

/// One small diffuse scene and some plugins, with the dev build that the tests have just made.
pub(crate) fn quick() -> Result<(), Trouble> {
    let python = environment()?;
    // By the same command as the tests, so that the dependencies are built with the same features, hence only once.
    tools::run(&mut tools::cargo(&["test", "--workspace", "--no-run"]))?;
    compare(&python, "debug", &["--quick"])
}

/// Every scene and check, with the release build.
pub(crate) fn full() -> Result<(), Trouble> {
    with_release(&[])
}

/// Scenes of plugins and dialects, and the page of what was found.
pub(crate) fn plugins() -> Result<(), Trouble> {
    with_release(&["--plugins", "--table", "docs/plugin-checks.md"])
}

fn with_release(options: &[&str]) -> Result<(), Trouble> {
    let python = environment()?;
    tools::run(&mut tools::cargo(&["build", "--release", "--package", "foton"]))?;
    compare(&python, "release", options)
}

/// Runs the scripts against the program of a profile.
fn compare(python: &Path, profile: &str, options: &[&str]) -> Result<(), Trouble> {
    let target = tools::target_dir();
    let foton = target.join(profile).join("foton").with_extension(std::env::consts::EXE_EXTENSION);
    let mut command = Command::new(python);
    command.env("PYTHONDONTWRITEBYTECODE", "1").env("PYTHONUTF8", "1");
    command.arg(SCRIPTS).arg("--foton").arg(foton).arg("--repository").arg(tools::root());
    tools::run(command.arg("--out").arg(target.join("conformance")).args(options))
}

/// The interpreter of an environment that holds what `requirements.txt` asks for; made or made anew where needed.
pub(crate) fn environment() -> Result<PathBuf, Trouble> {
    let folder = tools::target_dir().join("conformance-venv");
    let python = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let requirements = tools::root().join(SCRIPTS).join("requirements.txt");
    let wanted = fs::read_to_string(&requirements).map_err(failed)?;
    let stamp = folder.join("installed.txt");
    if fs::read_to_string(&stamp).is_ok_and(|installed| installed == wanted) && python.exists() {
        return Ok(python);
    }
    let system_python = if cfg!(windows) { "python" } else { "python3" };
    let make = tools::run(Command::new(system_python).args(["-m", "venv", "--clear"]).arg(&folder));
    let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement"];
    make.and_then(|()| tools::run(Command::new(&python).args(install).arg(&requirements)))
        .map_err(missing)?;
    fs::write(stamp, wanted).map_err(failed)?;
    Ok(python)
}

/// Without network, or with a Python that Mitsuba has no build for, the comparison cannot start.
fn missing(trouble: Trouble) -> Trouble {
    match trouble {
        Trouble::Failed(why) | Trouble::Missing(why) => {
            Trouble::Missing(format!("a Python environment with Mitsuba 3 ({why})"))
        }
    }
}

fn failed(cause: std::io::Error) -> Trouble {
    Trouble::Failed(cause.to_string())
}
