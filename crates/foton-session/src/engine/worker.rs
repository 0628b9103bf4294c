//! The engine's own thread: commands, then work, then a frame; for ever.

mod publish;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, Sender, never, select};
use foton_integrator::{Cancel, RenderSettings};
use foton_scene::Scene;
use rayon::ThreadPool;

use super::command::{Change, Command, Configuration, Event, ViewMode};
use super::frame::{Frame, Picture};
use super::loader::{Opening, Ready};
use super::render::{Level, LevelRender};
use super::setup::Setup;
use super::slot::NewestSender;
use super::stage::{Effect, Stage};
use crate::checkpoint::Keeper;
use crate::panic::{Panic, catch_panic};
use crate::session::{PassError, Session, StartError};
use crate::stop::StopRule;
use crate::threads::{self, Rank};

/// How long to wait for commands while a scene is opened, before there is something new to see.
const LOOK_AGAIN: Duration = Duration::from_millis(100);

/// What the thread is connected to.
pub(super) struct Channels {
    pub(super) commands: Receiver<Command>,
    pub(super) frames: NewestSender<Frame>,
    pub(super) events: Sender<Event>,
}

/// What goes on.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Flow {
    /// Passes, until the stop rule.
    Run,
    /// So many passes, then wait.
    Steps(u64),
}

/// The thread's state.
pub(super) struct Worker {
    pub(super) setup: Setup,
    channels: Channels,
    /// Discards the pass, or gives up the build, that is under way.
    cancel: Cancel,
    /// Gives up whatever is built, once the engine is to end.
    quit: Cancel,
    pub(super) unwritten: Arc<AtomicUsize>,
    pub(super) stage: Option<Stage>,
    opening: Option<Opening>,
    pub(super) settings: RenderSettings,
    threads: Option<usize>,
    /// Kept from render to render: threads that come and go leave memory behind that the system's allocator does not give back.
    pool: Option<Arc<ThreadPool>>,
    stop: StopRule,
    flow: Flow,
    pub(super) render: Option<LevelRender>,
    /// The number of the render; it changes with each start.
    render_number: u64,
    /// Whether more camera moves are to follow.
    moving: bool,
    /// A render that cannot start is not tried again until something changes.
    refused: bool,
    last_pass: Duration,
    shown: ViewMode,
    show_photons: bool,
    probed: Option<[u32; 2]>,
    auto_snapshots: Option<PathBuf>,
    /// The checkpoint that follows the render.
    pub(super) keeper: Option<Keeper>,
    /// The checkpoint that the next whole render goes on from.
    pub(super) resuming: Option<PathBuf>,
    frames: u64,
    /// The whole picture as it last was: kept while the next render has none.
    picture: Option<Picture>,
    /// The render that it is of.
    pictured: u64,
    last_frame: Instant,
    /// Whether there is something that no frame has shown.
    unseen: bool,
}

impl Worker {
    pub(super) fn new(
        setup: Setup,
        channels: Channels,
        [cancel, quit]: [Cancel; 2],
        unwritten: Arc<AtomicUsize>,
    ) -> Self {
        Self {
            setup,
            channels,
            cancel,
            quit,
            unwritten,
            stage: None,
            opening: None,
            settings: RenderSettings::default(),
            threads: None,
            pool: None,
            stop: StopRule::default(),
            flow: Flow::Run,
            render: None,
            render_number: 0,
            moving: false,
            refused: false,
            last_pass: Duration::ZERO,
            shown: ViewMode::Radiance,
            show_photons: false,
            probed: None,
            auto_snapshots: None,
            keeper: None,
            resuming: None,
            frames: 0,
            picture: None,
            pictured: 0,
            last_frame: Instant::now(),
            unseen: true,
        }
    }

    /// Runs until asked to quit, or until nobody holds the engine.
    pub(super) fn run(mut self) {
        loop {
            // A request that comes from here on is for work that is still to begin: at worst a pass is traced twice.
            self.cancel.rearm();
            let Some(commands) = self.wait_for_commands() else { return };
            for command in commands {
                if matches!(command, Command::Quit) {
                    self.finish_checkpoint();
                    return;
                }
                let writes = command.writes();
                self.guarded(|worker| worker.obey(command));
                if writes {
                    self.unwritten.fetch_sub(1, Ordering::SeqCst);
                }
            }
            self.guarded(|worker| {
                worker.take_opened();
                worker.work();
                worker.publish(false);
            });
        }
    }

    /// Does work; a fault of our own in it ends the render, not the window, which keeps its last picture and says why.
    fn guarded(&mut self, work: impl FnOnce(&mut Self)) {
        if let Err(message) = catch_panic(|| work(self)) {
            self.render = None;
            self.refuse(Panic { stage: None, message }.to_string());
        }
    }

    /// Commands that are there; waits for one when there is nothing else to do. `None` when the engine was dropped.
    fn wait_for_commands(&mut self) -> Option<Vec<Command>> {
        let mut commands: Vec<Command> = self.channels.commands.try_iter().collect();
        if commands.is_empty() && self.is_idle() {
            self.guarded(|worker| worker.publish(true));
            let nothing = never();
            let opened = self.opening.as_ref().map_or(&nothing, |o| &o.result);
            // What was opened stays in its channel: it is taken where commands are not waited for.
            let mut wait = crossbeam_channel::Select::new();
            wait.recv(&self.channels.commands);
            wait.recv(opened);
            if self.opening.is_some() {
                // Building goes on, and the window shows how far it is.
                let _ = wait.ready_timeout(LOOK_AGAIN);
                self.unseen = true;
            } else {
                wait.ready();
            }
            select! {
                recv(self.channels.commands) -> command => commands.push(command.ok()?),
                default => {}
            }
            commands.extend(self.channels.commands.try_iter());
        }
        Some(commands)
    }

    pub(super) fn event(&self, event: Event) {
        // A window that does not read its events has other troubles.
        let _ = self.channels.events.try_send(event);
        (self.setup.wake)();
    }

    fn obey(&mut self, command: Command) {
        self.unseen = true;
        match command {
            Command::Open(source) => self.opening = Some(Opening::begin(&self.setup.loader, source)),
            Command::CancelOpen => self.opening = None,
            Command::Steer(change) => {
                self.settings.change(change);
                if let Some(render) = self.render.as_mut().filter(|r| r.is_whole()) {
                    render.session_mut().render_mut().change(change);
                }
            }
            Command::Configure(configuration) => self.configure(&configuration),
            Command::Pause => self.flow = Flow::Steps(0),
            Command::Resume => self.flow = Flow::Run,
            Command::Step => {
                let left = if let Flow::Steps(n) = self.flow { n } else { 0 };
                self.flow = Flow::Steps(left + 1);
            }
            Command::Restart => self.restart(),
            Command::StopAt(rule) => self.stop = rule,
            Command::Camera { gesture, moving } => {
                self.moving = moving;
                let sensor = self.settings.sensor;
                self.on_stage(|stage| stage.gesture(sensor, gesture));
            }
            Command::Moving(moving) => self.moving = moving,
            Command::ResetCamera => {
                self.moving = false;
                let sensor = self.settings.sensor;
                self.on_stage(|stage| stage.reset_camera(sensor));
            }
            Command::Choose(film) => {
                let sensor = self.settings.sensor;
                self.on_stage(|stage| {
                    stage.choose(sensor, film);
                    Ok(Effect::None)
                });
            }
            Command::Edit(change) => self.edit(change),
            Command::Show(shown) => self.shown = shown,
            Command::ShowPhotons(on) => self.show_photons = on,
            Command::Probe(pixel) => self.probed = pixel,
            Command::Snapshot(folder) => self.snapshot(&folder),
            Command::AutoSnapshots(folder) => self.auto_snapshots = folder,
            Command::SaveScene(path) => self.save_scene(&path),
            Command::KeepCheckpoint(path) => self.keep(&path),
            Command::ResumeCheckpoint(path) => {
                self.restart();
                self.resuming = Some(path);
            }
            Command::Quit => {}
        }
    }

    fn configure(&mut self, configuration: &Configuration) {
        configuration.apply(&mut self.settings);
        if let Some(stage) = &self.stage {
            self.settings.sensor = self.settings.sensor.min(stage.sensors().len() - 1);
        }
        if self.threads != configuration.threads {
            self.threads = configuration.threads;
            self.pool = None;
        }
        self.restart();
    }

    fn restart(&mut self) {
        self.leave_checkpoint();
        self.resuming = None;
        self.render = None;
        self.render_number += 1;
        self.refused = false;
        // There is always a pass to look at, paused or not.
        if self.flow == Flow::Steps(0) {
            self.flow = Flow::Steps(1);
        }
    }

    /// Changes the stage, and starts anew where that changes the picture.
    fn on_stage(&mut self, change: impl FnOnce(&mut Stage) -> Result<Effect, String>) {
        let Some(stage) = &mut self.stage else { return };
        match change(stage) {
            Ok(Effect::Anew) => self.restart(),
            Ok(Effect::None) => {}
            Err(message) => self.event(Event::Failed(message)),
        }
    }

    fn edit(&mut self, change: Change) {
        let sensor = self.settings.sensor;
        match change {
            Change::BeginDrag { .. } | Change::DragTo(_) | Change::SetField { done: false, .. } => {
                self.moving = true;
            }
            _ => self.moving = false,
        }
        self.on_stage(|stage| match change {
            Change::BeginDrag { film, mode } => {
                stage.begin_drag(sensor, film, mode);
                Ok(Effect::None)
            }
            Change::DragTo(film) => stage.drag_to(film),
            Change::EndDrag(film) => stage.end_drag(film),
            Change::CancelDrag => stage.cancel_drag(),
            Change::Nudge { steps, mode } => stage.nudge(sensor, steps, mode),
            Change::SetField { field, value, done } => stage.set_field(field, value, done),
            Change::OwnMaterial => stage.own_material(),
            Change::Undo => stage.undo(),
            Change::Redo => stage.redo(),
        });
    }

    /// Takes a scene that was opened meanwhile.
    fn take_opened(&mut self) {
        let Some(result) = self.opening.as_ref().and_then(|o| o.result.try_recv().ok()) else { return };
        self.opening = None;
        self.unseen = true;
        match result {
            Ok(ready) => self.show(*ready),
            Err(message) => self.event(Event::Failed(message)),
        }
    }

    fn show(&mut self, ready: Ready) {
        let loaded = &ready.loaded;
        let findings = ready.findings.iter().map(|finding| finding.text.clone());
        let warnings = loaded.warnings.iter().cloned().chain(findings).collect();
        self.event(Event::Opened { name: loaded.identity.name.clone(), warnings });
        self.settings = RenderSettings { layers: self.settings.layers, ..loaded.settings.clone() };
        self.stage = Some(Stage::new(ready, [self.cancel.clone(), self.quit.clone()]));
        self.moving = false;
        self.picture = None;
        self.probed = None;
        self.flow = Flow::Run;
        self.restart();
    }

    /// Whether there is nothing to do but wait.
    fn is_idle(&self) -> bool {
        if self.stage.is_none() || self.refused {
            return true;
        }
        let Some(level) = &self.render else { return false };
        if !level.is_whole() {
            return self.moving && level.waits_for_a_move();
        }
        match self.flow {
            Flow::Steps(left) => left == 0,
            Flow::Run => {
                let render = level.render();
                self.stop.is_reached(
                    render.passes(),
                    level.elapsed(),
                    self.last_pass,
                    render.error().as_ref(),
                )
            }
        }
    }

    /// One step: a start or a pass.
    fn work(&mut self) {
        if self.is_idle() {
            return;
        }
        if !self.build_edited() {
            return;
        }
        let Some(stage) = &self.stage else { return };
        let (scene, cancel) = (Arc::clone(stage.scene()), self.cancel.clone());
        let level = match &self.render {
            None => Some(Level::Small),
            Some(render) if self.moving || render.is_whole() => None,
            Some(render) => render.next_level(self.eye_samples(stage)),
        };
        let started = level.map(|level| {
            // A small picture is there so soon that a frame without it would only keep the window busy.
            if level != Level::Small || self.picture.is_none() {
                self.publish(true);
            }
            if level == Level::Whole
                && let Some(message) = self.beyond_memory(&scene)
            {
                return Err(message);
            }
            let Some(stage) = &self.stage else { return Ok(None) };
            let pool = match &self.pool {
                Some(pool) => pool,
                None => {
                    let pool = threads::pool(self.threads, Rank::Behind);
                    self.pool.insert(pool.map_err(|error| error.to_string())?)
                }
            };
            match LevelRender::start(level, &scene, stage.sensors(), &self.settings, pool, &cancel) {
                Ok(render) => Ok(Some(render)),
                Err(StartError::Panicked(panic)) => Err(panic.to_string()),
                Err(_) => Ok(None),
            }
        });
        match started {
            Some(Ok(Some(render))) => {
                self.unseen = true;
                self.render = if render.is_whole() { self.resume_in(render) } else { Some(render) };
            }
            Some(Ok(None)) => return,
            Some(Err(message)) => return self.refuse(message),
            None => {}
        }
        self.advance(&cancel);
    }

    /// Builds the scene of an edit, if that was given up before. Whether there is a scene to render now.
    fn build_edited(&mut self) -> bool {
        if !self.stage.as_ref().is_some_and(Stage::is_stale) {
            return true;
        }
        self.unseen = true;
        self.publish(true);
        let built = self.stage.as_mut().map_or(Ok(true), Stage::freshen);
        built.unwrap_or_else(|message| {
            self.event(Event::Failed(message));
            false
        })
    }

    /// Eye samples of the whole picture.
    fn eye_samples(&self, stage: &Stage) -> u64 {
        let sensor = &stage.sensors()[self.settings.sensor];
        let pixels = u64::from(sensor.width) * u64::from(sensor.height);
        pixels * u64::from(self.settings.samples_per_pixel.get())
    }

    fn advance(&mut self, cancel: &Cancel) {
        let Some(render) = &mut self.render else { return };
        let took = match render.advance(cancel) {
            Ok(took) => took,
            Err(PassError::Cancelled(_)) => return,
            Err(PassError::Panicked(panic)) => {
                // The picture of the passes before is still there to be saved; where it is not, the last frame stays.
                if !panic.leaves_the_image_whole() {
                    self.render = None;
                }
                return self.refuse(panic.to_string());
            }
            Err(PassError::NotFinite(place)) => return self.refuse(place.to_string()),
        };
        self.unseen = true;
        if !render.is_whole() {
            return;
        }
        self.last_pass = took;
        if let Flow::Steps(left) = &mut self.flow {
            *left = left.saturating_sub(1);
        }
        let due = render.render().passes().is_power_of_two();
        self.update_checkpoint();
        if let Some(folder) = self.auto_snapshots.clone().filter(|_| due) {
            self.auto_snapshot(&folder);
        }
    }

    fn refuse(&mut self, message: String) {
        self.refused = true;
        self.event(Event::Failed(message));
    }

    fn beyond_memory(&self, scene: &Scene) -> Option<String> {
        let estimate = Session::estimate_memory(scene, &self.settings, self.threads);
        let refusal = estimate.refusal(self.setup.memory_limit)?;
        Some(format!("{refusal}. Fewer eye samples or photons a pass need less"))
    }
}
