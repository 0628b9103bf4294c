//! Points of primitives as images of the unit square, uniform by area, and back.

use std::f32::consts::PI;

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Frame, warp};

use crate::plane::Plane;
use crate::primitive::Primitive;
use crate::surface::locate;

/// A point of a primitive.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub(crate) position: Vec3,
    /// How far it may lie from the true surface, a bound for each axis.
    pub(crate) error: Vec3,
    /// Unit geometric normal on the outside.
    pub(crate) normal: Vec3,
    /// Weights of a triangle's second and third vertex.
    pub(crate) barycentric: Vec2,
}

impl Place {
    /// The image of a point of the unit square.
    pub(crate) fn new(primitive: &Primitive, u: Vec2) -> Self {
        Self::on(primitive, &primitive.plane(), u)
    }

    /// The same with the triangle's plane at hand.
    pub(super) fn on(primitive: &Primitive, plane: &Plane, u: Vec2) -> Self {
        let mut barycentric = Vec2::ZERO;
        let (position, error, normal) = match *primitive {
            Primitive::Triangle(corners) => {
                barycentric = warp::square_to_triangle(u);
                plane.locate(corners, barycentric)
            }
            Primitive::Sphere { centre, radius, .. } => {
                locate(primitive, Vec2::ZERO, centre + warp::square_to_sphere(u) * radius)
            }
            Primitive::Disc { centre, normal, radius } => {
                let frame = Frame::from_normal(normal);
                let d = warp::square_to_disc(u) * radius;
                locate(primitive, Vec2::ZERO, centre + frame.tangent * d.x + frame.bitangent * d.y)
            }
            Primitive::Cylinder { from, axis, radius } => {
                let frame = Frame::from_normal(axis.normalize());
                let (sin, cos) = (2.0 * PI * u.y).sin_cos();
                let across = (frame.tangent * cos + frame.bitangent * sin) * radius.abs();
                locate(primitive, Vec2::ZERO, from + axis * u.x + across)
            }
        };
        Self { position, error, normal, barycentric }
    }

    /// The point of the unit square whose image it is.
    pub(crate) fn on_the_square(&self, primitive: &Primitive) -> Vec2 {
        let turns = |x: f32, y: f32| {
            let turn = y.atan2(x) / (2.0 * PI);
            turn - turn.floor()
        };
        let at = match *primitive {
            Primitive::Triangle(_) => {
                let rest = 1.0 - self.barycentric.x;
                Vec2::new(rest * rest, if rest > 0.0 { self.barycentric.y / rest } else { 0.0 })
            }
            Primitive::Sphere { centre, radius, .. } => {
                let d = (self.position - centre) / radius;
                Vec2::new(0.5 * (1.0 - d.z), turns(d.x, d.y))
            }
            Primitive::Disc { centre, normal, radius } => {
                let d = Frame::from_normal(normal).to_local((self.position - centre) / radius);
                warp::disc_to_square(d.truncate())
            }
            Primitive::Cylinder { from, axis, .. } => {
                let p = self.position - from;
                let q = Frame::from_normal(axis.normalize()).to_local(p);
                Vec2::new(p.dot(axis) / axis.length_squared(), turns(q.x, q.y))
            }
        };
        at.clamp(Vec2::ZERO, Vec2::splat(1.0 - f32::EPSILON))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foton_math::{Purpose, Stream};

    #[test]
    fn a_place_has_the_point_of_the_square_that_it_came_from() {
        let corners = [Vec3::ZERO, Vec3::new(3.0, 0.0, 1.0), Vec3::new(0.5, 2.0, 0.0)];
        let axis = Vec3::new(0.0, 2.0, 1.0);
        let normal = Vec3::new(0.6, 0.0, -0.8);
        for primitive in [
            Primitive::Triangle(corners),
            Primitive::Sphere { centre: Vec3::ONE, radius: 2.0, inward: true },
            Primitive::Disc { centre: Vec3::X, normal, radius: 3.0 },
            Primitive::Cylinder { from: Vec3::ONE, axis, radius: -0.5 },
        ] {
            let mut stream = Stream::new(1, Purpose::Test, 0, 0);
            for _ in 0..2000 {
                let u = stream.next_2d();
                let back = Place::new(&primitive, u).on_the_square(&primitive);
                // Where the map shrinks a side of the square to a point, what lies along that side is lost.
                let lost = if matches!(primitive, Primitive::Disc { .. }) { 1e-3 } else { 2e-3 };
                assert!(back.distance(u) < lost || u.min_element() < 1e-3, "{primitive:?}: {u} {back}");
            }
        }
    }
}
