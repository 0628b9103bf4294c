//! What is in a folder, and what a typed path means. The only place of the dialog that touches the disk beyond asking whether a
//! path is there.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// One line of the list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Entry {
    pub(super) name: String,
    pub(super) is_folder: bool,
}

/// The folders, then the files that end in one of `extensions` (all without any), each sorted without regard to case. What
/// begins with a dot is left out, and what has a name that is not text: it can still be typed, or not.
pub(super) fn read(folder: &Path, extensions: Option<&[&str]>) -> io::Result<Vec<Entry>> {
    let mut entries = Vec::new();
    for found in fs::read_dir(folder)? {
        let Ok(found) = found else { continue };
        let Ok(name) = found.file_name().into_string() else { continue };
        // Follows links, unlike the kind that the folder itself tells.
        let is_folder = found.path().is_dir();
        if !name.starts_with('.') && (is_folder || matches(&name, extensions)) {
            entries.push(Entry { name, is_folder });
        }
    }
    entries.sort_by_cached_key(|entry| (!entry.is_folder, entry.name.to_lowercase(), entry.name.clone()));
    Ok(entries)
}

/// Whether a name ends as wanted.
fn matches(name: &str, extensions: Option<&[&str]>) -> bool {
    let Some(extensions) = extensions else { return true };
    let found = Path::new(name).extension().unwrap_or_default();
    extensions.iter().any(|extension| found.eq_ignore_ascii_case(extension))
}

/// What a person means who types this while looking at `folder`: `~` is the home folder.
pub(super) fn resolve(folder: &Path, typed: &str) -> PathBuf {
    let rest = typed.strip_prefix('~').filter(|rest| rest.is_empty() || rest.starts_with('/'));
    match (rest, env::home_dir()) {
        (Some(rest), Some(home)) => home.join(rest.trim_start_matches('/')),
        _ => folder.join(typed),
    }
}
