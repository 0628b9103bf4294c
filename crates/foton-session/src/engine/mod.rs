//! The engine: a thread that renders over a pool, takes commands and offers the newest frame. A window steers it; it knows none.
//!
//! Threads meet here and nowhere else: commands come in over one bounded channel, frames leave over another that holds only the
//! newest, events (which must not get lost) over a third. The engine calls `wake` when there is something to see.

mod cancels;
mod checkpointing;
mod command;
mod editable_scene;
mod filming;
mod frame;
mod gesture;
mod history;
mod keeping;
mod kept;
mod level;
mod loader;
mod memory;
mod newest;
mod probe;
mod rates;
mod render;
mod run;
mod setup;
mod starting;
mod teller;
mod worker;
mod writing;

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, Sender, bounded};

use cancels::Cancels;
pub use command::{Command, Configuration, ErrorPart, Event, Region, SceneEdit, Source, ViewMode};
pub use foton_scene::BuildStep;
pub use frame::{
    Activity, BuildProgress, Dot, DrawnPath, Frame, Picture, Probe, RenderStats, SceneFacts, Selection,
    SensorFacts, SurfaceNames,
};
pub use gesture::Gesture;
pub use history::{HistoryEntry, Thumbnail, shrunk};
pub use loader::{Loaded, Loader, Reopened, SavedScene, TellReading};
pub use setup::Setup;

/// Commands that may wait at once. A window sends a few for each frame it draws.
const COMMANDS: usize = 1024;

/// Events that may wait at once; the newest are dropped.
const EVENTS: usize = 256;

/// A handle on the engine. Dropping it ends the engine after what it is writing.
pub struct Engine {
    commands: Sender<Command>,
    frames: Receiver<Frame>,
    events: Receiver<Event>,
    cancels: Cancels,
    /// Files that were asked for and are not written yet.
    unwritten: Arc<AtomicUsize>,
}

/// How often to check whether all files are written.
const POLL: Duration = Duration::from_millis(2);

/// How long to wait for files at most.
const PATIENCE: Duration = Duration::from_secs(30);

impl Engine {
    /// Starts the thread; it waits for a scene.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn spawn(setup: Setup) -> std::io::Result<Self> {
        let (commands, command_receiver) = bounded(COMMANDS);
        let (frame_sender, frames) = newest::channel();
        let (event_sender, events) = bounded(EVENTS);
        let cancels = Cancels::default();
        let channels =
            worker::Channels { commands: command_receiver, frames: frame_sender, events: event_sender };
        let unwritten = Arc::new(AtomicUsize::new(0));
        let worker = worker::Worker::new(setup, channels, cancels.clone(), Arc::clone(&unwritten));
        thread::Builder::new().name("engine".to_owned()).spawn(move || worker.run())?;
        Ok(Self { commands, frames, events, cancels, unwritten })
    }

    /// Asks for something. A pass under way makes way for it at once. Returns whether the engine is there
    /// and had room.
    pub fn send(&self, command: Command) -> bool {
        let (interrupts, writes) = (command.interrupts(), command.writes());
        if matches!(command, Command::Quit) {
            self.cancels.quit.request();
        }
        if writes {
            self.unwritten.fetch_add(1, Ordering::SeqCst);
        }
        let sent = self.commands.try_send(command).is_ok();
        if writes && !sent {
            self.unwritten.fetch_sub(1, Ordering::SeqCst);
        }
        if interrupts {
            self.cancels.work.request();
        }
        self.cancels.news.tell();
        sent
    }

    /// Ends the engine. Returns at once, in the middle of a pass too, unless files that were asked for are still to be written:
    /// then when they are.
    pub fn finish_writing(&self) {
        self.send(Command::Quit);
        let begin = Instant::now();
        while self.unwritten.load(Ordering::SeqCst) > 0 && begin.elapsed() < PATIENCE {
            thread::sleep(POLL);
        }
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
