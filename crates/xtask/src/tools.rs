//! What every task uses: running commands, where things are, and the system packages that cargo cannot bring.

use std::env;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The step of `cargo xtask test` that runs the tests of the workspace.
pub(crate) const CARGO_TEST: &str = "cargo test";

/// The step that compares with Mitsuba 3.
pub(crate) const CONFORMANCE: &str = "comparison with Mitsuba 3 (small)";

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
    /// How to see whether the package, or something as good, is installed.
    probe: Probe,
}

/// How a package is recognised.
enum Probe {
    /// This command succeeds.
    Command(&'static [&'static str]),
    /// This program is found. Asked on Linux alone.
    Program(&'static str),
    /// The dynamic linker knows a library of this name. Asked on Linux alone: other systems bring their own windows.
    Library(&'static str),
    /// A file of such a name is there. Asked on Linux alone.
    File(&'static str),
}

/// Everything beyond Rust that the tests use.
pub(crate) const SYSTEM_PACKAGES: &[SystemPackage] = &[
    needed(CONFORMANCE, "python3", Probe::Command(&["python3", "--version"])),
    needed(CONFORMANCE, "python3-venv", Probe::Command(&["python3", "-c", "import ensurepip, venv"])),
    // A window, and something that draws it: software where there is no graphics card.
    needed(CARGO_TEST, "mesa-vulkan-drivers", Probe::File("/usr/share/vulkan/icd.d/*.json")),
    needed(CARGO_TEST, "libvulkan1", Probe::Library("libvulkan.so.1")),
    needed(CARGO_TEST, "libegl1", Probe::Library("libEGL.so.1")),
    needed(CARGO_TEST, "libgbm1", Probe::Library("libgbm.so.1")),
    needed(CARGO_TEST, "libgl1-mesa-dri", Probe::File("/usr/lib/*/dri/*_dri.so")),
    needed(CARGO_TEST, "libwayland-client0", Probe::Library("libwayland-client.so.0")),
    needed(CARGO_TEST, "libx11-xcb1", Probe::Library("libX11-xcb.so.1")),
    needed(CARGO_TEST, "libxcursor1", Probe::Library("libXcursor.so.1")),
    needed(CARGO_TEST, "libxi6", Probe::Library("libXi.so.6")),
    needed(CARGO_TEST, "libxkbcommon-x11-0", Probe::Library("libxkbcommon-x11.so.0")),
    needed(CARGO_TEST, "libxrandr2", Probe::Library("libXrandr.so.2")),
    // A display that nobody sees, hands for it, and eyes.
    needed(CARGO_TEST, "xvfb", Probe::Program("Xvfb")),
    needed(CARGO_TEST, "xdotool", Probe::Program("xdotool")),
    needed(CARGO_TEST, "imagemagick", Probe::Program("import")),
];

const fn needed(needed_for: &'static str, name: &'static str, probe: Probe) -> SystemPackage {
    SystemPackage { name, needed_for, probe }
}

impl SystemPackage {
    /// Whether it is not there.
    fn is_missing(&self) -> bool {
        let shell = |line: &str, word: &str| !succeeds(&["sh", "-c", line, "sh", word]);
        match self.probe {
            Probe::Command(words) => !succeeds(words),
            Probe::Program(name) => cfg!(target_os = "linux") && shell("command -v \"$1\"", name),
            Probe::Library(name) => {
                cfg!(target_os = "linux")
                    && shell("PATH=$PATH:/sbin:/usr/sbin; ldconfig -p | grep -qF \"$1\"", name)
            }
            // Not quoted, so that the pattern is tried.
            Probe::File(pattern) => cfg!(target_os = "linux") && shell("ls $1", pattern),
        }
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
pub(crate) fn succeeds(words: &[&str]) -> bool {
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
