//! Temporary files: names that nobody can guess, made anew or not at all, with the rights of what they replace.

use std::collections::BTreeSet;
use std::ffi::{OsStr, OsString};
use std::fs::{self, File, Metadata, OpenOptions};
use std::hash::{BuildHasher, RandomState};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::target::folder_of;
use crate::WriteError;

/// A name up to this many bytes stands in that of its temporary file; of a longer one there is a hash, for names may not have more
/// than 255, on some file systems 143.
const MAX_NAME: usize = 100;

/// How often another name is tried where one is taken.
const TRIES: usize = 8;

/// A file that is removed when dropped, unless it was renamed.
pub(super) struct Temporary {
    path: PathBuf,
    name: OsString,
}

impl Temporary {
    /// Makes one for a target, which stands for `path`.
    pub(super) fn make(
        path: &Path,
        target: &Path,
        old: Option<&Metadata>,
    ) -> Result<(Self, File), WriteError> {
        Self::create(target, old).map_err(|cause| WriteError::Folder {
            path: path.into(),
            folder: folder_of(target).into(),
            cause,
        })
    }

    /// Makes `.NAME.tmp-PID-RANDOM` beside `target`. What is there already by that name, link or not, is left alone.
    fn create(target: &Path, old: Option<&Metadata>) -> io::Result<(Self, File)> {
        let prefix = prefix(target).ok_or(ErrorKind::InvalidInput)?;
        let mut failure = io::Error::from(ErrorKind::AlreadyExists);
        for _ in 0..TRIES {
            let mut name = prefix.clone();
            name.push(format!("{}-{:016x}", process::id(), random()));
            // Named before it is made, so that another thread's look for leftovers knows it.
            let temporary = Self { path: folder_of(target).join(&name), name };
            ours().insert(temporary.name.clone());
            match options(old).open(&temporary.path) {
                Ok(file) => {
                    // Where there are no locks, the number of the process must do.
                    let _ = file.try_lock();
                    if let Some(old) = old {
                        copy_rights(&file, old);
                    }
                    return Ok((temporary, file));
                }
                Err(cause) => {
                    temporary.forget();
                    if cause.kind() != ErrorKind::AlreadyExists {
                        return Err(cause);
                    }
                    failure = cause;
                }
            }
        }
        Err(failure)
    }

    /// Where it is.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Gives it the name of its target. On failure it is removed.
    pub(super) fn rename(self, target: &Path) -> io::Result<()> {
        fs::rename(&self.path, target)?;
        self.forget();
        Ok(())
    }

    /// Whether this process has the file of that name in hand.
    pub(super) fn is_ours(name: &OsStr) -> bool {
        ours().contains(name)
    }

    /// Lets it be: it is not there, or not by this name.
    fn forget(mut self) {
        self.path.clear();
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if !self.path.as_os_str().is_empty() {
            // A failure to remove must not hide the failure that brought us here.
            let _ = fs::remove_file(&self.path);
        }
        ours().remove(&self.name);
    }
}

/// What the names of all temporary files of a target begin with; `None` where it has no name.
pub(super) fn prefix(target: &Path) -> Option<OsString> {
    let name = target.file_name()?;
    let mut prefix = OsString::from(".");
    let bytes = name.as_encoded_bytes();
    if bytes.len() <= MAX_NAME {
        prefix.push(name);
    } else {
        // FNV-1a, 64 bits.
        let hash = bytes
            .iter()
            .fold(0xcbf2_9ce4_8422_2325_u64, |h, &b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
        prefix.push(format!("{hash:016x}"));
    }
    prefix.push(".tmp-");
    Some(prefix)
}

/// Names of the temporary files that this process has in hand.
fn ours() -> MutexGuard<'static, BTreeSet<OsString>> {
    static OURS: Mutex<BTreeSet<OsString>> = Mutex::new(BTreeSet::new());
    OURS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A number that nobody can guess: a keyed hash under a key of the system's random numbers.
fn random() -> u64 {
    RandomState::new().hash_one(process::id())
}

/// Makes a file and opens none. It is at no time open to more people than the one that it replaces.
fn options(old: Option<&Metadata>) -> OpenOptions {
    let mut options = File::options();
    options.write(true).create_new(true);
    #[cfg(unix)]
    if let Some(old) = old {
        use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
        options.mode(old.mode() & RIGHTS);
    }
    #[cfg(not(unix))]
    let _ = old;
    options
}

/// Bits of a mode that are copied; as after any write, no program takes its owner's rights by it.
#[cfg(unix)]
const RIGHTS: u32 = 0o777;

/// Gives a file the owner, the group and the mode of another, as far as the system allows. What it does not is no failure: the
/// file is then its writer's, and never open to more people.
#[cfg(unix)]
fn copy_rights(file: &File, old: &Metadata) {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
    let Ok(now) = file.metadata() else { return };
    let mut mode = old.mode() & RIGHTS;
    if (now.uid(), now.gid()) != (old.uid(), old.gid())
        && fchown(file, Some(old.uid()), Some(old.gid())).is_err()
        && now.gid() != old.gid()
        && fchown(file, None, Some(old.gid())).is_err()
    {
        // Another group may do what everyone may.
        mode &= 0o707 | (mode & 0o007) << 3;
    }
    let _ = file.set_permissions(fs::Permissions::from_mode(mode));
}

#[cfg(not(unix))]
fn copy_rights(_: &File, _: &Metadata) {}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    /// A link that somebody has put in the way.
    #[test]
    fn what_is_there_by_that_name_is_neither_opened_nor_followed() {
        let folder = std::env::temp_dir().join(format!("foton-film-{}-exclusive", process::id()));
        fs::create_dir_all(&folder).expect("a folder");
        let (victim, trap) = (folder.join("victim"), folder.join("trap"));
        for target in ["victim", "not there"] {
            std::os::unix::fs::symlink(target, &trap).expect("a link");
            fs::write(&victim, "precious").expect("written");
            let outcome = options(None).open(&trap).map_err(|cause| cause.kind());
            assert_eq!(outcome.map(drop), Err(ErrorKind::AlreadyExists));
            assert_eq!(fs::read_to_string(&victim).expect("there"), "precious");
            assert!(!folder.join("not there").exists());
            fs::remove_file(&trap).expect("ours");
        }
        fs::remove_dir_all(&folder).expect("ours");
    }
}
