//! The principled models against the laws of BSDFs, but for the two that they break: a body's diffuse base makes energy, and what
//! passes through a sheet differs between two directions and their reverse. Here: all ways of sampling them.

mod laws;

use std::f32::consts::PI;

use foton_math::glam::Vec3;
use foton_math::{Purpose, Rgb, Stream, warp};

use super::{Principled, PrincipledThin};
use crate::bsdf::{Bsdf, LobeFlags, Scattering, Transport};

const ALL: LobeFlags = LobeFlags::ALL;
const RED: Rgb = Rgb::new(0.8, 0.4, 0.1);

const PLAIN: Principled<Rgb, f32> = Principled {
    base_color: RED,
    roughness: 0.5,
    anisotropic: 0.0,
    metallic: 0.0,
    spec_trans: 0.0,
    eta: 1.5,
    spec_tint: 0.0,
    sheen: 0.0,
    sheen_tint: 0.0,
    flatness: 0.0,
    clearcoat: 0.0,
    clearcoat_gloss: 0.0,
};

const SHEET: PrincipledThin<Rgb, f32> = PrincipledThin {
    base_color: RED,
    roughness: 0.6,
    anisotropic: 0.0,
    spec_trans: 0.0,
    diff_trans: 0.0,
    eta: 1.5,
    spec_tint: 0.0,
    sheen: 0.0,
    sheen_tint: 0.0,
    flatness: 0.0,
};

fn at(bsdf: Bsdf<Rgb, f32>) -> Scattering {
    Scattering { bsdf, opacity: 1.0, coat: None }
}

fn solids() -> Vec<Scattering> {
    [
        PLAIN,
        Principled { metallic: 1.0, anisotropic: 0.7, ..PLAIN },
        Principled { metallic: 0.4, spec_tint: 0.5, sheen: 0.8, sheen_tint: 0.6, flatness: 0.7, ..PLAIN },
        Principled { clearcoat: 1.0, ..PLAIN },
        Principled { clearcoat: 1.0, metallic: 0.7, roughness: 0.3, ..PLAIN },
        Principled { spec_trans: 1.0, roughness: 0.6, ..PLAIN },
        Principled { spec_trans: 0.5, clearcoat: 0.7, sheen: 0.4, metallic: 0.2, eta: 1.3, ..PLAIN },
        Principled { base_color: Rgb::BLACK, sheen: 1.0, roughness: 0.8, ..PLAIN },
    ]
    .map(|model| at(Bsdf::Principled(model)))
    .to_vec()
}

fn sheets() -> Vec<Scattering> {
    [
        SHEET,
        PrincipledThin { diff_trans: 0.8, sheen: 0.7, flatness: 0.5, ..SHEET },
        PrincipledThin { diff_trans: 2.0, ..SHEET },
        PrincipledThin { spec_trans: 1.0, anisotropic: 0.5, ..SHEET },
        PrincipledThin { spec_trans: 0.4, diff_trans: 1.0, spec_tint: 0.5, eta: 1.8, ..SHEET },
    ]
    .map(|model| at(Bsdf::PrincipledThin(model)))
    .to_vec()
}

fn all() -> Vec<Scattering> {
    [solids(), sheets()].concat()
}

fn views() -> [Vec3; 5] {
    [
        Vec3::Z,
        Vec3::new(0.6, 0.1, 0.7),
        Vec3::new(-0.9, 0.3, 0.3),
        Vec3::new(0.2, -0.5, -0.6),
        Vec3::new(0.9, 0.1, -0.2),
    ]
    .map(Vec3::normalize)
}

/// The sphere in bins of even solid angle.
const BINS: [usize; 2] = [12, 16];

fn bin(w: Vec3) -> usize {
    let row = ((w.z + 1.0) * 0.5 * BINS[0] as f32) as usize;
    let column = ((w.y.atan2(w.x) / (2.0 * PI) + 0.5) * BINS[1] as f32) as usize;
    row.min(BINS[0] - 1) * BINS[1] + column.min(BINS[1] - 1)
}

/// What a density brings to each bin.
fn expected(pdf: impl Fn(Vec3) -> f32) -> Vec<f64> {
    const FINE: usize = 40;
    let (rows, columns) = (BINS[0] * FINE, BINS[1] * FINE);
    let mut sums = vec![0.0; BINS[0] * BINS[1]];
    for i in 0..rows {
        let theta = PI * (i as f32 + 0.5) / rows as f32;
        for j in 0..columns {
            let phi = 2.0 * PI * ((j as f32 + 0.5) / columns as f32 - 0.5);
            let w = Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
            let solid_angle = PI / rows as f32 * 2.0 * PI / columns as f32 * theta.sin();
            sums[bin(w)] += f64::from(pdf(w) * solid_angle);
        }
    }
    sums
}

/// χ² of counts against what is expected, and the bound that one of 200 tests exceeds by chance once in a hundred times.
fn chi2(count: &[f64], expected: &[f64]) -> (f64, f64) {
    let (mut chi2, mut dof, mut rest) = (0.0, -1.0f64, (0.0, 0.0));
    for (&c, &e) in count.iter().zip(expected) {
        if e < 10.0 {
            rest = (rest.0 + c, rest.1 + e);
        } else {
            chi2 += (c - e).powi(2) / e;
            dof += 1.0;
        }
    }
    if rest.1 > 10.0 {
        chi2 += (rest.0 - rest.1).powi(2) / rest.1;
        dof += 1.0;
    }
    let k = 2.0 / (9.0 * dof.max(1.0));
    (chi2, dof.max(1.0) * (1.0 - k + 3.9 * k.sqrt()).powi(3))
}

#[test]
fn directions_follow_their_density() {
    const N: usize = 40_000;
    let mut stream = Stream::new(41, Purpose::Test, 0, 0);
    for s in all() {
        for wo in views().into_iter().filter(|w| w.z > 0.0 || s.bsdf.has_two_sides()) {
            let mut count = vec![0.0; BINS[0] * BINS[1]];
            for _ in 0..N {
                let (lobe, u) = (stream.next_1d(), stream.next_2d());
                if let Some(sample) = s.sample(wo, Transport::Radiance, lobe, u, LobeFlags::NONE) {
                    count[bin(sample.wi)] += 1.0;
                }
            }
            let expected: Vec<f64> = expected(|w| s.pdf(wo, w)).into_iter().map(|e| e * N as f64).collect();
            let (chi2, bound) = chi2(&count, &expected);
            assert!(chi2 < bound, "{s:?} {wo}: χ² {chi2}, bound {bound}");
        }
    }
}

#[test]
fn the_glossy_reflection_that_paths_follow_has_its_own_density() {
    const N: usize = 40_000;
    let mut stream = Stream::new(42, Purpose::Test, 0, 0);
    for s in all().into_iter().filter(|s| s.bsdf.flags().intersects(LobeFlags::GLOSSY)) {
        for wo in views().into_iter().filter(|w| w.z > 0.0 || s.bsdf.has_two_sides()) {
            let mut count = vec![0.0; BINS[0] * BINS[1]];
            for _ in 0..N {
                let [lobe, ..] = s.lobes(wo, Transport::Radiance, stream.next_2d(), LobeFlags::GLOSSY);
                if let Some(lobe) = lobe {
                    count[bin(lobe.wi)] += 1.0;
                    let value = s.eval(wo, lobe.wi, LobeFlags::GLOSSY) * lobe.wi.z.abs();
                    let expected = value / s.glossy_pdf(wo, lobe.wi);
                    let error = (expected - lobe.weight).map(f32::abs).max_component();
                    assert!(
                        error < 1e-2 * lobe.weight.max_component() + 1e-4,
                        "{s:?} {wo} {lobe:?} {expected:?}"
                    );
                }
            }
            let expected: Vec<f64> =
                expected(|w| s.glossy_pdf(wo, w)).into_iter().map(|e| e * N as f64).collect();
            let (chi2, bound) = chi2(&count, &expected);
            assert!(chi2 < bound, "{s:?} {wo}: χ² {chi2}, bound {bound}");
        }
    }
}

/// A function of directions that tells them apart.
fn tell(w: Vec3) -> f32 {
    1.0 + 0.5 * w.x + 0.3 * w.y * w.z + if w.z > 0.0 { 0.7 } else { 0.0 }
}

#[test]
fn weights_are_value_times_cosine_over_density() {
    let mut stream = Stream::new(43, Purpose::Test, 0, 0);
    for s in all() {
        for wo in views().into_iter().filter(|w| w.z > 0.0 || s.bsdf.has_two_sides()) {
            for _ in 0..2000 {
                let (lobe, u) = (stream.next_1d(), stream.next_2d());
                let sample = s.sample(wo, Transport::Radiance, lobe, u, LobeFlags::NONE);
                let Some(sample) = sample.filter(|sample| sample.wi.z.abs() > 1e-3) else { continue };
                let expected = s.eval(wo, sample.wi, ALL) * (sample.wi.z.abs() / s.pdf(wo, sample.wi));
                let error = (expected - sample.weight).map(f32::abs).max_component();
                assert!(
                    error <= 2e-2 * sample.weight.max_component().max(1e-3),
                    "{s:?} {wo} {sample:?} {expected:?}"
                );
                assert!((sample.wi.length() - 1.0).abs() < 1e-4, "{sample:?}");
            }
        }
    }
}

/// Mean and standard error.
fn mean(n: u32, mut next: impl FnMut() -> f32) -> (f64, f64) {
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..n {
        let x = f64::from(next());
        (sum, squares) = (sum + x, squares + x * x);
    }
    let mean = sum / f64::from(n);
    (mean, ((squares / f64::from(n) - mean * mean).max(0.0) / f64::from(n)).sqrt())
}

#[test]
fn all_ways_of_sampling_bring_the_light_that_the_value_says() {
    let glossy = LobeFlags::GLOSSY;
    for s in all() {
        for wo in views().into_iter().filter(|w| w.z > 0.0 || s.bsdf.has_two_sides()) {
            let mut stream = Stream::new(44, Purpose::Test, 0, 0);
            let truth = |lobes: LobeFlags, stream: &mut Stream| {
                mean(40_000, || {
                    let w = warp::square_to_sphere(stream.next_2d());
                    s.eval(wo, w, lobes).g * w.z.abs() * tell(w) / warp::square_to_sphere_pdf()
                })
            };
            let sampled = |apart: LobeFlags, counted: LobeFlags, stream: &mut Stream| {
                mean(40_000, || {
                    let (lobe, u) = (stream.next_1d(), stream.next_2d());
                    let sample = s.sample(wo, Transport::Radiance, lobe, u, apart);
                    let sample = sample.filter(|sample| sample.lobe.intersects(counted));
                    sample.map_or(0.0, |x| x.weight.g * tell(x.wi))
                })
            };
            let followed = |stream: &mut Stream| {
                mean(40_000, || {
                    let lobes = s.lobes(wo, Transport::Radiance, stream.next_2d(), glossy);
                    lobes.iter().flatten().map(|l| l.weight.g * tell(l.wi)).sum()
                })
            };
            let chosen = |stream: &mut Stream| {
                mean(40_000, || {
                    let (lobe, u) = (stream.next_1d(), stream.next_2d());
                    let lobe = s.choose_lobe(wo, Transport::Radiance, lobe, u, glossy);
                    lobe.map_or(0.0, |l| l.weight.g / l.probability * tell(l.wi))
                })
            };
            let whole = truth(ALL, &mut stream);
            let gloss = truth(glossy, &mut stream);
            for (name, truth, found) in [
                ("together", whole, sampled(LobeFlags::NONE, ALL, &mut stream)),
                ("apart", whole, sampled(glossy, ALL, &mut stream)),
                ("glossy", gloss, sampled(glossy, glossy, &mut stream)),
                ("followed", gloss, followed(&mut stream)),
                ("one followed", gloss, chosen(&mut stream)),
            ] {
                let sigma = truth.1.hypot(found.1);
                assert!(
                    (truth.0 - found.0).abs() < 4.5 * sigma + 1e-6,
                    "{name} {s:?} {wo}: {truth:?} {found:?}"
                );
            }
        }
    }
}

#[test]
fn photons_bring_the_light_that_is_seen() {
    // What a photon from the light brings to the view is what the view sees of the light, by the density of the photon's way.
    let mut stream = Stream::new(45, Purpose::Test, 0, 0);
    for s in all() {
        for light in views().into_iter().filter(|w| w.z > 0.0 || s.bsdf.has_two_sides()) {
            for _ in 0..2000 {
                let (lobe, u) = (stream.next_1d(), stream.next_2d());
                let sample = s.sample(light, Transport::Importance, lobe, u, LobeFlags::NONE);
                let Some(sample) = sample.filter(|sample| sample.wi.z.abs() > 1e-3) else { continue };
                let view = sample.wi;
                let expected = s.eval(view, light, ALL) * (view.z.abs() / s.pdf(light, view));
                let error = (expected - sample.weight).map(f32::abs).max_component();
                assert!(
                    error <= 2e-2 * sample.weight.max_component().max(1e-3),
                    "{s:?} {light} {sample:?} {expected:?}"
                );
            }
        }
    }
}
