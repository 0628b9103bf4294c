//! Checkpoints of the engine: one file that follows its render, and the resumption of another.

use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::Duration;

use super::command::Event;
use super::render::LevelRender;
use super::worker::Worker;
use crate::checkpoint::{self, Keeper};
use crate::metadata::SceneIdentity;

/// Seconds of rendering between two writings, as of `foton render` by default.
const EVERY: Duration = Duration::from_secs(30);

impl Worker {
    /// Writes the render to a file, and again every half minute and at the end.
    pub(super) fn begin_checkpoint(&mut self, path: &Path) {
        if let Some(message) = self.why_not_over_the_scene(path) {
            return self.event(Event::Failed(message));
        }
        self.settle();
        self.finish_checkpoint();
        match self.first_checkpoint(path) {
            Ok(keeper) => {
                self.event(Event::Saved(vec![path.to_owned()]));
                self.files.keeper = Some(keeper);
                // The last state is owed from now on, so that the end waits for it.
                self.files.unwritten.fetch_add(1, Ordering::SeqCst);
            }
            Err(message) => self.event(Event::Failed(message)),
        }
    }

    fn first_checkpoint(&self, path: &Path) -> Result<Keeper, String> {
        let scene = self.named_by_its_file()?;
        let (render, _) = self.rendered().ok_or("there is no pass to write yet")?;
        let session = render.session();
        let mut keeper = Keeper::new(path, scene, EVERY, session.elapsed());
        let written = keeper.write(session.render(), session.elapsed(), session.rays());
        written.map(|()| keeper).map_err(|error| error.to_string())
    }

    /// How much rendering the checkpoint does not have yet.
    pub(super) fn checkpoint_age(&self) -> Option<Duration> {
        let (render, _) = self.rendered()?;
        self.files.keeper.as_ref()?.age(render.elapsed())
    }

    /// Finishes the checkpoint of a render that ends: the next render has no business in its file.
    pub(super) fn leave_checkpoint(&mut self) {
        if let Some(keeper) = &self.files.keeper {
            let name = foton_input::shown_path(keeper.path());
            self.event(Event::Notice(format!("{name} has the render before; this one has no checkpoint")));
        }
        self.finish_checkpoint();
    }

    /// Writes the checkpoint if it is due.
    pub(super) fn update_checkpoint(&mut self) {
        let Some(keeper) = &mut self.files.keeper else { return };
        let Some(session) = self.current.render.as_ref().map(LevelRender::session) else { return };
        if !keeper.is_due(session.elapsed()) {
            return;
        }
        if let Err(error) = keeper.write(session.render(), session.elapsed(), session.rays()) {
            self.event(Event::Failed(format!("{error}; the file has the state before")));
        }
    }

    /// Writes the checkpoint for the last time.
    pub(super) fn finish_checkpoint(&mut self) {
        if self.files.keeper.is_some() {
            self.settle();
        }
        let Some(mut keeper) = self.files.keeper.take() else { return };
        let written = self.rendered().map_or(Ok(()), |(render, _)| keeper.write_last(render.session()));
        if let Err(unwritten) = written {
            let instead = unwritten.spare.map_or_else(
                || "nor anywhere else".to_owned(),
                |spare| format!("the render is in {} instead", spare.display()),
            );
            self.event(Event::Failed(format!("{}; {instead}", unwritten.cause)));
        }
        self.files.unwritten.fetch_sub(1, Ordering::SeqCst);
    }

    /// Resumes the checkpoint that was asked for in a render that has just started whole. Where the checkpoint does not fit, there
    /// is no render: the next one begins at its first pass.
    pub(super) fn resume_in(&mut self, mut render: LevelRender) -> Option<LevelRender> {
        let Some(path) = self.files.resuming.take() else { return Some(render) };
        let scene = self.files.resuming_as.take().map_or_else(|| self.named_by_its_file(), Ok);
        let resumed = scene.and_then(|scene| {
            checkpoint::resume(&path, render.session_mut(), &scene, false).map_err(|error| error.to_string())
        });
        if let Err(message) = resumed {
            // What it left behind is not to be used.
            self.event(Event::Failed(message));
            return None;
        }
        let settings = render.render().settings();
        self.plan.settings.ppm.alpha = settings.ppm.alpha;
        self.plan.settings.ppm.photons_per_pass = settings.ppm.photons_per_pass;
        // There is a pass to look at: who has paused waits.
        self.current.owes_a_pass = false;
        let resumed = render.render();
        let passes = resumed.passes();
        let by_class = if resumed.photons_by_class() == Some(resumed.photons_emitted()) {
            ""
        } else {
            "; the view by light path covers the passes from here on"
        };
        self.event(Event::Notice(format!("Resumed after {passes} passes{by_class}")));
        Some(render.resumed())
    }

    /// The scene that is rendered, if the hash of its file stands for it.
    fn named_by_its_file(&self) -> Result<SceneIdentity, String> {
        let scene = self.scene.as_ref().ok_or("there is no render to write")?;
        if scene.is_as_opened() {
            return Ok(scene.identity());
        }
        Err("a checkpoint belongs to a scene file, and this scene has edits: save it and open the saved file first".into())
    }
}
