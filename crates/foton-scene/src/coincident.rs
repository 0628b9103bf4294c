//! Surfaces that lie in one another: which of them a ray meets, and what the boundary of two clear ones is.
//!
//! Exporters set a glass block exactly on a floor and state the face between water and glass twice. A ray meets both at one
//! distance, or in the order that rounding gives them, and the next ray starts beyond both. So pairs of primitives that share a
//! part of a surface, within what single precision can tell apart, are found when a scene is built, and where a ray hits one of
//! them the hit is settled: an emitter before what is opaque, that before what is clear, then the order of the file; the faces
//! of two dielectrics become the one boundary between their inner media. Scenes without such pairs pay a look at an empty list.

use foton_math::Ray;
use foton_math::glam::{DVec3, Vec2, Vec3};
use rayon::prelude::*;

use crate::accel::Accel;
use crate::description::{Bsdf, Colour, Material};
use crate::primitive::Primitive;
use crate::scene::Scene;
use crate::surface::Surface;

/// Coordinates are rounded once on each surface, which moves it by half of this share of them; doubled.
const TOLERANCE: f64 = 2.0 * f32::EPSILON as f64;

/// Cosine between the normals of surfaces that may be one: more than rounding takes off where there are only three corners.
const PARALLEL: f64 = 0.999;

/// Surfaces that are told apart at one point.
const MOST: usize = 8;

/// The primitives that share a part of their surface with another.
#[derive(Clone, Debug, Default)]
pub(crate) struct Coincidences {
    /// By primitive in the tree's order; empty where there are none.
    shared: Vec<bool>,
    /// Pairs of shapes that share a part of a surface, the lower index first, each once, and whether their normals agree.
    shapes: Vec<([u32; 2], bool)>,
    /// By shape: how far apart its surface and those in it may be, for rays that start there.
    gaps: Vec<f32>,
}

impl Coincidences {
    /// Finds all pairs.
    pub(crate) fn find(accel: &Accel, shape_of: &[u32]) -> Self {
        let primitives = accel.primitives();
        let pairs: Vec<[u32; 2]> = (0..primitives.len())
            .into_par_iter()
            .flat_map_iter(|i| {
                let mut partners = Vec::new();
                accel.for_each_near(&primitives[i].bounds(), |j| {
                    if j > i && coincide(&primitives[i], &primitives[j]) {
                        partners.push([i as u32, j as u32]);
                    }
                });
                partners
            })
            .collect();
        if pairs.is_empty() {
            return Self::default();
        }
        let count = shape_of.iter().max().map_or(0, |&s| s as usize + 1);
        let (mut shared, mut gaps) = (vec![false; primitives.len()], vec![0f32; count]);
        let mut shapes = Vec::with_capacity(pairs.len());
        for pair in pairs {
            let [a, b] = pair.map(|i| i as usize);
            let gap = 2.0 * tolerance(&primitives[a], &primitives[b]) as f32;
            for i in [a, b] {
                shared[i] = true;
                gaps[shape_of[i] as usize] = gaps[shape_of[i] as usize].max(gap);
            }
            let mut pair = pair.map(|i| shape_of[i as usize]);
            pair.sort_unstable();
            let normal = |i: usize| Sheet::of(&primitives[i], primitives[i].bounds().max.as_dvec3()).normal;
            shapes.push((pair, normal(a).dot(normal(b)) > 0.0));
        }
        shapes.sort_unstable();
        shapes.dedup();
        shapes.retain(|([a, b], _)| a != b);
        Self { shared, shapes, gaps }
    }

    /// Whether a primitive shares a part of its surface with another.
    #[inline(always)]
    pub(crate) fn has(&self, primitive: u32) -> bool {
        self.shared.get(primitive as usize).is_some_and(|&shared| shared)
    }

    /// How far from a shape's surface another may lie that counts as the same.
    pub(crate) fn gap(&self, shape: usize) -> f32 {
        self.gaps.get(shape).copied().unwrap_or(0.0)
    }
}

/// A surface as a ray that comes to it may meet it.
#[derive(Clone, Copy)]
struct Candidate {
    primitive: u32,
    shape: u32,
    rank: u8,
    normal: DVec3,
    gap: f64,
}

impl Scene {
    /// Makes of the surface that a ray hit the one that counts among those that lie in it.
    #[inline(never)]
    pub(crate) fn settle(&self, ray: &Ray, hit: &mut Surface) {
        let primitives = self.accel.primitives();
        let (own, p) = (&primitives[hit.primitive as usize], hit.position.as_dvec3());
        let mut found = [None; MOST];
        let mut count = 0;
        let reach = hit.error.max_element() + 2.0 * self.coincidences.gap(hit.shape as usize);
        self.accel.for_each_near(&foton_math::Aabb::around(hit.position, reach), |j| {
            let primitive = &primitives[j];
            if j as u32 != hit.primitive && !(self.coincidences.has(j as u32) && meet_at(own, primitive, p)) {
                return;
            }
            let sheet = Sheet::of(primitive, p);
            let (shape, gap) = (self.shape_of[j], sheet.distance.abs() + tolerance(own, primitive));
            let rank = self.rank(shape, -ray.direction.as_dvec3().dot(sheet.normal) > 0.0);
            // Two triangles of one shape share a diagonal.
            let known = found[..count].iter().flatten().any(|c: &Candidate| {
                c.shape == shape && c.normal.dot(sheet.normal) > 0.0 && j as u32 != hit.primitive
            });
            if !known && count < MOST {
                found[count] =
                    Some(Candidate { primitive: j as u32, shape, rank, normal: sheet.normal, gap });
                count += 1;
            }
        });
        let found = &mut found[..count];
        // The order of the tree is none of the file's.
        found.sort_unstable_by_key(|c| c.map(|c| (std::cmp::Reverse(c.rank), c.shape, c.primitive)));
        let Some(first) = found.first().copied().flatten().filter(|_| count > 1) else { return };
        if first.primitive != hit.primitive {
            let primitive = &primitives[first.primitive as usize];
            *hit = self.surface_of(first.primitive, weights(primitive, p), hit.position);
        }
        let gap = found.iter().flatten().map(|c| c.gap).fold(0.0, f64::max) as f32;
        hit.error += hit.normal.abs() * (2.0 * gap);
        hit.interface = self.merged(first, found.iter().flatten().skip(1));
    }

    /// Which surface counts: the highest on the side that a ray comes to.
    fn rank(&self, shape: u32, outward: bool) -> u8 {
        let material = self.material(shape);
        match self.shapes[shape as usize].emitter {
            Some(_) if outward => 4,
            _ if material.shows(outward) => 3,
            _ if material.is_opaque() => 2,
            _ => u8::from(material.front != Bsdf::Null),
        }
    }

    /// The indices inside and outside of a dielectric in which others lie, by its own normal.
    fn merged<'a>(&self, first: Candidate, others: impl Iterator<Item = &'a Candidate>) -> Option<[f32; 2]> {
        let indices = |c: &Candidate| match self.material(c.shape).front {
            Bsdf::Dielectric { int_ior, ext_ior, .. } => Some([int_ior, ext_ior]),
            _ => None,
        };
        let [mut inside, mut outside] = indices(&first)?;
        let mut merged = false;
        for other in others.filter(|c| c.shape != first.shape) {
            let Some([its_inside, its_outside]) = indices(other) else { continue };
            merged = true;
            if other.normal.dot(first.normal) < 0.0 {
                outside = its_inside;
            } else if its_outside == inside {
                inside = its_inside;
            } else if its_inside == outside {
                outside = its_outside;
            }
        }
        merged.then_some([inside, outside])
    }

    /// Whether any surfaces lie in one another.
    #[must_use]
    pub fn has_coincident_surfaces(&self) -> bool {
        !self.coincidences.shared.is_empty()
    }

    /// Pairs of shapes of which the first hides the second where both lie in one surface: both are opaque on the same side.
    /// Emitters are none of them.
    pub fn hidden_shapes(&self) -> impl Iterator<Item = [u32; 2]> {
        self.coincidences.shapes.iter().filter_map(|&([a, b], agree)| {
            let hides = |a: u32, b: u32| {
                let (over, under) = (self.material(a), self.material(b));
                let shows = |side: bool| under.shows(side == agree) || under.opacity.is_some();
                [true, false].into_iter().any(|side| over.shows(side) && shows(side))
            };
            let emits = |s: u32| self.shapes[s as usize].emitter.is_some();
            match (emits(a) || emits(b), hides(a, b), hides(b, a)) {
                (true, ..) | (_, false, false) => None,
                (_, true, _) => Some([a, b]),
                (_, false, true) => Some([b, a]),
            }
        })
    }
}

impl Material {
    /// Whether nothing passes through.
    fn is_opaque(&self) -> bool {
        self.opacity.is_none() && !self.front.transmits()
    }

    /// Whether it is opaque and described on a side.
    fn shows(&self, outward: bool) -> bool {
        self.is_opaque() && (outward || self.back.is_some())
    }
}

impl Surface {
    /// A BSDF with the indices of what lies on both sides here.
    #[inline(always)]
    pub(crate) fn between(&self, bsdf: Bsdf<Colour>) -> Bsdf<Colour> {
        match (self.interface, bsdf) {
            (
                Some([int_ior, ext_ior]),
                Bsdf::Dielectric { specular_reflectance, specular_transmittance, roughness, .. },
            ) => {
                Bsdf::Dielectric { int_ior, ext_ior, specular_reflectance, specular_transmittance, roughness }
            }
            _ => bsdf,
        }
    }
}

/// A primitive's surface near a point: the unit normal by its orientation, and how far the point is off it along that.
struct Sheet {
    normal: DVec3,
    distance: f64,
}

impl Sheet {
    fn of(primitive: &Primitive, p: DVec3) -> Self {
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
            Primitive::Tube { from, axis, radius } => {
                let (from, axis) = (p - from.as_dvec3(), axis.as_dvec3().normalize());
                around(from - axis * from.dot(axis), radius.abs(), radius < 0.0)
            }
        }
    }
}

/// How far two surfaces may be apart and still be one: what rounding of their coordinates does along their normal.
fn tolerance(a: &Primitive, b: &Primitive) -> f64 {
    // A quarter turn leaves a trace of the other axes.
    let turned = |p: Vec3| 1e-6 * f64::from(p.abs().max_element());
    let of = |p: &Primitive| match *p {
        Primitive::Triangle(corners) => {
            let normal = Sheet::of(p, DVec3::ZERO).normal.abs();
            corners.map(|c| normal.dot(c.as_dvec3().abs()) + turned(c)).into_iter().fold(0.0, f64::max)
        }
        Primitive::Disc { centre, normal, radius } => {
            let normal = normal.as_dvec3().abs();
            // A normal is rounded too, so the rim is off the plane.
            let tilt = f64::from(radius) * (1.0 - normal.max_element()).min(0.1);
            normal.dot(centre.as_dvec3().abs()) + tilt + turned(centre)
        }
        Primitive::Sphere { centre, radius, .. } => f64::from(centre.abs().max_element() + radius),
        Primitive::Tube { from, axis, radius } => {
            f64::from(from.abs().max((from + axis).abs()).max_element() + radius.abs())
        }
    };
    TOLERANCE * of(a).max(of(b))
}

/// Whether two primitives share a part of their surfaces, more than an edge.
fn coincide(a: &Primitive, b: &Primitive) -> bool {
    let tolerance = tolerance(a, b);
    let near = |p: &Primitive, at: Vec3| Sheet::of(p, at.as_dvec3()).distance.abs() <= tolerance;
    match (a, b) {
        (
            Primitive::Sphere { centre, radius, .. },
            Primitive::Sphere { centre: other, radius: its_radius, .. },
        ) => {
            f64::from(centre.distance(*other)) <= tolerance
                && f64::from((radius - its_radius).abs()) <= tolerance
        }
        (Primitive::Tube { axis, .. }, Primitive::Tube { from, axis: other, radius }) => {
            let across = other.any_orthogonal_vector().normalize() * radius.abs();
            let beside = other.cross(across).normalize() * radius.abs();
            let parallel = axis.normalize().dot(other.normalize()).abs() > PARALLEL as f32;
            let ends = [*from, *from + *other];
            let rims = [across, beside, -across];
            parallel && ends.iter().all(|&end| rims.iter().all(|&r| near(a, end + r))) && overlap(a, b)
        }
        (Primitive::Sphere { .. } | Primitive::Tube { .. }, _)
        | (_, Primitive::Sphere { .. } | Primitive::Tube { .. }) => false,
        _ => {
            let (na, nb) = (Sheet::of(a, DVec3::ZERO).normal, Sheet::of(b, DVec3::ZERO).normal);
            // The plane of the larger is the better known one.
            let (large, small) = if a.area() >= b.area() { (a, b) } else { (b, a) };
            let flat = match *small {
                Primitive::Triangle(corners) => corners.into_iter().all(|c| near(large, c)),
                Primitive::Disc { centre, .. } => near(large, centre),
                _ => false,
            };
            na.dot(nb).abs() > PARALLEL && flat && overlap(a, b)
        }
    }
}

/// Whether one primitive's surface passes through a point of another's, within their tolerance.
fn meet_at(own: &Primitive, other: &Primitive, p: DVec3) -> bool {
    let (mine, its) = (Sheet::of(own, p), Sheet::of(other, p));
    mine.normal.dot(its.normal).abs() > PARALLEL
        && (its.distance - mine.distance * mine.normal.dot(its.normal).signum()).abs()
            <= 2.0 * tolerance(own, other)
        && room(other, p) >= -edge_margin(other)
}

/// How far within a primitive's edges a point of its surface is; negative outside.
fn room(primitive: &Primitive, p: DVec3) -> f64 {
    match *primitive {
        Primitive::Triangle(_) => inward_edges(primitive).map_or(0.0, |edges| {
            edges.into_iter().map(|(corner, inward)| (p - corner).dot(inward)).fold(f64::INFINITY, f64::min)
        }),
        Primitive::Disc { centre, radius, .. } => f64::from(radius) - p.distance(centre.as_dvec3()),
        Primitive::Sphere { .. } => f64::INFINITY,
        Primitive::Tube { from, axis, .. } => {
            let (axis, length) = (axis.as_dvec3().normalize(), f64::from(axis.length()));
            let along = (p - from.as_dvec3()).dot(axis);
            along.min(length - along)
        }
    }
}

/// A corner and the unit direction inwards of each edge of a triangle.
fn inward_edges(primitive: &Primitive) -> Option<[(DVec3, DVec3); 3]> {
    let Primitive::Triangle(corners) = *primitive else { return None };
    let normal = Sheet::of(primitive, DVec3::ZERO).normal;
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    Some([(a, b), (b, c), (c, a)].map(|(p, q)| (p, normal.cross(q - p).normalize_or_zero())))
}

/// How far rounding moves a primitive's edges.
fn edge_margin(primitive: &Primitive) -> f64 {
    let bounds = primitive.bounds();
    2.0 * TOLERANCE * f64::from(bounds.min.abs().max(bounds.max.abs()).max_element())
}

/// Whether two primitives in one surface have more than edges in common: no edge of either has all of the other beyond it.
fn overlap(a: &Primitive, b: &Primitive) -> bool {
    let margin = edge_margin(a).max(edge_margin(b));
    let apart = |one: &Primitive, other: &Primitive| match (*one, *other) {
        (Primitive::Triangle(_), Primitive::Triangle(corners)) => inward_edges(one).is_some_and(|edges| {
            edges
                .into_iter()
                .any(|(corner, inward)| corners.iter().all(|c| (c.as_dvec3() - corner).dot(inward) <= margin))
        }),
        (Primitive::Triangle(_), Primitive::Disc { centre, radius, .. }) => {
            room(one, centre.as_dvec3()) <= margin - f64::from(radius)
        }
        (
            Primitive::Disc { centre, radius, .. },
            Primitive::Disc { centre: other, radius: its_radius, .. },
        ) => f64::from(centre.distance(other)) + margin >= f64::from(radius) + f64::from(its_radius),
        (Primitive::Tube { from, axis, .. }, Primitive::Tube { from: start, axis: other, .. }) => {
            let (unit, length) = (axis.as_dvec3().normalize(), f64::from(axis.length()));
            let ends = [start, start + other].map(|end| (end - from).as_dvec3().dot(unit));
            ends.iter().all(|&e| e <= margin) || ends.iter().all(|&e| e >= length - margin)
        }
        _ => false,
    };
    !apart(a, b) && !apart(b, a)
}

/// Weights of a triangle's second and third vertex at a point of its plane; zero for other primitives.
fn weights(primitive: &Primitive, p: DVec3) -> Vec2 {
    let Primitive::Triangle(corners) = *primitive else { return Vec2::ZERO };
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let area = (b - a).cross(c - a);
    let share = |x: DVec3, y: DVec3| (x.cross(y).dot(area) / area.length_squared()).clamp(0.0, 1.0) as f32;
    let (v, w) = (share(p - a, c - a), share(b - a, p - a));
    Vec2::new(v, w.min(1.0 - v))
}
