//! Files under names that a program chose itself: they appear whole, and never in the place of another.

use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::Path;

use super::temporary::Temporary;
use super::{stale, target};
use crate::WriteError;

/// Lets `write` write a file beside `path`, which then gets that name unless something has it. No link is followed.
///
/// # Errors
/// As `write`, with the path; and [`WriteError::is_taken`] if something is there, which is left as it is.
pub fn write_new(path: &Path, write: impl FnOnce(&Path) -> Result<(), WriteError>) -> Result<(), WriteError> {
    let to_error = WriteError::io(path);
    if path.symlink_metadata().is_ok() {
        return Err(to_error(ErrorKind::AlreadyExists.into()));
    }
    let folder = target::folder_of(path);
    if !folder.is_dir() {
        return Err(WriteError::NoFolder { path: path.into(), folder: folder.into() });
    }
    stale::remove(path);
    let (temporary, _lock) = Temporary::make(path, path, None)?;
    write(temporary.path()).map_err(|error| error.about(path))?;
    give_name(temporary, path).map_err(to_error)
}

/// Gives a file a name that nothing has. Two programs may try at once: the system lets one of them.
fn give_name(file: Temporary, path: &Path) -> io::Result<()> {
    match fs::hard_link(file.path(), path) {
        // The other name goes with the value.
        Ok(()) => Ok(()),
        Err(cause) if cause.kind() == ErrorKind::AlreadyExists => Err(cause),
        // Some file systems have no such links.
        Err(_) => {
            File::create_new(path)?;
            file.rename(path).inspect_err(|_| {
                let _ = fs::remove_file(path);
            })
        }
    }
}
