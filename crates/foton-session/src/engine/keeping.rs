//! Keeping a pass, and returning to one.

use std::sync::Arc;

use super::command::Event;
use super::history::{Files, HistoryEntry, Kept, Thumbnail, in_words};
use super::worker::Worker;
use crate::checkpoint::Prepared;
use crate::metadata;

impl Worker {
    /// Keeps the pass that the render stands at, unless it is kept already.
    pub(super) fn remember(&mut self) {
        self.settle();
        let Some((render, _)) = self.rendered() else {
            return self.event(Event::Notice("There is no pass to keep yet".to_owned()));
        };
        let (number, passes) = (self.current.number, render.render().passes());
        let entries = self.history.shown();
        if entries.last().is_some_and(|last| (last.render, last.passes) == (number, passes)) {
            return;
        }
        let (room, id) = match self.history.place() {
            Ok(place) => place,
            Err(message) => return self.event(Event::Failed(message)),
        };
        let Some((level, scene)) = self.rendered() else { return };
        let (render, session, identity) = (level.render(), level.session(), scene.identity());
        let image = render.image();
        let [picture, state] = ["exr", "checkpoint"].map(|e| room.join(format!("{id:06}.{e}")));
        let settings = render.settings().clone();
        let shown = HistoryEntry {
            id,
            render: number,
            passes,
            photons: render.photons_emitted(),
            elapsed: session.elapsed(),
            error: render.error().map(|error| error.total),
            scene: scene.facts().title.clone(),
            settings: in_words(&settings, render),
            window: render.scene().sensors()[settings.sensor].window(),
            thumbnail: Arc::new(Thumbnail::of(&image, self.files.look)),
            picture: picture.clone(),
        };
        let files = Files {
            id,
            picture: (picture, image, metadata::of(render, &[], &identity)),
            state: (state.clone(), Prepared::of(render, session.elapsed(), session.rays(), &identity)),
        };
        let kept = Kept {
            shown,
            description: Arc::clone(scene.edited()),
            sensors: scene.sensors().to_vec(),
            settings,
            region: scene.region(),
            identity,
            state,
        };
        self.history.add(kept, files);
    }

    /// Goes on from a pass that was kept: with its scene, camera, settings and state.
    pub(super) fn return_to_entry(&mut self, id: u64) {
        let Some(kept) = self.history.get(id).cloned() else {
            return self.event(Event::Failed("the history does not have that pass any more".to_owned()));
        };
        if !kept.state.exists() {
            return self
                .event(Event::Failed("that pass is still being written; try again in a moment".to_owned()));
        }
        let Some(scene) = &mut self.scene else { return };
        if scene.identity().hash != kept.identity.hash {
            return self.event(Event::Failed(format!(
                "that pass is of another scene ({}): open it first",
                kept.shown.scene
            )));
        }
        let region = kept.region.map(|region| (kept.settings.sensor, region));
        if let Err(message) = scene.return_to(&kept.description, kept.sensors, region) {
            return self.event(Event::Failed(message));
        }
        self.plan.settings = kept.settings;
        self.restart();
        // There is a pass to look at: who has paused waits.
        self.current.owes_a_pass = false;
        self.files.resuming = Some(kept.state);
        self.files.resuming_as = Some(kept.identity);
    }
}
