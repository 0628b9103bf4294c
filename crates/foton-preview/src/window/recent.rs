//! Scenes that were opened: their files are remembered, and a small picture of each is left in the cache.

use std::path::PathBuf;

use foton_film::{Metadata, write_png};
use foton_session::engine::{Picture, ViewMode, shrunk};
use foton_session::folders;

use crate::state::State;

/// Passes after which a picture is worth keeping; and a better one after each power of it.
const PASSES: u64 = 4;

/// What is known of the present scene.
#[derive(Default)]
pub(super) struct Recent {
    file: Option<PathBuf>,
    /// Passes of the picture that was kept last.
    kept: u64,
}

impl Recent {
    /// Remembers the scene of the newest frame, and keeps its picture where that is due.
    pub(super) fn mind(&mut self, state: &mut State) {
        let Some(frame) = &state.frame else { return };
        let file = frame.scene.file.as_ref().and_then(|file| std::path::absolute(file).ok());
        if file != self.file {
            self.file.clone_from(&file);
            self.kept = 0;
            if let Some(file) = &file {
                state.preferences.remember(file);
            }
        }
        let Some(file) = &self.file else { return };
        let passes = frame.stats.passes;
        let is_due = passes >= PASSES.max(self.kept.saturating_mul(PASSES));
        let Some(Picture::Colour(image)) = frame.picture.as_ref().filter(|_| is_due) else { return };
        if frame.view != ViewMode::Radiance || image.width != frame.window.width {
            return;
        }
        self.kept = passes;
        let Some(path) = folders::thumbnail(file) else { return };
        if let Some(folder) = path.parent() {
            let _ = std::fs::create_dir_all(folder);
        }
        // Whether there is a picture in a menu is no reason to trouble anyone.
        let (tone_map, stops) = (state.tone_map, state.exposure_stops);
        let _ = write_png(&path, &shrunk(image), tone_map, stops, &Metadata::default());
    }
}
