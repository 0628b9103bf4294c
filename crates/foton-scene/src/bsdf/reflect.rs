//! Reflection by a mirror, by facets, and in all directions.

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Rgb, warp};

use super::fresnel;
use super::lobe::SpecularLobe;
use crate::description::Microfacets;

/// Density (sr⁻¹) of reflecting `wo` into `wi` by a facet that is seen; both above.
pub(super) fn facet_density(r: &Microfacets, wo: Vec3, wi: Vec3) -> f32 {
    r.reflect_density(wo, (wo + wi).normalize())
}

pub(super) fn mirrored(wo: Vec3) -> Vec3 {
    Vec3::new(-wo.x, -wo.y, wo.z)
}

pub(super) fn single(wi: Vec3, weight: Rgb) -> Option<SpecularLobe> {
    Some(SpecularLobe { wi, weight, probability: 1.0 })
}

/// Cosine-distributed on `wo`'s side.
#[inline(always)]
pub(super) fn cosine(wo: Vec3, u: Vec2) -> Vec3 {
    let wi = warp::square_to_cosine_hemisphere(u);
    if wo.z < 0.0 { -wi } else { wi }
}

/// Reflection by a facet normal chosen as `wo` sees them; its weight is F G₁(wi).
pub(super) fn reflect_by_facet(
    r: &Microfacets,
    wo: Vec3,
    u: Vec2,
    fresnel: impl FnOnce(f32) -> Rgb,
) -> Option<SpecularLobe> {
    let side = 1f32.copysign(wo.z);
    let up = wo * side;
    let h = r.sample(up, u);
    let wi = h * (2.0 * up.dot(h)) - up;
    (wi.z > 0.0).then(|| SpecularLobe {
        wi: wi * side,
        weight: fresnel(up.dot(h)) * r.visible(wi, h),
        probability: 1.0,
    })
}

pub(super) fn rough_metal(
    r: &Microfacets,
    wo: Vec3,
    u: Vec2,
    eta: Rgb,
    k: Rgb,
    tint: Rgb,
) -> Option<SpecularLobe> {
    reflect_by_facet(r, wo, u, |cos| fresnel::conductor(cos, eta, k) * tint)
}
