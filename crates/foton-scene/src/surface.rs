//! A point on a surface, with the bound on its rounding error that robust ray origins need.

use foton_math::glam::{Vec2, Vec3};

use crate::primitive::{Primitive, triangle_normal};

/// Bound on the relative rounding error of a point interpolated in a triangle: γ₇ of `[PBR16]` section 3.9, doubled to cover
/// the rounding of the barycentric coordinates.
const TRIANGLE_ERROR: f32 = 2.0 * 7.0 * 0.5 * f32::EPSILON;

/// The same for a point projected onto a sphere or a disc: γ₅, doubled.
const QUADRIC_ERROR: f32 = 2.0 * 5.0 * 0.5 * f32::EPSILON;

/// A point on a surface in scene units.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// The point.
    pub position: Vec3,
    /// How far `position` may lie from the true surface, a bound for each axis.
    pub error: Vec3,
    /// Unit geometric normal on the outside.
    pub normal: Vec3,
    /// Unit shading normal, on the same side of the surface.
    pub shading_normal: Vec3,
    /// Whether the surface curves: a neighbourhood on it leaves the tangent plane.
    pub curved: bool,
    /// Index of the shape.
    pub shape: u32,
    /// Index of the primitive, in the tree's order.
    pub(crate) primitive: u32,
    /// Weights of a triangle's second and third vertex.
    pub(crate) barycentric: Vec2,
}

impl Surface {
    /// An origin for a ray towards `direction` that lies certainly on that side of the surface.
    ///
    /// The offset is along the geometric normal and only as long as the error bound asks, so that a small object on a
    /// large floor keeps its contact. `[PBR16]` section 3.9
    #[must_use]
    pub fn ray_origin(&self, direction: Vec3) -> Vec3 {
        let distance = self.normal.abs().dot(self.error);
        self.position + self.normal * distance.copysign(direction.dot(self.normal))
    }
}

/// Position, error bound and geometric normal of a point on a primitive.
///
/// `approximate` is the point on the ray; quadrics project it onto themselves, triangles interpolate instead.
pub(crate) fn locate(primitive: &Primitive, barycentric: Vec2, approximate: Vec3) -> (Vec3, Vec3, Vec3) {
    match *primitive {
        Primitive::Triangle([a, b, c]) => {
            let (v, w) = (barycentric.x, barycentric.y);
            let u = 1.0 - v - w;
            let terms = (a * u).abs() + (b * v).abs() + (c * w).abs();
            let normal = triangle_normal([a, b, c]).unwrap_or(Vec3::Z);
            (a * u + b * v + c * w, terms * TRIANGLE_ERROR, normal)
        }
        Primitive::Sphere { centre, radius, inward } => {
            let outward = (approximate - centre).normalize_or(Vec3::Z);
            let position = centre + outward * radius;
            let error = (centre.abs() + radius) * QUADRIC_ERROR;
            (position, error, if inward { -outward } else { outward })
        }
        Primitive::Disc { centre, normal, .. } => {
            let position = approximate - normal * (approximate - centre).dot(normal);
            (position, (centre.abs() + position.abs()) * QUADRIC_ERROR, normal)
        }
        Primitive::Tube { from, axis, radius } => {
            let p = approximate - from;
            let along = axis * (p.dot(axis) / axis.length_squared());
            let outward = (p - along).normalize_or(Vec3::Z);
            let position = from + along + outward * radius.abs();
            let error = (from.abs() + axis.abs() + radius.abs()) * QUADRIC_ERROR;
            (position, error, if radius < 0.0 { -outward } else { outward })
        }
    }
}
