//! What rays are tested against: triangles, spheres, discs and tubes in scene units. No acceleration, no shading.

use foton_math::glam::{DVec3, Vec2, Vec3};
use foton_math::{Aabb, Ray};

use crate::plane::Plane;

/// A surface element in scene units. 40 bytes, kept in the order of the tree's leaves.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Primitive {
    /// Counter-clockwise seen from outside.
    Triangle([Vec3; 3]),
    /// Normal outwards, or inwards when `inward`.
    Sphere {
        /// The centre.
        centre: Vec3,
        /// The radius.
        radius: f32,
        /// Whether the normal points to the centre.
        inward: bool,
    },
    /// A flat disc.
    Disc {
        /// The centre.
        centre: Vec3,
        /// Unit normal.
        normal: Vec3,
        /// The radius.
        radius: f32,
    },
    /// An open tube.
    Cylinder {
        /// Middle of one end.
        from: Vec3,
        /// Middle of the other end, less `from`.
        axis: Vec3,
        /// The radius; negative when the normal points to the axis.
        radius: f32,
    },
}

/// A ray prepared for the watertight triangle test of Woop, Benthin and Wald (2013): axes permuted so that the direction's
/// largest component is z, and the shear that turns the direction into +z. `[WBW13]`
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShearedRay {
    ray: Ray,
    origin: DVec3,
    direction: DVec3,
    axes: [usize; 3],
    shear: Vec3,
}

impl ShearedRay {
    /// Prepares a ray. The winding of triangles is not looked at, so axes are not swapped to preserve it.
    #[inline(always)]
    pub(crate) fn new(ray: Ray) -> Self {
        let d = ray.direction.abs();
        let z = if d.x >= d.y && d.x >= d.z { 0 } else { usize::from(d.z > d.y) + 1 };
        let [x, y] = [[1, 2], [2, 0], [0, 1]][z];
        let inverse = 1.0 / ray.direction[z];
        Self {
            ray,
            origin: ray.origin.as_dvec3(),
            direction: ray.direction.as_dvec3(),
            axes: [x, y, z],
            shear: Vec3::new(ray.direction[x] * inverse, ray.direction[y] * inverse, inverse),
        }
    }

    /// The ray itself.
    #[inline(always)]
    pub(crate) const fn ray(&self) -> &Ray {
        &self.ray
    }

    /// Where x, y and z come from.
    #[inline(always)]
    pub(crate) const fn axes(&self) -> [usize; 3] {
        self.axes
    }

    /// What of z is taken off x and off y.
    #[inline(always)]
    pub(crate) const fn shear(&self) -> Vec3 {
        self.shear
    }

    #[inline(always)]
    fn permuted(&self, v: Vec3) -> [f32; 3] {
        [v[self.axes[0]], v[self.axes[1]], v[self.axes[2]]]
    }

    /// The origin, its axes permuted.
    #[inline(always)]
    pub(crate) fn permuted_origin(&self) -> [f32; 3] {
        self.permuted(self.ray.origin)
    }

    /// The ray's position among a triangle's edges: twice the areas that it makes with each, seen along the ray.
    ///
    /// Products of single precision numbers are exact in double precision: signs are right, on edges too, and a sliver keeps
    /// the digits of its weights.
    #[inline(always)]
    fn edges(&self, vertices: &[Vec3; 3]) -> [f64; 3] {
        let sheared = |vertex: Vec3| {
            let v = self.permuted(vertex - self.ray.origin);
            (v[0] - self.shear.x * v[2], v[1] - self.shear.y * v[2])
        };
        let ((ax, ay), (bx, by), (cx, cy)) =
            (sheared(vertices[0]), sheared(vertices[1]), sheared(vertices[2]));
        let cross = |x0: f32, y0: f32, x1: f32, y1: f32| {
            f64::from(x0) * f64::from(y0) - f64::from(x1) * f64::from(y1)
        };
        [cross(cx, by, cy, bx), cross(ax, cy, ay, cx), cross(bx, ay, by, ax)]
    }

    /// Whether the ray's line meets a triangle. Watertight: of the triangles around an edge or a vertex at least one is met
    /// by a line through it.
    #[cold]
    pub(crate) fn meets(&self, vertices: &[Vec3; 3]) -> bool {
        let [u, v, w] = self.edges(vertices);
        let inside = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
        inside && u + v + w != 0.0
    }

    /// Distance of the plane of a triangle with that corner, if it lies in the ray's interval up to `t_max`.
    #[inline(always)]
    pub(crate) fn hit_plane(&self, plane: &Plane, corner: Vec3, t_max: f32) -> Option<f32> {
        let t = plane.distance(corner, self.origin, self.direction) as f32;
        // Along the plane t may be infinite.
        (self.accepts(t, t_max) && t.is_finite()).then_some(t)
    }

    /// The same of the plane through a triangle's corners.
    #[inline(always)]
    pub(crate) fn hit_plane_of(&self, corners: &[Vec3; 3], t_max: f32) -> Option<f32> {
        let t = crate::plane::distance(corners, self.origin, self.direction) as f32;
        (self.accepts(t, t_max) && t.is_finite()).then_some(t)
    }

    /// Weights of the second and third vertex where the ray's line meets a triangle.
    #[inline(always)]
    pub(crate) fn weights(&self, vertices: &[Vec3; 3]) -> Vec2 {
        let [u, v, w] = self.edges(vertices);
        let inverse = 1.0 / (u + v + w);
        Vec2::new((v * inverse) as f32, (w * inverse) as f32)
    }

    /// Roots as in Haines et al., "Precision Improvements for Ray/Sphere Intersection" (2019): the discriminant from the
    /// distance of the centre to the ray, which does not cancel for a small sphere far away. `[HGA19]`
    #[inline(always)]
    fn hit_sphere(&self, centre: Vec3, radius: f32, t_max: f32) -> Option<f32> {
        let f = self.ray.origin - centre;
        let d = self.ray.direction;
        let b = -f.dot(d);
        let discriminant = radius * radius - (f + d * b).length_squared();
        if discriminant < 0.0 {
            return None;
        }
        let q = b + discriminant.sqrt().copysign(b);
        // (|f| − r)(|f| + r) keeps its sign for an origin just off the surface, where |f|² − r² may not.
        let length = f.length();
        let c = (length - radius) * (length + radius);
        let (t0, t1) = (c / q, q);
        let (near, far) = (t0.min(t1), t0.max(t1));
        let t = if self.accepts(near, t_max) { near } else { far };
        self.accepts(t, t_max).then_some(t)
    }

    /// In double precision, as triangles' planes: a disc seen edge-on would else be met where it is not.
    fn hit_disc(&self, centre: Vec3, normal: Vec3, radius: f32, t_max: f32) -> Option<f32> {
        let (centre, normal) = (centre.as_dvec3(), normal.as_dvec3());
        let t = (centre - self.origin).dot(normal) / self.direction.dot(normal);
        let radius = f64::from(radius);
        let inside = self.accepts(t as f32, t_max)
            && (self.origin + self.direction * t - centre).length_squared() <= radius * radius;
        inside.then_some(t as f32)
    }

    /// In double precision: tubes are few, and their quadratic cancels like a sphere's.
    fn hit_tube(&self, from: Vec3, axis: Vec3, radius: f32, t_max: f32) -> Option<f32> {
        let (o, d) = ((self.ray.origin - from).as_dvec3(), self.ray.direction.as_dvec3());
        let axis = axis.as_dvec3();
        let unit = axis.normalize();
        let across = |v: DVec3| v - unit * v.dot(unit);
        let (p, q) = (across(o), across(d));
        let (a, b) = (q.length_squared(), p.dot(q));
        let c = p.length_squared() - f64::from(radius) * f64::from(radius);
        let discriminant = b * b - a * c;
        if a == 0.0 || discriminant < 0.0 {
            return None;
        }
        let far = -b - discriminant.sqrt().copysign(b);
        let mut roots = [far / a, c / far];
        roots.sort_by(f64::total_cmp);
        let on_tube = |t: &f64| {
            self.accepts(*t as f32, t_max) && (0.0..=axis.length()).contains(&(o + d * *t).dot(unit))
        };
        let t = roots.into_iter().find(on_tube)?;
        Some(t as f32)
    }

    #[inline(always)]
    fn accepts(&self, t: f32, t_max: f32) -> bool {
        t > self.ray.t_min && t <= t_max
    }

    /// Distance of the nearest point of a sphere, a disc or a tube in the ray's interval up to `t_max`.
    #[inline(always)]
    pub(crate) fn hit_other(&self, primitive: &Primitive, t_max: f32) -> Option<f32> {
        match primitive {
            // Quads hold triangles; this is for completeness.
            Primitive::Triangle(vertices) if self.meets(vertices) => {
                self.hit_plane(&Plane::new(*vertices), vertices[0], t_max)
            }
            Primitive::Triangle(_) => None,
            Primitive::Sphere { centre, radius, .. } => self.hit_sphere(*centre, *radius, t_max),
            Primitive::Disc { centre, normal, radius } => self.hit_disc(*centre, *normal, *radius, t_max),
            Primitive::Cylinder { from, axis, radius } => self.hit_tube(*from, *axis, *radius, t_max),
        }
    }
}

impl Primitive {
    /// The plane of a triangle; whatever for another primitive.
    pub(crate) fn plane(&self) -> Plane {
        if let Self::Triangle(corners) = self { Plane::new(*corners) } else { Plane::default() }
    }

    /// The smallest box around the primitive.
    #[must_use]
    pub(crate) fn bounds(&self) -> Aabb {
        match *self {
            Self::Triangle(vertices) => vertices.into_iter().fold(Aabb::EMPTY, Aabb::with),
            Self::Sphere { centre, radius, .. } => Aabb::around(centre, radius),
            Self::Disc { centre, normal, radius } => {
                let extent = (Vec3::ONE - normal * normal).max(Vec3::ZERO).map(f32::sqrt) * radius;
                Aabb { min: centre - extent, max: centre + extent }
            }
            Self::Cylinder { from, axis, radius } => {
                let unit = axis.normalize();
                let extent = (Vec3::ONE - unit * unit).max(Vec3::ZERO).map(f32::sqrt) * radius.abs();
                let ends = Aabb::EMPTY.with(from).with(from + axis);
                Aabb { min: ends.min - extent, max: ends.max + extent }
            }
        }
    }

    /// Area in square scene units.
    #[must_use]
    pub(crate) fn area(&self) -> f32 {
        use std::f32::consts::PI;
        match *self {
            Self::Triangle([a, b, c]) => 0.5 * (b - a).cross(c - a).length(),
            Self::Sphere { radius, .. } => 4.0 * PI * radius * radius,
            Self::Disc { radius, .. } => PI * radius * radius,
            Self::Cylinder { axis, radius, .. } => 2.0 * PI * radius.abs() * axis.length(),
        }
    }
}
