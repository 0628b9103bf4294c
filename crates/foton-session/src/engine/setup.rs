//! What the engine is given.

use std::path::PathBuf;
use std::sync::Arc;

use super::loader::Loader;

/// What the engine is given.
pub struct Setup {
    /// How scenes are opened and saved.
    pub loader: Arc<dyn Loader>,
    /// Called from the engine's thread when a frame or event is there.
    pub wake: Box<dyn Fn() + Send>,
    /// Renders beyond this many bytes are refused.
    pub memory_limit: Option<f64>,
    /// Where the history's files go; `None`: the folder for temporary files.
    pub history_folder: Option<PathBuf>,
    /// Bytes that they take at most.
    pub history_limit: u64,
    /// The program that makes MP4s.
    pub ffmpeg: PathBuf,
}

impl Setup {
    /// Bytes of the history, unless asked otherwise.
    pub const HISTORY: u64 = 2 << 30;

    /// With the history in the user's cache, and `ffmpeg` as it is found.
    #[must_use]
    pub fn new(loader: Arc<dyn Loader>, wake: Box<dyn Fn() + Send>, memory_limit: Option<f64>) -> Self {
        let history_folder = crate::folders::cache().map(|folder| folder.join("history"));
        Self {
            loader,
            wake,
            memory_limit,
            history_folder,
            history_limit: Self::HISTORY,
            ffmpeg: PathBuf::from("ffmpeg"),
        }
    }
}
