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
        if !self.census.anisotropy || !self.materials[self.material_index(surface)].is_anisotropic() {
            return frame;
        }
        let [along_u, _] = self.derivatives(surface);
        match (along_u - normal * along_u.dot(normal)).try_normalize() {
            Some(tangent) => Frame { tangent, bitangent: normal.cross(tangent), normal },
            None => frame,
        }
    }

    /// Texture coordinate of a point.
    pub(super) fn texture_coordinate(&self, surface: &Surface) -> Vec2 {
        let (primitive, uvs) = (self.accel.primitive(surface.primitive), self.uvs_of(surface.primitive));
        let to_object = &self.shapes[surface.shape as usize].to_object;
        coordinate(&primitive, surface.position, surface.barycentric, uvs, to_object)
    }

    /// How far the point moves for each step of u and of v, in scene units: ∂p/∂u and ∂p/∂v, as Mitsuba 3 has them. Zeros where texture
    /// coordinates do not say.
    pub(super) fn derivatives(&self, surface: &Surface) -> [Vec3; 2] {
        use std::f32::consts::PI;
        let to_object = self.shapes[surface.shape as usize].to_object;
        let to_scene = |v: Vec3| to_object.transpose() * v;
        match self.accel.primitive(surface.primitive) {
            Primitive::Triangle([a, b, c]) => {
                let [ta, tb, tc] = self.uvs_of(surface.primitive);
                let (e, f, s, t) = (b - a, c - a, tb - ta, tc - ta);
                let determinant = s.x * t.y - s.y * t.x;
                if determinant == 0.0 {
                    return [Vec3::ZERO; 2];
                }
                [(e * t.y - f * s.y) / determinant, (f * s.x - e * t.x) / determinant]
            }
            Primitive::Sphere { centre, radius, .. } => {
                let p = to_object * (surface.position - centre);
                let across = p.x.hypot(p.y).max(radius * f32::EPSILON);
                let along_v = Vec3::new(p.x * p.z / across, p.y * p.z / across, -across);
                [to_scene(Vec3::new(-p.y, p.x, 0.0) * (2.0 * PI)), to_scene(along_v * PI)]
            }
            Primitive::Disc { centre, radius, .. } => {
                let p = to_object * (surface.position - centre);
                let outwards = (p / p.x.hypot(p.y)).with_z(0.0);
                let around = Vec3::new(-p.y, p.x, 0.0) * (2.0 * PI);
                if outwards.is_finite() {
                    [to_scene(outwards * radius), to_scene(around)]
                } else {
                    [Vec3::ZERO; 2]
                }
            }
            Primitive::Cylinder { from, axis, .. } => {
                let p = surface.position - from;
                let unit = axis.normalize();
                [unit.cross(p) * (2.0 * PI), axis]
            }
        }
    }
}
