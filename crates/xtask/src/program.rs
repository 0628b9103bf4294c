//! What runs the built program from outside: `cargo xtask monkey` and pictures of the real window on a display that nobody sees, and
//! `cargo xtask kills` and `limits`.

use std::path::{Path, PathBuf};

use crate::tools::{self, Trouble};

/// Random clicks and keys for some minutes, in the dev build.
///
/// # Errors
/// What could not be built, or what the monkey found.
pub(crate) fn monkey(minutes: &str) -> Result<(), Trouble> {
    if !minutes.parse::<f64>().is_ok_and(|m| m > 0.0) {
        return Err(Trouble::Failed(format!("\"{minutes}\" is no number of minutes")));
    }
    tools::run(&mut tools::cargo(&["build", "--package", "foton"]))?;
    example("monkey", &foton("debug"), minutes.as_ref())
}

/// Renders that are killed, in the dev build without the window.
///
/// # Errors
/// What could not be built, or what the kills broke.
pub(crate) fn kills(count: &str) -> Result<(), Trouble> {
    if !count.parse::<u32>().is_ok_and(|n| n > 0) {
        return Err(Trouble::Failed(format!("\"{count}\" is no number of kills")));
    }
    example("kills", &windowless()?, count.as_ref())
}

/// Renders in as little memory as they say they need, in the dev build without the window.
///
/// # Errors
/// What could not be built, or did not end.
pub(crate) fn limits() -> Result<(), Trouble> {
    example("limits", &windowless()?, "".as_ref())
}

fn windowless() -> Result<PathBuf, Trouble> {
    tools::run(&mut tools::cargo(&["build", "--package", "foton", "--no-default-features"]))?;
    Ok(foton("debug"))
}

/// Pictures of the window, drawn by the program at `foton`.
///
/// # Errors
/// What could not be built, opened or written.
pub(crate) fn pictures(foton: &Path, folder: &Path) -> Result<(), Trouble> {
    example("window_pictures", foton, folder.as_os_str())
}

/// Pictures of each state of the window, drawn by the dev build.
///
/// # Errors
/// What could not be built, opened or written.
pub(crate) fn screenshots(folder: &Path) -> Result<(), Trouble> {
    tools::run(&mut tools::cargo(&["build", "--package", "foton"]))?;
    example("screenshots", &foton("debug"), folder.as_os_str())
}

/// The program of a profile.
pub(crate) fn foton(profile: &str) -> PathBuf {
    tools::target_dir().join(profile).join(format!("foton{}", std::env::consts::EXE_SUFFIX))
}

fn example(name: &str, foton: &Path, argument: &std::ffi::OsStr) -> Result<(), Trouble> {
    let mut run = tools::cargo(&["run", "--package", "foton-tests", "--example", name, "--"]);
    tools::run(run.arg(foton).arg(argument))
}
