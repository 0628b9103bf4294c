//! What threads beside the engine's have to say: events, with a nudge for whoever listens.

use std::sync::{Arc, Mutex, PoisonError};

use crossbeam_channel::Sender;

use super::command::Event;

/// Called when there is something to see.
pub(super) type Wake = Box<dyn Fn() + Send>;

/// Says events from any thread.
#[derive(Clone)]
pub(super) struct Teller {
    events: Sender<Event>,
    wake: Arc<Mutex<Wake>>,
}

impl Teller {
    pub(super) fn new(events: Sender<Event>, wake: Wake) -> Self {
        Self { events, wake: Arc::new(Mutex::new(wake)) }
    }

    /// Says an event.
    pub(super) fn tell(&self, event: Event) {
        // A window that does not read its events has other troubles.
        let _ = self.events.try_send(event);
        self.wake();
    }

    /// Says that there is something to see.
    pub(super) fn wake(&self) {
        (self.wake.lock().unwrap_or_else(PoisonError::into_inner))();
    }
}
