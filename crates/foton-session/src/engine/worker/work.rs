//! What the engine does between commands: takes scenes that were opened, starts renders, and passes.

use std::sync::Arc;
use std::time::{Duration, Instant};

use foton_integrator::{RenderSettings, ShouldSuspend};

use super::Worker;
use super::publish::When;
use super::state::Flow;
use crate::engine::command::Event;
use crate::engine::editable_scene::EditableScene;
use crate::engine::level::Level;
use crate::engine::loader::{Arrival, Ready};
use crate::engine::memory::within_memory;
use crate::engine::render::{Followed, LevelRender};
use crate::engine::starting::Starting;
use crate::session::{PassError, StartError};
use crate::threads::{self, Rank};

/// A pass makes way for a frame that shows how far it is after this long.
const SLICE: Duration = Duration::from_millis(200);

impl Worker {
    /// Takes a scene or a model that was opened meanwhile.
    pub(super) fn take_opened(&mut self) {
        let Some(result) = self.opening.as_ref().and_then(|o| o.result.try_recv().ok()) else { return };
        self.opening = None;
        self.published.unseen = true;
        match result {
            Ok(Arrival::Scene(ready)) => self.show(*ready),
            Ok(Arrival::Model(name, model)) => self.add_model(name, model),
            Err(message) => self.event(Event::Failed(message)),
        }
    }

    /// Makes a scene that was opened the one to render.
    fn show(&mut self, ready: Ready) {
        let loaded = &ready.loaded;
        self.event(Event::Opened { name: loaded.identity.name.clone(), warnings: ready.warnings() });
        // Light by path class changes no bit of the whole, and a person may look at it at any time.
        self.plan.settings = RenderSettings { layers: true, ..loaded.settings.clone() };
        self.scene = Some(EditableScene::new(ready, self.cancels.clone()));
        self.plan.moving = false;
        self.published.picture = None;
        self.view.probed = None;
        self.plan.flow = Flow::Run;
        self.current.kept.clear();
        self.restart();
    }

    /// Takes a render whose hit points were collected meanwhile.
    fn take_started(&mut self) {
        let Some(started) = self.current.starting.as_ref().and_then(|s| s.result.try_recv().ok()) else {
            return;
        };
        self.current.starting = None;
        self.published.unseen = true;
        match started {
            Ok(Some(render)) => {
                let render = render.after(self.current.render.as_ref());
                self.current.render = if render.is_whole() { self.resume_in(render) } else { Some(render) };
                self.steer_as_planned();
            }
            Ok(None) => {}
            Err(message) => self.refuse(message),
        }
    }

    /// Takes on what was changed while hit points were collected.
    fn steer_as_planned(&mut self) {
        let Some(render) = self.current.render.as_mut().filter(|render| render.is_whole()) else { return };
        render.steer(&self.plan.settings);
    }

    /// Whether there is nothing to do but wait.
    pub(super) fn is_idle(&self) -> bool {
        if self.scene.is_none() || self.current.refused || self.current.starting.is_some() {
            return true;
        }
        let Some(level) = &self.current.render else { return false };
        if !level.is_whole() {
            return self.plan.moving && level.waits_for_a_move();
        }
        match self.plan.flow {
            Flow::Steps(left) => left == 0 && !self.current.owes_a_pass,
            // A pass that was begun is finished, as everywhere.
            Flow::Run if level.render().pass_share() > 0.0 => false,
            Flow::Run => {
                if self.turntable.is_some() {
                    return false;
                }
                let render = level.render();
                self.plan.stop.is_reached(
                    render.passes(),
                    level.elapsed(),
                    self.current.last_pass,
                    render.error().as_ref(),
                )
            }
        }
    }

    /// One step: a start or a pass.
    pub(super) fn work(&mut self) {
        self.take_started();
        if self.is_idle() || !self.build_edited() {
            return;
        }
        if let Some(level) = self.due_level() {
            match self.start(level) {
                Ok(Some(render)) => {
                    self.published.unseen = true;
                    self.current.render = Some(render);
                }
                Ok(None) => return,
                Err(message) => return self.refuse(message),
            }
        }
        let (begin, news) = (Instant::now(), self.cancels.news.clone());
        self.advance(&|| news.is_there() || begin.elapsed() > SLICE);
    }

    /// The level at which a render is to be started now, if any is.
    fn due_level(&self) -> Option<Level> {
        let scene = self.scene.as_ref()?;
        match &self.current.render {
            None => Some(Level::Small),
            Some(render) if self.plan.moving || render.is_whole() => None,
            Some(render) => render.next_level(self.pixels(scene), &self.plan.settings),
        }
    }

    /// Starts a render at a level; `None` where that was cancelled, or goes on elsewhere, as it does for all pixels.
    fn start(&mut self, level: Level) -> Result<Option<LevelRender>, String> {
        // A small picture is there so soon that a frame without it would be drawn for nothing.
        if level != Level::Small || self.published.picture.is_none() {
            self.publish(When::AtOnce);
        }
        let Some(scene) = &self.scene else { return Ok(None) };
        let pool = match &self.current.pool {
            Some(pool) => pool,
            None => {
                let pool = threads::pool(self.plan.threads, Rank::Behind);
                self.current.pool.insert(pool.map_err(|error| error.to_string())?)
            }
        };
        let (threads, limit, pool) = (self.plan.threads, self.setup.memory_limit, Arc::clone(pool));
        let (settings, sensors) = (self.plan.settings.clone(), scene.rendered_sensors());
        if level <= Level::Middle {
            let cancel = &self.cancels.work;
            return started(LevelRender::start(level, scene.scene(), &sensors, &settings, &pool, cancel));
        }
        let scene = Arc::clone(scene.scene());
        self.current.subject = self.subject();
        let followed = self.current.render.as_mut().and_then(LevelRender::take_followed);
        let share = followed.as_ref().map_or(0.0, Followed::share);
        self.current.starting = Some(Starting::begin(share, move |tell, cancel| {
            let level = within_memory(level, &scene, &settings, threads, limit)?;
            let followed = followed.unwrap_or_else(|| Followed::none(scene, settings));
            let render = LevelRender::collect(level, followed, &pool, tell, cancel);
            started(render).map(|render| render.map(Box::new))
        }));
        Ok(None)
    }

    /// Builds the scene of an edit, if that was given up before. Whether there is a scene to render now.
    fn build_edited(&mut self) -> bool {
        if !self.scene.as_ref().is_some_and(EditableScene::is_stale) {
            return true;
        }
        self.published.unseen = true;
        self.publish(When::AtOnce);
        let built = self.scene.as_mut().map_or(Ok(true), EditableScene::freshen);
        built.unwrap_or_else(|message| {
            self.event(Event::Failed(message));
            false
        })
    }

    /// Pixels of the whole picture.
    fn pixels(&self, scene: &EditableScene) -> u64 {
        let sensor = &scene.scene().sensors()[self.plan.settings.sensor];
        u64::from(sensor.width) * u64::from(sensor.height)
    }

    /// Finishes a pass that has refined hit points already, so that what is written is of a whole pass. No photon is traced for that.
    pub(in crate::engine) fn settle(&mut self) {
        if self.current.render.as_ref().is_some_and(|render| render.render().has_refined()) {
            self.advance(&|| false);
        }
    }

    /// One pass, or a part of it, and what is written after it.
    fn advance(&mut self, should_suspend: ShouldSuspend<'_>) {
        let Some(render) = &mut self.current.render else { return };
        let took = match render.advance(should_suspend) {
            Ok(Some(took)) => took,
            Ok(None) => {
                // The window shows how far the pass is.
                self.published.unseen = true;
                return;
            }
            Err(PassError::Cancelled(_) | PassError::Suspended(_)) => return,
            Err(PassError::Panicked(panic)) => {
                // The picture of the passes before is still there to be saved; where it is not, the last frame stays.
                if !panic.leaves_the_image_whole() {
                    self.current.render = None;
                }
                return self.refuse(panic.to_string());
            }
            Err(PassError::NotFinite(place)) => return self.refuse(place.to_string()),
        };
        self.published.unseen = true;
        if !render.is_whole() {
            return;
        }
        self.current.last_pass = took;
        let was_owed = std::mem::take(&mut self.current.owes_a_pass);
        if let Flow::Steps(left) = &mut self.plan.flow {
            *left = left.saturating_sub(u64::from(!was_owed));
        }
        let due = render.render().passes().is_power_of_two();
        self.update_checkpoint();
        if let Some(folder) = self.files.auto_snapshots.clone().filter(|_| due) {
            self.write(&folder);
        }
        self.turn();
    }

    /// Ends the render until something changes, and says why.
    pub(super) fn refuse(&mut self, message: String) {
        self.current.refused = true;
        self.event(Event::Failed(message));
    }
}

/// A render that started, `None` where that was cancelled, or why it cannot.
fn started(outcome: Result<LevelRender, StartError>) -> Result<Option<LevelRender>, String> {
    match outcome {
        Ok(render) => Ok(Some(render)),
        Err(StartError::Panicked(panic)) => Err(panic.to_string()),
        Err(_) => Ok(None),
    }
}
