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

/// Judged images of the first seed that are kept: those at equal times are among the last.
const IMAGES_KEPT: usize = 4;

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

impl Runner<'_> {
    /// Runs a job for about `time`. With `central`, its centre is also judged by path class, and pictures are kept.
    pub(crate) fn run(
        &self,
        job: &Job,
        centre: &Configuration,
        time: Duration,
        tell: &mut dyn FnMut(u64, u64),
    ) -> Result<Finished, Unfinished> {
        let is_central = job.configurations.contains(centre);
        let settings = job.settings(self.base);
        let mut finished = Finished::default();
        // Passes that are judged, and photons by then.
        let mut passes: Vec<(u64, u64)> = Vec::new();
        let mut table: Vec<Vec<(Judge, Vec<Row>)>> = Vec::new();
        for seed in 0..self.seeds {
            let begin = Instant::now();
            let slot = time.div_f64(self.seeds.max(1) as f64);
            let mut way = self.start(&settings, seed)?;
            let mut kept: Vec<Vec<Picture>> = Vec::new();
            let mut checkpoint = 0;
            loop {
                if (self.is_stopped)() {
                    return Err(Unfinished::Stopped);
                }
                way.advance(self.cancel)?;
                let pass = way.reports[0].pass;
                tell(seed, pass);
                let is_last = if seed == 0 {
                    begin.elapsed() >= slot && pass >= 2
                } else {
                    passes.last().is_some_and(|(last, _)| pass >= *last)
                };
                let is_due = if seed == 0 {
                    is_due(&passes, &way.reports[0], is_last)
                } else {
                    passes.iter().any(|(p, _)| *p == pass)
                };
                if is_due {
                    if seed == 0 {
                        passes.push((pass, way.reports[0].photons));
                        table.push(
                            settings
                                .iter()
                                .map(|s| (Judge::new(self.reference, s.layers && is_central), Vec::new()))
                                .collect(),
                        );
                    }
                    let pictures =
                        self.judge(&way, seed, &job.configurations, centre, &mut table[checkpoint])?;
                    if seed == 0 && is_central {
                        kept.push(pictures);
                        if kept.len() > IMAGES_KEPT {
                            kept.remove(0);
                        }
                    }
                    checkpoint += 1;
                }
                if is_last {
                    break;
                }
            }
            if seed == 0 {
                finished.pictures = at_equal_times(&kept);
            }
        }
        for checkpoint in table {
            let own = job.configurations.len();
            let mut gathered: Vec<Gathered> = checkpoint
                .into_iter()
                .map(|(judge, rows)| Gathered { spread: judge.spread(self.reference), rows })
                .collect();
            if let Some(by_class) = gathered.get(own).map(|g| g.spread.classes) {
                gathered.truncate(own);
                for g in gathered.iter_mut().filter(|g| g.rows[0].configuration == *centre) {
                    g.spread.classes.clone_from(&by_class);
                }
            }
            finished.gathered.extend(gathered);
        }
        Ok(finished)
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

    /// Judges all runs as they stand; returns their images.
    fn judge(
        &self,
        way: &Way,
        seed: u64,
        configurations: &[Configuration],
        centre: &Configuration,
        cells: &mut [(Judge, Vec<Row>)],
    ) -> Result<Vec<Picture>, Unfinished> {
        let mut pictures = Vec::new();
        for (i, ((run, report), (judge, rows))) in
            way.runs.runs().iter().zip(&way.reports).zip(cells).enumerate()
        {
            let image = run.image();
            let judged = judge.add(run, &image, self.reference).map_err(Unfinished::Compare)?;
            // Beyond the job's own there is the centre with layers.
            let configuration = configurations.get(i).copied();
            let (error, spent) = (judged.error[0], way.clock.of(i));
            rows.push(Row {
                configuration: configuration.unwrap_or(*centre),
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
fn is_due(passes: &[(u64, u64)], report: &PassReport, is_last: bool) -> bool {
    let grown = |(_, photons): &(u64, u64)| report.photons as f64 >= SPACING * *photons as f64;
    is_last || passes.last().is_none_or(grown)
}

/// Of each configuration the picture whose time is nearest to the shortest of their last times.
fn at_equal_times(kept: &[Vec<Picture>]) -> Vec<Picture> {
    let Some(last) = kept.last() else { return Vec::new() };
    let time = last.iter().map(|p| p.cpu).fold(f64::INFINITY, f64::min);
    let off = |p: &Picture| (p.cpu.max(1e-9) / time.max(1e-9)).ln().abs();
    (0..last.len())
        .filter_map(|i| kept.iter().map(|all| &all[i]).min_by(|a, b| off(a).total_cmp(&off(b))))
        .cloned()
        .collect()
}
