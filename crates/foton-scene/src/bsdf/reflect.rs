//! Reflection by a mirror, by facets, and in all directions.

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Rgb, warp};

use super::lobe_sample::LobeSample;
use super::microfacet::Microfacets;

/// The pdf (sr⁻¹) of reflecting `wo` into `wi` by a facet that is seen; both above.
pub(super) fn facet_pdf(r: &Microfacets<f32>, wo: Vec3, wi: Vec3) -> f32 {
    r.reflect_pdf(wo, (wo + wi).normalize())
}

pub(super) fn mirrored(wo: Vec3) -> Vec3 {
    Vec3::new(-wo.x, -wo.y, wo.z)
}

/// Whether both directions are on one side of the surface.
pub(super) fn same_side(wo: Vec3, wi: Vec3) -> bool {
    wo.z * wi.z > 0.0
}

/// A direction turned to the upper side. Reflectors are seen from above; a material's other side is turned around before it gets
/// here.
pub(super) fn upward(w: Vec3) -> Vec3 {
    w * 1f32.copysign(w.z)
}

/// Cosine-distributed on `wo`'s side.
#[inline(always)]
pub(super) fn cosine(wo: Vec3, u: Vec2) -> Vec3 {
    let wi = warp::square_to_cosine_hemisphere(u);
    if wo.z < 0.0 { -wi } else { wi }
}

/// Reflection by a facet normal chosen as `wo` sees them; its weight is F G₁(wi).
pub(super) fn reflect_by_facet(
    r: &Microfacets<f32>,
    wo: Vec3,
    u: Vec2,
    fresnel: impl FnOnce(f32) -> Rgb,
) -> Option<LobeSample> {
    let side = 1f32.copysign(wo.z);
    let up = wo * side;
    let h = r.sample(up, u);
    let wi = h * (2.0 * up.dot(h)) - up;
    (wi.z > 0.0).then(|| LobeSample {
        wi: wi * side,
        weight: fresnel(up.dot(h)) * (r.visible(wi, h) * r.sample_weight(up, h)),
        probability: 1.0,
    })
}
