//! Geometric and shading normals: on which side a direction counts.

use foton_math::Frame;
use foton_math::glam::Vec3;
use foton_scene::{Scene, Surface};

/// |ω·n_g| counts as at least this in the shading normals' correction.
pub const MIN_COSINE: f32 = 1e-2;

/// Whether the shading normal sees a direction from the side that the geometry sees it from.
#[inline(always)]
pub fn normals_agree(surface: &Surface, wo: Vec3) -> bool {
    wo.dot(surface.normal) * wo.dot(surface.shading_normal) > 0.0
}

/// The shading normal, outside, or the geometric one where an interpolated normal turns away from a direction that the geometry does
/// see (or sees one that it does not): a smooth silhouette is not black. The normal of a relief always counts.
#[inline(always)]
pub fn shading_normal_towards(surface: &Surface, wo: Vec3) -> Vec3 {
    if surface.is_relieved || normals_agree(surface, wo) { surface.shading_normal } else { surface.normal }
}

/// The frame in which the surface's BSDF is stated for paths from `wo`, and that direction in it. Where a relief turns away from it, the
/// direction is mirrored at the relief's own horizon: what is seen there goes over into what is seen beside it, and is not black.
#[inline(always)]
pub fn shading_view(scene: &Scene, surface: &Surface, wo: Vec3) -> (Frame, Vec3) {
    let frame = scene.shading_frame(surface, shading_normal_towards(surface, wo));
    let mut local = frame.to_local(wo);
    if surface.is_relieved && !normals_agree(surface, wo) {
        local.z = -local.z;
    }
    (frame, local)
}

/// Whether a direction made with the shading normal lies on the wrong side of the true surface.
pub fn leaves_wrongly(surface: &Surface, wo: Vec3, wi: Vec3, reflects: bool) -> bool {
    (wo.dot(surface.normal) * wi.dot(surface.normal) > 0.0) != reflects
}

/// The direction of a specular lobe, mirrored in the plane of the true surface where it would end on the wrong side. To drop it
/// would darken whatever is seen at grazing angles: waves from near the water line lose up to 5 % of their light.
pub fn on_the_right_side(surface: &Surface, wo: Vec3, wi: Vec3, reflects: bool) -> Vec3 {
    if leaves_wrongly(surface, wo, wi, reflects) { wi.reflect(surface.normal) } else { wi }
}
