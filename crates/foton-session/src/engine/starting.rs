//! The whole render while its hit points are collected: on a thread of its own, so that the engine goes on answering.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

use crossbeam_channel::{Receiver, bounded};
use foton_integrator::Cancel;

use super::render::LevelRender;
use crate::panic::catch_panic;

/// A render that starts, `None` where that was cancelled, or why it cannot.
pub(super) type Started = Result<Option<Box<LevelRender>>, String>;

/// A render that is being started; dropped it is given up.
pub(super) struct Starting {
    pub(super) result: Receiver<Started>,
    share: Arc<AtomicU64>,
    cancel: Cancel,
}

impl Drop for Starting {
    fn drop(&mut self) {
        self.cancel.request();
    }
}

impl Starting {
    /// Begins `work`, of which a share is done; it tells how far it is.
    pub(super) fn begin(
        share: f64,
        work: impl FnOnce(&(dyn Fn(f64) + Sync), &Cancel) -> Started + Send + 'static,
    ) -> Self {
        let (sender, result) = bounded(1);
        let (share, cancel) = (Arc::new(AtomicU64::new(share.to_bits())), Cancel::default());
        let (told, asked, refusal) = (Arc::clone(&share), cancel.clone(), sender.clone());
        let run = move || {
            let tell = |share: f64| {
                // Shares are told by many threads in any order; those of positive numbers are ordered as their bits are.
                told.fetch_max(share.to_bits(), Ordering::Relaxed);
            };
            let started = catch_panic(|| work(&tell, &asked)).unwrap_or_else(Err);
            // Nobody listens any more once it was given up.
            let _ = sender.send(started);
        };
        if let Err(error) = thread::Builder::new().name("collect".to_owned()).spawn(run) {
            let _ = refusal.send(Err(format!("cannot make a thread: {error}")));
        }
        Self { result, share, cancel }
    }

    /// The share of the eye samples that have been followed.
    pub(super) fn share(&self) -> f64 {
        f64::from_bits(self.share.load(Ordering::Relaxed))
    }
}
