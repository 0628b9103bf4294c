//! Texture coordinates of each kind of primitive.

use std::f32::consts::PI;

use foton_math::Frame;
use foton_math::glam::{Mat3, Vec2, Vec3};

use crate::primitive::Primitive;

/// Texture coordinate of a point of a primitive, as Mitsuba 3 lays it on each kind of shape. `uvs` are those of a triangle's vertices,
/// and `to_object` turns the scene into the space of the shape.
#[inline]
pub(crate) fn coordinate(
    primitive: &Primitive,
    position: Vec3,
    barycentric: Vec2,
    uvs: [Vec2; 3],
    to_object: &Mat3,
) -> Vec2 {
    let turn = |a: f32| a - a.floor();
    match *primitive {
        Primitive::Triangle(_) => {
            let [a, b, c] = uvs;
            let (v, w) = (barycentric.x, barycentric.y);
            a * (1.0 - v - w) + b * v + c * w
        }
        Primitive::Sphere { centre, .. } => {
            let p = (*to_object * (position - centre)).normalize_or(Vec3::Z);
            Vec2::new(turn(p.y.atan2(p.x) / (2.0 * PI)), p.z.clamp(-1.0, 1.0).acos() / PI)
        }
        Primitive::Disc { centre, radius, .. } => {
            let p = *to_object * (position - centre);
            Vec2::new(p.x.hypot(p.y) / radius, turn(p.y.atan2(p.x) / (2.0 * PI)))
        }
        Primitive::Cylinder { from, axis, .. } => {
            let p = position - from;
            let q = Frame::from_normal(axis.normalize()).to_local(p);
            Vec2::new(turn(q.y.atan2(q.x) / (2.0 * PI)), p.dot(axis) / axis.length_squared())
        }
    }
}
