//! A place for what cannot be written where it was asked for, so that hours of work are not lost with a folder.

use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use crate::WriteError;

/// How many names are tried in a folder.
const NAMES: u32 = 1000;
/// How many letters of the name that was asked for stand in the other.
const LETTERS: usize = 60;

/// Lets `write` write beside `path` as `foton-NAME-001.EXT` with the first number that is free, or where there is no room in the
/// system's folder for temporary files; returns where. A file or link that is there already is never written to, and nothing is left
/// of what fails. `None` where there is no room either.
pub fn write_spare(path: &Path, write: impl Fn(&Path) -> Result<(), WriteError>) -> Option<PathBuf> {
    [path.to_owned(), std::env::temp_dir().join("_")].iter().find_map(|beside| {
        let spare = take(beside, path)?;
        if write(&spare).is_ok() {
            return Some(spare);
        }
        let _ = fs::remove_file(&spare);
        None
    })
}

/// Makes an empty file in the folder of another, with a name that nobody had.
fn take(beside: &Path, path: &Path) -> Option<PathBuf> {
    let stem: String = path.file_stem()?.to_string_lossy().chars().take(LETTERS).collect();
    let extension = path.extension().map_or_else(String::new, |e| format!(".{}", e.to_string_lossy()));
    for n in 1..NAMES {
        let spare = beside.with_file_name(format!("foton-{stem}-{n:03}{extension}"));
        match File::create_new(&spare) {
            Ok(_) => return Some(spare),
            Err(cause) if cause.kind() == ErrorKind::AlreadyExists => {}
            Err(_) => return None,
        }
    }
    None
}
