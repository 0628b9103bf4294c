//! How fast noise and bias fall with passes, where the truth is known: a floor below a spot light, a shadow's edge across it.
//!
//! Shadow rays to a spot are exact, so at the same eye samples they are the truth. What hides the light is clipped away from the
//! camera.

use std::num::NonZeroU32;

use foton_integrator::{Alpha, DirectLight, PpmSettings, RadiusFloor, RadiusRule, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::{EmitterDescription, EmitterKind};

use crate::{Sketch, grey};

/// Pixels along a side of the image.
const SIDE: usize = 32;

/// First radius.
const RADIUS: f64 = 0.4;

/// Smooth pixels are within this distance of the light's foot, where light falls off to all sides and bias has one sign.
const SMOOTH: f64 = 0.3;

/// World units that a pixel covers.
const PIXEL: f64 = 1.865 / SIDE as f64;

/// Root mean squares after some passes, relative to the mean of the truth over all pixels.
#[derive(Clone, Copy, Debug, Default)]
pub struct Parts {
    /// Passes.
    pub passes: u64,
    /// What differs between seeds, where light is smooth.
    pub noise: f64,
    /// What does not: its mean, since it has one sign there.
    pub bias: f64,
    /// Both, where light is smooth.
    pub smooth: f64,
    /// Bias at the edge.
    pub edge_bias: f64,
    /// All of the error at the edge.
    pub edge: f64,
}

/// The floor, at the left in light and at the right in shadow.
#[must_use]
pub fn scene() -> Sketch {
    let mut sketch = Sketch::default()
        .camera(DVec3::new(0.3, 2.0, 0.001), DVec3::new(0.3, 0.0, 0.0), 50.0, SIDE as u32)
        .rectangle(DVec3::ZERO, DVec3::new(0.0, 0.0, 4.0), DVec3::new(4.0, 0.0, 0.0), grey(0.8), None)
        .rectangle(
            DVec3::new(0.55, 0.5, 0.0),
            DVec3::new(0.0, 0.0, 0.8),
            DVec3::new(0.25, 0.0, 0.0),
            grey(0.0),
            None,
        )
        .max_depth(2);
    // Straight down; no photon of a cone of 60° misses what the camera sees by much.
    let to_world = DAffine3::from_cols(DVec3::X, DVec3::Z, -DVec3::Y, DVec3::new(0.0, 0.8, 0.0));
    let kind = EmitterKind::Spot {
        to_world,
        intensity: Rgb::WHITE,
        cutoff_degrees: 60.0,
        beam_degrees: 60.0,
        texture: None,
    };
    sketch.0.emitters.push(EmitterDescription { name: "spot".into(), kind });
    sketch.0.sensors[0].near_clip = Some(1.7);
    sketch
}

fn settings(alpha: f64, photons: u32, seed: u64) -> RenderSettings {
    let photons = NonZeroU32::new(photons).expect("above 0");
    RenderSettings {
        samples_per_pixel: NonZeroU32::MIN,
        seed,
        ppm: PpmSettings {
            alpha: Alpha::new(alpha).expect("in (0, 1]"),
            photons_per_pass: photons,
            first_pass: photons,
            // Theory is of photons, and of radii that shrink by α alone.
            direct_light: DirectLight::Photons,
            radius: Some(RADIUS),
            radius_floor: RadiusFloor::NONE,
            radius_rule: RadiusRule::Local,
            // Densities of photons that change between passes would be no part of it either.
            guided: false,
            ..PpmSettings::default()
        },
        ..RenderSettings::default()
    }
}

/// Renders `seeds` runs and takes them apart at each of `checkpoints`, which ascend.
///
/// # Panics
/// With no checkpoints.
#[must_use]
pub fn measure(alpha: f64, photons: u32, seeds: u64, checkpoints: &[u64]) -> Vec<Parts> {
    let scene = scene().build().expect("a sound scene");
    let cancel = foton_integrator::Cancel::default();
    let start = |settings: RenderSettings, photons: u64| {
        let started = foton_integrator::Variants::start(&scene, &[settings], photons, &mut |_| (), &cancel);
        started.expect("not cancelled").expect("one variant")
    };
    // Eye samples of seed 0 for all: only photons differ.
    let base = settings(alpha, photons, 0);
    let mut exact = start(
        RenderSettings { ppm: PpmSettings { direct_light: DirectLight::ShadowRays, ..base.ppm }, ..base },
        0,
    );
    exact.advance(&mut |_| (), &cancel).expect("not cancelled");
    let light = |runs: &foton_integrator::Variants| -> Vec<f64> {
        runs.runs()[0].image().pixels.iter().map(|p| f64::from(p.luminance())).collect()
    };
    let truth = light(&exact);
    let mut sums = vec![vec![(0.0, 0.0); truth.len()]; checkpoints.len()];
    for seed in 0..seeds {
        let mut runs = start(base.clone(), seed + 1);
        let last = *checkpoints.last().expect("checkpoints");
        for pass in 1..=last {
            runs.advance(&mut |_| (), &cancel).expect("not cancelled");
            if let Some(i) = checkpoints.iter().position(|c| *c == pass) {
                for ((sum, squares), (x, y)) in sums[i].iter_mut().zip(light(&runs).iter().zip(&truth)) {
                    *sum += x - y;
                    *squares += (x - y) * (x - y);
                }
            }
        }
    }
    let (smooth, edge) = masks(&truth);
    let mean = truth.iter().sum::<f64>() / truth.len() as f64;
    let parts = |passes: u64, sums: &[(f64, f64)]| {
        let k = seeds as f64;
        let over = |mask: &[bool], f: &dyn Fn(f64, f64) -> f64| {
            let picked = sums.iter().zip(mask).filter(|(_, m)| **m);
            let (sum, n) = picked.fold((0.0, 0.0), |(sum, n), ((e, q), _)| (sum + f(*e, *q), n + 1.0));
            sum / n / (mean * mean)
        };
        let variance = |mask: &[bool]| over(mask, &|e, q| (q - e * e / k) / (k - 1.0));
        let bias2 = |mask: &[bool]| over(mask, &|e, _| (e / k) * (e / k)) - variance(mask) / k;
        let total = |mask: &[bool]| over(mask, &|_, q| q / k).sqrt();
        Parts {
            passes,
            noise: variance(&smooth).sqrt(),
            bias: (over(&smooth, &|e, _| e / k) * mean).abs(),
            smooth: total(&smooth),
            edge_bias: bias2(&edge).max(0.0).sqrt(),
            edge: total(&edge),
        }
    };
    checkpoints.iter().zip(&sums).map(|(&passes, sums)| parts(passes, sums)).collect()
}

/// Pixels around the light's foot, and all within half a first radius of both light and shadow.
fn masks(truth: &[f64]) -> (Vec<bool>, Vec<bool>) {
    let near = |pixel: usize, reach: f64, is: &dyn Fn(f64) -> bool| {
        let (x, y) = ((pixel % SIDE) as f64, (pixel / SIDE) as f64);
        truth.iter().enumerate().any(|(other, t)| {
            let d = ((other % SIDE) as f64 - x).hypot((other / SIDE) as f64 - y) * PIXEL;
            d <= reach && is(*t)
        })
    };
    let dark = |t: f64| t == 0.0;
    let lit = |t: f64| t > 0.0;
    let pixels = 0..truth.len();
    // The foot is where it is brightest.
    let brightest = truth.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(p, _)| p);
    let at = |p: usize| ((p % SIDE) as f64, (p / SIDE) as f64);
    let off = |p: usize| (at(p).0 - at(brightest).0).hypot(at(p).1 - at(brightest).1) * PIXEL;
    let smooth = pixels.clone().map(|p| off(p) <= SMOOTH).collect();
    (smooth, pixels.map(|p| near(p, 0.5 * RADIUS, &dark) && near(p, 0.5 * RADIUS, &lit)).collect())
}

/// The slope of log y over log x by least squares.
#[must_use]
pub fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let (mx, my) = logs.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + x / n, b + y / n));
    let (xy, xx) =
        logs.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + (x - mx) * (y - my), b + (x - mx).powi(2)));
    xy / xx
}

/// The slope of one of the parts over passes.
#[must_use]
pub fn slope_of(parts: &[Parts], f: impl Fn(&Parts) -> f64) -> f64 {
    slope(&parts.iter().map(|p| (p.passes as f64, f(p))).collect::<Vec<_>>())
}
