//! Checkpoints of the engine: one file, kept up to date while its render goes on, and resumed.

use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::Duration;

use foton_film::{WriteError, check_writable, write_spare};

use super::command::Event;
use super::kept::Kept;
use super::render::LevelRender;
use super::worker::Worker;
use crate::checkpoint;
use crate::metadata::SceneIdentity;

/// Seconds of rendering between two writings, as of `foton render` by default.
const EVERY: Duration = Duration::from_secs(30);

impl Worker {
    /// Writes the render to a file, and again every half minute and at the end.
    pub(super) fn keep(&mut self, path: &Path) {
        if let Some(message) = self.why_not_over_the_scene(path) {
            return self.event(Event::Failed(message));
        }
        self.keep_the_last();
        let scene = self.named_by_its_file();
        let written = scene.and_then(|scene| self.write_checkpoint(path, &scene).map(|()| scene));
        let scene = match written {
            Ok(scene) => scene,
            Err(message) => return self.event(Event::Failed(message)),
        };
        self.event(Event::Saved(vec![path.to_owned()]));
        self.kept = Some(Kept { path: path.to_owned(), scene, written: self.elapsed() });
        // The last state is owed from now on, so that the end waits for it.
        self.unwritten.fetch_add(1, Ordering::SeqCst);
    }

    /// Ends the keeping, for the render ends, and another has no business in the file.
    pub(super) fn let_go(&mut self) {
        if let Some(kept) = &self.kept {
            let name = foton_input::shown_path(&kept.path);
            self.event(Event::Notice(format!("{name} keeps the render before; this one is not kept")));
        }
        self.keep_the_last();
    }

    /// Writes what is kept when it is due.
    pub(super) fn keep_up(&mut self) {
        let elapsed = self.elapsed();
        let Some(kept) = self.kept.as_mut().filter(|kept| elapsed.saturating_sub(kept.written) >= EVERY)
        else {
            return;
        };
        kept.written = elapsed;
        let (path, scene) = (kept.path.clone(), kept.scene.clone());
        if let Err(message) = self.write_checkpoint(&path, &scene) {
            self.event(Event::Failed(format!("{message}; the file has the state before")));
        }
    }

    /// Writes what is kept for the last time.
    pub(super) fn keep_the_last(&mut self) {
        let Some(kept) = self.kept.take() else { return };
        if self.elapsed() > kept.written
            && let Err(message) = self.write_checkpoint(&kept.path, &kept.scene)
        {
            let spare = write_spare(&kept.path, |path| self.write_state(path, &kept.scene));
            let instead = spare.map_or_else(
                || "nor anywhere else".to_owned(),
                |spare| format!("the render is in {} instead", spare.display()),
            );
            self.event(Event::Failed(format!("{message}; {instead}")));
        }
        self.unwritten.fetch_sub(1, Ordering::SeqCst);
    }

    /// Takes up the checkpoint that was asked for in a render that has just started whole. One that does not fit is not taken:
    /// the render then begins at its first pass.
    pub(super) fn resume_in(&mut self, mut render: LevelRender) -> Option<LevelRender> {
        let Some(path) = self.resuming.take() else { return Some(render) };
        let taken = self.named_by_its_file().and_then(|scene| {
            checkpoint::resume(&path, render.session_mut(), &scene).map_err(|error| error.to_string())
        });
        if let Err(message) = taken {
            // What it left behind is not to be used.
            self.event(Event::Failed(message));
            return None;
        }
        let settings = render.render().settings();
        self.settings.ppm.alpha = settings.ppm.alpha;
        self.settings.ppm.photons_per_pass = settings.ppm.photons_per_pass;
        self.event(Event::Notice(format!("Going on after {} passes", render.render().passes())));
        Some(render.resumed())
    }

    /// What is rendered, if the hash of its file says so.
    fn named_by_its_file(&self) -> Result<SceneIdentity, String> {
        let stage = self.stage.as_ref().ok_or("there is no render to keep")?;
        if stage.is_as_opened() {
            return Ok(stage.identity());
        }
        Err("a checkpoint belongs to a scene file, and this scene has edits: save it, open the saved file, and keep that".into())
    }

    fn elapsed(&self) -> Duration {
        self.render.as_ref().map_or(Duration::ZERO, LevelRender::elapsed)
    }

    fn write_checkpoint(&self, path: &Path, scene: &SceneIdentity) -> Result<(), String> {
        if self.rendered().is_none() {
            return Err("there is no pass to keep yet".into());
        }
        check_writable(path).and_then(|()| self.write_state(path, scene)).map_err(|error| error.to_string())
    }

    /// Writes the render, once it has a pass.
    fn write_state(&self, path: &Path, scene: &SceneIdentity) -> Result<(), WriteError> {
        let Some((render, _)) = self.rendered() else { return Ok(()) };
        let session = render.session();
        checkpoint::write(path, session.render(), session.elapsed(), session.rays(), scene)
    }
}
