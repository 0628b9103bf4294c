//! Reflection and refraction at smooth boundaries: of two dielectrics, and of a metal.

use foton_math::Rgb;
use foton_math::glam::Vec3;

/// What a smooth dielectric boundary does with light that arrives from `wo`'s side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Boundary {
    /// Share reflected, averaged over polarisations.
    pub(crate) reflectance: f32,
    /// Where the rest goes, a unit vector in the frame of `wo`; `None` at total internal reflection.
    pub(crate) refracted: Option<Vec3>,
    /// Index of refraction on `wo`'s side, divided by that on the other.
    pub(crate) relative_ior: f32,
}

/// Fresnel's equations and Snell's law for a direction `wo` in a frame whose +z side has the index `ext_ior`.
///
/// In double precision: near the critical angle the cosine of refraction is the root of a small difference.
pub(crate) fn dielectric(wo: Vec3, int_ior: f32, ext_ior: f32) -> Boundary {
    let (here, beyond) = if wo.z >= 0.0 { (ext_ior, int_ior) } else { (int_ior, ext_ior) };
    if here == beyond {
        return Boundary { reflectance: 0.0, refracted: Some(-wo), relative_ior: 1.0 };
    }
    let wo64 = wo.as_dvec3();
    let eta = f64::from(here) / f64::from(beyond);
    let sin2_beyond = eta * eta * (wo64.x * wo64.x + wo64.y * wo64.y) / wo64.length_squared();
    if sin2_beyond >= 1.0 {
        return Boundary { reflectance: 1.0, refracted: None, relative_ior: eta as f32 };
    }
    let cos_here = wo64.z.abs() / wo64.length();
    let cos_beyond = (1.0 - sin2_beyond).sqrt();
    let refracted =
        Vec3::new((-eta * wo64.x) as f32, (-eta * wo64.y) as f32, (-cos_beyond).copysign(-wo64.z) as f32);
    Boundary {
        reflectance: unpolarised(eta, cos_here, cos_beyond),
        refracted: Some(refracted.normalize()),
        relative_ior: eta as f32,
    }
}

/// [`Boundary::reflectance`] at the cosine `cos` of incidence on the side of the index `here`.
pub(crate) fn reflectance(cos: f32, here: f32, beyond: f32) -> f32 {
    if here == beyond {
        return 0.0;
    }
    let cos = f64::from(cos.clamp(0.0, 1.0));
    let eta = f64::from(here) / f64::from(beyond);
    let cos2_beyond = 1.0 - eta * eta * (1.0 - cos * cos);
    if cos2_beyond > 0.0 { unpolarised(eta, cos, cos2_beyond.sqrt()) } else { 1.0 }
}

/// Fresnel's equations, the mean of both polarisations, `eta` being the index here over that beyond.
fn unpolarised(eta: f64, cos_here: f64, cos_beyond: f64) -> f32 {
    let perpendicular = (eta * cos_here - cos_beyond) / (eta * cos_here + cos_beyond);
    let parallel = (cos_here - eta * cos_beyond) / (cos_here + eta * cos_beyond);
    (0.5 * (perpendicular * perpendicular + parallel * parallel)) as f32
}

/// Share of unpolarised light that a metal of complex index `eta + i k` reflects at the cosine `cos` of incidence, per channel.
///
/// The exact equations, as in `[PBR16]` section 8.2.1.
pub(crate) fn conductor(cos: f32, eta: Rgb, k: Rgb) -> Rgb {
    let cos = f64::from(cos.clamp(0.0, 1.0));
    let cos2 = cos * cos;
    let sin2 = 1.0 - cos2;
    let channel = |eta: f32, k: f32| {
        let (eta2, k2) = (f64::from(eta).powi(2), f64::from(k).powi(2));
        let t0 = eta2 - k2 - sin2;
        let a2_plus_b2 = (t0 * t0 + 4.0 * eta2 * k2).sqrt();
        let t1 = a2_plus_b2 + cos2;
        let t2 = 2.0 * cos * (0.5 * (a2_plus_b2 + t0)).max(0.0).sqrt();
        let perpendicular = (t1 - t2) / (t1 + t2);
        let t3 = cos2 * a2_plus_b2 + sin2 * sin2;
        let t4 = t2 * sin2;
        let parallel = perpendicular * (t3 - t4) / (t3 + t4);
        (0.5 * (perpendicular + parallel)) as f32
    };
    Rgb::new(channel(eta.r, k.r), channel(eta.g, k.g), channel(eta.b, k.b))
}

/// Share of diffuse light that a boundary reflects, 2 ∫ F(cos) cos dcos, with `eta` the index beyond over that here.
///
/// The fits of d'Eon and Irving (2011), good to half a percent for indices from 1 to 2. `[EI11]`
pub(crate) fn diffuse_reflectance(eta: f32) -> f32 {
    let inverse = 1.0 / eta;
    if eta < 1.0 {
        return -1.4399 * eta * eta + 0.7099 * eta + 0.6681 + 0.0636 * inverse;
    }
    let coefficients = [-1.36881f32, 4.98554, -7.80989, 6.75335, -3.4793, 0.919317];
    coefficients.into_iter().fold(0.0, |sum, c| sum * inverse + c)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn incident(degrees: f64, sign: f32) -> Vec3 {
        let (s, c) = degrees.to_radians().sin_cos();
        Vec3::new(s as f32, 0.0, c as f32 * sign)
    }

    /// The textbook form, in double precision, from the angle itself.
    fn textbook(degrees: f64, here: f64, beyond: f64) -> Option<(f64, f64)> {
        let i = degrees.to_radians();
        let sin_t = here / beyond * i.sin();
        (sin_t < 1.0).then(|| {
            let t = sin_t.asin();
            let rs = (here * i.cos() - beyond * t.cos()) / (here * i.cos() + beyond * t.cos());
            let rp = (beyond * i.cos() - here * t.cos()) / (beyond * i.cos() + here * t.cos());
            (0.5 * (rs * rs + rp * rp), t)
        })
    }

    #[test]
    fn reflectance_and_angle_agree_with_the_textbook_form_from_both_sides() {
        for step in 1..900 {
            let degrees = f64::from(step) * 0.1;
            for (sign, here, beyond) in [(1.0, 1.0, 1.5), (-1.0, 1.5, 1.0)] {
                let got = dielectric(incident(degrees, sign), 1.5, 1.0);
                match textbook(degrees, here, beyond) {
                    // The direction itself is rounded to single precision, which near 41.8° moves the result more.
                    Some(_) if (degrees - 41.81).abs() < 0.2 && sign < 0.0 => {}
                    Some((reflectance, t)) => {
                        assert!((f64::from(got.reflectance) - reflectance).abs() < 1e-6, "{degrees} {sign}");
                        let sine = f64::from(-got.refracted.expect("not total").x);
                        assert!((sine - t.sin()).abs() < 1e-6, "{degrees} {sign}");
                    }
                    None => assert_eq!((got.reflectance, got.refracted), (1.0, None), "{degrees} {sign}"),
                }
            }
        }
    }

    #[test]
    fn equal_indices_change_nothing_and_a_huge_one_mirrors_by_the_normal_formula() {
        let wo = incident(63.0, 1.0);
        assert_eq!(
            dielectric(wo, 1.3, 1.3),
            Boundary { reflectance: 0.0, refracted: Some(-wo), relative_ior: 1.0 }
        );
        let expected = (999.0f64 / 1001.0).powi(2);
        assert!((f64::from(dielectric(Vec3::Z, 1000.0, 1.0).reflectance) - expected).abs() < 1e-6);
    }

    #[test]
    fn a_metal_reflects_as_its_textbook_values_say() {
        // At normal incidence ((n−1)² + k²)/((n+1)² + k²); at grazing incidence everything.
        let (eta, k) = (Rgb::new(0.143, 0.375, 1.442), Rgb::new(3.983, 2.386, 1.603));
        let normal = |n: f32, k: f32| ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k);
        let got = conductor(1.0, eta, k);
        assert!((got.r - normal(eta.r, k.r)).abs() < 1e-6 && (got.b - normal(eta.b, k.b)).abs() < 1e-6);
        assert!((conductor(0.0, eta, k).g - 1.0).abs() < 1e-6);
        // Without absorption a metal is a dielectric.
        let wo = incident(50.0, 1.0);
        let glass = conductor(wo.z, Rgb::splat(1.5), Rgb::BLACK);
        assert!((glass.r - dielectric(wo, 1.5, 1.0).reflectance).abs() < 1e-6);
    }

    #[test]
    fn the_fit_of_diffuse_reflectance_is_its_integral() {
        let integral = |eta: f32| {
            let n = 4096;
            let sum: f64 = (0..n)
                .map(|i| {
                    let cos = (f64::from(i) + 0.5) / f64::from(n);
                    let wo = Vec3::new((1.0 - cos * cos).sqrt() as f32, 0.0, cos as f32);
                    f64::from(dielectric(wo, eta, 1.0).reflectance) * cos
                })
                .sum();
            2.0 * sum / f64::from(n)
        };
        for eta in [1.2, 1.33, 1.5, 1.8] {
            for eta in [eta, 1.0 / eta] {
                let fit = f64::from(diffuse_reflectance(eta));
                assert!((fit - integral(eta)).abs() < 5e-3, "{eta}: {fit} {}", integral(eta));
            }
        }
    }

    #[test]
    fn grazing_light_is_finite_and_reflected() {
        let got = dielectric(incident(89.999, 1.0), 1.5, 1.0);
        assert!(got.reflectance > 0.999 && got.refracted.is_some_and(Vec3::is_finite));
    }
}
