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
mod tests;
