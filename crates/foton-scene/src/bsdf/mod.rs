//! What surfaces do with light: lobes of each BSDF, split into those that eye paths follow and those that hit points keep.
//!
//! Directions are local: z is the shading normal on the outside, `wo` points to where the path came from, `wi` to where it
//! goes. No texture lookups, no geometry: correcting for shading normals is the path's business.
//!
//! A lobe is *followed* if it is a single direction or narrower than [`MAX_SPECULAR_ROUGHNESS`]: a hit point there would find
//! photons in a sliver of directions only. All others are *kept*: hit points weigh photons with them. Light refracted by
//! rough glass is always followed, since photons would have to be looked for on both sides.

mod coat;
mod fresnel;
mod glass;
mod lobe;
mod microfacet;
mod plastic;
mod reflect;

use std::f32::consts::FRAC_1_PI;

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Rgb, warp};

use crate::description::{Bsdf, Microfacets};
pub use coat::Coat;
use glass::{glass_lobes, rough_glass, rough_glass_pdf};
pub use lobe::{BsdfSample, LOBES, Lobe, SpecularLobe, Transport};
use reflect::{cosine, facet_density, mirrored, rough_metal, single};

/// Lobes of at most this roughness α are followed by eye paths. Below it a lobe is narrower than about 6° and a hit point
/// would weigh a few photons very much and most not at all.
pub const MAX_SPECULAR_ROUGHNESS: f32 = 0.1;

/// A BSDF at a point of a surface: colours looked up, and how much of the surface is there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattering {
    /// The BSDF.
    pub bsdf: Bsdf<Rgb>,
    /// Share of light that meets the surface; the rest passes straight through.
    pub opacity: f32,
    /// What gets through its coat, where that is rough.
    pub coat: Option<Coat>,
}

impl Microfacets {
    /// Whether eye paths follow a lobe of this roughness.
    const fn is_specular(&self) -> bool {
        self.widest() <= MAX_SPECULAR_ROUGHNESS
    }
}

impl<C: Copy> Bsdf<C> {
    /// Whether hit points keep any of its lobes.
    #[must_use]
    pub fn gathers(&self) -> bool {
        match self {
            Self::Diffuse { .. } | Self::Plastic { .. } => true,
            Self::Conductor { roughness, .. } => roughness.is_some_and(|r| !r.is_specular()),
            Self::Dielectric { .. } | Self::ThinDielectric { .. } | Self::Mirror { .. } | Self::Null => false,
        }
    }

    /// Whether eye paths follow any of its lobes.
    #[must_use]
    pub fn has_specular(&self) -> bool {
        match self {
            Self::Diffuse { .. } => false,
            Self::Conductor { roughness, .. } | Self::Plastic { roughness, .. } => {
                roughness.is_none_or(|r| r.is_specular())
            }
            Self::Dielectric { .. } | Self::ThinDielectric { .. } | Self::Mirror { .. } | Self::Null => true,
        }
    }

    /// Whether it describes both sides of the surface by itself, since light passes through.
    #[must_use]
    pub const fn transmits(&self) -> bool {
        matches!(self, Self::Dielectric { .. } | Self::ThinDielectric { .. } | Self::Null)
    }

    /// Its microfacets, if any.
    #[must_use]
    pub const fn roughness(&self) -> Option<Microfacets> {
        match self {
            Self::Dielectric { roughness, .. }
            | Self::Conductor { roughness, .. }
            | Self::Plastic { roughness, .. } => *roughness,
            _ => None,
        }
    }

    /// The same BSDF with its colours replaced.
    #[inline]
    pub fn map<D>(&self, mut f: impl FnMut(C) -> D) -> Bsdf<D> {
        match *self {
            Self::Diffuse { reflectance } => Bsdf::Diffuse { reflectance: f(reflectance) },
            Self::Dielectric {
                int_ior,
                ext_ior,
                specular_reflectance,
                specular_transmittance,
                roughness,
            } => Bsdf::Dielectric {
                int_ior,
                ext_ior,
                specular_reflectance: f(specular_reflectance),
                specular_transmittance: f(specular_transmittance),
                roughness,
            },
            Self::ThinDielectric { int_ior, ext_ior, specular_reflectance, specular_transmittance } => {
                Bsdf::ThinDielectric {
                    int_ior,
                    ext_ior,
                    specular_reflectance: f(specular_reflectance),
                    specular_transmittance: f(specular_transmittance),
                }
            }
            Self::Mirror { reflectance } => Bsdf::Mirror { reflectance: f(reflectance) },
            Self::Conductor { eta, k, specular_reflectance, roughness } => {
                Bsdf::Conductor { eta, k, specular_reflectance: f(specular_reflectance), roughness }
            }
            Self::Plastic {
                int_ior,
                ext_ior,
                diffuse_reflectance,
                specular_reflectance,
                nonlinear,
                roughness,
            } => Bsdf::Plastic {
                int_ior,
                ext_ior,
                diffuse_reflectance: f(diffuse_reflectance),
                specular_reflectance: f(specular_reflectance),
                nonlinear,
                roughness,
            },
            Self::Null => Bsdf::Null,
        }
    }
}

impl Scattering {
    /// `π f` if what hit points keep is exactly Lambertian.
    #[must_use]
    pub fn lambertian(&self) -> Option<Rgb> {
        match self.bsdf {
            Bsdf::Diffuse { reflectance } => Some(reflectance * self.opacity),
            _ => None,
        }
    }

    /// The value `f(wo, wi)` of the kept lobes, without the cosine (sr⁻¹).
    #[must_use]
    pub fn eval_gathered(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.eval_where(wo, wi, |roughness| !roughness.is_specular())
    }

    /// The value `f(wo, wi)` of all lobes but delta ones, without the cosine (sr⁻¹).
    #[must_use]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.eval_where(wo, wi, |_| true)
    }

    /// The value `f(wo, wi)` of the followed lobes, without the cosine (sr⁻¹): 0 for those that are a single direction.
    #[must_use]
    pub fn eval_specular(&self, wo: Vec3, wi: Vec3) -> Rgb {
        let up = |w: Vec3| w * 1f32.copysign(w.z);
        match self.bsdf {
            Bsdf::Plastic { roughness: Some(r), .. } if r.is_specular() && wo.z * wi.z > 0.0 => {
                self.coat(&r, up(wo), up(wi)) * self.opacity
            }
            Bsdf::Plastic { .. } => Rgb::BLACK,
            _ if self.bsdf.has_specular() => self.eval(wo, wi),
            _ => Rgb::BLACK,
        }
    }

    /// Density (sr⁻¹) with which the followed lobe of rough metal or of a rough coat takes the direction `wi`; 0 for lobes
    /// that are a single direction, and for rough glass.
    #[must_use]
    pub fn pdf_specular(&self, wo: Vec3, wi: Vec3) -> f32 {
        match self.bsdf {
            Bsdf::Conductor { roughness: Some(r), .. } | Bsdf::Plastic { roughness: Some(r), .. }
                if r.is_specular() && wo.z * wi.z > 0.0 =>
            {
                facet_density(&r, wo * 1f32.copysign(wo.z), wi * 1f32.copysign(wi.z))
            }
            _ => 0.0,
        }
    }

    fn eval_where(&self, wo: Vec3, wi: Vec3, counts: impl Fn(&Microfacets) -> bool) -> Rgb {
        if wo.z == 0.0 || wi.z == 0.0 {
            return Rgb::BLACK;
        }
        let same_side = wo.z * wi.z > 0.0;
        // Reflectors are seen from above; a material's other side is turned around before it gets here.
        let (up_o, up_i) = (wo * 1f32.copysign(wo.z), wi * 1f32.copysign(wi.z));
        let value = match self.bsdf {
            Bsdf::Diffuse { reflectance } if same_side => reflectance * FRAC_1_PI,
            Bsdf::Conductor { eta, k, specular_reflectance, roughness: Some(r) }
                if same_side && counts(&r) =>
            {
                r.reflect(up_o, up_i, |cos| fresnel::conductor(cos, eta, k)) * specular_reflectance
            }
            Bsdf::Dielectric {
                int_ior,
                ext_ior,
                specular_reflectance,
                specular_transmittance,
                roughness: Some(r),
            } if counts(&r) => {
                rough_glass(&r, wo, wi, int_ior, ext_ior, specular_reflectance, specular_transmittance)
            }
            Bsdf::Plastic { roughness, .. } if same_side => {
                let coat = roughness.filter(|r| counts(r)).map_or(Rgb::BLACK, |r| self.coat(&r, up_o, up_i));
                self.base(up_o, up_i) + coat
            }
            _ => Rgb::BLACK,
        };
        value * self.opacity
    }

    /// The followed lobes: reflection, refraction, straight on; absent ones are `None`. Rough ones are followed in one
    /// direction, chosen by `u`.
    #[must_use]
    pub fn specular_lobes(&self, wo: Vec3, transport: Transport, u: Vec2) -> [Option<SpecularLobe>; LOBES] {
        let straight = |chance: f32, tint: Rgb| {
            (chance > 0.0).then(|| SpecularLobe { wi: -wo, weight: tint * chance, probability: chance })
        };
        let mut lobes = match self.bsdf {
            Bsdf::Diffuse { .. } => [None; LOBES],
            Bsdf::Null => [None, None, straight(1.0, Rgb::WHITE)],
            Bsdf::Mirror { reflectance } => [single(mirrored(wo), reflectance), None, None],
            Bsdf::Conductor { eta, k, specular_reflectance, roughness } => match roughness {
                None => [
                    single(mirrored(wo), fresnel::conductor(wo.z.abs(), eta, k) * specular_reflectance),
                    None,
                    None,
                ],
                Some(r) if r.is_specular() => {
                    [rough_metal(&r, wo, u, eta, k, specular_reflectance), None, None]
                }
                Some(_) => [None; LOBES],
            },
            Bsdf::ThinDielectric { int_ior, ext_ior, specular_reflectance, specular_transmittance } => {
                let once = fresnel::reflectance(wo.z.abs(), ext_ior, int_ior);
                // R + T R T + T R³ T + … = 2R/(1 + R).
                let f = if once < 1.0 { 2.0 * once / (1.0 + once) } else { 1.0 };
                let reflected =
                    SpecularLobe { wi: mirrored(wo), weight: specular_reflectance * f, probability: f };
                [Some(reflected), None, straight(1.0 - f, specular_transmittance)]
            }
            Bsdf::Dielectric {
                int_ior,
                ext_ior,
                specular_reflectance,
                specular_transmittance,
                roughness,
            } => {
                let colours = [specular_reflectance, specular_transmittance];
                glass_lobes(wo, transport, u, [int_ior, ext_ior], colours, roughness)
            }
            Bsdf::Plastic { int_ior, ext_ior, specular_reflectance, roughness, .. } => {
                let f = Rgb::splat(fresnel::reflectance(wo.z.abs(), ext_ior, int_ior));
                match roughness {
                    None => [single(mirrored(wo), f * specular_reflectance), None, None],
                    Some(r) if r.is_specular() => [self.rough_coat_lobe(&r, wo, u), None, None],
                    Some(_) => [None; LOBES],
                }
            }
        };
        if self.opacity < 1.0 {
            for lobe in lobes.iter_mut().flatten() {
                lobe.weight *= self.opacity;
                lobe.probability *= self.opacity;
            }
            let before = lobes[2].map_or((Rgb::BLACK, 0.0), |l| (l.weight, l.probability));
            let through = 1.0 - self.opacity;
            lobes[2] = Some(SpecularLobe {
                wi: -wo,
                weight: before.0 + Rgb::splat(through),
                probability: before.1 + through,
            });
        }
        lobes
    }

    /// The share of light from `wo` that passes straight on, as if there were no surface.
    #[must_use]
    pub fn straight(&self, wo: Vec3) -> Rgb {
        let [_, _, straight] = self.specular_lobes(wo, Transport::Importance, Vec2::ZERO);
        straight.map_or(Rgb::BLACK, |lobe| lobe.weight)
    }

    /// Whether a followed lobe is rough.
    #[must_use]
    pub fn has_narrow_specular(&self) -> bool {
        self.bsdf.has_specular() && self.bsdf.roughness().is_some()
    }

    /// One followed lobe, chosen by `u_lobe` in [0, 1) with the lobes' chances; its weight is not divided by its chance.
    /// `None` with the chance of lobes that are absent: rough ones that would leave below the surface.
    #[must_use]
    pub fn choose_specular(
        &self,
        wo: Vec3,
        transport: Transport,
        u_lobe: f32,
        u: Vec2,
    ) -> Option<SpecularLobe> {
        self.choose_among_specular(wo, transport, u_lobe, u).map(|(_, lobe)| lobe)
    }

    /// The same with its kind.
    fn choose_among_specular(
        &self,
        wo: Vec3,
        transport: Transport,
        u_lobe: f32,
        u: Vec2,
    ) -> Option<(Lobe, SpecularLobe)> {
        // Chances that sum to 1 but for rounding leave no gap at the end.
        const ROUNDING: f32 = 1e-6;
        let lobes = self.specular_lobes(wo, transport, u);
        let bent = if self.bsdf.roughness().is_some() { Lobe::Narrow } else { Lobe::Single };
        let mut left = u_lobe;
        for (kind, lobe) in [bent, bent, Lobe::Straight].into_iter().zip(&lobes) {
            let Some(lobe) = lobe else { continue };
            if left < lobe.probability + ROUNDING {
                return Some((kind, *lobe)).filter(|_| lobe.probability > 0.0);
            }
            left -= lobe.probability;
        }
        None
    }

    /// Chooses a direction for a photon that came from `wo`; `None` where nothing is scattered.
    #[must_use]
    #[inline(always)]
    pub fn sample(&self, wo: Vec3, transport: Transport, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let whole = Self { opacity: 1.0, ..*self };
        if self.opacity >= 1.0 {
            return whole.sample_surface(wo, transport, u_lobe, u);
        }
        if u_lobe < self.opacity {
            return whole.sample_surface(wo, transport, u_lobe / self.opacity, u);
        }
        Some(BsdfSample { wi: -wo, weight: Rgb::WHITE, lobe: Lobe::Straight })
    }

    #[inline(always)]
    fn sample_surface(&self, wo: Vec3, transport: Transport, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        match self.bsdf {
            Bsdf::Diffuse { reflectance } => {
                Some(BsdfSample { wi: cosine(wo, u), weight: reflectance, lobe: Lobe::Gathered })
            }
            Bsdf::Conductor { eta, k, specular_reflectance, roughness: Some(r) } if !r.is_specular() => {
                let lobe = rough_metal(&r, wo, u, eta, k, specular_reflectance)?;
                Some(BsdfSample { wi: lobe.wi, weight: lobe.weight, lobe: Lobe::Gathered })
            }
            Bsdf::Plastic { roughness, .. } => self.sample_plastic(wo, transport, u_lobe, u, roughness),
            _ => {
                let (kind, lobe) = self.choose_among_specular(wo, transport, u_lobe, u)?;
                Some(BsdfSample { wi: lobe.wi, weight: lobe.weight / lobe.probability, lobe: kind })
            }
        }
    }

    /// Density of all lobes but delta ones in [`Scattering::sample`], per unit solid angle, the chance of lobes included.
    #[must_use]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if wo.z == 0.0 || wi.z == 0.0 {
            return 0.0;
        }
        let same_side = wo.z * wi.z > 0.0;
        let (up_o, up_i) = (wo * 1f32.copysign(wo.z), wi * 1f32.copysign(wi.z));
        let facet = |r: &Microfacets| facet_density(r, up_o, up_i);
        let pdf = match self.bsdf {
            Bsdf::Diffuse { .. } if same_side => warp::square_to_cosine_hemisphere_pdf(up_i),
            Bsdf::Conductor { roughness: Some(r), .. } if same_side => facet(&r),
            Bsdf::Dielectric { int_ior, ext_ior, roughness: Some(r), .. } => {
                rough_glass_pdf(&r, wo, wi, int_ior, ext_ior)
            }
            Bsdf::Plastic { roughness, .. } if same_side => {
                let chance = self.coat_chance(wo);
                let coat = roughness.map_or(0.0, |r| facet(&r));
                chance * coat + (1.0 - chance) * warp::square_to_cosine_hemisphere_pdf(up_i)
            }
            _ => 0.0,
        };
        pdf * self.opacity
    }
}

#[cfg(test)]
mod tests;
