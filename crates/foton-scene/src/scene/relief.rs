//! Normals that a relief perturbs: the shading normal of a surface with a bump map `[BLI78]` or a normal map.

use foton_math::glam::Vec3;

use super::Scene;
use super::lookup::Footprint;
use crate::description::{Relief, ReliefKind};
use crate::surface::Surface;

impl Scene {
    /// The surface with the normal that its relief gives it, as seen from the side of `outward`.
    #[inline(always)]
    pub(super) fn relieved(&self, surface: Surface, outward: bool, footprint: Option<&Footprint>) -> Surface {
        if !self.census.reliefs {
            return surface;
        }
        match self.materials[self.material_index(&surface)].relief {
            Some(relief) => self.perturbed(surface, &relief, outward, footprint),
            None => surface,
        }
    }

    #[inline(never)]
    fn perturbed(
        &self,
        surface: Surface,
        relief: &Relief,
        outward: bool,
        footprint: Option<&Footprint>,
    ) -> Surface {
        let lookup = self.lookup(&surface, footprint);
        let [dp_du, dp_dv] = self.derivatives(&surface);
        let n = surface.shading_normal;
        let texture = &self.textures[relief.texture];
        let perturbed = match relief.kind {
            ReliefKind::Bump { scale } => {
                let factor = scale * self.normalisation.scale() as f32;
                let slope = lookup.slope(texture) * factor;
                // What stands out along n tilts both tangents; they span the surface at its own height.
                let tangent = |along: Vec3| along - n * n.dot(along);
                let (u, v) = (tangent(dp_du) + n * slope.x, tangent(dp_dv) + n * slope.y);
                let cross = u.cross(v);
                cross * cross.dot(n).signum()
            }
            ReliefKind::Normal => {
                let Some(tangent) = (dp_du - n * n.dot(dp_du)).try_normalize() else { return surface };
                let c = lookup.colour(texture);
                let local = Vec3::new(c.r, c.g, c.b) * 2.0 - 1.0;
                tangent * local.x + n.cross(tangent) * local.y + n * local.z
            }
        };
        let Some(mut perturbed) = perturbed.try_normalize() else { return surface };
        if relief.same_behind && !outward {
            // Seen from behind the normal is −n, and what perturbs it is to look as in front.
            perturbed = n * (2.0 * n.dot(perturbed)) - perturbed;
        }
        let below = perturbed.dot(surface.normal);
        if below <= MIN_COSINE {
            // Mirrored at the surface, and never along it.
            perturbed += surface.normal * (below.abs().max(MIN_COSINE) - below);
            perturbed = perturbed.normalize_or(surface.normal);
        }
        Surface { shading_normal: perturbed, is_relieved: true, ..surface }
    }
}

/// No relief turns the normal farther from the surface's own than to this cosine.
const MIN_COSINE: f32 = 1e-3;
