//! Light from infinitely far away, from all directions: an even sky, and a map of radiances.

use std::f32::consts::PI;

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Frame, Rgb, warp};

use super::aim::{Aim, Ball};
use super::emission::{Emission, Illumination, from_infinity};
use super::environment_map::EnvironmentMap;

/// The same radiance from every direction.
#[derive(Clone, Debug)]
pub(crate) struct Constant {
    pub(crate) radiance: Rgb,
    /// Around the scene.
    pub(crate) scene: Ball,
}

impl Constant {
    pub(super) fn power_factor(&self) -> f32 {
        4.0 * PI * self.scene.cross_section()
    }

    pub(super) fn emit(&self, aim: &Aim, u_part: f32, u_position: Vec2, u_direction: Vec2) -> Emission {
        let direction = warp::square_to_sphere(u_direction);
        let (origin, pdf) = aim.parallel(&self.scene, direction, u_part, u_position);
        Emission { origin, direction, power: self.radiance / (pdf * warp::square_to_sphere_pdf()) }
    }

    pub(super) fn illuminate(&self, normal: Vec3, u: Vec2) -> Option<Illumination> {
        let local = warp::square_to_cosine_hemisphere(u);
        let pdf = warp::square_to_cosine_hemisphere_pdf(local);
        let direction = Frame::from_normal(normal).to_outer(local);
        (pdf > 0.0).then(|| from_infinity(direction, self.radiance / pdf, pdf))
    }

    /// The pdf (sr⁻¹) with which [`Constant::illuminate`] chooses a direction towards it.
    pub(super) fn pdf(&self, normal: Vec3, direction: Vec3) -> f32 {
        direction.dot(normal).max(0.0) / PI
    }
}

/// Radiance by direction.
#[derive(Clone, Debug)]
pub(crate) struct Environment {
    pub(crate) map: Box<EnvironmentMap>,
    /// Around the scene.
    pub(crate) scene: Ball,
}

impl Environment {
    pub(super) fn power_factor(&self) -> f32 {
        self.scene.cross_section()
    }

    pub(super) fn emit(&self, aim: &Aim, u_part: f32, u_position: Vec2, u_direction: Vec2) -> Emission {
        let Some(sample) = self.map.sample(u_direction) else {
            return Emission { origin: self.scene.centre, direction: Vec3::Z, power: Rgb::BLACK };
        };
        let direction = -sample.direction;
        let (origin, pdf) = aim.parallel(&self.scene, direction, u_part, u_position);
        Emission { origin, direction, power: sample.radiance / (pdf * sample.pdf) }
    }

    /// The pdf (sr⁻¹) with which [`Environment::illuminate`] chooses a direction towards it.
    pub(super) fn pdf(&self, direction: Vec3) -> f32 {
        self.map.pdf(direction)
    }

    pub(super) fn illuminate(&self, u: Vec2) -> Option<Illumination> {
        self.map.sample(u).map(|s| from_infinity(s.direction, s.radiance / s.pdf, s.pdf))
    }
}
