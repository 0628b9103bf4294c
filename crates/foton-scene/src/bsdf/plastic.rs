//! A clear coat over a diffuse base.

use std::f32::consts::FRAC_1_PI;

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Rgb, warp};

use super::lobe::{BsdfSample, Lobe, SpecularLobe, Transport};
use super::reflect::{cosine, reflect_by_facet};
use super::{Scattering, fresnel};
use crate::description::{Bsdf, Microfacets};

impl Scattering {
    /// Light reflected by a rough coat.
    pub(super) fn coat(&self, r: &Microfacets, wo: Vec3, wi: Vec3) -> Rgb {
        self.coat_with_density(r, wo, wi).0
    }

    /// The same, and the density of sampling it (sr⁻¹), its chance left out.
    #[inline(always)]
    fn coat_with_density(&self, r: &Microfacets, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        let Bsdf::Plastic { int_ior, ext_ior, specular_reflectance, .. } = self.bsdf else {
            return (Rgb::BLACK, 0.0);
        };
        let fresnel = |cos: f32| Rgb::splat(fresnel::reflectance(cos, ext_ior, int_ior));
        let (value, density) = r.reflect_with_density(wo, wi, fresnel);
        (value * specular_reflectance, density)
    }

    /// Light that enters a coat, is spread by the base and leaves again, reflections inside the coat summed up.
    pub(super) fn base(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.spread(self.enters(wo.z), self.enters(wi.z))
    }

    /// The same by the shares that get through the coat on the way in and out.
    fn spread(&self, enters: f32, leaves: f32) -> Rgb {
        let Bsdf::Plastic { int_ior, ext_ior, diffuse_reflectance, nonlinear, .. } = self.bsdf else {
            return Rgb::BLACK;
        };
        let eta = ext_ior / int_ior;
        let inside = self.coat.map_or_else(|| fresnel::diffuse_reflectance(eta), |c| c.inside);
        let again = if nonlinear { diffuse_reflectance * inside } else { Rgb::splat(inside) };
        let scale = enters * leaves * eta * eta * FRAC_1_PI;
        Rgb::new(
            diffuse_reflectance.r / (1.0 - again.r),
            diffuse_reflectance.g / (1.0 - again.g),
            diffuse_reflectance.b / (1.0 - again.b),
        ) * scale
    }

    /// Share of light at a cosine of incidence that gets through the coat.
    fn enters(&self, cos: f32) -> f32 {
        match (&self.coat, self.bsdf) {
            (Some(coat), _) => coat.transmittance(cos),
            (None, Bsdf::Plastic { int_ior, ext_ior, .. }) => {
                1.0 - fresnel::reflectance(cos, ext_ior, int_ior)
            }
            (None, _) => 0.0,
        }
    }

    /// The chance with which a photon from `wo` takes the coat rather than the base.
    pub(super) fn coat_chance(&self, wo: Vec3) -> f32 {
        self.chance(self.enters(wo.z.abs()))
    }

    /// The same by the share that gets through the coat.
    fn chance(&self, enters: f32) -> f32 {
        let Bsdf::Plastic { diffuse_reflectance, specular_reflectance, .. } = self.bsdf else { return 0.0 };
        let coat = specular_reflectance.mean() * (1.0 - enters);
        let base = diffuse_reflectance.mean() * enters;
        if coat + base > 0.0 { coat / (coat + base) } else { 0.0 }
    }

    pub(super) fn rough_coat_lobe(&self, r: &Microfacets, wo: Vec3, u: Vec2) -> Option<SpecularLobe> {
        let Bsdf::Plastic { int_ior, ext_ior, specular_reflectance, .. } = self.bsdf else { return None };
        reflect_by_facet(r, wo, u, |cos| {
            Rgb::splat(fresnel::reflectance(cos, ext_ior, int_ior)) * specular_reflectance
        })
    }

    pub(super) fn sample_plastic(
        &self,
        wo: Vec3,
        transport: Transport,
        u_lobe: f32,
        u: Vec2,
        roughness: Option<Microfacets>,
    ) -> Option<BsdfSample> {
        let enters = self.enters(wo.z.abs());
        let chance = self.chance(enters);
        let coat = u_lobe < chance;
        let up = |w: Vec3| w * 1f32.copysign(wo.z);
        match roughness {
            // Lobes that overlap are weighed together.
            Some(r) if !r.is_specular() => {
                let wi = if coat { self.rough_coat_lobe(&r, wo, u)?.wi } else { cosine(wo, u) };
                if wi.z * wo.z <= 0.0 {
                    return None;
                }
                let (value, density) = self.coat_with_density(&r, up(wo), up(wi));
                let cosine = up(wi).z;
                let pdf = chance * density + (1.0 - chance) * warp::square_to_cosine_hemisphere_pdf(up(wi));
                let weight = (self.spread(enters, self.enters(cosine)) + value) * (cosine / pdf);
                (pdf > 0.0).then_some(BsdfSample { wi, weight, lobe: Lobe::Gathered })
            }
            _ if coat => {
                let [lobe, ..] = self.specular_lobes(wo, transport, u);
                let kind = if roughness.is_some() { Lobe::Narrow } else { Lobe::Single };
                lobe.map(|l| BsdfSample { wi: l.wi, weight: l.weight / chance, lobe: kind })
            }
            _ => {
                let wi = cosine(wo, u);
                let weight =
                    self.spread(enters, self.enters(wi.z.abs())) * (std::f32::consts::PI / (1.0 - chance));
                Some(BsdfSample { wi, weight, lobe: Lobe::Gathered })
            }
        }
    }
}
