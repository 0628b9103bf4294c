//! Coatings: values against the published formula in double precision, what they return of a white furnace, and rough ones that become
//! smooth. The laws that hold for every BSDF hold for coated ones, too.

use std::f64::consts::PI;

use super::published::{DIRECTIONS, albedo, direction, sampled_albedo};
use super::*;

/// A coating of index 1.5 that absorbs.
fn coating(roughness: Option<Microfacets<f32>>, sigma_a: Rgb) -> Coating<Rgb, f32> {
    Coating {
        int_ior: 1.5,
        ext_ior: 1.0,
        thickness: 0.5,
        sigma_a,
        specular_reflectance: Rgb::WHITE,
        roughness,
    }
}

/// A BSDF under a coating.
fn over(bsdf: Bsdf<Rgb, f32>, coating: Coating<Rgb, f32>) -> Scattering {
    let described = coating.map(Into::into, |n, _| n.into());
    let coats = described.rough_coats(|n, _| [n.constant().unwrap_or(0.0); 2]);
    Scattering { bsdf, opacity: 1.0, coat: Some(Cover::Layer(coating.layer(coats.as_ref()))) }
}

const CLEAR: Rgb = Rgb::BLACK;

fn white() -> Bsdf<Rgb, f32> {
    Bsdf::Diffuse(Diffuse { reflectance: Rgb::WHITE })
}

/// Coated BSDFs of all kinds.
pub(super) fn coated() -> Vec<Scattering> {
    let amber = Rgb::new(0.1, 0.4, 2.0);
    let grey = Bsdf::Diffuse(Diffuse { reflectance: Rgb::new(0.2, 0.5, 0.8) });
    vec![
        over(grey, coating(None, amber)),
        over(grey, coating(rough(Ggx, 0.3), amber)),
        over(grey, coating(rough(Beckmann, 0.05), CLEAR)),
        over(gold(rough(Ggx, 0.25)), coating(None, CLEAR)),
        over(gold(rough(Ggx, 0.3)), coating(rough(Beckmann, 0.25), CLEAR)),
        over(gold(rough(Ggx, 0.05)), coating(rough(Beckmann, 0.08), amber)),
        over(gold(None), coating(None, amber)),
        over(plastic(true, None), coating(rough(Ggx, 0.3), CLEAR)),
        over(phong(12.0), coating(rough(Ggx, 0.25), CLEAR)),
        over(rough_diffuse(0.5, false), coating(None, CLEAR)),
        over(glass(rough(Ggx, 0.3)), coating(None, CLEAR)),
        over(
            Bsdf::DiffuseTransmitter(DiffuseTransmitter { transmittance: Rgb::splat(0.7) }),
            coating(None, amber),
        ),
    ]
}

/// Share of light that a smooth boundary from index 1 to 1.5 lets through at an angle, and the angle on the other side.
fn enters(theta: f64) -> (f64, f64) {
    let inner = (theta.sin() / 1.5).asin();
    let (a, b) = (theta.cos(), inner.cos());
    let [s, p] = [(a - 1.5 * b) / (a + 1.5 * b), (1.5 * a - b) / (1.5 * a + b)];
    (1.0 - 0.5 * (s * s + p * p), inner)
}

#[test]
fn coating_has_the_values_of_its_formula() {
    let sigma = Rgb::new(0.0, 0.8, 0.0);
    let s = over(Bsdf::Diffuse(Diffuse { reflectance: Rgb::splat(0.6) }), coating(None, sigma));
    for o in DIRECTIONS {
        for i in DIRECTIONS {
            let [(t_o, inner_o), (t_i, inner_i)] = [o, i].map(|[theta, _]| enters(theta.to_radians()));
            let path = 1.0 / inner_o.cos() + 1.0 / inner_i.cos();
            let wanted = 0.6 / PI * t_o * t_i * (-0.8 * 0.5 * path).exp() / (1.5 * 1.5);
            let value = f64::from(s.eval(direction(o), direction(i), ALL).g);
            assert!((value - wanted).abs() < 1e-4 * wanted, "{o:?} {i:?}: {value} {wanted}");
        }
    }
    // The mirror on top.
    let wo = direction([60.0, 20.0]);
    let lobes = s.lobes(wo, Transport::Radiance, Vec2::ZERO, LobeFlags::DELTA);
    let [lobe] = lobes.iter().flatten().collect::<Vec<_>>()[..] else { panic!("one lobe") };
    assert!((f64::from(lobe.weight.g) - (1.0 - enters(60f64.to_radians()).0)).abs() < 1e-6);
    assert!(lobe.wi.distance(Vec3::new(-wo.x, -wo.y, wo.z)) < 1e-6);
}

#[test]
fn coating_refracts_what_its_base_sees() {
    // A mirror under it mirrors; its light crosses the boundary twice.
    let s = over(Bsdf::Mirror(Mirror { reflectance: Rgb::WHITE }), coating(None, CLEAR));
    let wo = direction([50.0, 0.0]);
    let lobes = s.lobes(wo, Transport::Radiance, Vec2::ZERO, ALL);
    let sum: f32 = lobes.iter().flatten().map(|l| l.weight.g).sum();
    let through = enters(50f64.to_radians()).0;
    assert!((f64::from(sum) - (1.0 - through + through * through)).abs() < 1e-5, "{sum}");
    for lobe in lobes.iter().flatten() {
        assert!(lobe.wi.distance(Vec3::new(-wo.x, -wo.y, wo.z)) < 1e-5);
    }
}

#[test]
fn coating_returns_no_more_than_it_gets() {
    for coating in [coating(None, CLEAR), coating(None, Rgb::splat(0.5))] {
        for theta in [2.0, 40.0, 70.0, 85.0] {
            let s = over(white(), coating);
            let wo = direction([theta, 20.0]);
            let mirrored = 1.0 - enters(theta.to_radians()).0;
            let (exact, sampled) = (albedo(&s, wo) + mirrored, sampled_albedo(&s, wo));
            assert!((exact - sampled).abs() < 5e-3, "{theta}°: {exact}, {sampled} by sampling");
            assert!(exact < 1.0, "{theta}°: {exact}");
        }
    }
}

#[test]
fn roughcoating_returns_no_more_than_it_gets() {
    for alpha in [0.2, 0.5] {
        for base in [white(), gold(rough(Ggx, 0.3)), plastic(false, None)] {
            for theta in [2.0, 40.0, 70.0] {
                let s = over(base, coating(rough(Ggx, alpha), CLEAR));
                let wo = direction([theta, 20.0]);
                let delta = s.lobes(wo, Transport::Importance, Vec2::ZERO, LobeFlags::DELTA);
                let mirrored: f32 = delta.iter().flatten().map(|l| l.weight.g).sum();
                let (exact, sampled) = (albedo(&s, wo) + f64::from(mirrored), sampled_albedo(&s, wo));
                assert!((exact - sampled).abs() < 8e-3, "{alpha} {base:?} {theta}°: {exact}, {sampled}");
                assert!(exact < 1.0, "{alpha} {base:?} {theta}°: {exact}");
            }
        }
    }
}

#[test]
fn roughcoating_becomes_a_coating_as_its_roughness_vanishes() {
    let smooth = over(white(), coating(None, Rgb::splat(0.3)));
    let nearly = over(white(), coating(rough(Ggx, 1e-3), Rgb::splat(0.3)));
    for o in &DIRECTIONS[..5] {
        for i in &DIRECTIONS[..5] {
            let (wo, wi) = (direction(*o), direction(*i));
            let [a, b] = [&smooth, &nearly].map(|s| s.eval(wo, wi, LobeFlags::DIFFUSE).g);
            assert!((a - b).abs() < 1e-2 * a, "{o:?} {i:?}: {a} {b}");
        }
        let [a, b] =
            [&smooth, &nearly].map(|s| s.lobes(direction(*o), Transport::Radiance, Vec2::splat(0.4), ALL));
        let (a, b) = (a[3].expect("a mirror"), b[3].expect("nearly one"));
        assert!(a.wi.distance(b.wi) < 5e-3 && (a.weight.g - b.weight.g).abs() < 1e-3, "{o:?}");
    }
}

#[test]
fn roughcoating_has_the_values_of_its_formula() {
    // Facets by D G F / (4 cos cos), over a base that sees what gets through, which the series tells: to its accuracy.
    let r = Microfacets::isotropic(Beckmann, 0.3);
    let s = over(Bsdf::Diffuse(Diffuse { reflectance: Rgb::splat(0.6) }), coating(Some(r), CLEAR));
    let through = Coats::new(Beckmann, [0.3; 2], 1.5, 1.0).at(0.3);
    for o in DIRECTIONS {
        for i in DIRECTIONS {
            let (wo, wi) = (direction(o), direction(i));
            let facets = r.reflect(wo, wi, |cos| Rgb::splat(fresnel::reflectance(cos, 1.0, 1.5))).g;
            let base = 0.6 / PI as f32 * through.transmittance(wo.z) * through.transmittance(wi.z) / 2.25;
            let value = s.eval(wo, wi, ALL).g;
            assert!((value - facets - base).abs() < 2e-3 * value.max(0.01), "{o:?} {i:?}: {value}");
        }
    }
}
