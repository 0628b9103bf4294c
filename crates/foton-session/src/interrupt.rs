//! A person's wish to stop, from another thread or a signal handler.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use foton_integrator::Cancel;

/// Asked once, the pass under way is finished and the render stops. Asked again, the pass is discarded.
#[derive(Clone, Debug, Default)]
pub struct Interrupt {
    finish: Arc<AtomicBool>,
    cancel: Cancel,
}

impl Interrupt {
    /// Asks.
    pub fn request(&self) {
        if self.finish.swap(true, Ordering::Relaxed) {
            self.cancel.request();
        }
    }

    /// Whether anyone has asked.
    #[must_use]
    pub fn is_requested(&self) -> bool {
        self.finish.load(Ordering::Relaxed)
    }

    /// What discards the pass under way.
    #[must_use]
    pub const fn cancel(&self) -> &Cancel {
        &self.cancel
    }
}
