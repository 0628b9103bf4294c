//! Reflection and refraction at a smooth boundary of two dielectrics.

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
    let perpendicular = (eta * cos_here - cos_beyond) / (eta * cos_here + cos_beyond);
    let parallel = (cos_here - eta * cos_beyond) / (cos_here + eta * cos_beyond);
    let reflectance = 0.5 * (perpendicular * perpendicular + parallel * parallel);
    let refracted =
        Vec3::new((-eta * wo64.x) as f32, (-eta * wo64.y) as f32, (-cos_beyond).copysign(-wo64.z) as f32);
    Boundary {
        reflectance: reflectance as f32,
        refracted: Some(refracted.normalize()),
        relative_ior: eta as f32,
    }
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
    fn grazing_light_is_finite_and_reflected() {
        let got = dielectric(incident(89.999, 1.0), 1.5, 1.0);
        assert!(got.reflectance > 0.999 && got.refracted.is_some_and(Vec3::is_finite));
    }
}
