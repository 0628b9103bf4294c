//! Sweeps: what accuracy costs in a scene, over α, photons a pass, first radii, the rule by which they shrink, and direct light.
//!
//! A star around one configuration, and the plane of α and photons a pass. Runs that emit the same photons share them
//! (`foton_integrator::Variants`). All see the same eye samples; seeds differ in their photons. Everything lies in a folder: a
//! sweep that is started again resumes after what is finished, and its tables and page are made from what is there. Not here: reading
//! scenes, threads, arguments.

mod clock;
mod error;
mod judge;
mod masks;
mod page;
mod plan;
pub mod reference;
mod run;
mod store;
mod table;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use foton_film::Image;
use foton_integrator::{Cancel, Cancelled, MemoryEstimate, Render, RenderSettings};
use foton_scene::Scene;

pub use clock::processor_time;
pub use error::SweepError;
pub use masks::Masks;
pub use plan::Configuration;
pub use store::files_in;

use plan::{Job, count};
use reference::Reference;
use run::{Runner, Unfinished};
use store::Store;
use table::Point;

/// Share of the time that a reference of its own takes.
const REFERENCE_SHARE: f64 = 0.3;
/// The first job, which has the star's arms, gets as much time as this many others.
const FIRST_WEIGHT: f64 = 3.0;
/// A job is left out if the centre has emitted less than this many of its passes in the time there was.
const MIN_PASSES: u64 = 4;

/// What to sweep.
pub struct Sweep {
    /// The scene.
    pub scene: Arc<Scene>,
    /// Its name, for headings.
    pub name: String,
    /// What the scene was read from, as a hash.
    pub hash: u64,
    /// The centre of the star; its seed is that of the eye samples, and of the reference.
    pub centre: RenderSettings,
    /// Runs of each configuration, at least 2.
    pub seeds: u64,
    /// Time for all of it, on the wall.
    pub budget: Duration,
    /// An image to compare with, and what it is; without one, a run of its own.
    pub given: Option<(Image, String)>,
    /// Where results go; made if it is not there.
    pub folder: PathBuf,
}

/// How a sweep goes.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// Where it stands: what is done, and how much of the time is gone.
    Progress {
        /// In words.
        what: String,
        /// From 0 to 1.
        fraction: f64,
    },
    /// The reference is there.
    Reference {
        /// What it is.
        origin: String,
        /// Its own noise over the mean reflected light; zero where it is not known.
        noise: f64,
        /// Share of the seen pixels that are smooth.
        smooth_share: f64,
    },
    /// All runs of some photons a pass are done.
    Job {
        /// Photons a pass.
        photons: u32,
        /// Configurations that ran.
        configurations: usize,
        /// Passes of each.
        passes: u64,
        /// Least error among them.
        least_error: f64,
        /// Whether it was found finished.
        is_old: bool,
    },
    /// Something to know.
    Note(String),
}

impl Event {
    fn of_job(job: &Job, found: &[Point], is_old: bool) -> Self {
        Self::Job {
            photons: job.photons.get(),
            configurations: job.configurations.len(),
            passes: found.iter().map(|p| p.pass).max().unwrap_or(0),
            least_error: found.iter().map(|p| p.error).fold(f64::INFINITY, f64::min),
            is_old,
        }
    }
}

/// What a sweep has made.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Page and tables.
    pub outputs: Vec<PathBuf>,
    /// What to take, in a sentence; `None` where nothing ran.
    pub recommendation: Option<String>,
    /// Jobs that ran now or before, of all.
    pub jobs: (usize, usize),
}

impl Sweep {
    /// What the largest job takes on so many threads: its runs stand side by side.
    #[must_use]
    pub fn memory(&self, threads: usize) -> Option<MemoryEstimate> {
        let estimate = |settings: &RenderSettings| Render::estimate_memory(&self.scene, settings, threads);
        let of_job = |job: &Job| {
            let runs: Vec<MemoryEstimate> = job.settings(&self.centre).iter().map(estimate).collect();
            MemoryEstimate::together(&runs)
        };
        let jobs = plan::jobs(&Configuration::of(&self.centre));
        jobs.iter().filter_map(of_job).max_by(|a, b| a.peak_bytes().total_cmp(&b.peak_bytes()))
    }

    /// Runs what is not finished yet, as far as the time goes, and writes tables and page. Meant for a pool of threads.
    ///
    /// # Errors
    /// See [`SweepError`].
    pub fn run(
        &self,
        is_stopped: &dyn Fn() -> bool,
        cancel: &Cancel,
        tell: &mut dyn FnMut(&Event),
    ) -> Result<Outcome, SweepError> {
        let begin = Instant::now();
        let eye = Render::start(Arc::clone(&self.scene), self.centre.clone(), &mut |_| (), cancel)?;
        // Before the folder is taken.
        if let Some((image, _)) = &self.given {
            crate::Pair::new(&eye.image(), image)?;
        }
        let store = Store::open(&self.folder, &self.identity())?;
        let centre = Configuration::of(&self.centre);
        let jobs = plan::jobs(&centre);
        let reference = self.reference(&eye, &store, begin, is_stopped, cancel, tell)?;
        tell(&Event::Reference {
            origin: reference.origin.clone(),
            noise: reference.noise(),
            smooth_share: reference.masks.smooth_share(),
        });
        let runner = Runner {
            scene: &self.scene,
            base: &self.centre,
            reference: &reference,
            seeds: self.seeds,
            cancel,
            is_stopped,
        };
        let mut points: Vec<Vec<Point>> = Vec::new();
        let mut skipped = Vec::new();
        for (i, job) in jobs.iter().enumerate() {
            let left = self.budget.saturating_sub(begin.elapsed());
            let (found, is_old) = if let Some(points) = store.points(job)? {
                (points, true)
            } else if is_too_large(job, points.first()) {
                skipped.push(count(job.photons.get().into()));
                continue;
            } else if (i > 0 && left.is_zero()) || is_stopped() {
                continue;
            } else {
                let todo: f64 = jobs[i..].iter().map(|job| weight(job, &centre)).sum();
                let time = left.mul_f64(weight(job, &centre) / todo);
                let Some(points) = self.run_job(&runner, &store, job, (time, begin), tell)? else { break };
                (points, false)
            };
            tell(&Event::of_job(job, &found, is_old));
            points.push(found);
        }
        if !skipped.is_empty() {
            tell(&Event::Note(format!(
                "left out passes of {} photons: too few of them fit into the time",
                skipped.join(", ")
            )));
        }
        self.conclude(&store, &reference, &points, jobs.len())
    }

    fn run_job(
        &self,
        runner: &Runner<'_>,
        store: &Store,
        job: &Job,
        (time, begin): (Duration, Instant),
        tell: &mut dyn FnMut(&Event),
    ) -> Result<Option<Vec<Point>>, SweepError> {
        let centre = Configuration::of(&self.centre);
        let mut told = |seed: u64, pass: u64| {
            let what = format!(
                "{} photons a pass, seed {} of {}, pass {pass}",
                count(job.photons.get().into()),
                seed + 1,
                self.seeds
            );
            tell(&Event::Progress { what, fraction: self.gone(begin) });
        };
        let finished = match runner.run(job, &centre, time, &mut told) {
            Ok(finished) => finished,
            Err(Unfinished::Stopped) => return Ok(None),
            Err(Unfinished::Compare(cause)) => return Err(cause.into()),
        };
        let points: Vec<Point> = finished.gathered.iter().filter_map(Point::of).collect();
        let pictures = store.pictures(&finished.pictures, &runner.reference.image);
        // Numbers are worth having without pictures.
        store.finish(job, &table::runs(&finished), &points)?;
        pictures?;
        // As written, so that the page says the same when it is made from the tables alone.
        store.points(job)
    }

    fn conclude(
        &self,
        store: &Store,
        reference: &Reference,
        points: &[Vec<Point>],
        jobs: usize,
    ) -> Result<Outcome, SweepError> {
        let all: Vec<Point> = points.concat();
        let centre = Configuration::of(&self.centre);
        let mut outputs = store.tables(&plan::jobs(&centre))?;
        let report = page::Report {
            name: &self.name,
            identity: &self.identity(),
            centre,
            reference,
            points: &all,
            pictures: &store.read_pictures()?,
        };
        let page = store.page(&report.html())?;
        outputs.insert(0, page);
        let recommendation = page::advice::recommend(&self.name, &centre, &all).map(|advice| advice.sentence);
        Ok(Outcome { outputs, recommendation, jobs: (points.len(), jobs) })
    }

    /// The reference: that of the folder, the one given, or a new run.
    fn reference(
        &self,
        eye: &Render,
        store: &Store,
        begin: Instant,
        is_stopped: &dyn Fn() -> bool,
        cancel: &Cancel,
        tell: &mut dyn FnMut(&Event),
    ) -> Result<Reference, SweepError> {
        if let Some((image, origin)) = &self.given {
            let reference = Reference::new(eye, image.clone(), None, (None, None), origin.clone());
            return reference.ok_or(SweepError::Dark);
        }
        if let Some(found) = store.reference(eye)? {
            return Ok(found);
        }
        let time = self.budget.mul_f64(REFERENCE_SHARE);
        let mut is_enough = || {
            tell(&Event::Progress { what: "the reference".to_owned(), fraction: self.gone(begin) });
            begin.elapsed() >= time
        };
        let is_cancelled = || if is_stopped() { Err(Cancelled) } else { Ok(()) };
        let reference =
            Reference::render(&self.scene, &self.centre, time, &mut is_enough, &is_cancelled, cancel)?;
        let reference = reference.ok_or(SweepError::Dark)?;
        store.write_reference(&reference)?;
        store.reference(eye)?.ok_or(SweepError::Dark)
    }

    /// The share of the time that is gone.
    fn gone(&self, begin: Instant) -> f64 {
        (begin.elapsed().as_secs_f64() / self.budget.as_secs_f64().max(1e-9)).min(1.0)
    }

    /// All that must be the same for results to belong together.
    fn identity(&self) -> String {
        let s = &self.centre;
        let sensor = &self.scene.sensors()[s.sensor];
        let reference = self.given.as_ref().map_or("its own, of two radii", |(_, origin)| origin);
        format!(
            "{} {:016x}, {} × {} pixels of \"{}\", {} eye samples, seed {}, depth {}, first radius {}, {} seeds, centre {}, reference {reference}, \
             foton {}",
            self.name,
            self.hash,
            sensor.width,
            sensor.height,
            sensor.name,
            s.samples_per_pixel,
            s.seed,
            s.max_depth_in(&self.scene),
            s.ppm.radius.map_or("by footprint".to_owned(), |r| r.to_string()),
            self.seeds,
            Configuration::of(s),
            env!("CARGO_PKG_VERSION"),
        )
    }
}

fn weight(job: &Job, centre: &Configuration) -> f64 {
    if job.configurations.contains(centre) { FIRST_WEIGHT } else { 1.0 }
}

/// Whether passes are so large that a handful of them is more than the centre emitted in its longer time.
fn is_too_large(job: &Job, first: Option<&Vec<Point>>) -> bool {
    let emitted = first.and_then(|points| points.iter().map(|p| p.photons).max());
    emitted.is_some_and(|emitted| u64::from(job.photons.get()) * MIN_PASSES > emitted)
}
