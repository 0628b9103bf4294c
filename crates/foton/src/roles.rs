//! Files by the options that name them: what is read is not written, and two things are not written to one file. Links of either
//! kind are followed, so that names alone do not hide it.
//!
//! Not here: whether a file can be read or written at all.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

use foton_film::{is_same_file, stands_for};
use foton_session::snapshot;

use crate::args::Every;

/// What is done with a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Use {
    Read,
    Written,
    /// A checkpoint to go on from; the same file may have later states, too.
    StateRead,
    StateWritten,
}

impl Use {
    const fn is_read(self) -> bool {
        matches!(self, Self::Read | Self::StateRead)
    }

    /// Whether what is written may be what another role is.
    const fn allows(self, other: Self) -> bool {
        matches!((self, other), (Self::StateWritten, Self::StateRead))
    }
}

/// A file and what a person calls it.
struct Role {
    /// An option, or a word for what has none: "--checkpoint", "the scene".
    named: String,
    path: PathBuf,
    used: Use,
    /// The images of `--every` beside an image.
    every: Option<Every>,
}

impl Role {
    /// How messages name it.
    fn text(&self, path: &Path) -> String {
        format!("{} {}", self.named, path.display())
    }

    /// The path of this role's by which it is the file of another role.
    fn meets(&self, other: &Path) -> Option<PathBuf> {
        match self.every {
            None => is_same_file(&self.path, other).then(|| self.path.clone()),
            Some(every) => meets_numbered(&self.path, every, other),
        }
    }
}

/// The image of `--every` that a path leads to, be it there yet or not.
fn meets_numbered(image: &Path, every: Every, other: &Path) -> Option<PathBuf> {
    let is_due = |name: &OsStr| snapshot::pass_of(image, name).is_some_and(|pass| every.is_due(pass));
    // By its own name, and by links among those that are there.
    let own = other.file_name().filter(|name| is_due(name)).map(|name| image.with_file_name(name));
    let folder = image.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let there = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.file_name());
    let there = there.filter(|name| is_due(name)).map(|name| image.with_file_name(name));
    own.into_iter().chain(there).find(|path| is_same_file(path, other))
}

/// All files of a command.
#[derive(Default)]
pub(crate) struct Roles {
    files: Vec<Role>,
    prints: bool,
}

impl Roles {
    /// A file that is read, if there is one; `named` as in messages.
    pub(crate) fn reads(self, named: &str, path: Option<&Path>) -> Self {
        self.with(named, path, Use::Read, None)
    }

    /// A file that is written.
    pub(crate) fn writes(self, named: &str, path: Option<&Path>) -> Self {
        self.with(named, path, Use::Written, None)
    }

    /// The images that `--every` asks for beside an image.
    pub(crate) fn writes_numbered(self, image: &Path, every: Option<Every>) -> Self {
        match every {
            Some(_) => self.with("--every", Some(image), Use::Written, every),
            None => self,
        }
    }

    /// A checkpoint to go on from.
    pub(crate) fn resumes(self, path: Option<&Path>) -> Self {
        self.with("--resume", path, Use::StateRead, None)
    }

    /// Where checkpoints are written; where it was read from is such a place.
    pub(crate) fn keeps(self, path: Option<&Path>) -> Self {
        self.with("--checkpoint", path, Use::StateWritten, None)
    }

    /// Whether results go to standard output.
    pub(crate) fn prints(self, prints: bool) -> Self {
        Self { prints, ..self }
    }

    /// Files that the scene is read from, known once it was.
    pub(crate) fn scene_reads(self, files: &[PathBuf]) -> Self {
        files.iter().fold(self, |roles, file| roles.reads("the scene's file", Some(file)))
    }

    fn with(mut self, named: &str, path: Option<&Path>, used: Use, every: Option<Every>) -> Self {
        self.files.extend(path.map(|path| Role {
            named: named.to_owned(),
            path: path.to_owned(),
            used,
            every,
        }));
        self
    }

    /// Which two are one file although one of them is written, and what would help.
    pub(crate) fn clash(&self) -> Option<Clash> {
        let written = self.files.iter().enumerate().filter(|(_, role)| !role.used.is_read());
        let mut pairs = written.flat_map(|(i, one)| {
            let others = self.files.iter().enumerate();
            let others = others.filter(move |(j, other)| *j != i && !one.used.allows(other.used));
            // Of images with numbers there is no one path to be met.
            others.filter(|(_, other)| other.every.is_none()).map(move |(_, other)| (one, other))
        });
        let found = pairs.find_map(|(one, other)| Some(refusal(one, &one.meets(&other.path)?, other)));
        let files = found.map(|message| Clash { message, is_standard_output: false });
        files.or_else(|| self.clash_with_standard_output())
    }

    /// Standard output may have been sent into one of the files.
    fn clash_with_standard_output(&self) -> Option<Clash> {
        let stream = standard_output().filter(|_| self.prints)?;
        let role = self.files.iter().find(|role| role.every.is_none() && stands_for(&stream, &role.path))?;
        let message = format!("standard output goes into {}; send it elsewhere", role.text(&role.path));
        Some(Clash { message, is_standard_output: true })
    }
}

/// Two roles of one file.
#[derive(Debug)]
pub(crate) struct Clash {
    /// Which, and what would help.
    pub(crate) message: String,
    /// Whether saying so on standard output would be the damage itself.
    pub(crate) is_standard_output: bool,
}

fn refusal(one: &Role, path: &Path, other: &Role) -> String {
    let [a, b] = [one.text(path), other.text(&other.path)];
    let why = if other.used.is_read() {
        "what is read would be written over; write to another file"
    } else {
        "one would be written over the other; give each a file of its own"
    };
    format!("{a} and {b} are the same file: {why}")
}

/// Standard output as a file of this process's own.
fn standard_output() -> Option<File> {
    #[cfg(unix)]
    {
        use std::os::fd::AsFd;
        std::io::stdout().as_fd().try_clone_to_owned().ok().map(File::from)
    }
    #[cfg(not(unix))]
    None
}
