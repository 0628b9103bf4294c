//! A point on a surface, with the bound on its rounding error that robust ray origins need.

use foton_math::glam::{Vec2, Vec3};

use crate::plane::Plane;
use crate::primitive::Primitive;

/// The same for a point projected onto a sphere or a disc in single precision: γ₅ of `[PBR16]` section 3.9, doubled.
const QUADRIC_ERROR: f32 = 2.0 * 5.0 * 0.5 * f32::EPSILON;

/// Rays start at least this far off a surface. In a plane through the origin coordinates have no rounding error at all, and a ray
/// that started in the plane would not meet it, where a shading normal sends it to the other side.
const LEAST_OFFSET: f32 = 1e-7;

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
    /// Number of the patch: of what continues this surface. Its lowest bit says which side is the outside.
    pub(crate) patch: u8,
    /// Index of the primitive, in the tree's order.
    pub(crate) primitive: u32,
    /// Weights of a triangle's second and third vertex.
    pub(crate) barycentric: Vec2,
    /// Indices of refraction inside and outside where the faces of two dielectrics are one; `None`: the material's own.
    pub(crate) interface: Option<[f32; 2]>,
    /// Whether a relief perturbs the shading normal.
    pub is_relieved: bool,
    /// Which of the materials counts that the surface is blended of, after one has been taken.
    pub(crate) component: u16,
}

impl Surface {
    /// What a photon and a hit point have in common where both are on one side of one surface, or of surfaces that continue each
    /// other. Other surfaces nearby differ; far away some are alike.
    #[must_use]
    #[inline]
    pub const fn patch_towards(&self, outward: bool) -> u8 {
        self.patch ^ outward as u8
    }

    /// An origin for a ray towards `direction` that lies certainly on that side of the surface.
    ///
    /// The offset is along the geometric normal and only as long as the error bound asks, so that a small object on a
    /// large floor keeps its contact. `[PBR16]` section 3.9
    #[must_use]
    #[inline]
    pub fn ray_origin(&self, direction: Vec3) -> Vec3 {
        self.position + self.normal * self.ray_offset().copysign(direction.dot(self.normal))
    }

    /// How far that is from the surface.
    #[must_use]
    #[inline]
    pub fn ray_offset(&self) -> f32 {
        self.normal.abs().dot(self.error).max(LEAST_OFFSET)
    }
}

/// Position, error bound and geometric normal of a point on a primitive.
///
/// `approximate` is the point on the ray; quadrics project it onto themselves, triangles interpolate instead.
pub(crate) fn locate(primitive: &Primitive, barycentric: Vec2, approximate: Vec3) -> (Vec3, Vec3, Vec3) {
    match *primitive {
        Primitive::Triangle(corners) => Plane::new(corners).locate(corners, barycentric),
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
        Primitive::Cylinder { from, axis, radius } => {
            let p = approximate - from;
            let along = axis * (p.dot(axis) / axis.length_squared());
            let outward = (p - along).normalize_or(Vec3::Z);
            let position = from + along + outward * radius.abs();
            let error = (from.abs() + axis.abs() + radius.abs()) * QUADRIC_ERROR;
            (position, error, if radius < 0.0 { -outward } else { outward })
        }
    }
}
