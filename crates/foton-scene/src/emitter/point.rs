//! A point emitter.

use std::f32::consts::PI;

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Rgb, warp};

use super::aim::Aim;
use super::emission::{Emission, Illumination, from_point};
use super::extent::Extent;

/// The same radiant intensity in all directions from one point.
#[derive(Clone, Debug)]
pub(crate) struct Point {
    pub(crate) position: Vec3,
    pub(crate) intensity: Rgb,
}

impl Point {
    pub(super) const fn power_factor(&self) -> f32 {
        4.0 * PI
    }

    pub(super) fn emit(&self, aim: &Aim, u_direction: Vec2) -> Emission {
        let Self { position, intensity } = *self;
        if aim.is_empty() {
            let direction = warp::square_to_sphere(u_direction);
            return Emission { origin: position, direction, power: intensity * self.power_factor() };
        }
        let uniform = |_| warp::square_to_sphere_pdf();
        let (direction, pdf) = aim.divergent(position, u_direction, warp::square_to_sphere, uniform);
        Emission { origin: position, direction, power: intensity / pdf }
    }

    pub(super) fn extent(&self) -> Extent {
        Extent::of_point(self.position, self.intensity.luminance())
    }

    pub(super) fn illuminate(&self, position: Vec3) -> Option<Illumination> {
        from_point(self.position, position, self.intensity)
    }
}
