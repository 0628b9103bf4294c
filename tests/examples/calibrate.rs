//! Whether the live error can be believed: estimated against true error, and how often bounds of tiles hold.
//!
//! `cargo run --release -p foton-tests --example calibrate` prints the tables that docs/error.md keeps; names of assets and
//! `seeds=4` may be given. The truth has the same eye samples: its run has the same seed, shrinks its radii within 64 passes
//! and stays there (α 0.2, then 1), and is the mean of the passes after those, which share no photon with the run that is
//! judged. Its own noise, known from its passes, is taken off the squared error.
#![allow(clippy::print_stdout, reason = "a program that prints a table")]

use std::num::NonZeroU32;
use std::path::Path;
use std::sync::Arc;

use foton_format::Options;
use foton_integrator::{Alpha, Cancel, Change, LayerKind, Ppm, Settings};
use foton_scene::Scene;

const ASSETS: [&str; 6] =
    ["furnace", "cornell-diffuse", "cornell-spheres", "box-spheres", "ring", "glass-and-ring"];
const SIDE: u32 = 64;
const TILE: usize = 8;
const CHECKPOINTS: [u64; 3] = [16, 32, 64];
const PHOTONS: u32 = 1 << 14;
/// Passes of the truth that are thrown away, and the photons and number of those that are kept.
const SHRINKING: u64 = 64;
const TRUTH_PHOTONS: u32 = 1 << 17;
const TRUTH_PASSES: u64 = 48;
/// Standard deviations of nominal 50, 90 and 99 % bounds.
const Z: [f64; 3] = [0.674, 1.645, 2.576];

/// The converged image at some eye samples: luminance and the variance of that, by pixel; mean and variance by tile.
struct Truth {
    pixels: Vec<(f64, f64)>,
    tiles: Vec<(f64, f64)>,
}

/// What a checkpoint found, of one seed.
struct Found {
    estimated: [f64; 3],
    truth: f64,
    is_within: bool,
    /// Tiles within each bound, and all, of smooth tiles and of others.
    covered: [([f64; 3], f64); 2],
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let seeds = arguments.iter().find_map(|a| a.strip_prefix("seeds=")?.parse().ok()).unwrap_or(3u64);
    let named: Vec<&str> = arguments.iter().map(String::as_str).filter(|a| !a.contains('=')).collect();
    println!(
        "| scene | passes | true % | estimated % (noise, bias) | estimated/true | true within low..high | smooth tiles: 50 90 99 % | other tiles: 50 90 99 % |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for name in if named.is_empty() { ASSETS.to_vec() } else { named } {
        let scene = open(name);
        let runs: Vec<Vec<Found>> = (0..seeds).map(|seed| run(&scene, seed)).collect();
        for (i, passes) in CHECKPOINTS.iter().enumerate() {
            row(name, *passes, &runs.iter().map(|run| &run[i]).collect::<Vec<_>>());
        }
    }
}

fn open(name: &str) -> Arc<Scene> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ lies in the repository");
    let path = root.join(format!("assets/{name}/scene.xml"));
    let mut description = foton_format::open(&path, &Options::default()).expect("an asset").description;
    for sensor in &mut description.sensors {
        sensor.resize(SIDE, SIDE);
    }
    Arc::new(Scene::build(&description).expect("a sound asset"))
}

fn settings(photons: u32, seed: u64) -> Settings {
    Settings {
        photons_per_pass: NonZeroU32::new(photons).expect("above 0"),
        samples_per_pixel: NonZeroU32::MIN,
        seed,
        ..Settings::default()
    }
}

fn run(scene: &Arc<Scene>, seed: u64) -> Vec<Found> {
    let truth = truth(scene, seed);
    let cancel = Cancel::default();
    let settings = Settings { error: true, ..settings(PHOTONS, seed) };
    let mut ppm = Ppm::start(Arc::clone(scene), settings, &mut |_| (), &cancel).expect("not cancelled");
    let mut found = Vec::new();
    while ppm.passes() < CHECKPOINTS[CHECKPOINTS.len() - 1] {
        ppm.advance(&mut |_| (), &cancel).expect("not cancelled");
        if CHECKPOINTS.contains(&ppm.passes()) {
            found.push(judge(&ppm, &truth));
        }
    }
    found
}

fn truth(scene: &Arc<Scene>, seed: u64) -> Truth {
    let cancel = Cancel::default();
    let first = Settings { alpha: Alpha::new(0.2).expect("in range"), ..settings(PHOTONS, seed) };
    let mut ppm = Ppm::start(Arc::clone(scene), first, &mut |_| (), &cancel).expect("not cancelled");
    let advance = |ppm: &mut Ppm| {
        ppm.advance(&mut |_| (), &cancel).expect("not cancelled");
    };
    for _ in 0..SHRINKING {
        advance(&mut ppm);
    }
    ppm.change(Change::Alpha(Alpha::new(1.0).expect("in range")));
    ppm.change(Change::PhotonsPerPass(NonZeroU32::new(TRUTH_PHOTONS).expect("above 0")));
    let count = (SIDE * SIDE) as usize;
    let mut pixels = vec![(0.0, 0.0); count];
    let mut tiles = vec![(0.0, 0.0); (SIDE as usize / TILE).pow(2)];
    for _ in 0..TRUTH_PASSES {
        advance(&mut ppm);
        let pass: Vec<f64> = ppm.last_pass().pixels.iter().map(|p| f64::from(p.luminance())).collect();
        add(&mut pixels, &pass);
        add(&mut tiles, &tile_means(&pass));
    }
    conclude(&mut pixels);
    conclude(&mut tiles);
    Truth { pixels, tiles }
}

fn add(sums: &mut [(f64, f64)], pass: &[f64]) {
    for ((sum, squares), x) in sums.iter_mut().zip(pass) {
        *sum += x;
        *squares += x * x;
    }
}

/// From sums and squares of equal passes to their mean and its variance.
fn conclude(sums: &mut [(f64, f64)]) {
    let n = TRUTH_PASSES as f64;
    for (sum, squares) in sums {
        *sum /= n;
        *squares = ((*squares / n - *sum * *sum) / (n - 1.0)).max(0.0);
    }
}

fn tile_means(pixels: &[f64]) -> Vec<f64> {
    let (width, across) = (SIDE as usize, SIDE as usize / TILE);
    let mut tiles = vec![0.0; across * across];
    for (i, p) in pixels.iter().enumerate() {
        tiles[i / width / TILE * across + i % width / TILE] += p / (TILE * TILE) as f64;
    }
    tiles
}

fn judge(ppm: &Ppm, truth: &Truth) -> Found {
    let error = ppm.error().expect("passes and light");
    let emission = ppm.colour_layer(LayerKind::Emission).expect("always kept");
    let image = ppm.image();
    let reflected: Vec<f64> = image
        .pixels
        .iter()
        .zip(&emission.pixels)
        .map(|(all, e)| f64::from(all.luminance()) - f64::from(e.luminance()))
        .collect();
    let seen: Vec<bool> = (0..reflected.len()).map(|p| !ppm.discs(p).is_empty()).collect();
    let count = seen.iter().filter(|s| **s).count() as f64;
    let (mut squares, mut light) = (0.0, 0.0);
    for ((x, (t, variance)), _) in reflected.iter().zip(&truth.pixels).zip(&seen).filter(|(_, s)| **s) {
        squares += (x - t).powi(2) - variance;
        light += t;
    }
    let relative = (squares / count).max(0.0).sqrt() / (light / count);
    let mut covered = [([0.0; 3], 0.0); 2];
    for (i, (tile, (t, variance))) in ppm.error_tiles().iter().zip(&truth.tiles).enumerate() {
        if tile.pixels < (TILE * TILE) as u32 {
            continue;
        }
        let kind = usize::from(!is_smooth(i, truth, ppm));
        // The truth's noise widens what is compared, not the error: the bound is widened by as much.
        let widened = |z: f64| {
            let noise = (tile.noise * tile.noise + variance).sqrt();
            foton_integrator::TileError { noise, ..*tile }.bound(z)
        };
        let off = (tile.mean - t).abs();
        for (sum, z) in covered[kind].0.iter_mut().zip(Z) {
            *sum += f64::from(u8::from(off <= widened(z)));
        }
        covered[kind].1 += 1.0;
    }
    Found {
        estimated: [error.total, error.noise, error.bias],
        truth: relative,
        is_within: (error.low..=error.high).contains(&relative),
        covered,
    }
}

/// A tile that sees one shape, and whose light differs from its neighbours' by less than a third.
fn is_smooth(tile: usize, truth: &Truth, ppm: &Ppm) -> bool {
    let across = SIDE as usize / TILE;
    let (x, y) = ((tile % across) as i64, (tile / across) as i64);
    let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy)));
    let mean = truth.tiles[tile].0;
    let is_even = around
        .filter(|(x, y)| (0..across as i64).contains(x) && (0..across as i64).contains(y))
        .all(|(x, y)| (truth.tiles[y as usize * across + x as usize].0 / mean - 1.0).abs() < 1.0 / 3.0);
    let shapes = match ppm.layer(LayerKind::ShapeId).map(|l| l.channels) {
        Some(foton_film::LayerData::U32(plane)) => plane.values,
        _ => return false,
    };
    let corner = y as usize * TILE * SIDE as usize + x as usize * TILE;
    let pixels = (0..TILE).flat_map(|dy| (0..TILE).map(move |dx| corner + dy * SIDE as usize + dx));
    is_even && pixels.into_iter().all(|p| shapes[p] == shapes[corner])
}

fn row(name: &str, passes: u64, found: &[&Found]) {
    let n = found.len() as f64;
    let mean = |f: &dyn Fn(&Found) -> f64| found.iter().map(|x| f(x)).sum::<f64>() / n;
    let quotients: Vec<f64> = found.iter().map(|f| f.estimated[0] / f.truth).collect();
    let (least, most) = quotients.iter().fold((f64::MAX, 0f64), |(a, b), q| (a.min(*q), b.max(*q)));
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
        "| {name} | {passes} | {:.2} | {:.2} ({:.2}, {:.2}) | {:.2} ({least:.2}–{most:.2}) | {within}/{} | {} | {} |",
        100.0 * mean(&|f| f.truth),
        100.0 * mean(&|f| f.estimated[0]),
        100.0 * mean(&|f| f.estimated[1]),
        100.0 * mean(&|f| f.estimated[2]),
        mean(&|f| f.estimated[0] / f.truth),
        found.len(),
        coverage(0),
        coverage(1),
    );
}
