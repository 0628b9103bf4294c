//! The clear coat of a principled surface: a narrow, colourless highlight with a long tail.

use std::f32::consts::PI;

use foton_math::glam::{Vec2, Vec3};

use super::shading::grazing;
use crate::bsdf::microfacet::{MicrofacetDistribution, Microfacets};

/// α of the dullest coat.
pub(super) const WIDEST: f32 = 0.1;
/// α of the sharpest one.
const NARROWEST: f32 = 1e-3;
/// Burley's scale of its strength.
pub(super) const STRENGTH: f32 = 0.25;
/// What it reflects at normal incidence: an index of refraction of 1.5.
const NORMAL: f32 = 0.04;

/// A clear coat of strength 1. `[BUR12]` section 5.4
#[derive(Clone, Copy, Debug)]
pub(super) struct ClearCoat {
    /// Roughness α, below 1.
    pub(super) alpha: f32,
}

impl ClearCoat {
    pub(super) fn new(gloss: f32) -> Self {
        Self { alpha: WIDEST + (NARROWEST - WIDEST) * gloss }
    }

    /// Density of normals, of the family of Trowbridge and Reitz with the exponent 1; ∫ D cos = 1.
    fn density(&self, h: Vec3) -> f32 {
        let alpha2 = self.alpha * self.alpha;
        // sin² + α² cos², without the difference of two numbers near 1.
        let t = h.x * h.x + h.y * h.y + alpha2 * h.z * h.z;
        (alpha2 - 1.0) / (PI * alpha2.ln() * t)
    }

    /// Share reflected at the cosine to a facet.
    pub(super) fn reflectance(cos: f32) -> f32 {
        STRENGTH * (NORMAL + (1.0 - NORMAL) * grazing(cos))
    }

    /// Its value for two directions above with this half vector.
    pub(super) fn eval(&self, wo: Vec3, wi: Vec3, h: Vec3) -> f32 {
        // Masked as by facets of this roughness, whatever its own is.
        let masking = Microfacets::isotropic(MicrofacetDistribution::Ggx, 0.25f32);
        let visible = masking.visible(wo, h) * masking.visible(wi, h);
        Self::reflectance(wo.dot(h)) * self.density(h) * visible
    }

    /// The pdf (sr⁻¹) of [`ClearCoat::sample`].
    pub(super) fn pdf(&self, wo: Vec3, h: Vec3) -> f32 {
        self.density(h) * h.z / (4.0 * wo.dot(h)).max(f32::MIN_POSITIVE)
    }

    /// `wo`, above, reflected by a facet whose normal is chosen by density; `None`: below.
    pub(super) fn sample(&self, wo: Vec3, u: Vec2) -> Option<Vec3> {
        let alpha2 = self.alpha * self.alpha;
        // The inverse of the distribution, for the sine: near the normal the cosine has no digits left.
        let sin2 = (alpha2 * (-u.x * alpha2.ln()).exp_m1() / (1.0 - alpha2)).clamp(0.0, 1.0);
        let (sin_phi, cos_phi) = (2.0 * PI * u.y).sin_cos();
        let sin = sin2.sqrt();
        let h = Vec3::new(sin * cos_phi, sin * sin_phi, (1.0 - sin2).sqrt());
        let wi = h * (2.0 * wo.dot(h)) - wo;
        (wi.z > 0.0 && wo.dot(h) > 0.0).then(|| wi.normalize())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facets_cover_the_surface_once_however_narrow() {
        for gloss in [0.0, 0.5, 1.0] {
            let coat = ClearCoat::new(gloss);
            // Over u = ln(sin² + α² cos²), in which the density is even.
            let alpha2 = coat.alpha * coat.alpha;
            let n = 2000;
            let sum: f32 = (0..n)
                .map(|i| {
                    let t = (alpha2.ln() * (1.0 - (i as f32 + 0.5) / n as f32)).exp();
                    let sin2 = (t - alpha2) / (1.0 - alpha2);
                    let h = Vec3::new(sin2.sqrt(), 0.0, (1.0 - sin2).sqrt());
                    // cos dω = π d(sin²) = π dt / (1 − α²).
                    coat.density(h) * PI * t * -alpha2.ln() / (1.0 - alpha2) / n as f32
                })
                .sum();
            assert!((sum - 1.0).abs() < 1e-3, "{gloss}: {sum}");
        }
    }
}
