//! Time that a step took: on the wall, and on all of the process's processors, which other programs do not change much.

use std::time::{Duration, Instant};

use foton_integrator::{Stage, Step};

/// Seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Spent {
    pub(crate) wall: f64,
    /// The wall's where the system does not tell.
    pub(crate) cpu: f64,
}

impl Spent {
    fn add(&mut self, other: Self) {
        self.wall += other.wall;
        self.cpu += other.cpu;
    }
}

/// Time of runs that share their photons.
pub(crate) struct Clock {
    trace: Spent,
    stages: Vec<[Spent; Stage::ALL.len()]>,
    running: Option<(Step, Instant, Duration)>,
}

impl Clock {
    pub(crate) fn new(runs: usize) -> Self {
        Self {
            trace: Spent::default(),
            stages: vec![[Spent::default(); Stage::ALL.len()]; runs],
            running: None,
        }
    }

    /// Ends the step under way and begins another.
    pub(crate) fn begin(&mut self, step: Step) {
        self.pause();
        self.running = Some((step, Instant::now(), processor_time()));
    }

    /// Ends the step under way.
    pub(crate) fn pause(&mut self) {
        let Some((step, wall, before)) = self.running.take() else { return };
        let wall = wall.elapsed().as_secs_f64();
        let cpu = if before.is_zero() { wall } else { processor_time().saturating_sub(before).as_secs_f64() };
        let spent = Spent { wall, cpu };
        match step {
            Step::Trace => self.trace.add(spent),
            Step::Share => {}
            Step::Of(run, stage) => self.stages[run][stage as usize].add(spent),
        }
    }

    /// By stage, what a run would have taken alone.
    pub(crate) fn stages(&self, run: usize) -> [Spent; Stage::ALL.len()] {
        let mut stages = self.stages[run];
        stages[Stage::Trace as usize].add(self.trace);
        stages
    }

    /// What a run would have taken alone.
    pub(crate) fn of(&self, run: usize) -> Spent {
        let mut sum = Spent::default();
        self.stages(run).into_iter().for_each(|spent| sum.add(spent));
        sum
    }
}

/// Processor time of all threads of this process; zero where the system does not tell.
#[cfg(unix)]
#[must_use]
pub fn processor_time() -> Duration {
    use nix::time::{ClockId, clock_gettime};
    clock_gettime(ClockId::CLOCK_PROCESS_CPUTIME_ID).map_or(Duration::ZERO, Duration::from)
}

/// Processor time of all threads of this process; zero where the system does not tell.
#[cfg(not(unix))]
#[must_use]
pub fn processor_time() -> Duration {
    Duration::ZERO
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tracing_counts_for_each_run_and_sharing_for_none() {
        let mut clock = Clock::new(2);
        let work = || std::hint::black_box((0..200_000u64).fold(0u64, |a, b| a.wrapping_mul(31) ^ b));
        for step in [Step::Trace, Step::Of(0, Stage::Gather), Step::Share] {
            clock.begin(step);
            work();
        }
        clock.pause();
        let (first, second) = (clock.of(0), clock.of(1));
        let traced = clock.stages(1)[Stage::Trace as usize];
        assert!(second.wall > 0.0 && second == traced && first.wall > second.wall);
        assert_eq!(clock.stages(0)[Stage::Trace as usize], traced);
    }
}
