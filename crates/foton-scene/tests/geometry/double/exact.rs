//! Shapes in double precision: where a line meets them, and on which side of them a point is.

use foton_math::glam::{DAffine3, DQuat, DVec3};
use foton_math::{Stream, warp};
use foton_scene::Normalisation;
use foton_scene::description::{Geometry, ShapeDescription};

use crate::{ball, in_cube, log_uniform, shape, triangle};

/// A shape in scene units, its numbers rounded as the scene's own.
#[derive(Clone, Copy, Debug)]
pub(super) enum Exact {
    Triangle([DVec3; 3]),
    Sphere { centre: DVec3, radius: f64 },
    Disc { centre: DVec3, normal: DVec3, radius: f64 },
    Cylinder { from: DVec3, axis: DVec3, radius: f64 },
}

pub(super) const KINDS: [&str; 4] = ["triangle", "sphere", "disc", "tube"];

/// A crossing of a line with a shape.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    pub(super) t: f64,
    /// How far inside the outline, over the shape's size; below zero outside.
    pub(super) margin: f64,
    /// The cosine between line and normal.
    pub(super) cosine: f64,
}

impl Exact {
    /// A random shape of that kind within the unit cube, between a ten-thousandth and half of it large.
    pub(super) fn random(kind: &str, stream: &mut Stream) -> ShapeDescription {
        let size = log_uniform([1e-4, 0.5], stream);
        let centre = in_cube(stream) * (1.0 - size) * 0.9;
        let turned = DQuat::from_rotation_arc(DVec3::Z, in_cube(stream).normalize());
        let to_world = DAffine3::from_scale_rotation_translation(DVec3::splat(size), turned, centre);
        match kind {
            "triangle" => triangle([(); 3].map(|()| centre + in_cube(stream) * size)),
            "sphere" => ball(centre, size),
            "disc" => shape(Geometry::Disc, to_world),
            _ => {
                let half = DVec3::Z * log_uniform([0.05, 1.0], stream);
                shape(Geometry::Cylinder { from: -half, to: half, radius: 0.4 }, to_world)
            }
        }
    }

    pub(super) fn of(shape: &ShapeDescription, units: &Normalisation) -> Self {
        let (point, length) = (|p| units.point(p).as_dvec3(), |l| f64::from(units.length(l)));
        let m = shape.to_world.matrix3;
        match &shape.geometry {
            Geometry::Mesh(mesh) => Self::Triangle([0, 1, 2].map(|i| point(mesh.positions[i]))),
            Geometry::Sphere { centre, radius } => {
                Self::Sphere { centre: point(*centre), radius: length(*radius) }
            }
            Geometry::Disc => Self::Disc {
                centre: point(shape.to_world.translation),
                normal: m.x_axis.cross(m.y_axis).normalize().as_vec3().as_dvec3(),
                radius: length(m.x_axis.length()),
            },
            Geometry::Cylinder { from, to, radius } => {
                let [from, to] = [from, to].map(|&p| units.point(shape.to_world.transform_point3(p)));
                let radius = length(radius * m.x_axis.length());
                Self::Cylinder { from: from.as_dvec3(), axis: (to - from).as_dvec3(), radius }
            }
        }
    }

    /// A point on the shape: half anywhere, half on an edge, a corner, a rim.
    pub(super) fn target(&self, stream: &mut Stream) -> DVec3 {
        let [u, v] = [(); 2].map(|()| f64::from(stream.next_1d()));
        let outermost = stream.next_1d() < 0.5;
        match *self {
            Self::Triangle([a, b, c]) if outermost => {
                if u < 0.2 {
                    [a, b, c][(v * 2.9) as usize]
                } else {
                    a + (if u < 0.6 { b } else { c } - a) * v
                }
            }
            Self::Triangle([a, b, c]) => {
                let w = warp::square_to_triangle(stream.next_2d()).as_dvec2();
                a + (b - a) * w.x + (c - a) * w.y
            }
            Self::Sphere { centre, radius } => {
                centre + warp::square_to_sphere(stream.next_2d()).as_dvec3() * radius
            }
            Self::Disc { centre, normal, radius } => {
                let across = normal.any_orthonormal_pair();
                let angle = u * std::f64::consts::TAU;
                let r = radius * if outermost { 1.0 } else { v.sqrt() };
                centre + (across.0 * angle.cos() + across.1 * angle.sin()) * r
            }
            Self::Cylinder { from, axis, radius } => {
                let across = axis.normalize().any_orthonormal_pair();
                let angle = u * std::f64::consts::TAU;
                let along = if outermost { v.round() } else { v };
                from + axis * along + (across.0 * angle.cos() + across.1 * angle.sin()) * radius
            }
        }
    }

    /// A point moved away from the shape's middle or towards it, by a tenth of the way down to next to nothing: past outlines,
    /// and just within them.
    pub(super) fn beside(&self, point: DVec3, stream: &mut Stream) -> DVec3 {
        let middle = match *self {
            Self::Triangle([a, b, c]) => (a + b + c) / 3.0,
            Self::Sphere { centre, .. } | Self::Disc { centre, .. } => centre,
            Self::Cylinder { from, axis, .. } => from + axis * 0.5,
        };
        let side = if stream.next_1d() < 0.3 { 1.0 } else { -1.0 };
        middle + (point - middle) * (1.0 + side * log_uniform([1e-6, 0.1], stream))
    }

    /// The unit normal at a point of the surface, on the outside.
    pub(super) fn normal(&self, point: DVec3) -> DVec3 {
        match *self {
            Self::Triangle([a, b, c]) => (b - a).cross(c - a).normalize(),
            Self::Sphere { centre, .. } => (point - centre).normalize(),
            Self::Disc { normal, .. } => normal.normalize(),
            Self::Cylinder { from, axis, .. } => {
                let unit = axis.normalize();
                let p = point - from;
                (p - unit * p.dot(unit)).normalize()
            }
        }
    }

    /// How far outside the (endless) surface a point lies; below zero inside.
    pub(super) fn height(&self, point: DVec3) -> f64 {
        match *self {
            Self::Triangle([a, ..]) => (point - a).dot(self.normal(point)),
            Self::Sphere { centre, radius } => point.distance(centre) - radius,
            Self::Disc { centre, normal, .. } => (point - centre).dot(normal.normalize()),
            Self::Cylinder { from, axis, radius } => {
                let unit = axis.normalize();
                let p = point - from;
                (p - unit * p.dot(unit)).length() - radius
            }
        }
    }

    /// All crossings ahead of the origin, the nearest first, and those just beside the outline with a negative margin.
    pub(super) fn crossings(&self, origin: DVec3, d: DVec3) -> Vec<Crossing> {
        let d = d.normalize();
        let mut found = Vec::new();
        let mut add =
            |t: f64, margin: f64, cosine: f64| found.push(Crossing { t, margin, cosine: cosine.abs() });
        match *self {
            Self::Triangle([a, b, c]) => {
                // Möller and Trumbore (1997).
                let (e1, e2, s) = (b - a, c - a, origin - a);
                let (p, q) = (d.cross(e2), s.cross(e1));
                let determinant = e1.dot(p);
                let (v, w) = (s.dot(p) / determinant, d.dot(q) / determinant);
                add(e2.dot(q) / determinant, v.min(w).min(1.0 - v - w), self.normal(a).dot(d));
            }
            Self::Sphere { centre, radius } => {
                let f = origin - centre;
                let b = f.dot(d);
                let passes = (f - d * b).length() / radius;
                let half = radius * (1.0 - passes * passes).max(0.0).sqrt();
                for t in [-b - half, -b + half] {
                    add(t, 1.0 - passes, half / radius);
                }
            }
            Self::Disc { centre, normal, radius } => {
                let t = (centre - origin).dot(normal) / d.dot(normal);
                add(t, 1.0 - (origin + d * t).distance(centre) / radius, d.dot(normal.normalize()));
            }
            Self::Cylinder { from, axis, radius } => {
                let unit = axis.normalize();
                let across = |v: DVec3| v - unit * v.dot(unit);
                let (p, q) = (across(origin - from), across(d));
                let (a, b) = (q.length(), p.dot(q) / q.length());
                let passes = (p - q * (b / q.length())).length() / radius;
                let half = radius * (1.0 - passes * passes).max(0.0).sqrt();
                for x in [-b - half, -b + half] {
                    let t = x / a;
                    let along = (origin + d * t - from).dot(unit) / axis.length();
                    add(t, (1.0 - passes).min(along).min(1.0 - along), half / radius * a);
                }
            }
        }
        found.retain(|c| c.t > 0.0);
        found.sort_by(|a, b| a.t.total_cmp(&b.t));
        found
    }
}
