//! What the engine says of itself: frames, no more often than a window can show them.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::{Flow, Worker};
use crate::engine::frame::{Activity, Frame, Numbers};
use crate::engine::loader::Opening;
use crate::engine::probe;

/// Frames are at least this far apart unless a person is waiting for one.
const FRAME_GAP: Duration = Duration::from_millis(30);

impl Worker {
    fn activity(&self) -> Activity {
        let Some(render) = &self.render else {
            return match &self.stage {
                None => Activity::Empty,
                Some(stage) if stage.is_stale() => Activity::Building,
                Some(_) => Activity::Collecting,
            };
        };
        match self.flow {
            _ if self.moving => Activity::Moving,
            _ if !render.is_whole() => Activity::Collecting,
            Flow::Steps(0) => Activity::Paused,
            Flow::Run if self.is_idle() => Activity::Done,
            _ => Activity::Rendering,
        }
    }

    /// Offers a frame if there is something new: at once if `now`, else not too soon after the last.
    pub(super) fn publish(&mut self, now: bool) {
        // While something moves, a picture is there so soon that a frame before it would only keep the window busy.
        let comes_soon = self.moving && self.render.is_none() && self.picture.is_some();
        if !self.unseen || (!now && (comes_soon || self.last_frame.elapsed() < FRAME_GAP)) {
            return;
        }
        let activity = self.activity();
        let mut numbers = Numbers::default();
        let mut dots = Arc::default();
        let mut probed = None;
        if let Some(render) = self.render.as_mut().filter(|r| r.render().passes() > 0) {
            self.picture = Some(render.picture(self.shown));
            self.pictured = self.render_number;
            if render.is_whole() {
                numbers = render.numbers(self.stop.error);
                if self.show_photons {
                    dots = Arc::new(probe::dots(render.render()));
                }
                probed = self.probed.and_then(|pixel| probe::probe(render.render(), pixel));
            }
        }
        let sensor = self.settings.sensor;
        let stage = self.stage.as_ref();
        let facts = stage.map(|s| Arc::clone(s.facts())).unwrap_or_default();
        let selection = stage.and_then(|s| s.selection(sensor));
        let lights = stage.map_or_else(Vec::new, |s| s.light_markers(sensor));
        self.frames += 1;
        self.channels.frames.send(Frame {
            number: self.frames,
            render: self.render_number,
            pictured: self.pictured,
            activity,
            opening: self.opening.as_ref().map(|o| o.name.clone()),
            building: self.opening.as_ref().and_then(Opening::building),
            size: facts.sensors.get(sensor).map_or([0, 0], |s| s.size),
            picture: self.picture.clone(),
            shown: self.shown,
            numbers,
            settings: self.settings.clone(),
            threads: self.threads,
            stop: self.stop,
            scene: facts,
            dots,
            probe: probed,
            selection,
            lights,
        });
        self.unseen = false;
        self.last_frame = Instant::now();
        (self.setup.wake)();
    }
}
