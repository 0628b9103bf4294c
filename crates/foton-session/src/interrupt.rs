//! A person's wish to stop, from another thread or a signal handler.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use foton_integrator::Cancel;

/// Asked once, the batch of photons under way is finished, with it the pass, and the render stops. Asked again, the pass is discarded. Before there are passes
/// there is nothing to finish, and asking once is enough.
#[derive(Clone, Debug, Default)]
pub struct Interrupt {
    finish: Arc<AtomicBool>,
    /// Whether the scene is still being read, built or looked at.
    loading: Arc<AtomicBool>,
    /// Whether the program may end at once, since there is nothing to lose.
    disposable: Arc<AtomicBool>,
    cancel: Cancel,
}

impl Interrupt {
    /// For a scene that is still to be read: asked once, whatever goes on is given up, until [`Interrupt::begin_passes`].
    #[must_use]
    pub fn while_loading() -> Self {
        let yes = || Arc::new(AtomicBool::new(true));
        Self { loading: yes(), disposable: yes(), ..Self::default() }
    }

    /// From here on a pass can be finished.
    pub fn begin_passes(&self) {
        self.loading.store(false, Ordering::SeqCst);
        self.begin_work();
    }

    /// From here on there is something to lose: the program may not end before what it does has heard of the request.
    pub fn begin_work(&self) {
        self.disposable.store(false, Ordering::SeqCst);
    }

    /// Whether the program may end at once: someone asked, and there is nothing to lose.
    #[must_use]
    pub fn may_end_at_once(&self) -> bool {
        self.is_requested() && self.disposable.load(Ordering::SeqCst)
    }

    /// Whether someone asked, and the pass under way is being finished for it.
    #[must_use]
    pub fn finishes_a_pass(&self) -> bool {
        self.is_requested() && !self.cancel.is_requested()
    }

    /// Asks.
    pub fn request(&self) {
        if self.finish.swap(true, Ordering::SeqCst) || self.loading.load(Ordering::SeqCst) {
            self.cancel.request();
        }
    }

    /// Whether anyone has asked.
    #[must_use]
    pub fn is_requested(&self) -> bool {
        self.finish.load(Ordering::Relaxed)
    }

    /// What gives up loading, and discards the pass under way.
    #[must_use]
    pub const fn cancel(&self) -> &Cancel {
        &self.cancel
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_request_gives_up_loading_and_finishes_a_pass_two_discard_it() {
        let interrupt = Interrupt::while_loading();
        interrupt.request();
        assert!(interrupt.cancel().is_requested() && interrupt.may_end_at_once());
        let interrupt = Interrupt::while_loading();
        interrupt.begin_work();
        interrupt.request();
        assert!(interrupt.cancel().is_requested() && !interrupt.may_end_at_once());
        let interrupt = Interrupt::while_loading();
        interrupt.begin_passes();
        interrupt.request();
        assert!(!interrupt.may_end_at_once());
        assert!(interrupt.is_requested() && !interrupt.cancel().is_requested());
        assert!(interrupt.finishes_a_pass());
        interrupt.request();
        assert!(interrupt.cancel().is_requested() && !interrupt.finishes_a_pass());
    }
}
