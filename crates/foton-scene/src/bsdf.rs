//! What surfaces do with light: lobes of each BSDF, followed by eye paths and chosen by photons.
//!
//! Directions are local: z is the shading normal on the outside, `wo` points to where the path came from, `wi` to where it
//! goes. No texture lookups, no geometry: correcting for shading normals is the path's business.

use std::f32::consts::FRAC_1_PI;

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Rgb, warp};

use crate::description::Bsdf;
use crate::fresnel;

/// What flows along the path: it decides whether refraction scales by the squared relative index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transport {
    /// Eye paths: radiance is compressed or spread by refraction.
    Radiance,
    /// Photon paths: power is not.
    Importance,
}

/// A direction in which a delta lobe continues.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeltaLobe {
    /// Unit direction.
    pub wi: Vec3,
    /// What the path's weight is multiplied with when every lobe is followed.
    pub weight: Rgb,
    /// The chance with which a path that follows a single lobe should take this one; chances of all lobes sum to 1.
    pub probability: f32,
}

/// The kind of a lobe that a path took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lobe {
    /// Spread over the hemisphere.
    Diffuse,
    /// A single direction.
    Delta,
}

/// One direction chosen at random.
#[derive(Clone, Copy, Debug)]
pub struct BsdfSample {
    /// Unit direction.
    pub wi: Vec3,
    /// `f · |cos θ| / pdf`, the chance of the lobe included.
    pub weight: Rgb,
    /// What kind of lobe it came from.
    pub lobe: Lobe,
}

impl Bsdf {
    /// Whether all light goes into single directions: the eye follows them and no photon is stored.
    #[must_use]
    pub const fn is_delta(&self) -> bool {
        !matches!(self, Self::Diffuse { .. })
    }

    /// Whether light may pass to the other side.
    #[must_use]
    pub const fn transmits(&self) -> bool {
        matches!(self, Self::Dielectric { .. })
    }

    /// Share of light that the smooth lobes reflect in all, zero for delta BSDFs: `π f` for a diffuse one.
    #[must_use]
    pub const fn albedo(&self) -> Rgb {
        match self {
            Self::Diffuse { reflectance } => *reflectance,
            Self::Dielectric { .. } | Self::Mirror { .. } => Rgb::BLACK,
        }
    }

    /// The smooth lobes' value `f(wo, wi)`, without the cosine (sr⁻¹).
    #[must_use]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if wo.z * wi.z > 0.0 { self.albedo() * FRAC_1_PI } else { Rgb::BLACK }
    }

    /// The delta lobes, reflection before refraction; absent ones are `None`.
    #[must_use]
    pub fn delta_lobes(&self, wo: Vec3, transport: Transport) -> [Option<DeltaLobe>; 2] {
        let mirrored = Vec3::new(-wo.x, -wo.y, wo.z);
        match *self {
            Self::Diffuse { .. } => [None, None],
            Self::Mirror { reflectance } => {
                [Some(DeltaLobe { wi: mirrored, weight: reflectance, probability: 1.0 }), None]
            }
            Self::Dielectric { int_ior, ext_ior, specular_reflectance, specular_transmittance } => {
                let boundary = fresnel::dielectric(wo, int_ior, ext_ior);
                let f = boundary.reflectance;
                let reflected = (f > 0.0).then(|| DeltaLobe {
                    wi: mirrored,
                    weight: specular_reflectance * f,
                    probability: f,
                });
                let spread = match transport {
                    Transport::Radiance => boundary.relative_ior * boundary.relative_ior,
                    Transport::Importance => 1.0,
                };
                let refracted = boundary.refracted.filter(|_| f < 1.0).map(|wi| DeltaLobe {
                    wi,
                    weight: specular_transmittance * ((1.0 - f) * spread),
                    probability: 1.0 - f,
                });
                [reflected, refracted]
            }
        }
    }

    /// One delta lobe, chosen by `u` in [0, 1).
    #[must_use]
    pub fn choose_delta_lobe(&self, wo: Vec3, transport: Transport, u: f32) -> Option<DeltaLobe> {
        let [first, second] = self.delta_lobes(wo, transport);
        match (first, second) {
            (Some(a), Some(b)) => Some(if u < a.probability { a } else { b }),
            (a, b) => a.or(b),
        }
    }

    /// Chooses a direction for a photon that came from `wo`; `None` where nothing is scattered.
    #[must_use]
    pub fn sample(&self, wo: Vec3, transport: Transport, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        if let Self::Diffuse { reflectance } = *self {
            let wi = warp::square_to_cosine_hemisphere(u);
            let wi = if wo.z < 0.0 { -wi } else { wi };
            return Some(BsdfSample { wi, weight: reflectance, lobe: Lobe::Diffuse });
        }
        let lobe = self.choose_delta_lobe(wo, transport, u_lobe)?;
        Some(BsdfSample { wi: lobe.wi, weight: lobe.weight / lobe.probability, lobe: Lobe::Delta })
    }

    /// Density of the smooth lobes of [`Bsdf::sample`] per unit solid angle.
    #[must_use]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let same_side = wo.z * wi.z > 0.0;
        if same_side && !self.is_delta() {
            warp::square_to_cosine_hemisphere_pdf(Vec3::new(wi.x, wi.y, wi.z.abs()))
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foton_math::{Purpose, Stream};

    const GLASS: Bsdf = Bsdf::Dielectric {
        int_ior: 1.5,
        ext_ior: 1.0,
        specular_reflectance: Rgb::WHITE,
        specular_transmittance: Rgb::WHITE,
    };

    fn directions() -> impl Iterator<Item = Vec3> {
        let mut stream = Stream::new(2, Purpose::Test, 0, 0);
        (0..2000).map(move |_| warp::square_to_sphere(stream.next_2d()))
    }

    #[test]
    fn glass_loses_no_power() {
        for wo in directions() {
            let sum: f32 =
                GLASS.delta_lobes(wo, Transport::Importance).iter().flatten().map(|l| l.weight.r).sum();
            assert!((sum - 1.0).abs() < 1e-6, "{wo}");
        }
    }

    #[test]
    fn refraction_is_reversible_and_radiance_through_both_faces_is_unscaled() {
        for wo in directions() {
            let [_, Some(entry)] = GLASS.delta_lobes(wo, Transport::Radiance) else { continue };
            let [_, back] = GLASS.delta_lobes(entry.wi, Transport::Radiance);
            let back = back.expect("what came in can go out");
            assert!(back.wi.distance(wo) < 2e-4 / wo.z.abs().max(1e-2), "{wo}: {}", back.wi);
            // (1−F)·(η₁/η₂)² on the way in times (1−F)·(η₂/η₁)² on the way out.
            let through = entry.weight.r * back.weight.r;
            assert!((through - entry.probability * back.probability).abs() < 1e-5, "{wo}");
        }
    }

    #[test]
    fn diffuse_sampling_follows_its_density_and_is_reciprocal() {
        let diffuse = Bsdf::Diffuse { reflectance: Rgb::new(0.2, 0.5, 0.8) };
        let mut stream = Stream::new(5, Purpose::Test, 0, 0);
        for sign in [1.0, -1.0] {
            let wo = Vec3::new(0.3, 0.4, sign * 0.866).normalize();
            // ∫ pdf = 1 and E[weight] = albedo, by sampling the sphere and the BSDF against each other.
            let n = 200_000;
            let (mut integral, mut weight) = (0.0f64, 0.0f64);
            for _ in 0..n {
                let w = warp::square_to_sphere(stream.next_2d());
                integral += f64::from(diffuse.pdf(wo, w) / warp::square_to_sphere_pdf());
                let s = diffuse.sample(wo, Transport::Importance, 0.0, stream.next_2d()).expect("reflects");
                assert!(s.wi.z * sign >= 0.0);
                let expected = diffuse.eval(wo, s.wi) * (s.wi.z.abs() / diffuse.pdf(wo, s.wi));
                assert!((expected.g - s.weight.g).abs() < 1e-5);
                assert_eq!(diffuse.eval(wo, s.wi), diffuse.eval(s.wi, wo));
                weight += f64::from(s.weight.r);
            }
            assert!((integral / f64::from(n) - 1.0).abs() < 0.01, "{integral}");
            assert!((weight / f64::from(n) - 0.2).abs() < 1e-6);
        }
    }

    #[test]
    fn photons_choose_glass_lobes_in_proportion_to_fresnel() {
        let wo = Vec3::new(0.9, 0.0, 0.19f32.sqrt());
        let [Some(reflection), _] = GLASS.delta_lobes(wo, Transport::Importance) else { panic!("reflects") };
        let mut stream = Stream::new(9, Purpose::Test, 0, 0);
        let n = 100_000;
        let reflected = (0..n)
            .filter(|_| {
                let s =
                    GLASS.sample(wo, Transport::Importance, stream.next_1d(), Vec2::ZERO).expect("scatters");
                assert!((s.weight.r - 1.0).abs() < 1e-6);
                s.wi.z > 0.0
            })
            .count() as f32;
        let p = reflection.probability;
        let sigma = (p * (1.0 - p) * n as f32).sqrt();
        assert!((reflected - p * n as f32).abs() < 4.0 * sigma);
    }
}
