//! Energy, reciprocity, extremes, and which lobes there are.

use std::f32::consts::PI;

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Purpose, Rgb, Stream, warp};

use super::{ALL, PLAIN, RED, SHEET, at, mean, solids};
use crate::bsdf::{Bsdf, LobeFlags, Principled, PrincipledThin, Scattering, Transport};

#[test]
fn a_body_is_reciprocal_up_to_the_squared_index() {
    let mut stream = Stream::new(46, Purpose::Test, 0, 0);
    for s in solids() {
        let Bsdf::Principled(model) = s.bsdf else { panic!("a body") };
        for _ in 0..2000 {
            let [a, b] = [0; 2].map(|_| warp::square_to_sphere(stream.next_2d()));
            if !s.bsdf.transmits() && (a.z < 0.0 || b.z < 0.0) {
                continue;
            }
            let ior = |w: Vec3| if w.z > 0.0 { 1.0 } else { model.eta };
            let scale = if a.z * b.z < 0.0 { (ior(a) / ior(b)).powi(2) } else { 1.0 };
            let (forth, back) = (s.eval(a, b, ALL).g, s.eval(b, a, ALL).g * scale);
            assert!((forth - back).abs() <= 2e-3 * forth.abs().max(1e-3), "{s:?} {a} {b}: {forth} {back}");
        }
    }
}

/// Share of light of a white surface that leaves it.
fn albedo(s: &Scattering, wo: Vec3) -> f64 {
    let mut stream = Stream::new(47, Purpose::Test, 0, 0);
    let found = mean(60_000, || {
        let (lobe, u) = (stream.next_1d(), stream.next_2d());
        let sample = s.sample(wo, Transport::Importance, lobe, u, LobeFlags::NONE);
        sample.map_or(0.0, |x| x.weight.max_component())
    });
    found.0 - 3.0 * found.1
}

#[test]
fn only_a_bodys_diffuse_base_makes_energy_and_no_more_than_is_known() {
    let white = Principled { base_color: Rgb::WHITE, ..PLAIN };
    let sheet = PrincipledThin { base_color: Rgb::WHITE, ..SHEET };
    for roughness in [0.1, 0.5, 1.0] {
        for cos in [1.0f32, 0.6, 0.2, 0.05] {
            let wo = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
            let metal = at(Bsdf::Principled(Principled { metallic: 1.0, roughness, ..white }));
            let glass = at(Bsdf::Principled(Principled { spec_trans: 1.0, roughness, ..white }));
            let pane = at(Bsdf::PrincipledThin(PrincipledThin { spec_trans: 1.0, roughness, ..sheet }));
            for s in [metal, glass, pane] {
                assert!(albedo(&s, wo) < 1.0, "{s:?} {wo}: {}", albedo(&s, wo));
            }
            let dull = at(Bsdf::Principled(Principled { roughness, ..white }));
            let most = if cos == 1.0 { 1.07 } else { 1.7 };
            assert!(albedo(&dull, wo) < most, "{roughness} {cos}: {}", albedo(&dull, wo));
        }
    }
}

#[test]
fn extremes_are_finite() {
    let mut stream = Stream::new(48, Purpose::Test, 0, 0);
    let grazing = |z: f32| Vec3::new((1.0 - z * z).sqrt(), 0.0, z);
    let views = [Vec3::Z, grazing(1e-3), grazing(1e-6), grazing(-1e-4), -Vec3::Z];
    let mut pick = |values: &[f32]| values[(stream.next_1d() * values.len() as f32) as usize % values.len()];
    let mut u = Stream::new(49, Purpose::Test, 0, 0);
    for _ in 0..3000 {
        let ends = &[0.0, 1.0];
        let body = Principled {
            base_color: [Rgb::BLACK, Rgb::WHITE, RED][pick(&[0.0, 1.0, 2.0]) as usize],
            roughness: pick(&[0.0, 0.01, 1.0]),
            anisotropic: pick(ends),
            metallic: pick(ends),
            spec_trans: pick(ends),
            eta: pick(&[0.3, 1.0, 1.000_01, 1.5, 10.0]),
            spec_tint: pick(ends),
            sheen: pick(&[0.0, 100.0]),
            sheen_tint: pick(ends),
            flatness: pick(ends),
            clearcoat: pick(&[0.0, 1.0, 100.0]),
            clearcoat_gloss: pick(ends),
        };
        let Principled { base_color, roughness, anisotropic, spec_trans, eta, spec_tint, .. } = body;
        let Principled { sheen, sheen_tint, flatness, .. } = body;
        let diff_trans = 2.0 * body.metallic;
        let sheet = PrincipledThin {
            base_color,
            roughness,
            anisotropic,
            spec_trans,
            diff_trans,
            eta,
            spec_tint,
            sheen,
            sheen_tint,
            flatness,
        };
        for s in [at(Bsdf::Principled(body)), at(Bsdf::PrincipledThin(sheet))] {
            for wo in views {
                let sample = s.sample(
                    wo,
                    Transport::Radiance,
                    u.next_1d(),
                    u.next_2d(),
                    [LobeFlags::NONE, ALL][usize::from(u.next_1d() < 0.5)],
                );
                let lobes = s.lobes(wo, Transport::Importance, u.next_2d(), ALL);
                let weights = lobes.iter().flatten().map(|l| (l.wi, l.weight * l.probability));
                for (wi, weight) in weights.chain(sample.map(|x| (x.wi, x.weight))) {
                    assert!(weight.is_finite() && wi.is_finite(), "{s:?} {wo} {wi} {weight:?}");
                    let (value, pdf) = (s.eval(wo, wi, ALL), s.pdf(wo, wi) + s.glossy_pdf(wo, wi));
                    assert!(
                        value.to_array().iter().all(|v| *v >= 0.0) && pdf >= 0.0,
                        "{s:?} {wo} {wi} {value:?} {pdf}"
                    );
                }
            }
        }
    }
}

#[test]
fn lobes_are_told_by_how_paths_treat_them() {
    let flags = |model: Principled<Rgb, f32>| model.flags();
    let (diffuse, glossy) = (LobeFlags::DIFFUSE, LobeFlags::GLOSSY);
    let (reflection, transmission) = (LobeFlags::REFLECTION, LobeFlags::TRANSMISSION);
    assert_eq!(flags(PLAIN), diffuse | glossy | reflection);
    assert_eq!(flags(Principled { metallic: 1.0, ..PLAIN }), glossy | reflection);
    // The wide highlight of a metal under a coat is gathered, the coat's is followed.
    let car = Principled { metallic: 1.0, clearcoat: 1.0, clearcoat_gloss: 0.9, ..PLAIN };
    assert_eq!(flags(car), diffuse | glossy | reflection);
    let gloss = at(Bsdf::Principled(car)).bsdf.gloss();
    assert!(gloss.is_some_and(|alpha| alpha < 0.02), "{gloss:?}");
    let wi = Vec3::new(0.3, 0.0, 0.9).normalize();
    let value = |lobes| at(Bsdf::Principled(car)).eval(Vec3::Z, wi, lobes).g;
    assert!(value(diffuse) > 0.1 && value(glossy) < 0.05, "{} {}", value(diffuse), value(glossy));
    // A narrow highlight under the coat is followed with it.
    let polished = Principled { roughness: 0.2, ..car };
    assert_eq!(flags(polished), glossy | reflection);
    assert_eq!(flags(Principled { spec_trans: 1.0, ..PLAIN }), glossy | reflection | transmission);
    assert_eq!(flags(Principled { spec_trans: 1.0, metallic: 1.0, ..PLAIN }), glossy | reflection);
    let thin = |model: PrincipledThin<Rgb, f32>| model.flags();
    assert_eq!(thin(SHEET), diffuse | reflection);
    assert_eq!(thin(PrincipledThin { diff_trans: 0.1, ..SHEET }), diffuse | reflection | transmission);
    assert_eq!(thin(PrincipledThin { spec_trans: 1.0, ..SHEET }), glossy | reflection | transmission);
}

#[test]
fn sharp_coats_keep_their_digits() {
    // The coat of α = 0.001 at its peak: (1 − α²) / (−π ln α² · α²).
    let coat = Principled {
        metallic: 0.0,
        base_color: Rgb::BLACK,
        eta: 1.0,
        clearcoat: 1.0,
        clearcoat_gloss: 1.0,
        ..PLAIN
    };
    let peak = (1.0 - 1e-6) / (PI * -(1e-6f32).ln() * 1e-6);
    let value = at(Bsdf::Principled(coat)).eval(Vec3::Z, Vec3::Z, LobeFlags::GLOSSY).g;
    assert!((value / (peak * 0.25 * 0.04) - 1.0).abs() < 1e-3, "{value}");
    let u = Vec2::new(0.5, 0.3);
    let [Some(lobe), ..] = at(Bsdf::Principled(coat)).lobes(Vec3::Z, Transport::Radiance, u, ALL) else {
        panic!("a coat reflects")
    };
    // Half of the facets lie within sin² < α² (α^-1 − 1)…
    assert!(lobe.wi.z > 0.99 && lobe.wi.z < 1.0, "{lobe:?}");
}
