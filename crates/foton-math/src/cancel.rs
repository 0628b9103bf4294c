//! Requests to stop, shared between threads: long loops check them every few thousand steps. Cancelled work is discarded; suspended work
//! goes on later.

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

/// The work was asked to make way; what it had done so far is kept, and the next call goes on with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Suspended;

impl fmt::Display for Suspended {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("suspended")
    }
}

impl Error for Suspended {}

/// Asked by many threads, after every few milliseconds of work, whether that work is to make way. Which parts of the work were
/// done by then changes no result.
pub type ShouldSuspend<'a> = &'a (dyn Fn() -> bool + Sync);

/// A request to stop, shared between threads.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<State>);

#[derive(Debug, Default)]
struct State {
    requested: AtomicBool,
    /// Checks that are left until it requests itself, in tests.
    left: Option<AtomicU64>,
}

impl Cancel {
    /// How many items a loop handles between two checks, where each takes up to a few microseconds.
    pub const EVERY: usize = 4096;

    /// One that requests itself at the check after `checks` others: for tests of where work can be cancelled.
    #[must_use]
    pub fn after(checks: u64) -> Self {
        Self(Arc::new(State { requested: AtomicBool::new(false), left: Some(AtomicU64::new(checks)) }))
    }

    /// Asks the work that holds a clone of this to stop.
    pub fn request(&self) {
        self.0.requested.store(true, Ordering::Relaxed);
    }

    /// Withdraws the request, so that new work can run.
    pub fn rearm(&self) {
        self.0.requested.store(false, Ordering::Relaxed);
    }

    /// Whether a stop was requested.
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
    /// When a stop was requested.
    #[inline]
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.is_requested() { Err(Cancelled) } else { Ok(()) }
    }

    /// As [`Cancel::check`], for the `item`-th item of a loop: checks at one of [`Cancel::EVERY`].
    ///
    /// # Errors
    /// When a stop was requested.
    #[inline]
    pub fn check_at(&self, item: usize) -> Result<(), Cancelled> {
        if item.is_multiple_of(Self::EVERY) { self.check() } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_is_seen_by_all_clones_until_it_is_withdrawn() {
        let cancel = Cancel::default();
        let clone = cancel.clone();
        assert!(clone.check().is_ok());
        cancel.request();
        assert_eq!(clone.check(), Err(Cancelled));
        clone.rearm();
        assert!(!cancel.is_requested());
    }

    #[test]
    fn one_that_requests_itself_does_so_after_that_many_checks_and_stays() {
        let cancel = Cancel::after(2);
        let seen: Vec<bool> = (0..4).map(|_| cancel.is_requested()).collect();
        assert_eq!(seen, [false, false, true, true]);
    }

    #[test]
    fn a_loop_checks_once_in_so_many_items() {
        let cancel = Cancel::after(1);
        let stopped = (0..).find(|&item| cancel.check_at(item).is_err());
        assert_eq!(stopped, Some(Cancel::EVERY));
    }
}
