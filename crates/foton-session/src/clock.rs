//! How long each stage took.

use std::time::{Duration, Instant};

use foton_integrator::Stage;

/// Time spent in each stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StageTimes([Duration; Stage::ALL.len()]);

impl StageTimes {
    /// Time spent in a stage.
    #[must_use]
    pub fn of(&self, stage: Stage) -> Duration {
        self.0[stage as usize]
    }

    /// Adds time to a stage.
    pub(crate) fn add(&mut self, stage: Stage, time: Duration) {
        self.0[stage as usize] += time;
    }

    /// Each stage with its time, in order.
    pub fn iter(&self) -> impl Iterator<Item = (Stage, Duration)> {
        Stage::ALL.into_iter().zip(self.0)
    }
}

/// Measures stages as they are announced.
pub(crate) struct StageClock<'a> {
    times: &'a mut StageTimes,
    running: Option<(Stage, Instant)>,
}

impl<'a> StageClock<'a> {
    pub(crate) const fn new(times: &'a mut StageTimes) -> Self {
        Self { times, running: None }
    }

    /// Ends the running stage and begins another.
    pub(crate) fn begin(&mut self, stage: Stage) {
        self.end();
        self.running = Some((stage, Instant::now()));
    }

    /// The stage that was begun last.
    pub(crate) const fn stage(&self) -> Option<Stage> {
        match self.running {
            Some((stage, _)) => Some(stage),
            None => None,
        }
    }

    fn end(&mut self) {
        if let Some((stage, since)) = self.running.take() {
            self.times.0[stage as usize] += since.elapsed();
        }
    }
}

impl Drop for StageClock<'_> {
    fn drop(&mut self) {
        self.end();
    }
}
