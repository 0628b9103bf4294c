//! Fresnel's equations and Snell's law at smooth glass.

use foton_math::Rgb;
use foton_math::glam::{DVec3, Vec2, Vec3};
use foton_scene::description::{Bsdf, Dielectric};
use foton_scene::{LobeFlags, Scattering, Transport};

use super::Worst;
use crate::{cases, direction, grazing, log_uniform, stream};

fn glass(int_ior: f32, ext_ior: f32) -> Scattering {
    let (specular_reflectance, specular_transmittance) = (Rgb::WHITE, Rgb::WHITE);
    let bsdf = Bsdf::Dielectric(Dielectric {
        int_ior,
        ext_ior,
        specular_reflectance,
        specular_transmittance,
        roughness: None,
    });
    Scattering { bsdf, opacity: 1.0, coat: None }
}

/// Reflectance and the refracted direction by the textbook, from the angle's sine and cosine; `None`: all is reflected.
fn textbook(wo: DVec3, here: f64, beyond: f64) -> Option<(f64, DVec3)> {
    let wo = wo.normalize();
    let eta = here / beyond;
    let (cos_i, sin2_t) = (wo.z.abs(), eta * eta * (wo.x * wo.x + wo.y * wo.y));
    (sin2_t < 1.0).then(|| {
        let cos_t = (1.0 - sin2_t).sqrt();
        let rs = (here * cos_i - beyond * cos_t) / (here * cos_i + beyond * cos_t);
        let rp = (beyond * cos_i - here * cos_t) / (beyond * cos_i + here * cos_t);
        let refracted = DVec3::new(-eta * wo.x, -eta * wo.y, -cos_t * wo.z.signum());
        (0.5 * (rs * rs + rp * rp), refracted)
    })
}

/// What the code says: reflectance, and where the rest goes.
fn found(wo: Vec3, int_ior: f32, ext_ior: f32) -> (f64, Option<DVec3>) {
    let [reflection, refraction, ..] =
        glass(int_ior, ext_ior).lobes(wo, Transport::Importance, Vec2::ZERO, LobeFlags::ALL);
    let reflected = reflection.map_or(0.0, |l| f64::from(l.weight.r));
    (reflected, refraction.map(|l| l.wi.as_dvec3()))
}

#[test]
fn reflectance_and_refraction_are_those_of_double_precision() {
    let mut stream = stream(80);
    let (mut reflectance, mut angle, mut total) = (Worst::default(), Worst::default(), 0);
    for _ in 0..cases(1_000_000) {
        let ior = match (stream.next_1d() * 4.0) as u32 {
            0 => 1.0 + log_uniform([1e-6, 1e-2], &mut stream),
            1 => log_uniform([3.0, 1e3], &mut stream),
            _ => 1.0 + 2.0 * f64::from(stream.next_1d()),
        } as f32;
        let side = if stream.next_1d() < 0.5 { 1.0 } else { -1.0 };
        // Anywhere, nearly along the surface, and around the critical angle.
        let wo = match (stream.next_1d() * 3.0) as u32 {
            0 => direction(&mut stream),
            1 => grazing(Vec3::Z, side * log_uniform([1e-7, 1e-2], &mut stream), &mut stream),
            _ => {
                let sine = (1.0 / f64::from(ior)) * (1.0 + side * log_uniform([1e-8, 1e-3], &mut stream));
                grazing(-Vec3::Z, (1.0 - sine.min(1.0).powi(2)).sqrt(), &mut stream)
            }
        };
        if !wo.is_finite() {
            // One in millions of random tangents has no length.
            continue;
        }
        let (here, beyond) = if wo.z >= 0.0 { (1.0, f64::from(ior)) } else { (f64::from(ior), 1.0) };
        let (f, refracted) = found(wo, ior, 1.0);
        match textbook(wo.as_dvec3(), here, beyond) {
            None => {
                assert_eq!((f, refracted), (1.0, None), "{wo} at {ior}");
                total += 1;
            }
            Some((expected, direction)) => {
                reflectance.add((f - expected).abs());
                // All but nothing is reflected where the rest rounds to nothing.
                if let Some(refracted) = refracted {
                    angle.add(refracted.distance(direction));
                }
            }
        }
    }
    eprintln!("reflectance {reflectance}; refracted direction {angle}; {total} reflected totally");
    assert!(reflectance.largest < 1e-6 && angle.largest < 1e-6, "{reflectance} {angle}");
    assert!(total > cases(100_000), "{total}");
}

/// A direction itself is rounded, and at the critical angle that is magnified to its root: 10⁻⁷ to some 10⁻³.
#[test]
fn at_the_critical_angle_the_rounding_of_directions_is_all_that_is_felt() {
    let mut stream = stream(81);
    let (mut far, mut near) = (Worst::default(), Worst::default());
    for _ in 0..cases(300_000) {
        let ior = 1.05 + 1.5 * f64::from(stream.next_1d());
        let ior = f64::from(ior as f32);
        let beside = log_uniform([1e-9, 0.1], &mut stream);
        let sine = (1.0 / ior) * (1.0 - beside);
        let turn = std::f64::consts::TAU * f64::from(stream.next_1d());
        let exact = DVec3::new(sine * turn.cos(), sine * turn.sin(), -(1.0 - sine * sine).sqrt());
        let (expected, _) = textbook(exact, ior, 1.0).expect("below the critical angle");
        let (f, _) = found(exact.as_vec3(), ior as f32, 1.0);
        let worst = if beside > 1e-3 { &mut far } else { &mut near };
        worst.add((f - expected).abs());
    }
    eprintln!(
        "reflectance by rounded directions: {far} a thousandth and more off the critical angle, {near} nearer"
    );
    assert!(far.largest < 1e-4 && near.largest < 1e-2, "{far} {near}");
}
