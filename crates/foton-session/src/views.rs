//! Renders of one scene through several of its cameras, which share their photons: each pass is traced once and gathered by all.
//!
//! Passes are whole ones: they are not cut at a limit on time, and an interrupt lets the pass under way end first.

use std::sync::Arc;
use std::time::{Duration, Instant};

use foton_integrator::{Cancel, MemoryEstimate, PassReport, Render, RenderSettings, Stage, Step, Variants};
use foton_scene::Scene;
use rayon::ThreadPool;

use crate::clock::{StageClock, StageTimes};
use crate::interrupt::Interrupt;
use crate::panic::{Panic, catch_panic, inject_fault};
use crate::session::{Progress, Session, StartError, StopCause};
use crate::stop::StopRule;

/// Renders under way, one for each camera.
pub struct Views {
    runs: Variants,
    pool: Arc<ThreadPool>,
    stages: StageTimes,
    elapsed: Duration,
    rays: u64,
    panic: Option<Panic>,
    /// Whether all have the same passes: not after a pass was given up.
    is_whole: bool,
}

/// What a step of several renders is of one.
const fn stage_of(step: Step) -> Stage {
    match step {
        Step::Trace | Step::Share => Stage::Trace,
        Step::Of(_, stage) => stage,
    }
}

impl Views {
    /// What they would take in memory; `None` without cameras.
    #[must_use]
    pub fn estimate_memory(
        scene: &Scene,
        settings: &RenderSettings,
        sensors: &[usize],
        threads: Option<usize>,
    ) -> Option<MemoryEstimate> {
        let of = |&sensor| {
            Session::estimate_memory(scene, &RenderSettings { sensor, ..settings.clone() }, threads)
        };
        MemoryEstimate::together(&sensors.iter().map(of).collect::<Vec<_>>())
    }

    /// Collects the hit points of each camera, on `threads` threads. `None` without cameras, or where the method has no photons to
    /// share.
    ///
    /// # Errors
    /// As [`Session::start`].
    pub fn start(
        scene: &Arc<Scene>,
        settings: &RenderSettings,
        sensors: &[usize],
        threads: Option<usize>,
        cancel: &Cancel,
    ) -> Result<Option<Self>, StartError> {
        let (pool, mut stages) = (Session::pool(threads)?, StageTimes::default());
        let begin = Instant::now();
        let runs = {
            let mut clock = StageClock::new(&mut stages);
            let mut watch = |step| {
                clock.begin(stage_of(step));
                inject_fault(settings.seed, stage_of(step), 0);
            };
            let started = catch_panic(|| {
                pool.install(|| Variants::of_sensors(scene, settings, sensors, &mut watch, cancel))
            });
            started.map_err(|message| Panic { stage: clock.stage(), message })??
        };
        let elapsed = begin.elapsed();
        Ok(runs.map(|runs| Self { runs, pool, stages, elapsed, rays: 0, panic: None, is_whole: true }))
    }

    /// Runs passes until `rule` holds for every camera, or `interrupt` says stop. `after_pass` sees each pass of the camera with the
    /// largest error.
    pub fn run(
        &mut self,
        rule: &StopRule,
        interrupt: &Interrupt,
        after_pass: &mut dyn FnMut(&Progress<'_>),
    ) -> StopCause {
        let mut last = Duration::ZERO;
        loop {
            if interrupt.is_requested() && self.runs.runs()[0].passes() > 0 {
                return StopCause::Interrupted;
            }
            let is_done = |render: &Render| {
                rule.is_reached(render.passes(), self.elapsed, last, render.error().as_ref())
            };
            if self.runs.runs().iter().all(is_done) {
                return StopCause::Rule;
            }
            let before = self.elapsed;
            let reports = match self.advance(interrupt.cancel()) {
                Ok(reports) => reports,
                Err(cause) => return cause,
            };
            last = self.elapsed.saturating_sub(before);
            let error = |render: &Render| render.error().map_or(0.0, |error| error.total);
            let shown = self.runs.runs().iter().zip(reports);
            if let Some((render, report)) = shown.max_by(|a, b| error(a.0).total_cmp(&error(b.0))) {
                let (elapsed, rays, stages) = (self.elapsed, self.rays, &self.stages);
                after_pass(&Progress { render, report, elapsed, rays, stages });
            }
        }
    }

    /// One pass of all. After an error they are not to go on.
    fn advance(&mut self, cancel: &Cancel) -> Result<Vec<PassReport>, StopCause> {
        let begin = Instant::now();
        let outcome = {
            let mut clock = StageClock::new(&mut self.stages);
            let (seed, pass) = (self.runs.runs()[0].settings().seed, self.runs.runs()[0].passes() + 1);
            let mut watch = |step| {
                clock.begin(stage_of(step));
                inject_fault(seed, stage_of(step), pass);
            };
            let runs = &mut self.runs;
            let outcome = catch_panic(|| self.pool.install(|| runs.advance(&mut watch, cancel)));
            outcome.map_err(|message| Panic { stage: clock.stage(), message })
        };
        self.elapsed = self.elapsed.saturating_add(begin.elapsed());
        self.is_whole = matches!(outcome, Ok(Ok(_)));
        match outcome {
            Ok(Ok(reports)) => {
                // Photons were traced once, and each report counts their rays.
                self.rays = self.rays.saturating_add(reports.iter().map(|r| r.rays).max().unwrap_or(0));
                Ok(reports)
            }
            Ok(Err(_)) => Err(StopCause::Interrupted),
            Err(panic) => {
                self.panic = Some(panic);
                Err(StopCause::Panicked)
            }
        }
    }

    /// The renders, in the order of their cameras; `None` where a pass was given up, since some may have it and others not.
    #[must_use]
    pub fn renders(&self) -> Option<&[Render]> {
        self.is_whole.then(|| self.runs.runs())
    }

    /// The fault that ended them, if one did.
    #[must_use]
    pub const fn panic(&self) -> Option<&Panic> {
        self.panic.as_ref()
    }

    /// Time of rendering so far.
    #[must_use]
    pub const fn elapsed(&self) -> Duration {
        self.elapsed
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroU32;

    use foton_integrator::PpmSettings;
    use foton_math::Rgb;

    use super::*;
    use crate::test_scene::discs;

    #[test]
    fn they_stop_when_the_last_is_done_and_a_discarded_pass_leaves_nothing_to_write() {
        let photons = NonZeroU32::new(2000).expect("above 0");
        let settings = RenderSettings {
            error: true,
            ppm: PpmSettings { photons_per_pass: photons, first_pass: photons, ..PpmSettings::default() },
            ..RenderSettings::default()
        };
        let (scene, interrupt) = (Arc::new(discs(Some(Rgb::splat(1.0)))), Interrupt::default());
        let started = Views::start(&scene, &settings, &[0, 0], Some(2), interrupt.cancel()).expect("starts");
        let mut views = started.expect("of two cameras");
        let mut seen = 0;
        assert_eq!(views.run(&StopRule::passes(3), &interrupt, &mut |_| seen += 1), StopCause::Rule);
        let passes = |views: &Views| views.renders().map(|all| all.iter().map(Render::passes).collect());
        assert_eq!((seen, passes(&views)), (3, Some(vec![3, 3])));
        assert_eq!(views.run(&StopRule::time(Duration::ZERO), &interrupt, &mut |_| ()), StopCause::Rule);
        interrupt.request();
        assert_eq!(views.run(&StopRule::passes(9), &interrupt, &mut |_| ()), StopCause::Interrupted);
        assert_eq!(passes(&views), Some(vec![3, 3]), "whole passes");
        let cancelled = Cancel::default();
        cancelled.request();
        assert!(views.advance(&cancelled).is_err() && views.renders().is_none());
        let none = Views::start(&scene, &settings, &[], None, &Cancel::default()).expect("not cancelled");
        assert!(none.is_none());
    }
}
