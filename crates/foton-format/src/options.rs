//! How a scene is read, and where the bytes of its files come from.

use std::io;
use std::path::Path;

use foton_input::{Limit, Named};
use foton_math::Cancel;

use crate::watch::Progress;

/// Reads a file that a scene names.
pub type ReadFile<'a> = dyn Fn(&Path) -> io::Result<Vec<u8>> + 'a;

/// How to read a scene.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Parameters as name and value, stronger than the file's `<default>`s; of two with a name the last holds.
    pub defines: Vec<(String, String)>,
    /// Bytes that reading may take; `None`: as many as there are. What [`open`](fn@crate::open) could not read within that is refused unread.
    pub memory: Option<u64>,
    /// Whether a scene opens without the meshes and images that are not there: those meshes are left out, the images are magenta.
    pub allow_missing: bool,
    /// Ends reading within a fraction of a second: then the outcome is [`OpenError::Cancelled`](crate::OpenError::Cancelled).
    pub cancel: Cancel,
    /// Is told how far reading is.
    pub progress: Progress,
}

impl Options {
    /// The same, once reading is over.
    pub(crate) fn without_cancel(&self) -> Self {
        Self { cancel: Cancel::default(), progress: Progress::default(), ..self.clone() }
    }

    /// Reads a file of the disk, or refuses it by its kind or size; an error of some kind once cancelled.
    pub(crate) fn read(&self, path: &Path, named: Named) -> io::Result<Vec<u8>> {
        foton_input::read_file(path, named, Limit::new(self.memory, BYTES_PER_BYTE), &|| {
            self.cancel.is_requested()
        })
    }
}

/// The most bytes that reading takes for each of a file, its own included; fuzzing holds all readers of meshes to that.
pub(crate) const BYTES_PER_BYTE: u64 = 4;
