//! The engine's own thread: commands, then work, then a frame; for ever.

mod obey;
mod publish;
mod state;
mod work;

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use crossbeam_channel::{Receiver, Sender, never, select};

use self::publish::When;
pub(super) use self::state::Flow;
use self::state::{Current, Files, Plan, Published, View};
use super::cancels::Cancels;
use super::command::{Command, Event, ViewMode};
use super::editable_scene::EditableScene;
use super::frame::Frame;
use super::history::{History, Turntable};
use super::loader::Opening;
use super::newest::NewestSender;
use super::setup::Setup;
use super::teller::Teller;
use crate::panic::{Panic, catch_panic};
use crate::snapshot::Look;

/// How long to wait for commands while a scene is opened, before the progress of that is published.
const POLL: Duration = Duration::from_millis(100);

/// What the thread is connected to.
pub(super) struct Channels {
    pub(super) commands: Receiver<Command>,
    pub(super) frames: NewestSender<Frame>,
    pub(super) events: Sender<Event>,
}

/// The thread's state.
pub(super) struct Worker {
    pub(super) setup: Setup,
    channels: Channels,
    cancels: Cancels,
    pub(super) scene: Option<EditableScene>,
    opening: Option<Opening>,
    pub(super) plan: Plan,
    pub(super) current: Current,
    pub(super) files: Files,
    /// Passes that were kept.
    pub(super) history: History,
    /// The turntable, while one turns.
    pub(super) turntable: Option<Turntable>,
    /// Says what other threads have to say.
    pub(super) teller: Teller,
    view: View,
    published: Published,
}

impl Worker {
    pub(super) fn new(
        mut setup: Setup,
        channels: Channels,
        cancels: Cancels,
        unwritten: Arc<AtomicUsize>,
    ) -> Self {
        let wake = std::mem::replace(&mut setup.wake, Box::new(|| ()));
        let teller = Teller::new(channels.events.clone(), wake);
        let (home, limit) = (setup.history_folder.clone(), setup.history_limit);
        Self {
            history: History::new(home, limit, teller.clone(), Arc::clone(&unwritten)),
            turntable: None,
            teller,
            setup,
            channels,
            cancels,
            scene: None,
            opening: None,
            plan: Plan::default(),
            current: Current::default(),
            files: Files {
                unwritten,
                auto_snapshots: None,
                run: None,
                look: Look::default(),
                keeper: None,
                resuming: None,
                resuming_as: None,
            },
            view: View { mode: ViewMode::Radiance, photons: false, paths: None, probed: None },
            published: Published::default(),
        }
    }

    /// Runs until asked to quit, or until nobody holds the engine.
    pub(super) fn run(mut self) {
        loop {
            // A request that comes from here on is for work that is still to begin: at worst something is begun twice.
            self.cancels.work.rearm();
            self.cancels.news.forget();
            let Some(commands) = self.wait_for_commands() else { return };
            let is_asked = !commands.is_empty();
            for command in commands {
                if matches!(command, Command::Quit) {
                    self.history.end();
                    self.finish_checkpoint();
                    return;
                }
                let writes = command.writes();
                self.guarded(|worker| worker.obey(command));
                if writes {
                    self.files.unwritten.fetch_sub(1, Ordering::SeqCst);
                }
            }
            self.guarded(|worker| {
                worker.take_opened();
                if is_asked {
                    worker.publish(When::Answering);
                }
                worker.work();
                worker.publish(When::Due);
            });
        }
    }

    /// Does work; a fault of our own in it ends the render, not the window, which keeps its last picture and says why.
    fn guarded(&mut self, work: impl FnOnce(&mut Self)) {
        if let Err(message) = catch_panic(|| work(self)) {
            self.current.render = None;
            self.refuse(Panic { stage: None, message }.to_string());
        }
    }

    /// Commands that are there; waits for one when there is nothing else to do. `None` when the engine was dropped.
    fn wait_for_commands(&mut self) -> Option<Vec<Command>> {
        let mut commands: Vec<Command> = self.channels.commands.try_iter().collect();
        if commands.is_empty() && self.is_idle() {
            self.guarded(|worker| worker.publish(When::AtOnce));
            let nothing = never();
            let opened = self.opening.as_ref().map_or(&nothing, |o| &o.result);
            let never_started = never();
            let started = self.current.starting.as_ref().map_or(&never_started, |s| &s.result);
            // What was opened or started stays in its channel: it is taken where commands are not waited for.
            let mut wait = crossbeam_channel::Select::new();
            wait.recv(&self.channels.commands);
            wait.recv(opened);
            wait.recv(started);
            wait.recv(self.history.gone());
            if self.opening.is_some() || self.current.starting.is_some() {
                // That goes on, and the window shows how far it is.
                let _ = wait.ready_timeout(POLL);
                self.published.unseen = true;
            } else {
                wait.ready();
            }
            self.published.unseen |= !self.history.gone().is_empty();
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
        self.teller.wake();
    }
}
