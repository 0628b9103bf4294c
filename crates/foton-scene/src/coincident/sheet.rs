//! Whether two primitives lie in one another, and where: planes, discs, balls and tubes in double precision.

use foton_math::glam::{DVec3, Vec2, Vec3};

use crate::primitive::Primitive;

/// Coordinates are rounded once on each surface, which moves it by half of this share of them; doubled.
const TOLERANCE: f64 = 2.0 * f32::EPSILON as f64;

/// Cosine between the normals of surfaces that may be one: more than rounding takes off where there are only three corners.
const PARALLEL: f64 = 0.999;

/// A primitive's surface near a point: the unit normal by its orientation, and how far the point is off it along that.
pub(super) struct Sheet {
    pub(super) normal: DVec3,
    pub(super) distance: f64,
}

impl Sheet {
    pub(super) fn of(primitive: &Primitive, p: DVec3) -> Self {
        let around = |from: DVec3, radius: f32, inward: bool| {
            let (normal, sign) = (from.normalize_or(DVec3::Z), if inward { -1.0 } else { 1.0 });
            Self { normal: normal * sign, distance: (from.length() - f64::from(radius)) * sign }
        };
        match *primitive {
            Primitive::Triangle(corners) => {
                let [a, b, c] = corners.map(Vec3::as_dvec3);
                let normal = (b - a).cross(c - a).normalize_or(DVec3::Z);
                Self { normal, distance: (p - a).dot(normal) }
            }
            Primitive::Disc { centre, normal, .. } => {
                let normal = normal.as_dvec3();
                Self { normal, distance: (p - centre.as_dvec3()).dot(normal) }
            }
            Primitive::Sphere { centre, radius, inward } => around(p - centre.as_dvec3(), radius, inward),
            Primitive::Cylinder { from, axis, radius } => {
                let (from, axis) = (p - from.as_dvec3(), axis.as_dvec3().normalize());
                around(from - axis * from.dot(axis), radius.abs(), radius < 0.0)
            }
        }
    }
}

/// A primitive, and its plane if it is flat.
#[derive(Clone, Copy)]
pub(super) struct Face<'a> {
    primitive: &'a Primitive,
    /// A point of the plane and its unit normal.
    plane: Option<[DVec3; 2]>,
}

impl<'a> Face<'a> {
    pub(super) fn of(primitive: &'a Primitive, normal: DVec3) -> Self {
        let point = match *primitive {
            Primitive::Triangle([point, ..]) | Primitive::Disc { centre: point, .. } => Some(point),
            Primitive::Sphere { .. } | Primitive::Cylinder { .. } => None,
        };
        let plane = point.map(|p| [p.as_dvec3(), normal]);
        Self { primitive, plane }
    }

    /// What [`Self::of`] asks for: the unit normal of a flat primitive, and anything for others.
    pub(super) fn normal_of(primitive: &Primitive) -> DVec3 {
        Sheet::of(primitive, DVec3::ZERO).normal
    }

    /// What rounding of coordinates does along the normal, in the unit of [`TOLERANCE`].
    fn spread(&self) -> f64 {
        // A quarter turn leaves a trace of the other axes.
        let turned = |p: Vec3| 1e-6 * f64::from(p.abs().max_element());
        let normal = self.plane.map_or(DVec3::ZERO, |[_, normal]| normal.abs());
        match *self.primitive {
            Primitive::Triangle(corners) => {
                corners.map(|c| normal.dot(c.as_dvec3().abs()) + turned(c)).into_iter().fold(0.0, f64::max)
            }
            Primitive::Disc { centre, radius, .. } => {
                // A normal is rounded too, so the rim is off the plane.
                let tilt = f64::from(radius) * (1.0 - normal.max_element()).min(0.1);
                normal.dot(centre.as_dvec3().abs()) + tilt + turned(centre)
            }
            Primitive::Sphere { centre, radius, .. } => f64::from(centre.abs().max_element() + radius),
            Primitive::Cylinder { from, axis, radius } => {
                f64::from(from.abs().max((from + axis).abs()).max_element() + radius.abs())
            }
        }
    }
}

/// How far two surfaces may be apart and still be one: what rounding of their coordinates does along their normal.
pub(super) fn tolerance(a: &Primitive, b: &Primitive) -> f64 {
    let face = |of| Face::of(of, Face::normal_of(of));
    tolerance_of(&face(a), &face(b))
}

fn tolerance_of(a: &Face<'_>, b: &Face<'_>) -> f64 {
    TOLERANCE * a.spread().max(b.spread())
}

/// Whether two primitives share a part of their surfaces, more than an edge.
pub(super) fn coincide(a: &Face<'_>, b: &Face<'_>) -> bool {
    if let (Some([_, normal]), Some([_, other])) = (a.plane, b.plane) {
        // Most that lie near each other are not parallel, and this is known at once.
        return normal.dot(other).abs() > PARALLEL && are_in_one_plane(a, b) && overlap(a, b);
    }
    let tolerance = tolerance_of(a, b);
    let near = |p: &Primitive, at: Vec3| Sheet::of(p, at.as_dvec3()).distance.abs() <= tolerance;
    match (a.primitive, b.primitive) {
        (
            Primitive::Sphere { centre, radius, .. },
            Primitive::Sphere { centre: other, radius: its_radius, .. },
        ) => {
            f64::from(centre.distance(*other)) <= tolerance
                && f64::from((radius - its_radius).abs()) <= tolerance
        }
        (Primitive::Cylinder { axis, .. }, Primitive::Cylinder { from, axis: other, radius }) => {
            let across = other.any_orthogonal_vector().normalize() * radius.abs();
            let beside = other.cross(across).normalize() * radius.abs();
            let parallel = axis.normalize().dot(other.normalize()).abs() > PARALLEL as f32;
            let ends = [*from, *from + *other];
            let rims = [across, beside, -across];
            parallel
                && ends.iter().all(|&end| rims.iter().all(|&r| near(a.primitive, end + r)))
                && overlap(a, b)
        }
        _ => false,
    }
}

/// Whether two flat primitives that are parallel are so in one plane.
fn are_in_one_plane(a: &Face<'_>, b: &Face<'_>) -> bool {
    // The plane of the larger is the better known one.
    let (large, small) = if a.primitive.area() >= b.primitive.area() { (a, b) } else { (b, a) };
    let Some([point, normal]) = large.plane else { return false };
    let tolerance = tolerance_of(a, b);
    let near = |at: Vec3| (at.as_dvec3() - point).dot(normal).abs() <= tolerance;
    match *small.primitive {
        Primitive::Triangle(corners) => corners.into_iter().all(near),
        Primitive::Disc { centre, .. } => near(centre),
        _ => false,
    }
}

/// Whether one primitive's surface passes through a point of another's, within their tolerance.
pub(super) fn meet_at(own: &Primitive, other: &Primitive, p: DVec3) -> bool {
    let (mine, its) = (Sheet::of(own, p), Sheet::of(other, p));
    mine.normal.dot(its.normal).abs() > PARALLEL
        && (its.distance - mine.distance * mine.normal.dot(its.normal).signum()).abs()
            <= 2.0 * tolerance(own, other)
        && room(other, p) >= -edge_margin(other)
}

/// How far within a primitive's edges a point of its surface is; negative outside.
fn room(primitive: &Primitive, p: DVec3) -> f64 {
    match *primitive {
        Primitive::Triangle(_) => {
            inward_edges(&Face::of(primitive, Face::normal_of(primitive))).map_or(0.0, |edges| {
                edges
                    .into_iter()
                    .map(|(corner, inward)| (p - corner).dot(inward))
                    .fold(f64::INFINITY, f64::min)
            })
        }
        Primitive::Disc { centre, radius, .. } => f64::from(radius) - p.distance(centre.as_dvec3()),
        Primitive::Sphere { .. } => f64::INFINITY,
        Primitive::Cylinder { from, axis, .. } => {
            let (axis, length) = (axis.as_dvec3().normalize(), f64::from(axis.length()));
            let along = (p - from.as_dvec3()).dot(axis);
            along.min(length - along)
        }
    }
}

/// A corner and the unit direction inwards of each edge of a triangle.
fn inward_edges(face: &Face<'_>) -> Option<[(DVec3, DVec3); 3]> {
    let (Primitive::Triangle(corners), Some([_, normal])) = (*face.primitive, face.plane) else {
        return None;
    };
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    Some([(a, b), (b, c), (c, a)].map(|(p, q)| (p, normal.cross(q - p).normalize_or_zero())))
}

/// How far rounding moves a primitive's edges.
fn edge_margin(primitive: &Primitive) -> f64 {
    let bounds = primitive.bounds();
    2.0 * TOLERANCE * f64::from(bounds.min.abs().max(bounds.max.abs()).max_element())
}

/// Whether two primitives in one surface have more than edges in common: no edge of either has all of the other beyond it.
fn overlap(a: &Face<'_>, b: &Face<'_>) -> bool {
    let margin = edge_margin(a.primitive).max(edge_margin(b.primitive));
    let apart = |one: &Face<'_>, other: &Face<'_>| match (*one.primitive, *other.primitive) {
        (Primitive::Triangle(_), Primitive::Triangle(corners)) => inward_edges(one).is_some_and(|edges| {
            edges
                .into_iter()
                .any(|(corner, inward)| corners.iter().all(|c| (c.as_dvec3() - corner).dot(inward) <= margin))
        }),
        (Primitive::Triangle(_), Primitive::Disc { centre, radius, .. }) => {
            room(one.primitive, centre.as_dvec3()) <= margin - f64::from(radius)
        }
        (
            Primitive::Disc { centre, radius, .. },
            Primitive::Disc { centre: other, radius: its_radius, .. },
        ) => f64::from(centre.distance(other)) + margin >= f64::from(radius) + f64::from(its_radius),
        (Primitive::Cylinder { from, axis, .. }, Primitive::Cylinder { from: start, axis: other, .. }) => {
            let (unit, length) = (axis.as_dvec3().normalize(), f64::from(axis.length()));
            let ends = [start, start + other].map(|end| (end - from).as_dvec3().dot(unit));
            ends.iter().all(|&e| e <= margin) || ends.iter().all(|&e| e >= length - margin)
        }
        _ => false,
    };
    !apart(a, b) && !apart(b, a)
}

/// Weights of a triangle's second and third vertex at a point of its plane; zero for other primitives.
pub(super) fn weights(primitive: &Primitive, p: DVec3) -> Vec2 {
    let Primitive::Triangle(corners) = *primitive else { return Vec2::ZERO };
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let area = (b - a).cross(c - a);
    let share = |x: DVec3, y: DVec3| (x.cross(y).dot(area) / area.length_squared()).clamp(0.0, 1.0) as f32;
    let (v, w) = (share(p - a, c - a), share(b - a, p - a));
    Vec2::new(v, w.min(1.0 - v))
}
