//! Frames: how the engine's work stands, no more often than a window can draw.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::Worker;
use super::state::{Flow, PictureOf};
use crate::dots::dots;
use crate::engine::command::Region;
use crate::engine::editable_scene::EditableScene;
use crate::engine::frame::{Activity, Dot, Frame, Probe, RenderStats};
use crate::engine::history::Turntable;
use crate::engine::loader::Opening;
use crate::engine::probe;
use crate::engine::render::LevelRender;
use crate::engine::starting::Starting;

/// Frames are at least this far apart unless a person is waiting for one.
const FRAME_GAP: Duration = Duration::from_millis(30);

/// When a frame is offered.
#[derive(Clone, Copy)]
pub(super) enum When {
    /// There may be none for a while.
    AtOnce,
    /// A command was obeyed: a person waits, unless for a picture that comes soon.
    Answering,
    /// Not too soon after the last.
    Due,
}

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
            // Hit points that are being collected are collected to the end all the same.
            Flow::Steps(0) if !self.current.owes_a_pass => Activity::Paused,
            _ if !render.is_whole() => Activity::Collecting,
            Flow::Run if self.is_idle() => Activity::Done,
            _ => Activity::Rendering,
        }
    }

    /// The whole render, once its hit points are collected.
    fn whole(&self) -> Option<&LevelRender> {
        self.current.render.as_ref().filter(|render| render.is_whole())
    }

    /// Takes the picture of the newest pass. That of a preview stays until there is a better one, unless a person is waiting
    /// for this pass.
    fn renew_picture(&mut self) {
        let waits = self.plan.flow != Flow::Run || self.is_idle();
        let Some(render) = self.current.render.as_ref().filter(|r| r.render().passes() > 0) else { return };
        let has_preview = self.published.pictured == self.current.number;
        if has_preview && !(waits && render.is_whole()) && !render.beats_its_preview() {
            return;
        }
        let of = PictureOf {
            render: self.current.number,
            level: render.level(),
            passes: render.render().passes(),
            mode: self.view.mode,
        };
        if self.published.picture_of != Some(of) {
            self.published.picture = Some(render.picture(of.mode));
            self.published.picture_of = Some(of);
            self.published.pictured = of.render;
            self.published.window = self.window();
        }
    }

    /// How the whole render stands after its last pass.
    fn stats(&mut self) -> RenderStats {
        let (number, goal) = (self.current.number, self.plan.stop.error);
        let whole = self.current.render.as_mut().filter(|r| r.is_whole() && r.render().passes() > 0);
        let Some(render) = whole else { return RenderStats::default() };
        let passes = render.render().passes();
        match &mut self.published.stats {
            Some((n, p, g, stats)) if (*n, *p, *g) == (number, passes, goal) => {
                stats.elapsed = render.elapsed();
                stats.clone()
            }
            stats => stats.insert((number, passes, goal, render.stats(goal))).3.clone(),
        }
    }

    /// Photons, and what is known of the pixel that a person points at, as far as they are asked for.
    fn pointed_out(&mut self) -> (Arc<Vec<Dot>>, Option<Probe>) {
        let whole = self.current.render.as_ref().filter(|render| render.is_whole());
        let Some(level) = whole.filter(|level| level.render().passes() > 0) else {
            return Default::default();
        };
        let render = level.render();
        let dots = if self.view.photons { dots(render) } else { Vec::new() };
        let mut probe = self.view.probed.and_then(|pixel| probe::probe(render, pixel));
        if let (Some(probe), Some(paths)) = (&mut probe, &mut self.view.paths) {
            let of = Some((self.current.number, probe.pixel, render.passes().ilog2()));
            if paths.of != of {
                (paths.of, paths.drawn) =
                    (of, Arc::new(level.session().install(|| probe::paths(render, probe.pixel))));
            }
            probe.paths = Arc::clone(&paths.drawn);
        }
        (Arc::new(dots), probe)
    }

    /// Offers a frame if there is something new and it is time for one.
    pub(super) fn publish(&mut self, when: When) {
        // While something moves, a picture is there so soon that a frame before it would be drawn for nothing.
        let has_none = self.current.render.as_ref().is_none_or(|render| render.render().passes() == 0);
        let comes_soon = self.plan.moving && has_none && self.published.picture.is_some();
        let is_time = match when {
            When::AtOnce => true,
            When::Answering => !comes_soon,
            When::Due => !comes_soon && self.published.last_frame.elapsed() >= FRAME_GAP,
        };
        if !self.published.unseen || !is_time {
            return;
        }
        let activity = self.activity();
        self.renew_picture();
        let window = self.window();
        let stats = self.stats();
        let (dots, probe) = self.pointed_out();
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
            kept_bytes: self.current.kept.bytes(),
            pass_share: self.whole().map_or(0.0, |render| render.render().pass_share()),
            collecting: self.current.starting.as_ref().map(Starting::share),
            settings: self.plan.settings.clone(),
            threads: self.plan.threads,
            stop: self.plan.stop,
            history,
            turntable: self.turntable.as_ref().map(Turntable::progress),
            checkpoint_age: self.checkpoint_age(),
            scene: facts,
            dots,
            probe,
            selection,
            lights,
        });
        self.published.unseen = false;
        self.published.last_frame = Instant::now();
        self.teller.wake();
    }
}
