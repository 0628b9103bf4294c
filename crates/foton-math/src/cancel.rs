//! A request to stop, shared between threads: what takes long asks for it every few thousand steps.

use std::error::Error;
use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// The work was asked to stop; what it had done so far was discarded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cancelled;

impl fmt::Display for Cancelled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("cancelled")
    }
}

impl Error for Cancelled {}

/// A request to stop, shared between threads.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<State>);

#[derive(Debug, Default)]
struct State {
    requested: AtomicBool,
    /// Questions until it counts as requested, where it is to come by itself.
    left: Option<AtomicU64>,
}

impl Cancel {
    /// How many items a loop goes through between two questions, where each takes up to some microseconds.
    pub const EVERY: usize = 4096;

    /// One that comes by itself with the question after `questions` of them: for tests of what can be cancelled where.
    #[must_use]
    pub fn after(questions: u64) -> Self {
        Self(Arc::new(State { requested: AtomicBool::new(false), left: Some(AtomicU64::new(questions)) }))
    }

    /// Asks the work that holds a clone of this to stop.
    pub fn request(&self) {
        self.0.requested.store(true, Ordering::Relaxed);
    }

    /// Takes the request back: what comes next is to run.
    pub fn rearm(&self) {
        self.0.requested.store(false, Ordering::Relaxed);
    }

    /// Whether a stop was asked for.
    #[must_use]
    #[inline]
    pub fn is_requested(&self) -> bool {
        if let Some(left) = &self.0.left
            && left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |n| n.checked_sub(1)).is_err()
        {
            self.request();
        }
        self.0.requested.load(Ordering::Relaxed)
    }

    /// # Errors
    /// When a stop was asked for.
    #[inline]
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.is_requested() { Err(Cancelled) } else { Ok(()) }
    }

    /// As [`Cancel::check`], for the item of that number in a loop: asks for one in [`Cancel::EVERY`] of them.
    ///
    /// # Errors
    /// When a stop was asked for.
    #[inline]
    pub fn check_at(&self, item: usize) -> Result<(), Cancelled> {
        if item.is_multiple_of(Self::EVERY) { self.check() } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_is_seen_by_all_clones_until_it_is_taken_back() {
        let cancel = Cancel::default();
        let clone = cancel.clone();
        assert!(clone.check().is_ok());
        cancel.request();
        assert_eq!(clone.check(), Err(Cancelled));
        clone.rearm();
        assert!(!cancel.is_requested());
    }

    #[test]
    fn one_that_comes_by_itself_comes_after_so_many_questions_and_stays() {
        let cancel = Cancel::after(2);
        let asked: Vec<bool> = (0..4).map(|_| cancel.is_requested()).collect();
        assert_eq!(asked, [false, false, true, true]);
    }

    #[test]
    fn a_loop_asks_once_in_so_many_items() {
        let cancel = Cancel::after(1);
        let stopped = (0..).find(|&item| cancel.check_at(item).is_err());
        assert_eq!(stopped, Some(Cancel::EVERY));
    }
}
