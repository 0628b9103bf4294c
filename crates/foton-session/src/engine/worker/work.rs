//! What the engine does between commands: takes scenes that were opened, starts renders, and passes.

use foton_integrator::RenderSettings;
use foton_scene::Scene;

use super::Worker;
use super::state::Flow;
use crate::engine::command::Event;
use crate::engine::editable_scene::EditableScene;
use crate::engine::loader::Ready;
use crate::engine::render::{Level, LevelRender};
use crate::session::{PassError, Session, StartError};
use crate::threads::{self, Rank};

impl Worker {
    /// Takes a scene that was opened meanwhile.
    pub(super) fn take_opened(&mut self) {
        let Some(result) = self.opening.as_ref().and_then(|o| o.result.try_recv().ok()) else { return };
        self.opening = None;
        self.published.unseen = true;
        match result {
            Ok(ready) => self.show(*ready),
            Err(message) => self.event(Event::Failed(message)),
        }
    }

    /// Makes a scene that was opened the one to render.
    fn show(&mut self, ready: Ready) {
        let loaded = &ready.loaded;
        let findings = ready.findings.iter().map(|finding| finding.text.clone());
        let warnings = loaded.warnings.iter().cloned().chain(findings).collect();
        self.event(Event::Opened { name: loaded.identity.name.clone(), warnings });
        // Light by path class changes no bit of the whole, and a person may look at it at any time.
        self.plan.settings = RenderSettings { layers: true, ..loaded.settings.clone() };
        self.scene = Some(EditableScene::new(ready, self.cancels.clone()));
        self.plan.moving = false;
        self.published.picture = None;
        self.view.probed = None;
        self.plan.flow = Flow::Run;
        self.restart();
    }

    /// Whether there is nothing to do but wait.
    pub(super) fn is_idle(&self) -> bool {
        if self.scene.is_none() || self.current.refused {
            return true;
        }
        let Some(level) = &self.current.render else { return false };
        if !level.is_whole() {
            return self.plan.moving && level.waits_for_a_move();
        }
        match self.plan.flow {
            Flow::Steps(left) => left == 0,
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
        if self.is_idle() || !self.build_edited() {
            return;
        }
        match self.due_level().map(|level| self.start(level)) {
            Some(Ok(Some(render))) => {
                self.published.unseen = true;
                self.current.render = if render.is_whole() { self.resume_in(render) } else { Some(render) };
            }
            Some(Ok(None)) => return,
            Some(Err(message)) => return self.refuse(message),
            None => {}
        }
        // A state that was taken back may be past the stop rule already.
        if self.is_idle() {
            return;
        }
        self.advance();
    }

    /// The level at which a render is to be started now, if any is.
    fn due_level(&self) -> Option<Level> {
        let scene = self.scene.as_ref()?;
        match &self.current.render {
            None => Some(Level::Small),
            Some(render) if self.plan.moving || render.is_whole() => None,
            Some(render) => render.next_level(self.eye_samples(scene)),
        }
    }

    /// Starts a render at a level; `None` where that was cancelled.
    fn start(&mut self, level: Level) -> Result<Option<LevelRender>, String> {
        // A small picture is there so soon that a frame without it would be drawn for nothing.
        if level != Level::Small || self.published.picture.is_none() {
            self.publish(true);
        }
        let Some(scene) = &self.scene else { return Ok(None) };
        if level == Level::Whole
            && let Some(message) = self.beyond_memory(scene.scene())
        {
            return Err(message);
        }
        let pool = match &self.current.pool {
            Some(pool) => pool,
            None => {
                let pool = threads::pool(self.plan.threads, Rank::Behind);
                self.current.pool.insert(pool.map_err(|error| error.to_string())?)
            }
        };
        let (settings, cancel) = (&self.plan.settings, &self.cancels.work);
        match LevelRender::start(level, scene.scene(), &scene.rendered_sensors(), settings, pool, cancel) {
            Ok(render) => Ok(Some(render)),
            Err(StartError::Panicked(panic)) => Err(panic.to_string()),
            Err(_) => Ok(None),
        }
    }

    /// Builds the scene of an edit, if that was given up before. Whether there is a scene to render now.
    fn build_edited(&mut self) -> bool {
        if !self.scene.as_ref().is_some_and(EditableScene::is_stale) {
            return true;
        }
        self.published.unseen = true;
        self.publish(true);
        let built = self.scene.as_mut().map_or(Ok(true), EditableScene::freshen);
        built.unwrap_or_else(|message| {
            self.event(Event::Failed(message));
            false
        })
    }

    /// Eye samples of the whole picture.
    fn eye_samples(&self, scene: &EditableScene) -> u64 {
        let sensor = &scene.scene().sensors()[self.plan.settings.sensor];
        let pixels = u64::from(sensor.width) * u64::from(sensor.height);
        pixels * u64::from(self.plan.settings.samples_per_pixel.get())
    }

    /// One pass, and what is written after it.
    fn advance(&mut self) {
        let Some(render) = &mut self.current.render else { return };
        let took = match render.advance(&self.cancels.work) {
            Ok(took) => took,
            Err(PassError::Cancelled(_)) => return,
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
        if let Flow::Steps(left) = &mut self.plan.flow {
            *left = left.saturating_sub(1);
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

    /// Why the whole render is refused, if it would take too much memory.
    fn beyond_memory(&self, scene: &Scene) -> Option<String> {
        let estimate = Session::estimate_memory(scene, &self.plan.settings, self.plan.threads);
        let refusal = estimate.refusal(self.setup.memory_limit)?;
        Some(format!("{refusal}. Fewer eye samples or photons a pass need less"))
    }
}
