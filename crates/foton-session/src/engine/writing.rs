//! What the engine writes: pictures of a pass, and the edited scene.

use std::path::Path;

use foton_film::{check_writable, is_same_file};

use super::command::Event;
use super::editable_scene::EditableScene;
use super::render::LevelRender;
use super::worker::Worker;
use crate::checkpoint::Keeper;
use crate::snapshot::{self, Format};

impl Worker {
    /// The whole render, once it has a pass.
    pub(super) fn rendered(&self) -> Option<(&LevelRender, &EditableScene)> {
        let render = self.current.render.as_ref().filter(|r| r.is_whole() && r.render().passes() > 0)?;
        Some((render, self.scene.as_ref()?))
    }

    pub(super) fn snapshot(&mut self, folder: &Path) {
        self.settle();
        if self.rendered().is_none() {
            return self.event(Event::Failed("there is no pass to save yet".to_owned()));
        }
        self.write(&snapshot::next_free(folder));
    }

    pub(super) fn auto_snapshot(&self, folder: &Path) {
        let Some((render, scene)) = self.rendered() else { return };
        let stem = Path::new(&scene.facts().name).file_stem().unwrap_or_default().to_owned();
        let path = snapshot::numbered(&folder.join(stem).with_extension("exr"), render.render().passes());
        self.write(&path.with_extension(""));
    }

    /// Why a file is not to be written over: the scene was read from it.
    pub(super) fn why_not_over_the_scene(&self, path: &Path) -> Option<String> {
        let mut files = self.scene.iter().flat_map(|scene| &scene.files);
        let file = files.find(|file| is_same_file(file, path))?;
        Some(format!("cannot write {}: the scene reads that file ({})", path.display(), file.display()))
    }

    /// Why a picture is not to be written over a file: as for the scene, or it is the checkpoint.
    fn why_not_over(&self, path: &Path) -> Option<String> {
        self.why_not_over_the_scene(path).or_else(|| self.why_not_over_the_checkpoint(path))
    }

    fn why_not_over_the_checkpoint(&self, path: &Path) -> Option<String> {
        let checkpoint =
            self.files.keeper.as_ref().map(Keeper::path).filter(|file| is_same_file(file, path))?;
        let [path, checkpoint] = [path, checkpoint].map(Path::display);
        Some(format!("cannot write {path}: it is the checkpoint {checkpoint}"))
    }

    /// Writes both pictures of a stem.
    fn write(&self, stem: &Path) {
        let Some((render, scene)) = self.rendered() else { return };
        let identity = scene.identity();
        let mut written = Vec::new();
        for (extension, format) in [("exr", Format::Exr), ("png", Format::Png)] {
            let path = stem.with_extension(extension);
            let result = self.why_not_over(&path).map_or(Ok(()), Err).and_then(|()| {
                check_writable(&path)
                    .and_then(|()| snapshot::write(&path, format, render.render(), &[], &identity))
                    .map_err(|error| error.to_string())
            });
            match result {
                Ok(()) => written.push(path),
                Err(message) => self.event(Event::Failed(message)),
            }
        }
        if !written.is_empty() {
            self.event(Event::Saved(written));
        }
    }

    pub(super) fn save_scene(&mut self, path: &Path) {
        // What of the scene's own files may be replaced, the loader knows.
        if let Some(message) = self.why_not_over_the_checkpoint(path) {
            return self.event(Event::Failed(message));
        }
        let Some(scene) = &mut self.scene else {
            return self.event(Event::Failed("there is no scene to save".to_owned()));
        };
        match self.setup.loader.save(&*scene.origin, scene.description(), path) {
            Ok(saved) => {
                let note = saved.note.clone();
                scene.saved(path, saved);
                self.event(Event::SceneSaved(path.to_owned()));
                if !note.is_empty() {
                    self.event(Event::Notice(note));
                }
            }
            Err(message) => self.event(Event::Failed(message)),
        }
    }
}
