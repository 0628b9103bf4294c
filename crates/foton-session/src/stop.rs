//! When a render is done.

use std::time::Duration;

use foton_integrator::ErrorEstimate;

/// The error is believed once so far has been worth as many equal passes: of fewer, the scatter is not known.
const ENOUGH_PASSES: f64 = 8.0;

/// The error is believed while at most this share of the pixels has found no light at all.
const MAX_UNKNOWN: f64 = 0.05;

/// A render stops as soon as one of the limits is reached; without any it goes on until interrupted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StopRule {
    /// Passes.
    pub passes: Option<u64>,
    /// Time of rendering, loading not included. The last pass is one that should end in time.
    pub time: Option<Duration>,
    /// Relative error that the image is certainly below, as far as [`ErrorEstimate`] goes: its upper end counts. A render that
    /// has found too few photons to tell does not stop, nor one whose error is not estimated.
    pub error: Option<f64>,
}

impl StopRule {
    /// Stops after a number of passes.
    #[must_use]
    pub const fn passes(passes: u64) -> Self {
        Self { passes: Some(passes), time: None, error: None }
    }

    /// Stops after a time.
    #[must_use]
    pub const fn time(time: Duration) -> Self {
        Self { passes: None, time: Some(time), error: None }
    }

    /// Whether to stop after `passes` in `elapsed`, given how long another pass would take. There is always one pass.
    #[must_use]
    pub fn is_reached(
        &self,
        passes: u64,
        elapsed: Duration,
        next: Duration,
        error: Option<&ErrorEstimate>,
    ) -> bool {
        passes > 0
            && (self.passes.is_some_and(|limit| passes >= limit)
                || self.time.is_some_and(|limit| elapsed.saturating_add(next) > limit)
                || self.error.is_some_and(|limit| error.is_some_and(|e| is_certainly_below(e, limit))))
    }

    /// How far the render is, in [0, 1]; `None` without limits.
    #[must_use]
    pub fn fraction(&self, passes: u64, elapsed: Duration, error: Option<&ErrorEstimate>) -> Option<f64> {
        let by_passes = self.passes.map(|limit| passes as f64 / limit.max(1) as f64);
        let by_time = self.time.map(|limit| elapsed.as_secs_f64() / limit.as_secs_f64().max(1e-9));
        // At best errors fall with the cube root of the photons.
        let by_error = self.error.map(|limit| error.map_or(0.0, |e| (limit / e.high.max(limit)).powi(3)));
        by_passes.into_iter().chain(by_time).chain(by_error).reduce(f64::max).map(|f| f.clamp(0.0, 1.0))
    }
}

fn is_certainly_below(error: &ErrorEstimate, limit: f64) -> bool {
    error.high <= limit && error.effective_passes >= ENOUGH_PASSES && error.unknown_share <= MAX_UNKNOWN
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_limit_stops_and_a_pass_that_would_end_late_is_not_begun() {
        let s = Duration::from_secs;
        let both = StopRule { passes: Some(10), time: Some(s(60)), error: None };
        assert!(!both.is_reached(9, s(50), s(5), None));
        assert!(both.is_reached(10, s(5), s(5), None));
        assert!(both.is_reached(3, s(58), s(5), None));
        assert!(!both.is_reached(0, s(100), s(5), None), "there is always one pass");
        assert!(!StopRule::default().is_reached(1 << 40, s(1 << 30), s(1), None));
        assert_eq!(both.fraction(2, s(30), None), Some(0.5));
        assert_eq!(StopRule::default().fraction(2, s(30), None), None);
    }

    #[test]
    fn an_error_stops_only_when_it_is_certain() {
        let rule = StopRule { error: Some(0.02), ..StopRule::default() };
        let good = ErrorEstimate {
            total: 0.015,
            noise: 0.013,
            bias: 0.007,
            low: 0.012,
            high: 0.019,
            focus: 0.0,
            unknown_share: 0.01,
            effective_passes: 20.0,
            mean_luminance: 1.0,
            classes: None,
        };
        let stops = |error: Option<&ErrorEstimate>| {
            rule.is_reached(30, Duration::from_secs(9), Duration::ZERO, error)
        };
        assert!(stops(Some(&good)) && !stops(None));
        assert!(!stops(Some(&ErrorEstimate { high: 0.021, ..good })), "the upper end counts");
        assert!(!stops(Some(&ErrorEstimate { effective_passes: 4.0, ..good })), "too few passes to tell");
        assert!(!stops(Some(&ErrorEstimate { unknown_share: 0.3, ..good })), "unknown is not dark");
        let doubled = ErrorEstimate { high: 0.04, ..good };
        let share = rule.fraction(1, Duration::ZERO, Some(&doubled)).expect("a limit");
        assert!((share - 0.125).abs() < 1e-12);
    }
}
