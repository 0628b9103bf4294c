//! What every task uses: running commands, where things are, and the system packages that cargo cannot bring.

use std::env;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Why a task did not succeed.
#[derive(Debug)]
pub(crate) enum Trouble {
    /// It ran and found a fault, or could not do its work.
    Failed(String),
    /// It could not start, because this is not on the machine.
    Missing(String),
}

impl fmt::Display for Trouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Failed(why) => write!(f, "failed: {why}"),
            Self::Missing(what) => write!(f, "missing: {what}"),
        }
    }
}

/// A package of the system, by its Debian name.
pub(crate) struct SystemPackage {
    /// The name that apt knows.
    pub(crate) name: &'static str,
    /// The step of `cargo xtask test` that cannot run without it.
    pub(crate) needed_for: &'static str,
    /// A command that succeeds where the package, or something as good, is installed.
    probe: &'static [&'static str],
}

/// Everything beyond Rust that the tests use.
pub(crate) const SYSTEM_PACKAGES: &[SystemPackage] = &[
    SystemPackage { name: "python3", needed_for: crate::conformance::STEP, probe: &["python3", "--version"] },
    SystemPackage {
        name: "python3-venv",
        needed_for: crate::conformance::STEP,
        probe: &["python3", "-c", "import ensurepip, venv"],
    },
];

impl SystemPackage {
    /// Whether the probe fails.
    fn is_missing(&self) -> bool {
        !succeeds(self.probe)
    }
}

/// Installs what is missing, as root or where the person asked for it; otherwise says how. Returns what is missing afterwards.
pub(crate) fn provide_packages(asked_to_install: bool) -> Vec<&'static SystemPackage> {
    let missing = || SYSTEM_PACKAGES.iter().filter(|package| package.is_missing()).collect::<Vec<_>>();
    let wanted = missing();
    if wanted.is_empty() {
        return wanted;
    }
    let names: Vec<&str> = wanted.iter().map(|package| package.name).collect();
    let as_root = succeeds(&["sh", "-c", "[ $(id -u) = 0 ]"]);
    if !succeeds(&["apt-get", "--version"]) || !(as_root || asked_to_install) {
        let line = format!("sudo apt-get install -y --no-install-recommends {}", names.join(" "));
        println!("not installed: {}. To install: {line}", names.join(", "));
        return wanted;
    }
    println!("installing system packages: {}", names.join(", "));
    let apt = |arguments: &[&str]| {
        let mut command = if as_root { Command::new("apt-get") } else { Command::new("sudo") };
        if !as_root {
            command.arg("apt-get");
        }
        run(command.args(arguments))
    };
    let install: Vec<&str> = ["install", "-y", "--no-install-recommends"].into_iter().chain(names).collect();
    if let Err(trouble) = apt(&["update", "-q"]).and_then(|()| apt(&install)) {
        println!("{trouble}");
    }
    missing()
}

/// Prints and runs a command in the root of the repository.
pub(crate) fn run(command: &mut Command) -> Result<(), Trouble> {
    let line = describe(command);
    println!("$ {line}");
    match command.current_dir(root()).status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(Trouble::Failed(format!("{line}: {status}"))),
        Err(cause) if cause.kind() == io::ErrorKind::NotFound => Err(Trouble::Missing(line)),
        Err(cause) => Err(Trouble::Failed(format!("{line}: {cause}"))),
    }
}

/// The cargo that started this task.
pub(crate) fn cargo(arguments: &[&str]) -> Command {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(arguments);
    command
}

/// The root of the repository.
pub(crate) fn root() -> &'static Path {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.ancestors().nth(2).expect("this crate lies two folders below the root")
}

/// The folder that cargo builds into: this program itself lies in `debug` there.
pub(crate) fn target_dir() -> PathBuf {
    let program = env::current_exe().expect("the system knows the running program");
    program.ancestors().nth(2).expect("cargo puts programs into a folder per profile").to_path_buf()
}

/// Whether this runs unattended, where leaving out a check must not look like passing it.
pub(crate) fn in_ci() -> bool {
    env::var_os("CI").is_some_and(|value| !value.is_empty() && value != "false")
}

/// Whether a command can be run and ends well; its output is dropped.
fn succeeds(words: &[&str]) -> bool {
    let mut command = Command::new(words[0]);
    command.args(&words[1..]).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// The command as one would type it.
fn describe(command: &Command) -> String {
    let program = Path::new(command.get_program()).file_name().unwrap_or(command.get_program());
    let words = std::iter::once(program).chain(command.get_args());
    words.map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ")
}
