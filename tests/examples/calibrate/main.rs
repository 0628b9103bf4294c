//! Whether the live error can be believed: estimated against true error, how often bounds of tiles hold, where `--error` stops,
//! how fast noise and bias fall, and what radii that adapt are worth.
//!
//! `cargo run --release -p foton-tests --example calibrate` prints the tables of docs/error.md and writes its plot; `stops`,
//! `slopes`, `rules`, `floors` and `kernels` print the others. Names of assets, `seeds=4`, `truth=1024` (its passes), `rule=local` and `floor=0` may be given. The
//! truth has the same eye samples and photons of its own, small discs of two radii, and direct light by shadow rays.
#![allow(clippy::print_stdout, reason = "a program that prints a table")]

mod floors;
mod kernels;
mod rules;
mod scenes;
mod stops;
mod truth;

use std::num::NonZeroU32;
use std::path::Path;
use std::sync::Arc;

use foton_integrator::{PpmSettings, RadiusFloor, RadiusRule, Render, RenderSettings, TileError};
use foton_measure::plot::{Plot, Series, colour};
use foton_scene::Scene;
use foton_tests::slopes;
use truth::{TILE, Truth, open};

/// Pixels along a side of what is judged.
const SIDE: u32 = 128;

const ASSETS: [&str; 10] = [
    "furnace",
    "cornell-diffuse",
    "cornell-spheres",
    "box-spheres",
    "ring",
    "glass-and-ring",
    "pool",
    "decal",
    "narrow-lights",
    "far-lamp",
];
const CHECKPOINTS: [u64; 4] = [16, 32, 64, 128];
const PHOTONS: u32 = 1 << 16;
/// A tile is lit that has this share of the mean light.
const LIT: f64 = 0.01;
/// Standard deviations of nominal 50, 90 and 99 % bounds.
const Z: [f64; 3] = [0.674, 1.645, 2.576];

/// What a checkpoint found, of one seed.
struct Found {
    estimated: [f64; 3],
    truth: f64,
    deviation: f64,
    is_within: bool,
    /// Tiles within each bound, and all, of smooth tiles and of others.
    covered: [([f64; 3], f64); 2],
    /// Tiles that are called unknown though light reaches them, and all that light reaches.
    unknown: [f64; 2],
    /// Shares of the squared error of direct, caustic and indirect light, estimated and true.
    classes: [[f64; 3]; 2],
}

/// One eye sample a pixel.
fn settings(photons: u32, seed: u64) -> RenderSettings {
    RenderSettings {
        samples_per_pixel: NonZeroU32::MIN,
        seed,
        ppm: PpmSettings {
            photons_per_pass: NonZeroU32::new(photons).expect("above 0"),
            ..PpmSettings::default()
        },
        ..RenderSettings::default()
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |name: &str, default: u64| {
        arguments.iter().find_map(|a| a.strip_prefix(name)?.parse().ok()).unwrap_or(default)
    };
    let (seeds, passes) = (number("seeds=", 4), number("truth=", 1024));
    let mut named: Vec<&str> = arguments.iter().map(String::as_str).filter(|a| !a.contains('=')).collect();
    match named.first() {
        Some(&"stops") => stops::print(&named.split_off(1), 1, passes),
        Some(&"kernels") => kernels::print(&named.split_off(1), seeds, passes),
        Some(&"floors") => floors::print(&named.split_off(1), number("spp=", 1), passes),
        Some(&"rules") => rules::print(&named.split_off(1), number("seeds=", 2), passes),
        Some(&"slopes") => print_slopes(seeds.max(8)),
        _ => {
            let rule = arguments.iter().find_map(|a| a.strip_prefix("rule="));
            let rule = rule.map(|name| RadiusRule::from_name(name).expect("local, global or adaptive"));
            let floor = arguments.iter().find_map(|a| a.strip_prefix("floor=")?.parse().ok());
            let floor = floor.map(|f| RadiusFloor::new(f).expect("0 or more"));
            coverage(&named, (seeds, passes), (rule.unwrap_or_default(), floor.unwrap_or_default()));
        }
    }
}

fn print_slopes(seeds: u64) {
    let checkpoints: Vec<u64> = (2..10).map(|power| 1 << power).collect();
    println!("| α | smooth: noise | bias | both | edge: bias | both |\n|---|---|---|---|---|---|");
    for alpha in [2.0 / 3.0, 0.5] {
        let parts = slopes::measure(alpha, 16_000, seeds, &checkpoints);
        let cell = |f: &dyn Fn(&slopes::Parts) -> f64, theory: f64| {
            format!("{:.3} ({theory:.3})", slopes::slope_of(&parts, f))
        };
        println!(
            "| {alpha:.3} | {} | {} | {} | {} | {} |",
            cell(&|p| p.noise, -0.5 * alpha),
            cell(&|p| p.bias, alpha - 1.0),
            cell(&|p| p.smooth, -(0.5 * alpha).min(1.0 - alpha)),
            cell(&|p| p.edge_bias, -0.25 * (1.0 - alpha)),
            cell(&|p| p.edge, -(0.5 * alpha).min(0.25 * (1.0 - alpha))),
        );
    }
}

fn coverage(named: &[&str], (seeds, passes): (u64, u64), radii: (RadiusRule, RadiusFloor)) {
    println!(
        "| scene | passes | true % | estimated % (noise, bias) | estimated/true | true within low..high | smooth tiles: 50 90 99 % | other tiles: 50 90 99 % | unknown tiles, of lit ones |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    let mut plotted = Vec::new();
    let mut classes = String::new();
    for name in if named.is_empty() { ASSETS.to_vec() } else { named.to_vec() } {
        let scene = open(name, SIDE);
        let runs: Vec<Vec<Found>> = (0..seeds).map(|seed| run(&scene, (seed, radii), passes)).collect();
        for (i, passes) in CHECKPOINTS.iter().enumerate() {
            row(name, *passes, &runs.iter().map(|run| &run[i]).collect::<Vec<_>>());
        }
        let last: Vec<&Found> = runs.iter().filter_map(|run| run.last()).collect();
        classes += &row_of_classes(name, &last);
        plotted.push((name, runs));
    }
    println!("\n| scene | direct: estimated, true % | caustic | indirect |\n|---|---|---|---|\n{classes}");
    plot(&plotted);
}

/// Shares of the squared error after the last checkpoint.
fn row_of_classes(name: &str, found: &[&Found]) -> String {
    let mean = |which: usize, class: usize| {
        100.0 * found.iter().map(|f| f.classes[which][class]).sum::<f64>() / found.len() as f64
    };
    let cells = [0, 1, 2].map(|class| format!(" {:.0}, {:.0} |", mean(0, class), mean(1, class)));
    format!("| {name} |{}\n", cells.concat())
}

/// Estimated over true error, a marker a checkpoint: means over seeds.
fn plot(plotted: &[(&str, Vec<Vec<Found>>)]) {
    let mean = |runs: &[Vec<Found>], i: usize, f: &dyn Fn(&Found) -> f64| {
        100.0 * runs.iter().map(|run| f(&run[i])).sum::<f64>() / runs.len() as f64
    };
    let mut series: Vec<Series> = plotted
        .iter()
        .enumerate()
        .map(|(i, (name, runs))| {
            let point = |c| (mean(runs, c, &|f| f.truth), mean(runs, c, &|f| f.estimated[0]));
            Series::new(*name, colour(i), i, (0..CHECKPOINTS.len()).map(point).collect())
        })
        .collect();
    let all = || series.iter().flat_map(|s| &s.points).map(|p| p.0);
    let (low, high) = (all().fold(f64::MAX, f64::min), all().fold(0.0, f64::max));
    let mut equal =
        Series::new("as it should be", "var(--dim)".to_owned(), 0, vec![(low, low), (high, high)]);
    equal.dashed = true;
    series.push(equal);
    let plot = Plot {
        title: "The live error against the true one, at 16 to 128 passes",
        x: "true error (% of mean light)",
        y: "estimated error (%)",
        series,
    };
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ lies in the repository");
    let path = root.join("docs/pictures/calibration.svg");
    if let Some(svg) = plot.file() {
        std::fs::write(&path, svg).expect("docs/pictures can be written");
        eprintln!("wrote {}", path.display());
    }
}

fn run(
    scene: &Arc<Scene>,
    (seed, (radius_rule, radius_floor)): (u64, (RadiusRule, RadiusFloor)),
    passes: u64,
) -> Vec<Found> {
    let settings = RenderSettings {
        error: true,
        layers: true,
        ppm: PpmSettings { radius_floor, radius_rule, ..settings(PHOTONS, seed).ppm },
        ..settings(PHOTONS, seed)
    };
    let truth = Truth::render(scene, &settings, passes);
    eprintln!(
        "noise of the truth {:.1} %, smooth {:.0} %",
        100.0 * truth.noise(),
        100.0 * truth.smooth_share()
    );
    let mut runs = truth::start(scene, settings, seed);
    let mut found = Vec::new();
    for pass in 1..=CHECKPOINTS[CHECKPOINTS.len() - 1] {
        truth::advance(&mut runs);
        if CHECKPOINTS.contains(&pass) {
            found.push(judge(&runs.runs()[0], &truth));
        }
    }
    found
}

fn judge(render: &Render, truth: &Truth) -> Found {
    let error = render.error().expect("passes and light");
    let relative = truth.error(render);
    let (mut covered, mut unknown) = ([([0.0; 3], 0.0); 2], [0.0; 2]);
    for (i, (tile, (t, variance))) in render.error_tiles().iter().zip(&truth.tiles).enumerate() {
        if tile.pixels < (TILE * TILE) as u32 {
            continue;
        }
        if *t > LIT * truth.mean() {
            unknown[0] += f64::from(u8::from(tile.is_unknown()));
            unknown[1] += 1.0;
        }
        if tile.is_unknown() {
            continue;
        }
        let kind = usize::from(!truth.is_smooth(i));
        // The truth's noise widens what is compared, not the error: the bound is widened by as much.
        let widened = |z: f64| {
            let noise = (tile.noise * tile.noise + variance).sqrt();
            TileError { noise, ..*tile }.bound(z)
        };
        let off = (tile.mean - t).abs();
        for (sum, z) in covered[kind].0.iter_mut().zip(Z) {
            *sum += f64::from(u8::from(off <= widened(z)));
        }
        covered[kind].1 += 1.0;
    }
    let estimated = error.classes.expect("each was asked for").map(|c| (c.total() / error.total).powi(2));
    Found {
        estimated: [error.total, error.noise, error.bias],
        truth: relative.value,
        deviation: relative.deviation,
        is_within: (error.low..=error.high).contains(&relative.value),
        covered,
        unknown,
        classes: [estimated, truth.class_shares(render)],
    }
}

fn row(name: &str, passes: u64, found: &[&Found]) {
    let n = found.len() as f64;
    let mean = |f: &dyn Fn(&Found) -> f64| found.iter().map(|x| f(x)).sum::<f64>() / n;
    let quotients: Vec<f64> = found.iter().map(|f| f.estimated[0] / f.truth).collect();
    let (min, max) = quotients.iter().fold((f64::MAX, 0f64), |(a, b), q| (a.min(*q), b.max(*q)));
    let within = found.iter().filter(|f| f.is_within).count();
    let coverage = |kind: usize| {
        let all: f64 = found.iter().map(|f| f.covered[kind].1).sum();
        if all == 0.0 {
            return "none".to_owned();
        }
        let share = |i: usize| 100.0 * found.iter().map(|f| f.covered[kind].0[i]).sum::<f64>() / all;
        format!("{:.0} {:.0} {:.0} (of {all})", share(0), share(1), share(2))
    };
    println!(
        "| {name} | {passes} | {:.2} ± {:.2} | {:.2} ({:.2}, {:.2}) | {:.2} ({min:.2}–{max:.2}) | {within}/{} | {} | {} | {:.0} of {:.0} |",
        100.0 * mean(&|f| f.truth),
        100.0 * mean(&|f| f.deviation) / n.sqrt(),
        100.0 * mean(&|f| f.estimated[0]),
        100.0 * mean(&|f| f.estimated[1]),
        100.0 * mean(&|f| f.estimated[2]),
        mean(&|f| f.estimated[0] / f.truth),
        found.len(),
        coverage(0),
        coverage(1),
        found.iter().map(|f| f.unknown[0]).sum::<f64>(),
        found.iter().map(|f| f.unknown[1]).sum::<f64>(),
    );
}
