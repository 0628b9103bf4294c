//! A point on a surface, with the bound on its rounding error that robust ray origins need.

use foton_math::Ray;
use foton_math::glam::{DVec3, Vec2, Vec3};

use crate::normalise::Normalisation;
use crate::primitive::{Primitive, triangle_normal};

/// Bound on the relative rounding error of a point in a triangle, which is interpolated in double precision: it is rounded
/// once, and once more when a ray's origin is offset from it; doubled.
const TRIANGLE_ERROR: f32 = 2.0 * 2.0 * 0.5 * f32::EPSILON;

/// Length over height beyond which a triangle's points may lie closer to its edges than others'.
const SLENDER: f64 = 16.0;

/// A triangle whose corners are this many times as far out as a point in it places the point too coarsely by its weights.
const COARSE: f32 = 64.0;

/// The same for a point projected onto a sphere or a disc in single precision: γ₅ of `[PBR16]` section 3.9, doubled.
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
    /// Number of the patch: of what continues this surface. Its lowest bit says which side is the outside.
    pub(crate) patch: u8,
    /// Index of the primitive, in the tree's order.
    pub(crate) primitive: u32,
    /// Weights of a triangle's second and third vertex.
    pub(crate) barycentric: Vec2,
    /// Indices of refraction inside and outside where the faces of two dielectrics are one; `None`: the material's own.
    pub(crate) interface: Option<[f32; 2]>,
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
        let distance = self.normal.abs().dot(self.error);
        self.position + self.normal * distance.copysign(direction.dot(self.normal))
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

/// What locating a point on a triangle needs beside its corners, worked out beforehand.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Plane {
    /// Twice the area, along the normal by winding.
    area: DVec3,
    /// Unit normal by winding.
    normal: Vec3,
    /// A point's weights are at least this.
    ///
    /// Errors along the triangle would else put a point beyond the next face of a corner, and a closed box would lose the rays
    /// that start in its edges: points are moved off edges by twice their error. In a triangle longer than [`SLENDER`] times
    /// its height the move is cut short.
    least: f32,
}

impl Plane {
    /// That of a triangle; whatever for another primitive.
    pub(crate) fn of(primitive: &Primitive) -> Self {
        if let Primitive::Triangle(corners) = primitive { Self::new(*corners) } else { Self::default() }
    }

    /// That of a triangle.
    pub(crate) fn new(corners: [Vec3; 3]) -> Self {
        let [a, b, c] = corners.map(Vec3::as_dvec3);
        let margin = 2.0 * f64::from(TRIANGLE_ERROR) * a.abs().max(b.abs()).max(c.abs()).max_element();
        let longest =
            (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared()).sqrt();
        let height = (b - a).cross(c - a).length() / longest;
        let least = (margin / height.max(longest / SLENDER)) as f32;
        let area = (b - a).cross(c - a);
        let normal = triangle_normal(corners).unwrap_or(Vec3::Z);
        Self { area, normal, least: least * (1.0 + f32::EPSILON) }
    }

    /// Where a line meets the plane through `corner`, in double precision: the sign is right for an origin just off a plane
    /// whose corners are far away, where depths interpolated from the corners' are noise, and a line in the plane is seen to
    /// be.
    #[inline(always)]
    pub(crate) fn distance(&self, corner: Vec3, origin: DVec3, direction: DVec3) -> f64 {
        self.area.dot(corner.as_dvec3() - origin) / self.area.dot(direction)
    }

    /// As [`Plane::locate`], for a point that `ray` hits. Weights are single precision: in a triangle that is very much larger than
    /// its point's coordinates they place it too coarsely, and the ray itself says better.
    #[inline(always)]
    pub(crate) fn locate_on(&self, ray: &Ray, corners: [Vec3; 3], barycentric: Vec2) -> (Vec3, Vec3, Vec3) {
        let found = self.locate(corners, barycentric);
        // No corner is farther out than the scene is large.
        let out = found.0.abs().max_element() * COARSE;
        if out > Normalisation::HALF_SIZE as f32 {
            return found;
        }
        self.locate_finely(ray, corners, found, out)
    }

    /// The rest of [`Plane::locate_on`], for the few points near the middle of the scene.
    #[inline(never)]
    fn locate_finely(
        &self,
        ray: &Ray,
        corners: [Vec3; 3],
        found: (Vec3, Vec3, Vec3),
        out: f32,
    ) -> (Vec3, Vec3, Vec3) {
        let largest = corners.into_iter().fold(Vec3::ZERO, |l, p| l.max(p.abs())).max_element();
        if out > largest {
            return found;
        }
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let [a, b, c] = corners.map(Vec3::as_dvec3);
        let on_ray = origin + direction * self.distance(corners[0], origin, direction) - a;
        let weights = self.area / self.area.length_squared();
        let (v, w) = (on_ray.cross(c - a).dot(weights), (b - a).cross(on_ray).dot(weights));
        if (1.0 - v - w).min(v).min(w) < 0.0 {
            // By the rounding of its corners the triangle was met beyond its edge, mostly the diagonal of a large ground. Moved
            // into the triangle, all such points would lie on the edge.
            let position = (on_ray + a).as_vec3();
            return (position, position.abs() * TRIANGLE_ERROR, self.normal);
        }
        // Rounding moves a point that lies this near the middle by less.
        let share = f64::from((on_ray + a).abs().max_element() as f32 / largest).max(f64::EPSILON);
        self.point(corners, v, w, f64::from(self.least) * share)
    }

    /// Position, error bound and geometric normal of a point in the triangle.
    #[inline(always)]
    pub(crate) fn locate(&self, corners: [Vec3; 3], barycentric: Vec2) -> (Vec3, Vec3, Vec3) {
        self.point(corners, barycentric.x.into(), barycentric.y.into(), self.least.into())
    }

    /// The same by weights of the second and third corner, none of the three less than `least`.
    #[inline(always)]
    fn point(&self, corners: [Vec3; 3], v: f64, w: f64, least: f64) -> (Vec3, Vec3, Vec3) {
        let (mut u, mut v, mut w) = (1.0 - v - w, v, w);
        if u.min(v).min(w) < least {
            (u, v, w) = (u.max(least), v.max(least), w.max(least));
            let sum = u + v + w;
            (u, v, w) = (u / sum, v / sum, w / sum);
        }
        let [a, b, c] = corners;
        let position = (a.as_dvec3() * u + b.as_dvec3() * v + c.as_dvec3() * w).as_vec3();
        (position, position.abs() * TRIANGLE_ERROR, self.normal)
    }
}
