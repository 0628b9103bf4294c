//! Files that appear whole: written beside their target, then renamed over it. No locking between writers: the last wins.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU32, Ordering};

use crate::WriteError;

/// Writes `path` so that a reader, or a crash, meets the old file or the new one and never half of one.
///
/// `fill` writes to `.NAME.tmp-PID-N` in the same folder, which is flushed, synced to the disk and renamed over the
/// target; when anything fails it is removed and the target stays as it was. A link is followed; a device or pipe
/// (`/dev/null`) is written straight, since a rename would replace it.
///
/// # Errors
/// [`WriteError`] with the path: the folder is missing, the file is read-only, or the system or `fill` failed.
pub fn atomic_write(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), WriteError> {
    let to_error = WriteError::io(path);
    match Target::of(path)? {
        Target::Stream => stream(path, fill),
        Target::File(target) => replace(&target, fill),
    }
    .map_err(to_error)
}

/// Whether [`atomic_write`] can write `path` as things stand: the temporary file is made and removed again.
///
/// # Errors
/// As [`atomic_write`].
pub fn check_writable(path: &Path) -> Result<(), WriteError> {
    let Target::File(target) = Target::of(path)? else { return Ok(()) };
    let temp = temp_path(&target).map(Temp);
    temp.and_then(|temp| File::create(&temp.0).map(drop)).map_err(WriteError::io(path))
}

/// Where the bytes go.
enum Target {
    /// A plain file, with links followed; it may not exist yet.
    File(PathBuf),
    /// Something that must not be replaced.
    Stream,
}

impl Target {
    fn of(path: &Path) -> Result<Self, WriteError> {
        let to_error = WriteError::io(path);
        match fs::metadata(path) {
            Ok(found) if found.is_dir() => Err(to_error(ErrorKind::IsADirectory.into())),
            Ok(found) if !found.is_file() => Ok(Self::Stream),
            Ok(found) if found.permissions().readonly() => Err(WriteError::ReadOnly { path: path.into() }),
            Ok(_) => fs::canonicalize(path).map(Self::File).map_err(to_error),
            Err(cause) if cause.kind() == ErrorKind::NotFound => {
                let folder = folder_of(path);
                if folder.is_dir() {
                    Ok(Self::File(path.into()))
                } else {
                    Err(WriteError::NoFolder { path: path.into(), folder: folder.into() })
                }
            }
            Err(cause) => Err(to_error(cause)),
        }
    }
}

/// The folder of a file; the current one when the path names none.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Fills a device or pipe in place.
fn stream(path: &Path, fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    let mut writer = BufWriter::new(OpenOptions::new().write(true).open(path)?);
    fill(&mut writer)?;
    writer.flush()
}

/// Fills a temporary file and renames it over `target`.
fn replace(target: &Path, fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    let temp = Temp(temp_path(target)?);
    let mut writer = BufWriter::new(File::create(&temp.0)?);
    fill(&mut writer)?;
    writer.flush()?;
    writer.get_ref().sync_all()?;
    drop(writer);
    fs::rename(&temp.0, target)
}

/// `.NAME.tmp-PID-N` beside `target`; N keeps threads of one process apart.
fn temp_path(target: &Path) -> io::Result<PathBuf> {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let name = target.file_name().ok_or(ErrorKind::InvalidInput)?;
    let mut temp = OsString::from(".");
    temp.push(name);
    temp.push(format!(".tmp-{}-{}", process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
    Ok(target.with_file_name(temp))
}

/// Removes its file when dropped; after the rename there is nothing left to remove.
struct Temp(PathBuf);

impl Drop for Temp {
    fn drop(&mut self) {
        // A failure to remove must not hide the failure that brought us here.
        let _ = fs::remove_file(&self.0);
    }
}
