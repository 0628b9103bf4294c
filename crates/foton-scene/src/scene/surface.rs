//! From a hit to the point of the surface there.

use foton_math::Ray;
use foton_math::glam::{Vec2, Vec3};

use super::Scene;
use crate::accel::Hit;
use crate::primitive::Primitive;
use crate::surface::{Surface, locate};

impl Scene {
    /// The point that a ray hits. Where surfaces lie in one another, on the one that counts: an emitter before what is opaque,
    /// that before what is clear, then the first in the file.
    #[must_use]
    #[inline(always)]
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let mut surface = self.surface_of(ray, hit.primitive, hit.barycentric, ray.at(hit.t));
        if !self.parts[hit.primitive as usize].coincides {
            return surface;
        }
        let share = self.coincidences.share(hit.primitive);
        if share.is_unsettled(ray.direction.dot(surface.normal) < 0.0) {
            self.settle(ray, &mut surface);
        } else {
            surface.error += surface.normal.abs() * self.coincidences.gap(surface.shape as usize);
        }
        surface
    }

    /// The point of a primitive that a ray meets, by its weights or about where on the ray it is.
    #[inline(always)]
    pub(crate) fn surface_of(
        &self,
        ray: &Ray,
        primitive: u32,
        barycentric: Vec2,
        approximate: Vec3,
    ) -> Surface {
        let i = primitive as usize;
        let (part, primitive) = (self.parts[i], &self.accel.primitives()[i]);
        let (position, error, normal) = match *primitive {
            Primitive::Triangle(corners) => self.accel.plane(i).locate_on(ray, corners, barycentric),
            _ => locate(primitive, barycentric, approximate),
        };
        let mut surface = Surface {
            position,
            error,
            normal,
            shading_normal: normal,
            curved: part.patch.curved
                || matches!(primitive, Primitive::Sphere { .. } | Primitive::Cylinder { .. }),
            shape: part.shape,
            patch: part.patch.key,
            primitive: i as u32,
            barycentric,
            interface: None,
            is_relieved: false,
            component: 0,
        };
        if let Some([a, b, c]) = self.vertex_normals.get(i)
            && *a != Vec3::ZERO
        {
            let (v, w) = (barycentric.x, barycentric.y);
            let n = (*a * (1.0 - v - w) + *b * v + *c * w).normalize_or(normal);
            surface.shading_normal = if n.dot(normal) < 0.0 { -n } else { n };
            surface.curved = true;
        }
        surface
    }
}
