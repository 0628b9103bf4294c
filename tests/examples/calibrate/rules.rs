//! Radii that adapt against every fixed α and first radius, at equal processor time.
//!
//! All renders of a scene share their photons and its truth; each is charged for the photons as if it had traced them alone. One
//! thread, so that the time of a step is what the process took in it.

use std::num::NonZeroU32;
use std::sync::Arc;
use std::time::Duration;

use foton_integrator::{Alpha, Cancel, PpmSettings, RadiusRule, RadiusScale, RenderSettings, Step, Variants};
use foton_measure::sweep::processor_time;
use foton_scene::Scene;

use crate::truth::{self, Truth};

const ALPHAS: [f64; 6] = [0.5, 0.6, 2.0 / 3.0, 0.7, 0.8, 1.0];
const SCALES: [f64; 5] = [0.5, 0.7, 1.0, 1.4, 2.0];
/// Of radii that adapt: one or the other is not the default.
const OTHER_ALPHAS: [f64; 3] = [0.5, 0.6, 0.8];
const OTHER_SCALES: [f64; 4] = [0.5, 0.7, 1.4, 2.0];
/// Pixels along a side.
const SIDE: u32 = 64;
const PHOTONS: u32 = 1 << 16;
/// Passes after which renders are compared.
const SHOWN: [u64; 3] = [4, 16, 64];

/// Squared errors at a time: of all that is seen, of its smooth tiles, of the rest.
#[derive(Clone, Copy, Default)]
struct At {
    seconds: f64,
    squares: [f64; 3],
}

/// What a render came to, whenever its passes had doubled.
type Course = Vec<At>;

/// Prints the table, on one thread.
pub(crate) fn print(named: &[&str], seeds: u64, truth_passes: u64) {
    println!(
        "| scene | passes | processor s | local % | best fixed % (which) | adaptive % | over best fixed | best adaptive % (which) | smooth: best fixed, adaptive % | rest: best fixed, adaptive % |\n|---|---|---|---|---|---|---|---|---|---|"
    );
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    for name in if named.is_empty() { crate::ASSETS.to_vec() } else { named.to_vec() } {
        pool.install(|| rows(name, seeds, truth_passes));
    }
}

fn rows(name: &str, seeds: u64, truth_passes: u64) {
    let scene = truth::open(name, SIDE);
    let photons = NonZeroU32::new(PHOTONS).expect("above 0");
    let base = RenderSettings {
        ppm: PpmSettings {
            first_pass: photons,
            radius_rule: RadiusRule::Local,
            ..crate::settings(PHOTONS, 1).ppm
        },
        ..crate::settings(PHOTONS, 1)
    };
    let truth = Truth::render(&scene, &base, truth_passes);
    let adaptive = adaptive(&base);
    let adapting = adaptive.len();
    let all: Vec<RenderSettings> = adaptive.into_iter().chain([base.clone()]).chain(fixed(&base)).collect();
    let courses = run(&scene, &all, &truth, seeds);
    for (i, at) in courses[0].iter().enumerate().filter(|(i, _)| SHOWN.contains(&(1 << i))) {
        let percent = |which: usize, part: usize| 100.0 * error_at(&courses[which], at.seconds, part);
        let best = |of: std::ops::Range<usize>| {
            of.min_by(|a, b| percent(*a, 0).total_cmp(&percent(*b, 0))).expect("some")
        };
        let (best_fixed, best_adaptive) = (best(adapting..all.len()), best(0..adapting));
        let which =
            |i: usize| format!("α {:.2}, × {}", all[i].ppm.alpha.get(), all[i].ppm.radius_scale.get());
        let min = |part| (adapting..all.len()).map(|i| percent(i, part)).fold(f64::INFINITY, f64::min);
        println!(
            "| {name} | {} | {:.2} | {:.2} | {:.2} ({}) | {:.2} | {:.2} | {:.2} ({}) | {:.2}, {:.2} | {:.2}, {:.2} |",
            1 << i,
            at.seconds,
            percent(adapting, 0),
            percent(best_fixed, 0),
            which(best_fixed),
            percent(0, 0),
            percent(0, 0) / percent(best_fixed, 0),
            percent(best_adaptive, 0),
            which(best_adaptive),
            min(1),
            percent(0, 1),
            min(2),
            percent(0, 2),
        );
    }
    eprintln!("{name}: noise of the truth {:.1} %", 100.0 * truth.noise());
}

/// `base` with another rule, α and factor on first radii.
fn with(base: &RenderSettings, radius_rule: RadiusRule, alpha: f64, scale: f64) -> RenderSettings {
    let alpha = Alpha::new(alpha).expect("in range");
    let radius_scale = RadiusScale::new(scale).expect("above 0");
    RenderSettings { ppm: PpmSettings { alpha, radius_scale, radius_rule, ..base.ppm }, ..base.clone() }
}

/// Every fixed α with every first radius.
fn fixed(base: &RenderSettings) -> Vec<RenderSettings> {
    let pairs = SCALES.iter().flat_map(|&scale| ALPHAS.map(|alpha| (alpha, scale)));
    pairs.map(|(alpha, scale)| with(base, base.ppm.radius_rule, alpha, scale)).collect()
}

/// Radii that adapt: the defaults first, then each with one other value.
fn adaptive(base: &RenderSettings) -> Vec<RenderSettings> {
    let with = |alpha, scale| with(base, RadiusRule::Adaptive, alpha, scale);
    let central = Alpha::default().get();
    [with(central, 1.0)]
        .into_iter()
        .chain(OTHER_ALPHAS.map(|alpha| with(alpha, 1.0)))
        .chain(OTHER_SCALES.map(|scale| with(central, scale)))
        .collect()
}

/// All renders over the same photons, seed after seed.
fn run(scene: &Arc<Scene>, all: &[RenderSettings], truth: &Truth, seeds: u64) -> Vec<Course> {
    let mut courses: Vec<Course> = vec![Vec::new(); all.len()];
    let cancel = Cancel::default();
    for seed in 0..seeds {
        let mut clock = Clock { spent: vec![0.0; all.len()], last: (Step::Share, processor_time()) };
        let runs = Variants::start(scene, all, seed + 1, &mut |step| clock.begin(step), &cancel);
        let mut runs = runs.expect("not cancelled").expect("they share their photons");
        clock.begin(Step::Share);
        for pass in 1..=SHOWN[SHOWN.len() - 1] {
            runs.advance(&mut |step| clock.begin(step), &cancel).expect("not cancelled");
            clock.begin(Step::Share);
            if !pass.is_power_of_two() {
                continue;
            }
            for ((course, render), seconds) in courses.iter_mut().zip(runs.runs()).zip(&clock.spent) {
                let i = pass.ilog2() as usize;
                course.resize(course.len().max(i + 1), At::default());
                let squares = truth.squares(&truth::reflected(render)).map(|known| known.value);
                course[i].seconds += seconds / seeds as f64;
                for (sum, square) in course[i].squares.iter_mut().zip(squares) {
                    *sum += square / seeds as f64;
                }
            }
        }
    }
    courses
}

/// The root mean square after some seconds: between two points of a course, and beyond its ends, a power of time.
fn error_at(course: &Course, seconds: f64, part: usize) -> f64 {
    let after = course.partition_point(|at| at.seconds < seconds).clamp(1, course.len() - 1);
    let (a, b) = (&course[after - 1], &course[after]);
    let log = |at: &At| at.squares[part].max(1e-12).ln();
    let share = (seconds / a.seconds).ln() / (b.seconds / a.seconds).ln();
    (0.5 * (log(a) + share * (log(b) - log(a)))).exp()
}

/// Processor seconds of each render.
struct Clock {
    spent: Vec<f64>,
    last: (Step, Duration),
}

impl Clock {
    fn begin(&mut self, step: Step) {
        let now = processor_time();
        let took = now.saturating_sub(self.last.1).as_secs_f64();
        match self.last.0 {
            Step::Trace => self.spent.iter_mut().for_each(|spent| *spent += took),
            Step::Of(i, _) => self.spent[i] += took,
            Step::Share => {}
        }
        self.last = (step, now);
    }
}
