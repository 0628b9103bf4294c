//! Where an emitter lies and which way it shines, as bounds: what a choice among many goes by.

use std::f32::consts::{FRAC_PI_2, PI};

use foton_math::Aabb;
use foton_math::glam::Vec3;

use crate::plane::triangle_normal;
use crate::primitive::Primitive;

/// Bounds of an emitter. Scene units.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// Around its surface.
    pub bounds: Aabb,
    /// All of its normals are within `normals` of this unit vector.
    pub axis: Vec3,
    /// In radians; π: everywhere.
    pub normals: f32,
    /// The largest angle to a normal at which it shines, in radians.
    pub reach: f32,
    /// Its largest radiant intensity, in luminance.
    pub intensity: f32,
}

impl Extent {
    /// That of a point which shines everywhere.
    pub(super) const fn of_point(at: Vec3, intensity: f32) -> Self {
        let bounds = Aabb { min: at, max: at };
        Self { bounds, axis: Vec3::Z, normals: PI, reach: FRAC_PI_2, intensity }
    }

    /// That of surfaces of so much radiance, in luminance.
    pub(super) fn of_surfaces(primitives: &[Primitive], radiance: f32) -> Self {
        let normals = || primitives.iter().map(flat_normal);
        let sum = normals().try_fold(Vec3::ZERO, |sum, n| n.map(|n| sum + n));
        let axis = sum.and_then(Vec3::try_normalize);
        let spread = axis.map_or(PI, |axis| {
            let smallest = normals().flatten().map(|n| n.dot(axis)).fold(1.0, f32::min);
            // Rounding must not leave a normal out.
            (smallest - 1e-5).clamp(-1.0, 1.0).acos()
        });
        Self {
            bounds: primitives.iter().fold(Aabb::EMPTY, |b, p| b.union(p.bounds())),
            axis: axis.unwrap_or(Vec3::Z),
            normals: spread,
            reach: FRAC_PI_2,
            intensity: radiance * primitives.iter().map(widest).sum::<f32>(),
        }
    }
}

/// The normal of a primitive that has one.
fn flat_normal(primitive: &Primitive) -> Option<Vec3> {
    match *primitive {
        Primitive::Triangle(corners) => triangle_normal(corners),
        Primitive::Disc { normal, .. } => Some(normal),
        Primitive::Sphere { .. } | Primitive::Cylinder { .. } => None,
    }
}

/// The largest area that a primitive shows in any direction, without what it hides of itself.
fn widest(primitive: &Primitive) -> f32 {
    let share = match primitive {
        Primitive::Triangle(_) | Primitive::Disc { .. } => 1.0,
        Primitive::Sphere { .. } => 0.25,
        Primitive::Cylinder { .. } => std::f32::consts::FRAC_1_PI,
    };
    share * primitive.area()
}
