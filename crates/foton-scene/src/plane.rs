//! Points on triangles, and where lines meet their planes, in double precision where single is not enough.

use foton_math::Ray;
use foton_math::glam::{DVec3, Vec2, Vec3};

use crate::normalise::Normalisation;

/// Bound on the relative rounding error of a point in a triangle, which is interpolated in double precision: it is rounded
/// once, and once more when a ray's origin is offset from it; doubled.
const TRIANGLE_ERROR: f32 = 2.0 * 2.0 * 0.5 * f32::EPSILON;

/// Length over height beyond which a triangle's points may lie closer to its edges than others'.
const SLENDER: f64 = 16.0;

/// A triangle whose corners are this many times as far out as a point in it places the point too coarsely by its weights.
const COARSE: f32 = 64.0;

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

/// As [`Plane::distance`], of the plane through a triangle's corners.
#[inline(always)]
pub(crate) fn distance(corners: &[Vec3; 3], origin: DVec3, direction: DVec3) -> f64 {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let area = (b - a).cross(c - a);
    area.dot(a - origin) / area.dot(direction)
}

/// The unit normal of a triangle by its winding, or `None` when it has no area.
///
/// In double precision: a sliver of 10^6 : 1 still gets the normal of its plane.
pub(crate) fn triangle_normal([a, b, c]: [Vec3; 3]) -> Option<Vec3> {
    let [a, b, c]: [DVec3; 3] = [a, b, c].map(Vec3::as_dvec3);
    let n = (b - a).cross(c - a).try_normalize()?.as_vec3();
    n.is_finite().then_some(n)
}
