//! From a hit to the point of the surface there.

use foton_math::Ray;
use foton_math::glam::{Vec2, Vec3};

use super::{Part, Scene};
use crate::accel::Hit;
use crate::plane::Plane;
use crate::primitive::Primitive;
use crate::surface::{Surface, locate};

impl Scene {
    /// The point that a ray hits. Where surfaces lie in one another, on the one that counts: an emitter before what is opaque,
    /// that before what is clear, then the first in the file.
    #[must_use]
    #[inline(always)]
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let mut surface = self.surface_of(ray, hit.primitive, hit.barycentric, ray.at(hit.t));
        if !self.part(hit.primitive).coincides {
            return surface;
        }
        let share = self.share(hit.primitive);
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
        if i >= self.parts.len() {
            return self.surface_placed(ray, primitive, barycentric);
        }
        let (part, primitive) = (self.parts[i], &self.accel.primitives()[i]);
        let place = match *primitive {
            Primitive::Triangle(corners) => self.accel.plane(i).locate_on(ray, corners, barycentric),
            _ => locate(primitive, barycentric, approximate),
        };
        let is_round = matches!(primitive, Primitive::Sphere { .. } | Primitive::Cylinder { .. });
        let normals = self.vertex_normals.get(i).filter(|n| n[0] != Vec3::ZERO);
        let at = (i as u32, barycentric);
        surface(at, &part, place, is_round, normals)
    }

    /// The same on an instance.
    #[inline(never)]
    fn surface_placed(&self, ray: &Ray, primitive: u32, barycentric: Vec2) -> Surface {
        let part = self.part(primitive);
        let (i, triangle) = self.accel.placed(primitive).unwrap_or_default();
        let placed = self.accel.instances()[i].placed(triangle);
        let place = Plane::new(placed.corners).locate_on(ray, placed.corners, barycentric);
        surface((primitive, barycentric), &part, place, false, placed.normals.as_ref())
    }
}

/// A point of a primitive by its place: position, error bound and geometric normal.
#[inline(always)]
fn surface(
    (primitive, barycentric): (u32, Vec2),
    part: &Part,
    (position, error, normal): (Vec3, Vec3, Vec3),
    is_round: bool,
    normals: Option<&[Vec3; 3]>,
) -> Surface {
    let mut surface = Surface {
        position,
        error,
        normal,
        shading_normal: normal,
        curved: part.patch.curved || is_round,
        shape: part.shape,
        patch: part.patch.key,
        primitive,
        barycentric,
        interface: None,
        is_relieved: false,
        component: 0,
    };
    if let Some([a, b, c]) = normals {
        let (v, w) = (barycentric.x, barycentric.y);
        let n = (*a * (1.0 - v - w) + *b * v + *c * w).normalize_or(normal);
        surface.shading_normal = if n.dot(normal) < 0.0 { -n } else { n };
        surface.curved = true;
    }
    surface
}
