//! What files of one render are called in a folder: chosen with the first of them, the same for all.

use std::path::{Path, PathBuf};

use crate::snapshot::next_run;

/// The name of a run.
pub(super) struct Run {
    /// The number of the render.
    render: u64,
    folder: PathBuf,
    /// Such as `ring-001`.
    name: String,
}

impl Run {
    /// The next one in a folder, for a render of a scene.
    pub(super) fn new(render: u64, folder: &Path, scene: &str) -> Self {
        Self { render, folder: folder.to_owned(), name: next_run(folder, scene) }
    }

    /// Whether it is that of a render in a folder.
    pub(super) fn is_of(&self, render: u64, folder: &Path) -> bool {
        self.render == render && self.folder == folder
    }

    /// The name.
    pub(super) fn name(&self) -> &str {
        &self.name
    }
}
