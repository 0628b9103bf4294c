//! What the engine writes: pictures of a pass, and the edited scene.

use std::path::Path;

use foton_film::check_writable;

use super::command::Event;
use super::render::LevelRender;
use super::stage::Stage;
use super::worker::Worker;
use crate::snapshot::{self, Format};

impl Worker {
    /// The whole render, once it has a pass.
    pub(super) fn rendered(&self) -> Option<(&LevelRender, &Stage)> {
        let render = self.render.as_ref().filter(|r| r.is_whole() && r.render().passes() > 0)?;
        Some((render, self.stage.as_ref()?))
    }

    pub(super) fn snapshot(&self, folder: &Path) {
        if self.rendered().is_none() {
            return self.event(Event::Failed("there is no pass to save yet".to_owned()));
        }
        self.write(&snapshot::next_free(folder));
    }

    pub(super) fn auto_snapshot(&self, folder: &Path) {
        let Some((render, stage)) = self.rendered() else { return };
        let stem = Path::new(&stage.facts().name).file_stem().unwrap_or_default().to_owned();
        let path = snapshot::numbered(&folder.join(stem).with_extension("exr"), render.render().passes());
        self.write(&path.with_extension(""));
    }

    /// Writes both pictures of a stem.
    fn write(&self, stem: &Path) {
        let Some((render, stage)) = self.rendered() else { return };
        let identity = stage.identity();
        let mut written = Vec::new();
        for (extension, format) in [("exr", Format::Exr), ("png", Format::Png)] {
            let path = stem.with_extension(extension);
            let result = check_writable(&path)
                .and_then(|()| snapshot::write(&path, format, render.render(), &[], &identity));
            match result {
                Ok(()) => written.push(path),
                Err(error) => self.event(Event::Failed(error.to_string())),
            }
        }
        if !written.is_empty() {
            self.event(Event::Saved(written));
        }
    }

    pub(super) fn save_scene(&mut self, path: &Path) {
        let Some(stage) = &mut self.stage else {
            return self.event(Event::Failed("there is no scene to save".to_owned()));
        };
        match self.setup.loader.save(&*stage.origin, stage.description(), path) {
            Ok(note) => {
                stage.saved();
                self.event(Event::Saved(vec![path.to_owned()]));
                if !note.is_empty() {
                    self.event(Event::Notice(note));
                }
            }
            Err(message) => self.event(Event::Failed(message)),
        }
    }
}
