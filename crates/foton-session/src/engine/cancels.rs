//! The requests that the engine's handle shares with its thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use foton_integrator::Cancel;

/// The requests that the engine's handle shares with its thread.
#[derive(Clone, Default)]
pub(super) struct Cancels {
    /// Gives up the build, or the start of a small picture, that is under way, for something newer.
    pub(super) work: Cancel,
    /// Gives up whatever is built, once the engine is to end.
    pub(super) quit: Cancel,
    /// Whether a command waits: a pass makes way for it, and goes on after it.
    pub(super) news: News,
}

/// Whether a command waits.
#[derive(Clone, Default)]
pub(super) struct News(Arc<AtomicBool>);

impl News {
    /// A command was sent.
    pub(super) fn tell(&self) {
        self.0.store(true, Ordering::Release);
    }

    /// All commands so far are about to be taken.
    pub(super) fn forget(&self) {
        self.0.store(false, Ordering::Release);
    }

    pub(super) fn is_there(&self) -> bool {
        self.0.load(Ordering::Acquire)
    }
}
