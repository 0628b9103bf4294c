//! Parallel light from infinitely far away.

use foton_math::Rgb;
use foton_math::glam::{Vec2, Vec3};

use super::aim::{Aim, Ball};
use super::emission::{Emission, Illumination, from_infinity};

/// Parallel light from infinitely far away.
#[derive(Clone, Debug)]
pub(crate) struct Directional {
    pub(crate) direction: Vec3,
    pub(crate) irradiance: Rgb,
    /// Around the scene.
    pub(crate) scene: Ball,
}

impl Directional {
    pub(super) fn power_factor(&self) -> f32 {
        self.scene.cross_section()
    }

    pub(super) fn emit(&self, aim: &Aim, u_part: f32, u_position: Vec2) -> Emission {
        let (origin, pdf) = aim.parallel(&self.scene, self.direction, u_part, u_position);
        Emission { origin, direction: self.direction, power: self.irradiance / pdf }
    }

    pub(super) fn illuminate(&self) -> Illumination {
        from_infinity(-self.direction, self.irradiance, f32::INFINITY)
    }
}
