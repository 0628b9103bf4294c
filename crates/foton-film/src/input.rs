//! What reading an image may take: the file by its kind and size, its pixels by their number, before anything is unpacked.

use std::path::Path;

use foton_input::{Limit, Named, read_file};

use crate::ReadError;

/// A file's bytes; files are read whole, and unpacked from there.
pub(crate) fn read(path: &Path, memory: Option<u64>) -> Result<Vec<u8>, ReadError> {
    read_file(path, Named::ByFile, Limit::new(memory, 1), &|| false)
        .map_err(|cause| ReadError::Io { path: path.into(), cause })
}

/// Memory for pixels.
pub(crate) struct Room {
    /// Bytes that may be used; `None`: as many as there are.
    pub(crate) memory: Option<u64>,
    /// Bytes that each pixel takes.
    pub(crate) bytes_per_pixel: u64,
}

impl Room {
    /// Refuses an image that takes more.
    pub(crate) fn check(&self, path: &Path, width: u64, height: u64) -> Result<(), ReadError> {
        let takes = width.saturating_mul(height).saturating_mul(self.bytes_per_pixel);
        match self.memory {
            Some(limit) if takes > limit => {
                Err(ReadError::TooLarge { path: path.into(), width, height, takes, limit })
            }
            _ => Ok(()),
        }
    }
}
