//! Frames: how the engine's work stands, no more often than a window can draw.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::Worker;
use super::state::Flow;
use crate::engine::command::Region;
use crate::engine::editable_scene::EditableScene;
use crate::engine::frame::{Activity, Frame, RenderStats};
use crate::engine::history::Turntable;
use crate::engine::loader::Opening;
use crate::engine::probe;

/// Frames are at least this far apart unless a person is waiting for one.
const FRAME_GAP: Duration = Duration::from_millis(30);

impl Worker {
    /// The part of the whole image that is rendered.
    fn window(&self) -> Region {
        let none = Region { x: 0, y: 0, width: 0, height: 0 };
        let sensor =
            |scene: &EditableScene| Some(scene.scene().sensors().get(self.plan.settings.sensor)?.window());
        self.scene.as_ref().and_then(sensor).unwrap_or(none)
    }

    fn activity(&self) -> Activity {
        let Some(render) = &self.current.render else {
            return match &self.scene {
                None => Activity::Empty,
                Some(scene) if scene.is_stale() => Activity::Building,
                Some(_) => Activity::Collecting,
            };
        };
        match self.plan.flow {
            _ if self.plan.moving => Activity::Moving,
            _ if !render.is_whole() => Activity::Collecting,
            Flow::Steps(0) => Activity::Paused,
            Flow::Run if self.is_idle() => Activity::Done,
            _ => Activity::Rendering,
        }
    }

    /// Offers a frame if there is something new: at once if `now`, else not too soon after the last.
    pub(super) fn publish(&mut self, now: bool) {
        // While something moves, a picture is there so soon that a frame before it would be drawn for nothing.
        let comes_soon =
            self.plan.moving && self.current.render.is_none() && self.published.picture.is_some();
        if !self.published.unseen || (!now && (comes_soon || self.published.last_frame.elapsed() < FRAME_GAP))
        {
            return;
        }
        let activity = self.activity();
        let window = self.window();
        let mut stats = RenderStats::default();
        let mut dots = Arc::default();
        let mut probed = None;
        if let Some(render) = self.current.render.as_mut().filter(|r| r.render().passes() > 0) {
            self.published.picture = Some(render.picture(self.view.mode));
            self.published.pictured = self.current.number;
            self.published.window = window;
            if render.is_whole() {
                stats = render.stats(self.plan.stop.error);
                if self.view.photons {
                    dots = Arc::new(probe::dots(render.render()));
                }
                probed = self.view.probed.and_then(|pixel| probe::probe(render.render(), pixel));
            }
        }
        let history = self.history.shown();
        let sensor = self.plan.settings.sensor;
        let scene = self.scene.as_ref();
        let facts = scene.map(|s| Arc::clone(s.facts())).unwrap_or_default();
        let selection = scene.and_then(|s| s.selection(sensor));
        let lights = scene.map_or_else(Vec::new, |s| s.light_markers(sensor));
        self.published.frames += 1;
        self.channels.frames.send(Frame {
            number: self.published.frames,
            render: self.current.number,
            pictured: self.published.pictured,
            activity,
            opening: self.opening.as_ref().map(|o| o.name.clone()),
            building: self.opening.as_ref().and_then(Opening::building),
            size: facts.sensors.get(sensor).map_or([0, 0], |s| s.size),
            window: if self.published.picture.is_some() { self.published.window } else { window },
            region: scene.and_then(EditableScene::region),
            picture: self.published.picture.clone(),
            view: self.view.mode,
            stats,
            settings: self.plan.settings.clone(),
            threads: self.plan.threads,
            stop: self.plan.stop,
            history,
            turntable: self.turntable.as_ref().map(Turntable::progress),
            scene: facts,
            dots,
            probe: probed,
            selection,
            lights,
        });
        self.published.unseen = false;
        self.published.last_frame = Instant::now();
        self.teller.wake();
    }
}
