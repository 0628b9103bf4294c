//! Files that appear whole: written beside their target, then renamed over it. No locking between writers: the last wins.

mod fresh;
mod spare;
mod stale;
mod target;
mod temporary;

use std::fs::File;
use std::io::{self, BufWriter, Read, Write};
use std::path::Path;

use crate::WriteError;
use target::Target;
use temporary::Temporary;

pub use fresh::write_new;
pub use spare::write_spare;
pub use target::{is_same_file, stands_for};

/// Writes `path` so that a reader, or a crash, meets the old file or the new one and never half of one.
///
/// `fill` writes to `.NAME.tmp-PID-RANDOM` in the same folder, which no link can redirect and which is flushed, synced to the disk
/// and renamed over the target; when anything fails it is removed and the target stays as it was. What a process that was killed
/// has left of the same name is removed. The new file has the old one's permissions and, where the system allows it, its owner;
/// one that is new has those of any new file. Access control lists are not copied.
///
/// Links are followed, also one whose target does not exist yet: then the target is made. A character device or pipe (`/dev/null`)
/// is written straight, since a rename would replace it; a pipe must have a reader.
///
/// # Errors
/// [`WriteError`] with the path: the folder is missing, the file is read-only, or the system or `fill` failed.
pub fn atomic_write(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), WriteError> {
    match Target::of(path)? {
        Target::Stream(stream) => {
            stream.open(path).and_then(|file| put(file, fill)).map(drop).map_err(WriteError::io(path))
        }
        Target::File { target, old } => {
            stale::remove(&target);
            let (temporary, file) = Temporary::make(path, &target, old.as_ref())?;
            put(file, fill)
                .and_then(|file| file.sync_all())
                .and_then(|()| temporary.rename(&target))
                .map_err(WriteError::io(path))
        }
    }
}

/// Whether [`atomic_write`] can write `path` as things stand: the temporary file is made and removed again, and a file that is there
/// is opened to write. A pipe is not opened, for its reader would take that for the whole file.
///
/// # Errors
/// As [`atomic_write`].
pub fn check_writable(path: &Path) -> Result<(), WriteError> {
    let Target::File { target, old } = Target::of(path)? else { return Ok(()) };
    if old.is_some() {
        File::options().write(true).open(&target).map_err(WriteError::io(path))?;
    }
    let (_temporary, file) = Temporary::make(path, &target, old.as_ref())?;
    match &old {
        Some(old) => target::check_replaceable(&file, &target, old).map_err(WriteError::io(path)),
        None => Ok(()),
    }
}

/// Opens a log, which is written line by line and not whole. A file that is there is emptied only if it is empty or begins like this
/// kind of log; links and streams are as in [`atomic_write`].
///
/// # Errors
/// As [`atomic_write`], and if the file is of another kind.
pub fn create_log(path: &Path, begins: &str) -> Result<File, WriteError> {
    let to_error = WriteError::io(path);
    match Target::of(path)? {
        Target::Stream(stream) => stream.open(path).map_err(to_error),
        Target::File { target, old: None } => File::create_new(target).map_err(to_error),
        Target::File { target, old: Some(_) } => {
            let mut start = Vec::new();
            let file = File::open(&target).map_err(&to_error)?;
            file.take(begins.len() as u64).read_to_end(&mut start).map_err(&to_error)?;
            if !start.is_empty() && start != begins.as_bytes() {
                let what = "another kind of file, which would be lost";
                return Err(WriteError::Special { path: path.into(), what });
            }
            File::create(target).map_err(to_error)
        }
    }
}

/// The first bytes of a file that is there, at most so many: for asking what kind of output would be replaced.
///
/// # Errors
/// What the system says; and for anything that is no plain file.
pub fn head_of(path: &Path, length: usize) -> io::Result<Vec<u8>> {
    if !std::fs::metadata(path)?.is_file() {
        return Err(io::ErrorKind::InvalidInput.into());
    }
    let mut head = Vec::new();
    File::open(path)?.take(length as u64).read_to_end(&mut head)?;
    Ok(head)
}

/// Fills a file.
fn put(file: File, fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<File> {
    let mut writer = BufWriter::new(file);
    fill(&mut writer)?;
    writer.flush()?;
    writer.into_inner().map_err(io::IntoInnerError::into_error)
}
