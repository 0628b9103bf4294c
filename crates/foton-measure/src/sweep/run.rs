//! Jobs: runs that share their photons, seed after seed, judged against the reference at log-spaced passes.

use std::sync::Arc;
use std::time::{Duration, Instant};

use foton_film::Image;
use foton_integrator::{Cancel, Cancelled, PassReport, RenderSettings, Stage, Step, Variants};
use foton_scene::Scene;

use super::clock::{Clock, Spent};
use super::judge::{Judge, Judged, Spread};
use super::plan::{Configuration, Job};
use super::reference::Reference;
use crate::CompareError;

/// Passes are judged whenever photons have grown by this factor.
const SPACING: f64 = 1.9;

/// Pictures are taken from this many of the latest judged passes of the first seed: those at equal times are among them.
const MAX_LATEST: usize = 4;

/// A run of one seed at one pass.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    pub(crate) configuration: Configuration,
    pub(crate) seed: u64,
    pub(crate) report: PassReport,
    pub(crate) spent: Spent,
    pub(crate) stages: [Spent; Stage::ALL.len()],
    pub(crate) bytes: usize,
    pub(crate) judged: Judged,
}

/// All seeds of one configuration at one pass.
#[derive(Clone, Debug)]
pub(crate) struct Gathered {
    pub(crate) rows: Vec<Row>,
    pub(crate) spread: Spread,
}

/// A picture of the first seed.
#[derive(Clone, Debug)]
pub(crate) struct Picture {
    pub(crate) configuration: Configuration,
    pub(crate) cpu: f64,
    pub(crate) error: f64,
    pub(crate) image: Image,
}

/// What a job found: for each configuration each judged pass, and pictures at about equal times.
#[derive(Default)]
pub(crate) struct Finished {
    pub(crate) gathered: Vec<Gathered>,
    pub(crate) pictures: Vec<Picture>,
}

/// Why a job has no result.
#[derive(Debug)]
pub(crate) enum Unfinished {
    /// A person.
    Stopped,
    /// Images that cannot be compared.
    Compare(CompareError),
}

impl From<Cancelled> for Unfinished {
    fn from(_: Cancelled) -> Self {
        Self::Stopped
    }
}

/// What every job is given.
pub(crate) struct Runner<'a> {
    pub(crate) scene: &'a Arc<Scene>,
    pub(crate) base: &'a RenderSettings,
    pub(crate) reference: &'a Reference,
    pub(crate) seeds: u64,
    pub(crate) cancel: &'a Cancel,
    /// Asked between passes.
    pub(crate) is_stopped: &'a dyn Fn() -> bool,
}

/// One seed's way through a job.
struct Way {
    runs: Variants,
    clock: Clock,
    reports: Vec<PassReport>,
}

impl<'a> Runner<'a> {
    /// Runs a job for about `time`. If it contains `centre`, that is also judged by path class, and pictures are collected.
    pub(crate) fn run(
        &'a self,
        job: &'a Job,
        centre: &'a Configuration,
        time: Duration,
        tell: &mut dyn FnMut(u64, u64),
    ) -> Result<Finished, Unfinished> {
        let is_central = job.configurations.contains(centre);
        let settings = job.settings(self.base);
        let mut runs = JobRuns { runner: self, job, centre, is_central, settings, checkpoints: Vec::new() };
        let mut pictures = Vec::new();
        for seed in 0..self.seeds {
            if seed == 0 {
                pictures = runs.first_seed(time.div_f64(self.seeds as f64), tell)?;
            } else {
                runs.next_seed(seed, tell)?;
            }
        }
        Ok(Finished { gathered: runs.gathered(), pictures })
    }

    fn start(&self, settings: &[RenderSettings], seed: u64) -> Result<Way, Unfinished> {
        let mut clock = Clock::new(settings.len());
        // The reference has the photons of the base's own seed.
        let photons = self.base.seed.wrapping_add(1 + seed);
        let runs =
            Variants::start(self.scene, settings, photons, &mut |step| clock.begin(step), self.cancel)?;
        clock.pause();
        let runs = runs.ok_or(Unfinished::Stopped)?;
        Ok(Way { runs, clock, reports: Vec::new() })
    }
}

/// A pass after which all runs of a job are judged, seed after seed.
struct Checkpoint {
    pass: u64,
    photons: u64,
    /// One for each run.
    cells: Vec<Cell>,
}

/// What is known of one configuration at one pass.
struct Cell {
    judge: Judge,
    rows: Vec<Row>,
}

/// A job on its way. The first seed decides, by the time, which passes are judged; the others follow it.
struct JobRuns<'a> {
    runner: &'a Runner<'a>,
    job: &'a Job,
    centre: &'a Configuration,
    is_central: bool,
    settings: Vec<RenderSettings>,
    checkpoints: Vec<Checkpoint>,
}

impl JobRuns<'_> {
    /// Runs the first seed for about `time`, and returns pictures at about equal times.
    fn first_seed(
        &mut self,
        time: Duration,
        tell: &mut dyn FnMut(u64, u64),
    ) -> Result<Vec<Picture>, Unfinished> {
        let begin = Instant::now();
        let mut way = self.runner.start(&self.settings, 0)?;
        let mut latest: Vec<Vec<Picture>> = Vec::new();
        loop {
            let report = self.advance(&mut way, 0, tell)?;
            let is_last = begin.elapsed() >= time && report.pass >= 2;
            if is_due(self.checkpoints.last(), &report, is_last) {
                let judge =
                    |s: &RenderSettings| Judge::new(self.runner.reference, s.layers && self.is_central);
                let cells =
                    self.settings.iter().map(|s| Cell { judge: judge(s), rows: Vec::new() }).collect();
                self.checkpoints.push(Checkpoint { pass: report.pass, photons: report.photons, cells });
                let pictures = self.judge(&way, 0, self.checkpoints.len() - 1)?;
                if self.is_central {
                    latest.push(pictures);
                    if latest.len() > MAX_LATEST {
                        latest.remove(0);
                    }
                }
            }
            if is_last {
                return Ok(at_equal_times(&latest));
            }
        }
    }

    /// Runs another seed up to the last pass of the first.
    fn next_seed(&mut self, seed: u64, tell: &mut dyn FnMut(u64, u64)) -> Result<(), Unfinished> {
        let mut way = self.runner.start(&self.settings, seed)?;
        for checkpoint in 0..self.checkpoints.len() {
            while way.reports.first().is_none_or(|report| report.pass < self.checkpoints[checkpoint].pass) {
                self.advance(&mut way, seed, tell)?;
            }
            self.judge(&way, seed, checkpoint)?;
        }
        Ok(())
    }

    /// One pass of all runs of a seed, unless someone has stopped the sweep.
    fn advance(
        &self,
        way: &mut Way,
        seed: u64,
        tell: &mut dyn FnMut(u64, u64),
    ) -> Result<PassReport, Unfinished> {
        if (self.runner.is_stopped)() {
            return Err(Unfinished::Stopped);
        }
        way.advance(self.runner.cancel)?;
        let report = way.reports[0];
        tell(seed, report.pass);
        Ok(report)
    }

    /// What all seeds have found: for each judged pass each configuration of the job.
    fn gathered(self) -> Vec<Gathered> {
        let own = self.job.configurations.len();
        let mut all = Vec::new();
        for checkpoint in self.checkpoints {
            let gather =
                |cell: Cell| Gathered { spread: cell.judge.spread(self.runner.reference), rows: cell.rows };
            let mut gathered: Vec<Gathered> = checkpoint.cells.into_iter().map(gather).collect();
            if let Some(by_class) = gathered.get(own).map(|g| g.spread.classes) {
                gathered.truncate(own);
                for g in gathered.iter_mut().filter(|g| g.rows[0].configuration == *self.centre) {
                    g.spread.classes.clone_from(&by_class);
                }
            }
            all.extend(gathered);
        }
        all
    }

    /// Judges all runs of a seed as they stand at a checkpoint; returns their images.
    fn judge(&mut self, way: &Way, seed: u64, checkpoint: usize) -> Result<Vec<Picture>, Unfinished> {
        let mut pictures = Vec::new();
        let cells = &mut self.checkpoints[checkpoint].cells;
        for (i, ((run, report), cell)) in way.runs.runs().iter().zip(&way.reports).zip(cells).enumerate() {
            let image = run.image();
            let judged = cell.judge.add(run, &image, self.runner.reference).map_err(Unfinished::Compare)?;
            // Beyond the job's own there is the centre with layers.
            let configuration = self.job.configurations.get(i).copied();
            let (error, spent) = (judged.error[0], way.clock.of(i));
            cell.rows.push(Row {
                configuration: configuration.unwrap_or(*self.centre),
                seed,
                report: *report,
                spent,
                stages: way.clock.stages(i),
                bytes: run.bytes(),
                judged,
            });
            if let Some(configuration) = configuration {
                pictures.push(Picture { configuration, cpu: spent.cpu, error, image });
            }
        }
        Ok(pictures)
    }
}

impl Way {
    fn advance(&mut self, cancel: &Cancel) -> Result<(), Cancelled> {
        let clock = &mut self.clock;
        self.reports = self.runs.advance(&mut |step: Step| clock.begin(step), cancel)?;
        clock.pause();
        Ok(())
    }
}

/// Whether a pass is to be judged: the first, the last, and each by which photons have about doubled.
fn is_due(before: Option<&Checkpoint>, report: &PassReport, is_last: bool) -> bool {
    is_last || before.is_none_or(|before| report.photons as f64 >= SPACING * before.photons as f64)
}

/// Of each configuration the picture whose time is nearest to the shortest of their last times.
fn at_equal_times(latest: &[Vec<Picture>]) -> Vec<Picture> {
    let Some(last) = latest.last() else { return Vec::new() };
    let time = last.iter().map(|p| p.cpu).fold(f64::INFINITY, f64::min);
    let off = |p: &Picture| (p.cpu.max(1e-9) / time.max(1e-9)).ln().abs();
    (0..last.len())
        .filter_map(|i| latest.iter().map(|all| &all[i]).min_by(|a, b| off(a).total_cmp(&off(b))))
        .cloned()
        .collect()
}
