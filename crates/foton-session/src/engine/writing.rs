//! What the engine writes: pictures of a pass, and the edited scene.

use std::path::Path;

use foton_film::{is_same_file, write_new};
use foton_input::shown_path;

use super::command::Event;
use super::editable_scene::EditableScene;
use super::render::LevelRender;
use super::run::Run;
use super::worker::Worker;
use crate::checkpoint::Keeper;
use crate::shown::Shown;
use crate::snapshot::{self, Format};

/// Pictures of a pass, by extension.
const PICTURES: [(&str, Format); 2] = [("exr", Format::Exr), ("png", Format::Png)];

impl Worker {
    /// The whole render, once it has a pass.
    pub(super) fn rendered(&self) -> Option<(&LevelRender, &EditableScene)> {
        let render = self.current.render.as_ref().filter(|r| r.is_whole() && r.render().passes() > 0)?;
        Some((render, self.scene.as_ref()?))
    }

    /// Writes both pictures of the last whole pass into a folder.
    pub(super) fn snapshot(&mut self, folder: &Path) {
        if self.rendered().is_none() {
            return self.event(Event::Failed("there is no pass to save yet".to_owned()));
        }
        self.write(folder);
    }

    /// Why a file is not to be written over: the scene was read from it.
    pub(super) fn why_not_over_the_scene(&self, path: &Path) -> Option<String> {
        let mut files = self.scene.iter().flat_map(|scene| &scene.files);
        let file = files.find(|file| is_same_file(file, path))?;
        Some(format!("cannot write {}: the scene reads that file ({})", path.display(), file.display()))
    }

    fn why_not_over_the_checkpoint(&self, path: &Path) -> Option<String> {
        let checkpoint =
            self.files.keeper.as_ref().map(Keeper::path).filter(|file| is_same_file(file, path))?;
        let [path, checkpoint] = [path, checkpoint].map(Path::display);
        Some(format!("cannot write {path}: it is the checkpoint {checkpoint}"))
    }

    /// Writes both pictures of the last pass into a folder, which is made if need be, under names that nothing has.
    pub(super) fn write(&mut self, folder: &Path) {
        let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
        if let Err(cause) = std::fs::create_dir_all(&folder) {
            let folder = shown_path(&folder);
            return self
                .event(Event::Failed(format!("cannot make the folder {folder} for pictures: {cause}")));
        }
        let run = self.run_in(&folder);
        let Some((render, scene)) = self.rendered() else { return };
        let (render, identity, look) = (render.render(), scene.identity(), self.files.look);
        let path = |name: &str, extension: &str| folder.join(format!("{name}.{extension}"));
        let is_there = |name: &str| PICTURES.iter().any(|(e, _)| path(name, e).symlink_metadata().is_ok());
        let name = snapshot::of_run(&run, render.passes(), is_there);
        let mut written = Vec::new();
        for (extension, format) in PICTURES {
            let path = path(&name, extension);
            let result = write_new(&path, |path| {
                snapshot::write(path, format, (render, &Shown::All), &[], look, &identity)
            });
            match result {
                Ok(()) => written.push(path),
                Err(error) => self.event(Event::Failed(error.to_string())),
            }
        }
        if !written.is_empty() {
            self.event(Event::Saved(written));
            self.remember();
        }
    }

    /// The name that files of the present render share in a folder.
    fn run_in(&mut self, folder: &Path) -> String {
        let render = self.current.number;
        let known = self.files.run.take().filter(|run| run.is_of(render, folder));
        let run = known.unwrap_or_else(|| {
            let title = self.scene.as_ref().map_or_else(String::new, |scene| scene.facts().title.clone());
            Run::new(render, folder, &title)
        });
        self.files.run.insert(run).name().to_owned()
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
