//! The engine: a thread that renders over a pool, takes commands and offers the newest frame. A window steers it; it knows none.
//!
//! Threads meet here and nowhere else: commands come in over one bounded channel, frames leave over a slot that keeps the newest,
//! events (which must not get lost) over a third. The engine calls `wake` when there is something to see.

mod command;
mod frame;
mod loader;
mod probe;
mod render;
mod slot;
mod worker;

use std::sync::Arc;
use std::thread;

use crossbeam_channel::{Receiver, Sender, bounded};
use foton_integrator::Cancel;
use foton_scene::Scene;
use foton_scene::description::SensorDescription;

pub use command::{Command, Configuration, Event, Look, Shown, Source};
pub use frame::{Activity, Dot, Frame, Numbers, Picture, Probe, SceneFacts, SensorFacts};
pub use loader::{Loaded, Loader};

/// Commands that may wait at once. A window sends a few for each frame it draws.
const COMMANDS: usize = 1024;

/// Events that may wait at once; the oldest are kept.
const EVENTS: usize = 256;

/// What the engine is given.
pub struct Setup {
    /// How scenes are opened and saved.
    pub loader: Arc<dyn Loader>,
    /// Called from the engine's thread when a frame or event is there.
    pub wake: Box<dyn Fn() + Send>,
    /// Renders beyond this many bytes are refused.
    pub memory_limit: Option<f64>,
}

/// A handle on the engine. Dropping it ends the engine after what it is writing.
pub struct Engine {
    commands: Sender<Command>,
    frames: Receiver<Frame>,
    events: Receiver<Event>,
    cancel: Cancel,
}

impl Engine {
    /// Starts the thread; it waits for a scene.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn spawn(setup: Setup) -> std::io::Result<Self> {
        let (commands, command_receiver) = bounded(COMMANDS);
        let (frame_sender, frames) = slot::newest();
        let (event_sender, events) = bounded(EVENTS);
        let cancel = Cancel::default();
        let channels =
            worker::Channels { commands: command_receiver, frames: frame_sender, events: event_sender };
        let worker = worker::Worker::new(setup, channels, cancel.clone());
        thread::Builder::new().name("engine".to_owned()).spawn(move || worker.run())?;
        Ok(Self { commands, frames, events, cancel })
    }

    /// Asks for something. Where the pass under way would be for nothing, it is discarded. Returns whether the engine is there
    /// and had room.
    pub fn send(&self, command: Command) -> bool {
        let interrupts = command.interrupts();
        let sent = self.commands.try_send(command).is_ok();
        if interrupts {
            self.cancel.request();
        }
        sent
    }

    /// The newest frame, if there is one that was not taken yet.
    #[must_use]
    pub fn frame(&self) -> Option<Frame> {
        self.frames.try_recv().ok()
    }

    /// The next event, in order.
    #[must_use]
    pub fn event(&self) -> Option<Event> {
        self.events.try_recv().ok()
    }

    /// The frames themselves, for those who want to wait for one.
    #[must_use]
    pub const fn frames(&self) -> &Receiver<Frame> {
        &self.frames
    }

    /// The events themselves, for those who want to wait for one.
    #[must_use]
    pub const fn events(&self) -> &Receiver<Event> {
        &self.events
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        self.send(Command::Quit);
    }
}

/// What a window says of a scene.
fn scene_facts(source: &Source, loaded: &Loaded, scene: &Scene) -> SceneFacts {
    let sensor = |s: &SensorDescription| SensorFacts {
        name: s.name.clone(),
        look: Look { to_world: s.to_world, fov_degrees: s.fov_degrees },
        size: [s.width, s.height],
    };
    let bounds = scene.bounds();
    let normalisation = scene.normalisation();
    let centre = normalisation.world_point((bounds.min + bounds.max) * 0.5);
    SceneFacts {
        name: loaded.identity.name.clone(),
        file: source.file().cloned(),
        sensors: loaded.description.sensors.iter().map(sensor).collect(),
        shapes: loaded.description.shapes.len(),
        centre: centre.to_array(),
        half_size: normalisation.world_length(f64::from(bounds.size().max_element()) * 0.5),
        edited: false,
    }
}
