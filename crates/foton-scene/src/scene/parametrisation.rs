//! Texture coordinates of each kind of primitive, and frames along them.

use foton_math::Frame;
use foton_math::glam::{Vec2, Vec3};

use super::Scene;
use crate::coordinates::coordinate;
use crate::primitive::Primitive;
use crate::surface::Surface;

impl Scene {
    /// The frame in which the surface's BSDF is stated, around `normal`: along texture coordinates where roughness differs
    /// along them.
    #[must_use]
    #[inline(always)]
    pub fn shading_frame(&self, surface: &Surface, normal: Vec3) -> Frame {
        let frame = Frame::from_normal(normal);
        if !self.census.anisotropy || !self.material(surface.shape).is_anisotropic() {
            return frame;
        }
        let along_u = self.direction_of_u(surface);
        match (along_u - normal * along_u.dot(normal)).try_normalize() {
            Some(tangent) => Frame { tangent, bitangent: normal.cross(tangent), normal },
            None => frame,
        }
    }

    /// Texture coordinate of a point.
    pub(super) fn texture_coordinate(&self, surface: &Surface) -> Vec2 {
        let i = surface.primitive as usize;
        let uvs = self.vertex_uvs.get(i).copied().unwrap_or_default();
        let to_object = &self.shapes[surface.shape as usize].to_object;
        coordinate(&self.accel.primitives()[i], surface.position, surface.barycentric, uvs, to_object)
    }

    /// The direction in which u grows; any length.
    fn direction_of_u(&self, surface: &Surface) -> Vec3 {
        match self.accel.primitives()[surface.primitive as usize] {
            Primitive::Triangle([a, b, c]) => {
                let [ta, tb, tc] =
                    self.vertex_uvs.get(surface.primitive as usize).copied().unwrap_or_default();
                let (e, f, s, t) = (b - a, c - a, tb - ta, tc - ta);
                (e * t.y - f * s.y) * (s.x * t.y - s.y * t.x).signum()
            }
            Primitive::Sphere { centre, .. } | Primitive::Disc { centre, .. } => {
                let to_object = self.shapes[surface.shape as usize].to_object;
                let p = to_object * (surface.position - centre);
                to_object.transpose() * Vec3::new(-p.y, p.x, 0.0)
            }
            Primitive::Cylinder { axis, .. } => axis.cross(surface.normal),
        }
    }
}
