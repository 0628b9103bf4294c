//! The files that a scene names: looked for folder by folder, read through the caller, hashed, their memory counted.

use std::collections::HashSet;
use std::io;
use std::path::PathBuf;

use foton_input::shown_path;
use foton_math::Cancel;

use crate::diagnostic::{Place, Report};
use crate::hash::Fnv1a;
use crate::limits::Budget;
use crate::options::{BYTES_PER_BYTE, Options, ReadFile};
use crate::watch::Watch;

/// What is said once where files are missing.
const HELP_MISSING: &str = "--allow-missing opens the scene without the files that are not there: textures are magenta, meshes are left out";

/// A file that is not there, which is allowed.
pub(crate) struct Absent;

/// What lies where a file may lie.
enum Found {
    File(PathBuf, Vec<u8>),
    Nothing(PathBuf, io::Error),
    /// There is something else, or nobody may read it.
    Unreadable(PathBuf, io::Error),
}

/// Reads files and remembers which.
pub(crate) struct Files<'a> {
    read: &'a ReadFile<'a>,
    /// Of all that is read, and of what is read now.
    whole: Watch<'a>,
    watch: Watch<'a>,
    allow_missing: bool,
    /// Whether it was said how to do without files.
    has_helped: bool,
    seen: HashSet<PathBuf>,
    /// The contents of all files, in the order in which they were first read.
    pub(crate) hash: Fnv1a,
    /// What all of it may take.
    pub(crate) budget: Budget,
}

impl<'a> Files<'a> {
    pub(crate) fn new(read: &'a ReadFile<'a>, options: &'a Options, budget: Budget) -> Self {
        let (watch, allow_missing) = (Watch::new(&options.cancel, &options.progress), options.allow_missing);
        let (seen, hash) = (HashSet::new(), Fnv1a::default());
        Self { read, whole: watch, watch, allow_missing, has_helped: false, seen, hash, budget }
    }

    /// Whether the user takes a picture in which parts are missing.
    pub(crate) const fn allows_missing(&self) -> bool {
        self.allow_missing
    }

    /// What ends reading: from then on no file is read.
    pub(crate) const fn cancel(&self) -> &'a Cancel {
        self.watch.cancel()
    }

    /// What reads the file that comes next tells to how far it is.
    pub(crate) const fn watch(&self) -> Watch<'a> {
        self.watch
    }

    /// Begins one of so many parts of a scene.
    pub(crate) fn begin_part(&mut self, part: usize, parts: usize) {
        let parts = parts.max(1) as f64;
        self.watch = self.whole.part(part as f64 / parts, 1.0 / parts);
        self.watch.at(0.0);
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
        match self.find(filename, place, report)? {
            Found::File(path, bytes) => self.take(path, bytes, place, report),
            Found::Nothing(path, error) | Found::Unreadable(path, error) => {
                report.error(place, format!("cannot read {}: {error}", shown_path(&path)));
                None
            }
        }
    }

    /// As [`Self::read`], for a file that the scene can do without: where it is not there and the user allows for that, a warning
    /// says so and what comes `instead` of it.
    pub(crate) fn read_or_do_without(
        &mut self,
        filename: &str,
        place: Place,
        instead: &str,
        report: &mut Report,
    ) -> Option<Result<(PathBuf, Vec<u8>), Absent>> {
        match self.find(filename, place, report)? {
            Found::File(path, bytes) => self.take(path, bytes, place, report).map(Ok),
            Found::Nothing(path, _) if self.allow_missing => {
                report.warning(place, format!("{} is missing: {instead}", shown_path(&path)));
                Some(Err(Absent))
            }
            Found::Nothing(path, error) => {
                report.error(place, format!("cannot read {}: {error}", shown_path(&path)));
                if !std::mem::replace(&mut self.has_helped, true) {
                    report.help(HELP_MISSING);
                }
                None
            }
            Found::Unreadable(path, error) => {
                report.error(place, format!("cannot read {}: {error}", shown_path(&path)));
                None
            }
        }
    }

    /// Whether there is a file of that name; it need not be readable.
    pub(crate) fn is_there(&self, filename: &str, place: Place, report: &Report) -> bool {
        !matches!(self.find(filename, place, report), Some(Found::Nothing(..)))
    }

    /// What lies where a file may lie; nothing once cancelled.
    fn find(&self, filename: &str, place: Place, report: &Report) -> Option<Found> {
        if self.watch.is_requested() {
            return None;
        }
        let mut nothing = None;
        for path in candidates(filename, place, report) {
            match (self.read)(&path) {
                Ok(bytes) => return Some(Found::File(path, bytes)),
                Err(error) if error.kind() == io::ErrorKind::NotFound => {
                    nothing.get_or_insert(Found::Nothing(path, error));
                }
                Err(error) => return Some(nothing.unwrap_or(Found::Unreadable(path, error))),
            }
        }
        nothing
    }

    /// Counts and remembers a file that was read.
    fn take(
        &mut self,
        path: PathBuf,
        bytes: Vec<u8>,
        place: Place,
        report: &mut Report,
    ) -> Option<(PathBuf, Vec<u8>)> {
        if let Err(message) = self.budget.take((bytes.len() as u64).saturating_mul(BYTES_PER_BYTE)) {
            report.error(place, format!("cannot read {}: {message}", shown_path(&path)));
            return None;
        }
        if self.seen.insert(path.clone()) {
            self.hash.add(&bytes);
        }
        Some((path, bytes))
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
