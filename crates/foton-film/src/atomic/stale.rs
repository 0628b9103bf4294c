//! Leftovers: temporary files of processes that were killed while they wrote.

use std::fs::{self, DirEntry, File};
use std::path::Path;
use std::process;
use std::time::Duration;

use super::target::folder_of;
use super::temporary::{Temporary, prefix};

/// Where nobody can be asked whether a process lives, what was not touched for so long is a leftover.
const OLD: Duration = Duration::from_secs(24 * 60 * 60);

/// Removes the leftovers of earlier writes to `target`: plain files of its temporary names whose process is gone. In a folder that
/// cannot be listed they stay; they are in nobody's way.
pub(super) fn remove(target: &Path) {
    let Some(prefix) = prefix(target) else { return };
    let Ok(entries) = fs::read_dir(folder_of(target)) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let rest = name.as_encoded_bytes().strip_prefix(prefix.as_encoded_bytes());
        if rest.and_then(process_of).is_some_and(|process| is_leftover(&entry, process)) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// The process in what follows the prefix: `PID-RANDOM`.
fn process_of(rest: &[u8]) -> Option<u32> {
    let (process, random) = std::str::from_utf8(rest).ok()?.split_once('-')?;
    let is_plain = !process.is_empty() && process.bytes().all(|b| b.is_ascii_digit());
    let is_random = (1..=16).contains(&random.len()) && random.bytes().all(|b| b.is_ascii_hexdigit());
    process.parse().ok().filter(|_| is_plain && is_random)
}

/// Whether nobody writes it any more. Neither a folder nor a link is one, whatever its name. A writer holds a lock, too: the numbers
/// of processes say nothing of another container or machine that writes to the same folder.
fn is_leftover(entry: &DirEntry, process: u32) -> bool {
    entry.file_type().is_ok_and(|kind| kind.is_file())
        && if process == process::id() {
            !Temporary::is_ours(&entry.file_name())
        } else {
            lives(process).map_or_else(|| is_old(entry), |lives| !lives)
        }
        && is_unlocked(&entry.path())
}

fn is_old(entry: &DirEntry) -> bool {
    let touched = entry.metadata().and_then(|found| found.modified()).ok();
    touched.and_then(|touched| touched.elapsed().ok()).is_some_and(|age| age > OLD)
}

/// Whether no process holds it; one that we may not open is none of ours.
fn is_unlocked(path: &Path) -> bool {
    let Ok(file) = File::options().read(true).write(true).open(path) else { return false };
    !matches!(file.try_lock(), Err(fs::TryLockError::WouldBlock))
}

/// Whether a process of that number lives; `None` where the system is not asked.
#[cfg(unix)]
fn lives(process: u32) -> Option<bool> {
    use rustix::io::Errno;
    use rustix::process::{Pid, test_kill_process};
    // What is no number of a process was none of ours.
    let Some(process) = i32::try_from(process).ok().and_then(Pid::from_raw) else { return Some(false) };
    Some(test_kill_process(process) != Err(Errno::SRCH))
}

#[cfg(not(unix))]
const fn lives(_: u32) -> Option<bool> {
    None
}
