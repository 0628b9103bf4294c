//! Where on its textures a point of a surface lies, and how large an eye sample is there.

use std::f32::consts::PI;

use foton_math::Frame;
use foton_math::glam::{Vec2, Vec3};

use super::Scene;
use crate::attributes::Corner;
use crate::primitive::Primitive;
use crate::surface::Surface;
use crate::texture::{At, Sampler};

/// Sines of the angle to a pole, and shares of a disc's radius, below this count as this: texture coordinates change without bound there.
const NEAREST_POLE: f32 = 1e-3;

/// The part of a surface that an eye sample stands for: the parallelogram around the point with these sides, in its tangent plane.
/// Scene units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// From a point to those that the neighbouring samples along the image's width and height see.
    pub sides: [Vec3; 2],
}

/// A lookup of textures: at a point, or over a footprint in texture coordinates.
#[derive(Clone, Copy)]
pub(super) struct Lookup {
    at: At,
    sides: Option<[Vec2; 2]>,
}

impl Lookup {
    #[inline]
    pub(super) fn colour(&self, sampler: &Sampler) -> foton_math::Rgb {
        self.sides
            .as_ref()
            .map_or_else(|| sampler.colour(&self.at), |sides| sampler.filtered(&self.at, sides))
    }

    #[inline]
    pub(super) fn scalar(&self, sampler: &Sampler) -> f32 {
        let filtered = |sides: &[Vec2; 2]| sampler.filtered_scalar(&self.at, sides);
        self.sides.as_ref().map_or_else(|| sampler.scalar(&self.at), filtered)
    }

    /// How the number changes with the texture coordinates of the surface.
    pub(super) fn slope(&self, sampler: &Sampler) -> Vec2 {
        let step = sampler.step();
        let beside = |by: Vec2| Self { at: At { uv: self.at.uv + by, ..self.at }, ..*self }.scalar(sampler);
        let along = |by: Vec2| beside(by) - beside(-by);
        Vec2::new(along(Vec2::new(step.x, 0.0)), along(Vec2::new(0.0, step.y))) / (2.0 * step)
    }
}

impl Scene {
    /// Where textures are looked up for a point, or for what an eye sample sees around it.
    #[inline]
    pub(super) fn lookup(&self, surface: &Surface, footprint: Option<&Footprint>) -> Lookup {
        let primitive = self.order.get(surface.primitive as usize).copied().unwrap_or_default();
        let corner = Corner { shape: surface.shape, primitive, weights: surface.barycentric };
        let at = At { uv: self.texture_coordinate(surface), corner };
        let sides = footprint.map(|f| f.sides.map(|side| self.change_of_coordinate(surface, side)));
        Lookup { at, sides }
    }

    /// How texture coordinates change along a vector in the tangent plane.
    fn change_of_coordinate(&self, surface: &Surface, along: Vec3) -> Vec2 {
        let to_object = self.shapes[surface.shape as usize].to_object;
        // The change of the angle around an axis, in turns.
        let turn = |p: Vec2, d: Vec2, least: f32| p.perp_dot(d) / (2.0 * PI * p.length_squared().max(least));
        match self.accel.primitives()[surface.primitive as usize] {
            Primitive::Triangle(corners) => {
                let [a, b, c] = self.vertex_uvs[surface.primitive as usize];
                let weights = change_of_weights(corners, along);
                (b - a) * weights.x + (c - a) * weights.y
            }
            Primitive::Sphere { centre, radius, .. } => {
                let p = (to_object * (surface.position - centre)).normalize_or(Vec3::Z);
                let d = to_object * along / radius;
                let sine = (1.0 - p.z * p.z).max(0.0).sqrt().max(NEAREST_POLE);
                Vec2::new(turn(p.truncate(), d.truncate(), NEAREST_POLE * NEAREST_POLE), -d.z / (PI * sine))
            }
            Primitive::Disc { centre, radius, .. } => {
                let p = to_object * (surface.position - centre) / radius;
                let (p, d) = (p.truncate(), (to_object * along / radius).truncate());
                let out = p.dot(d) / p.length().max(NEAREST_POLE);
                Vec2::new(out, turn(p, d, NEAREST_POLE * NEAREST_POLE))
            }
            Primitive::Cylinder { from, axis, .. } => {
                let frame = Frame::from_normal(axis.normalize());
                let (p, d) = (frame.to_local(surface.position - from), frame.to_local(along));
                Vec2::new(
                    turn(p.truncate(), d.truncate(), f32::MIN_POSITIVE),
                    along.dot(axis) / axis.length_squared(),
                )
            }
        }
    }

    /// How the unit shading normal changes along a vector in the tangent plane. Relief is left out.
    #[must_use]
    pub fn change_of_normal(&self, surface: &Surface, along: Vec3) -> Vec3 {
        let i = surface.primitive as usize;
        let change = match self.accel.primitives()[i] {
            Primitive::Triangle(corners) => {
                let Some([a, b, c]) = self.vertex_normals.get(i).filter(|n| n[0] != Vec3::ZERO) else {
                    return Vec3::ZERO;
                };
                let (v, w) = (surface.barycentric.x, surface.barycentric.y);
                let normal = *a * (1.0 - v - w) + *b * v + *c * w;
                let weights = change_of_weights(corners, along);
                let change = (*b - *a) * weights.x + (*c - *a) * weights.y;
                // Interpolated normals may be turned to the side of the geometric one.
                change / normal.length().copysign(normal.dot(surface.shading_normal))
            }
            Primitive::Sphere { radius, inward, .. } => along / if inward { -radius } else { radius },
            Primitive::Disc { .. } => return Vec3::ZERO,
            // The radius has the sign of the side on which the normal is.
            Primitive::Cylinder { axis, radius, .. } => {
                (along - axis * (along.dot(axis) / axis.length_squared())) / radius
            }
        };
        let n = surface.shading_normal;
        let across = change - n * change.dot(n);
        if across.is_finite() { across } else { Vec3::ZERO }
    }
}

/// How the weights of a triangle's second and third vertex change along a vector in its plane.
fn change_of_weights([a, b, c]: [Vec3; 3], along: Vec3) -> Vec2 {
    let (e, f) = (b - a, c - a);
    let (ee, ef, ff) = (e.length_squared(), e.dot(f), f.length_squared());
    let (de, df) = (along.dot(e), along.dot(f));
    Vec2::new(ff * de - ef * df, ee * df - ef * de) / (ee * ff - ef * ef)
}
