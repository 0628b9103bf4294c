//! The files that a scene names: looked for folder by folder, read through the caller, hashed, their memory counted.

use std::collections::HashSet;
use std::io;
use std::path::PathBuf;

use foton_input::shown_path;
use foton_math::Cancel;

use crate::diagnostic::{Place, Report};
use crate::hash::Fnv1a;
use crate::limits::Budget;
use crate::options::{BYTES_PER_BYTE, ReadFile};

/// Reads files and remembers which.
pub(crate) struct Files<'a> {
    read: &'a ReadFile<'a>,
    cancel: &'a Cancel,
    seen: HashSet<PathBuf>,
    /// The contents of all files, in the order in which they were first read.
    pub(crate) hash: Fnv1a,
    /// What all of it may take.
    pub(crate) budget: Budget,
}

impl<'a> Files<'a> {
    pub(crate) fn new(read: &'a ReadFile<'a>, cancel: &'a Cancel, budget: Budget) -> Self {
        Self { read, cancel, seen: HashSet::new(), hash: Fnv1a::default(), budget }
    }

    /// What ends reading: from then on no file is read.
    pub(crate) const fn cancel(&self) -> &'a Cancel {
        self.cancel
    }

    /// The path where a file named at `place` is looked for first: its identity, whether it is there or not.
    pub(crate) fn key(filename: &str, place: Place, report: &Report) -> PathBuf {
        candidates(filename, place, report).swap_remove(0)
    }

    /// The path and contents of a file; an error at `place` if it cannot be read.
    pub(crate) fn read(
        &mut self,
        filename: &str,
        place: Place,
        report: &mut Report,
    ) -> Option<(PathBuf, Vec<u8>)> {
        if self.cancel.is_requested() {
            return None;
        }
        let mut failure = None;
        for path in candidates(filename, place, report) {
            match (self.read)(&path) {
                Ok(bytes) => {
                    if let Err(message) =
                        self.budget.take((bytes.len() as u64).saturating_mul(BYTES_PER_BYTE))
                    {
                        report.error(place, format!("cannot read {}: {message}", shown_path(&path)));
                        return None;
                    }
                    if self.seen.insert(path.clone()) {
                        self.hash.add(&bytes);
                    }
                    return Some((path, bytes));
                }
                Err(error) => {
                    let found = error.kind() != io::ErrorKind::NotFound;
                    failure.get_or_insert((path, error));
                    if found {
                        break;
                    }
                }
            }
        }
        if let Some((path, error)) = failure {
            report.error(place, format!("cannot read {}: {error}", shown_path(&path)));
        }
        None
    }
}

/// Where a file may lie; names written on Windows are tried with slashes, too. At least one path.
fn candidates(filename: &str, place: Place, report: &Report) -> Vec<PathBuf> {
    let folders = report.folders(place);
    let mut paths: Vec<_> = folders.iter().map(|folder| folder.join(filename)).collect();
    if filename.contains('\\') {
        let slashes = filename.replace('\\', "/");
        paths.extend(folders.iter().map(|folder| folder.join(&slashes)));
    }
    paths
}
