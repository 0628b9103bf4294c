//! When a render is done.

use std::time::Duration;

/// A render stops as soon as one of the limits is reached; without any it goes on until interrupted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StopRule {
    /// Passes.
    pub passes: Option<u64>,
    /// Time of rendering, loading not included. The last pass is one that should end in time.
    pub time: Option<Duration>,
}

impl StopRule {
    /// Stops after a number of passes.
    #[must_use]
    pub const fn passes(passes: u64) -> Self {
        Self { passes: Some(passes), time: None }
    }

    /// Stops after a time.
    #[must_use]
    pub const fn time(time: Duration) -> Self {
        Self { passes: None, time: Some(time) }
    }

    /// Whether to stop after `passes` in `elapsed`, given how long another pass would take. There is always one pass.
    pub(crate) fn is_reached(&self, passes: u64, elapsed: Duration, next: Duration) -> bool {
        passes > 0
            && (self.passes.is_some_and(|limit| passes >= limit)
                || self.time.is_some_and(|limit| elapsed + next > limit))
    }

    /// How far the render is, in [0, 1]; `None` without limits.
    #[must_use]
    pub fn fraction(&self, passes: u64, elapsed: Duration) -> Option<f64> {
        let by_passes = self.passes.map(|limit| passes as f64 / limit.max(1) as f64);
        let by_time = self.time.map(|limit| elapsed.as_secs_f64() / limit.as_secs_f64().max(1e-9));
        by_passes.into_iter().chain(by_time).reduce(f64::max).map(|f| f.clamp(0.0, 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_limit_stops_and_a_pass_that_would_end_late_is_not_begun() {
        let s = Duration::from_secs;
        let both = StopRule { passes: Some(10), time: Some(s(60)) };
        assert!(!both.is_reached(9, s(50), s(5)));
        assert!(both.is_reached(10, s(5), s(5)));
        assert!(both.is_reached(3, s(58), s(5)));
        assert!(!both.is_reached(0, s(100), s(5)), "there is always one pass");
        assert!(!StopRule::default().is_reached(1 << 40, s(1 << 30), s(1)));
        assert_eq!(both.fraction(2, s(30)), Some(0.5));
        assert_eq!(StopRule::default().fraction(2, s(30)), None);
    }
}
