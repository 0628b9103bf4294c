//! The folder of a process among those of all: locked while it lives, removed with it. What was killed leaves its folder, which the
//! next process finds unlocked and removes.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// The file that is locked.
const LOCK: &str = "lock";

/// A folder that goes with the value.
pub(super) struct Room {
    path: PathBuf,
    _lock: File,
}

impl Room {
    /// Makes one in `home`, and removes those that nobody holds any more.
    pub(super) fn new(home: &Path) -> io::Result<Self> {
        fs::create_dir_all(home)?;
        remove_abandoned(home);
        let mut number = std::process::id();
        loop {
            let path = home.join(format!("{number:08}"));
            match fs::create_dir(&path) {
                Ok(()) => {
                    let lock = File::create_new(path.join(LOCK))?;
                    // Where there are no locks, the next process may take it for abandoned; then it goes early, and that is said.
                    let _ = lock.try_lock();
                    return Ok(Self { path, _lock: lock });
                }
                Err(cause) if cause.kind() == io::ErrorKind::AlreadyExists => number = number.wrapping_add(1),
                Err(cause) => return Err(cause),
            }
        }
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }
}

impl Room {
    /// Removes it with all that is in it.
    pub(super) fn clear(&self) {
        // What another thread was just making needs a second look.
        let _ = fs::remove_dir_all(&self.path).or_else(|_| fs::remove_dir_all(&self.path));
    }
}

impl Drop for Room {
    fn drop(&mut self) {
        self.clear();
    }
}

fn remove_abandoned(home: &Path) {
    for entry in home.read_dir().into_iter().flatten().flatten() {
        let path = entry.path();
        let is_ours = path.file_name().is_some_and(|name| {
            let name = name.as_encoded_bytes();
            name.len() >= 8 && name.iter().all(u8::is_ascii_digit)
        });
        if is_ours && entry.file_type().is_ok_and(|kind| kind.is_dir()) && is_abandoned(&path) {
            let _ = fs::remove_dir_all(path);
        }
    }
}

/// Whether nobody holds a folder. One without its lock is still being made, or is nobody's that we know.
fn is_abandoned(folder: &Path) -> bool {
    let Ok(file) = File::options().read(true).write(true).open(folder.join(LOCK)) else { return false };
    file.try_lock().is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_room_goes_with_its_process_and_those_of_the_killed_with_the_next() {
        let home = std::env::temp_dir().join(format!("foton-rooms-{}", std::process::id()));
        let killed = home.join("00000007");
        fs::create_dir_all(&killed).expect("a folder");
        fs::write(killed.join(LOCK), "").expect("written");
        let strange = home.join("somebody's");
        fs::create_dir_all(&strange).expect("a folder");
        let one = Room::new(&home).expect("a room");
        assert!(!killed.exists() && strange.exists());
        let other = Room::new(&home).expect("another");
        assert!(one.path() != other.path() && one.path().exists());
        let path = one.path().to_owned();
        drop(one);
        assert!(!path.exists() && other.path().exists());
        drop(other);
        fs::remove_dir_all(home).expect("ours");
    }
}
