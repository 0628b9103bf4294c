//! A render on a pool of threads of its own, pass after pass until a rule or a person stops it.

use std::sync::Arc;
use std::time::{Duration, Instant};

use foton_integrator::{
    Cancel, Cancelled, Halt, KeptMaps, MemoryEstimate, NotFinite, PassReport, Render, RenderSettings,
    ShouldSuspend, Stage, StateError, Suspended,
};
use foton_scene::Scene;
use rayon::ThreadPool;
use thiserror::Error;

use crate::clock::{StageClock, StageTimes};
use crate::interrupt::Interrupt;
use crate::panic::{Panic, catch_panic, inject_fault};
use crate::stop::StopRule;
use crate::threads::{self, NoThreads, Rank};

/// Why a render did not start.
#[derive(Debug, Error)]
pub enum StartError {
    /// Someone asked to stop before the eye pass was done.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// No threads could be made.
    #[error("cannot make render threads: {0}")]
    Threads(#[from] NoThreads),
    /// A fault of our own.
    #[error(transparent)]
    Panicked(#[from] Panic),
}

/// Why a pass is not finished.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PassError {
    /// Someone asked to stop inside it.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// It made way; the next one goes on with it.
    #[error(transparent)]
    Suspended(#[from] Suspended),
    /// A fault of our own; no other pass can follow.
    #[error(transparent)]
    Panicked(#[from] Panic),
    /// A value is not finite where the render is to stop at the first of those; no other pass can follow.
    #[error(transparent)]
    NotFinite(#[from] Box<NotFinite>),
}

impl From<Halt> for PassError {
    fn from(halt: Halt) -> Self {
        match halt {
            Halt::Cancelled(cause) => cause.into(),
            Halt::Suspended(cause) => cause.into(),
            Halt::NotFinite(place) => place.into(),
        }
    }
}

/// Why a render stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopCause {
    /// A limit of the stop rule.
    Rule,
    /// A person.
    Interrupted,
    /// A fault of our own: see [`Session::panic`].
    Panicked,
    /// A value that is not finite: see [`Session::not_finite`].
    NotFinite,
}

/// How a render stands after a pass.
pub struct Progress<'a> {
    /// The render.
    pub render: &'a Render,
    /// The pass.
    pub report: PassReport,
    /// Time of rendering so far, eye pass included, loading and what callers did after passes not.
    pub elapsed: Duration,
    /// Rays of all passes so far.
    pub rays: u64,
    /// Time by stage so far.
    pub stages: &'a StageTimes,
}

/// A render under way.
pub struct Session {
    render: Render,
    pool: Arc<ThreadPool>,
    stages: StageTimes,
    elapsed: Duration,
    rays: u64,
    panic: Option<Panic>,
    not_finite: Option<Box<NotFinite>>,
}

impl Session {
    /// What a render would take in memory on `threads` threads, by default as many as the machine has.
    #[must_use]
    pub fn estimate_memory(
        scene: &Scene,
        settings: &RenderSettings,
        threads: Option<usize>,
    ) -> MemoryEstimate {
        Render::estimate_memory(scene, settings, threads::count(threads))
    }

    /// Collects hit points on `threads` threads, by default as many as the machine has.
    ///
    /// # Errors
    /// When cancelled, when the system gives no threads, or by a fault of our own.
    pub fn start(
        scene: Arc<Scene>,
        settings: RenderSettings,
        threads: Option<usize>,
        cancel: &Cancel,
    ) -> Result<Self, StartError> {
        Self::start_on(Self::pool(threads)?, scene, settings, &|_| (), cancel)
    }

    /// As [`Session::start`], with photon maps that were made before.
    ///
    /// # Errors
    /// As [`Session::start`].
    pub fn start_with_maps(
        scene: Arc<Scene>,
        settings: RenderSettings,
        maps: &KeptMaps,
        threads: Option<usize>,
        cancel: &Cancel,
    ) -> Result<Self, StartError> {
        Self::start_by(Self::pool(threads)?, settings.seed, Duration::ZERO, |watch| {
            Render::start_with_maps(scene, settings, maps, watch, cancel)
        })
    }

    /// Threads to render on, by default as many as the machine has; one pool serves any number of renders, one at a time.
    ///
    /// # Errors
    /// When the system gives no threads.
    pub fn pool(threads: Option<usize>) -> Result<Arc<ThreadPool>, NoThreads> {
        threads::pool(threads, Rank::Equal)
    }

    /// Collects hit points on the threads of `pool`, which tell what share of the eye samples is followed.
    pub(crate) fn start_on(
        pool: Arc<ThreadPool>,
        scene: Arc<Scene>,
        settings: RenderSettings,
        tell: &(dyn Fn(f64) + Sync),
        cancel: &Cancel,
    ) -> Result<Self, StartError> {
        Self::start_by(pool, settings.seed, Duration::ZERO, |watch| {
            Render::start_telling(scene, settings, tell, watch, cancel)
        })
    }

    /// Starts a render on the threads of `pool`, by eye samples of which some took `followed` before. `seed` chooses a fault for tests.
    pub(crate) fn start_by(
        pool: Arc<ThreadPool>,
        seed: u64,
        followed: Duration,
        start: impl FnOnce(&mut dyn FnMut(Stage)) -> Result<Render, Cancelled> + Send,
    ) -> Result<Self, StartError> {
        let mut stages = StageTimes::default();
        stages.add(Stage::EyePass, followed);
        let begin = Instant::now();
        let render = {
            let mut clock = StageClock::new(&mut stages);
            let mut watch = |stage| {
                clock.begin(stage);
                inject_fault(seed, stage, 0);
            };
            let started = catch_panic(|| pool.install(|| start(&mut watch)));
            started.map_err(|message| Panic { stage: clock.stage(), message })??
        };
        let elapsed = followed.saturating_add(begin.elapsed());
        Ok(Self { render, pool, stages, elapsed, rays: 0, panic: None, not_finite: None })
    }

    /// Runs passes until `rule` or `interrupt` says stop. `after_pass` sees each pass, and its time is not counted. It cannot
    /// end the run: a file that it fails to write is no reason to lose the passes.
    pub fn run(
        &mut self,
        rule: &StopRule,
        interrupt: &Interrupt,
        after_pass: &mut dyn FnMut(&Progress<'_>),
    ) -> StopCause {
        let mut last = None;
        loop {
            let passes = self.render.passes();
            if interrupt.is_requested() && passes > 0 {
                return StopCause::Interrupted;
            }
            let is_reached = |session: &Self, next| {
                rule.is_reached(passes, session.elapsed, next, session.render.error().as_ref())
            };
            if is_reached(self, Duration::ZERO) {
                return StopCause::Rule;
            }
            let next = self.plan_for(rule.time, last);
            if is_reached(self, next) {
                return StopCause::Rule;
            }
            let before = self.elapsed;
            let report = match self.advance_in_time(rule.time, interrupt) {
                Ok(Some(report)) => report,
                Ok(None) => return StopCause::Rule,
                Err(PassError::Cancelled(_) | PassError::Suspended(_)) => return StopCause::Interrupted,
                Err(PassError::Panicked(_)) => return StopCause::Panicked,
                Err(PassError::NotFinite(_)) => return StopCause::NotFinite,
            };
            last = Some((self.elapsed.saturating_sub(before), report.photons_in_pass));
            after_pass(&Progress {
                render: &self.render,
                report,
                elapsed: self.elapsed,
                rays: self.rays,
                stages: &self.stages,
            });
        }
    }

    /// Runs one pass.
    ///
    /// # Errors
    /// When cancelled, by a fault of our own, or at a value that is not finite if it is to stop there; the pass then has not happened.
    pub fn advance(&mut self, cancel: &Cancel) -> Result<PassReport, PassError> {
        self.advance_unless(&|| false, cancel)
    }

    /// Runs one pass, or what is left of one that was suspended: see [`Render::advance_unless`].
    ///
    /// # Errors
    /// As [`Session::advance`], and when suspended.
    pub fn advance_unless(
        &mut self,
        should_suspend: ShouldSuspend<'_>,
        cancel: &Cancel,
    ) -> Result<PassReport, PassError> {
        if let Some(panic) = &self.panic {
            return Err(panic.clone().into());
        }
        if let Some(place) = &self.not_finite {
            return Err(place.clone().into());
        }
        let begin = Instant::now();
        let report = {
            let mut clock = StageClock::new(&mut self.stages);
            let render = &mut self.render;
            let (seed, pass) = (render.settings().seed, render.passes() + 1);
            let mut watch = |stage| {
                clock.begin(stage);
                inject_fault(seed, stage, pass);
            };
            let outcome = catch_panic(|| {
                self.pool.install(|| render.advance_unless(should_suspend, &mut watch, cancel))
            });
            outcome.map_err(|message| Panic { stage: clock.stage(), message })
        };
        self.elapsed = self.elapsed.saturating_add(begin.elapsed());
        let report = report.inspect_err(|panic| self.panic = Some(panic.clone()))?;
        if let Err(Halt::NotFinite(place)) = &report {
            self.not_finite = Some(place.clone());
        }
        let report = report?;
        self.rays = self.rays.saturating_add(report.rays);
        Ok(report)
    }

    /// Finishes a suspended pass that has refined hit points, so that the render can be saved. No photon is traced for that.
    ///
    /// # Errors
    /// As [`Session::advance`].
    pub fn settle(&mut self) -> Result<(), PassError> {
        if self.render.has_refined() { self.advance(&Cancel::default()).map(|_| ()) } else { Ok(()) }
    }

    /// The fault that ended the render, if one did. What the image is then worth, [`Panic::leaves_the_image_whole`] says.
    #[must_use]
    pub const fn panic(&self) -> Option<&Panic> {
        self.panic.as_ref()
    }

    /// Where the render stopped because a value was not finite, if it did. The image is that of the passes before.
    #[must_use]
    pub fn not_finite(&self) -> Option<&NotFinite> {
        self.not_finite.as_deref()
    }

    /// Takes a render's state back, with the time and rays that it took.
    pub(crate) fn restore(&mut self, state: &[u8], elapsed: Duration, rays: u64) -> Result<(), StateError> {
        self.render.restore(state)?;
        self.elapsed = elapsed;
        self.rays = rays;
        Ok(())
    }

    /// Does something on the threads of the render.
    pub(crate) fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.pool.install(work)
    }

    /// The render.
    #[must_use]
    pub const fn render(&self) -> &Render {
        &self.render
    }

    /// The render, to change its settings between runs.
    pub const fn render_mut(&mut self) -> &mut Render {
        &mut self.render
    }

    /// Time by stage so far.
    #[must_use]
    pub const fn stages(&self) -> &StageTimes {
        &self.stages
    }

    /// Rays of all passes so far.
    #[must_use]
    pub const fn rays(&self) -> u64 {
        self.rays
    }

    /// Time of rendering so far.
    #[must_use]
    pub const fn elapsed(&self) -> Duration {
        self.elapsed
    }
}
