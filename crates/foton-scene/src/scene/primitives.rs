//! What a scene knows of a primitive, by its index: looked up for its own, worked out for those of instances.

use foton_math::glam::{Vec2, Vec3};

use super::{Part, Scene};
use crate::attributes::Corner;
use crate::surface::Surface;

impl Scene {
    /// What a primitive belongs to.
    #[inline(always)]
    pub(crate) fn part(&self, primitive: u32) -> Part {
        match self.parts.get(primitive as usize) {
            Some(part) => *part,
            None => self.part_placed(primitive),
        }
    }

    #[inline(never)]
    fn part_placed(&self, primitive: u32) -> Part {
        let Some((i, triangle)) = self.accel.placed(primitive) else { return Part::default() };
        let (instance, placing) = (&self.accel.instances()[i], &self.placings[i]);
        let patch = placing.patches.of(instance.tree.patches[triangle]);
        Part { shape: instance.shape, patch, coincides: placing.coincides }
    }

    /// The shape of a primitive.
    pub(crate) fn shape_of(&self, primitive: u32) -> u32 {
        self.part(primitive).shape
    }

    /// Unit vertex normals of a primitive, unless it is flat or no triangle.
    #[inline(always)]
    pub(crate) fn normals_of(&self, primitive: u32) -> Option<[Vec3; 3]> {
        match self.accel.placed(primitive) {
            None => self.vertex_normals.get(primitive as usize).copied().filter(|n| n[0] != Vec3::ZERO),
            Some((i, triangle)) => self.accel.instances()[i].placed(triangle).normals,
        }
    }

    /// Texture coordinates of a primitive's vertices; zeros where it has none.
    pub(crate) fn uvs_of(&self, primitive: u32) -> [Vec2; 3] {
        let Some((i, triangle)) = self.accel.placed(primitive) else {
            return self.vertex_uvs.get(primitive as usize).copied().unwrap_or_default();
        };
        let instance = &self.accel.instances()[i];
        let uvs = &instance.tree.mesh.texture_coordinates;
        instance.placed(triangle).vertices.map(|i| uvs.get(i as usize).map_or(Vec2::ZERO, |uv| uv.as_vec2()))
    }

    /// Where attributes of meshes are looked up for a point.
    pub(super) fn corner(&self, surface: &Surface) -> Corner {
        let (shape, weights) = (surface.shape, surface.barycentric);
        let Some((i, triangle)) = self.accel.placed(surface.primitive) else {
            let primitive = self.order.get(surface.primitive as usize).copied().unwrap_or_default();
            return Corner { shape, primitive, weights, is_turned: false };
        };
        let instance = &self.accel.instances()[i];
        let primitive = instance.tree.triangles[triangle];
        // The mesh has its vertices in the order of the file.
        let is_turned =
            instance.placed(triangle).vertices != instance.tree.mesh.triangles[primitive as usize];
        Corner { shape, primitive, weights, is_turned }
    }
}
