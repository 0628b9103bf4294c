//! Light from infinity: where its photons are aimed at.

use std::f32::consts::PI;

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Frame, warp};

/// Where photons from infinity are aimed at: the whole scene, and apart from it what focuses light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reach {
    pub(crate) scene: Ball,
    /// Around all surfaces that reflect or refract into single directions, if they take up clearly less than the scene.
    pub(crate) casters: Option<Ball>,
}

/// A ball that parallel light is aimed at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    pub(crate) centre: Vec3,
    pub(crate) radius: f32,
}

impl Ball {
    /// Area of its shadow.
    pub(super) fn cross_section(&self) -> f32 {
        PI * self.radius * self.radius
    }

    /// Whether a line through `point` along the unit `direction` meets it.
    pub(super) fn is_met(&self, point: Vec3, direction: Vec3) -> bool {
        let d = point - self.centre;
        (d - direction * d.dot(direction)).length_squared() <= self.radius * self.radius
    }
}

impl Reach {
    /// A start before the scene for parallel light along `direction`, and its density per unit area across it. Half of the
    /// light is aimed at the casters where there are any; both ways to get a line are weighed together.
    pub(super) fn aim(&self, direction: Vec3, u_part: f32, u: Vec2) -> (Vec3, f32) {
        let at_casters = self.casters.is_some() && u_part < 0.5;
        let ball = self.casters.filter(|_| at_casters).unwrap_or(self.scene);
        let disc = warp::square_to_disc(u) * ball.radius;
        let frame = Frame::from_normal(direction);
        let through = ball.centre + frame.tangent * disc.x + frame.bitangent * disc.y;
        let before = (through - self.scene.centre).dot(direction) + self.scene.radius;
        // The ball that was aimed at is met whatever rounding says at its rim: no line has density zero.
        let density = |b: &Ball, aimed_at: bool| {
            if aimed_at || b.is_met(through, direction) { 1.0 / b.cross_section() } else { 0.0 }
        };
        let pdf = match &self.casters {
            None => density(&self.scene, true),
            Some(casters) => 0.5 * density(&self.scene, !at_casters) + 0.5 * density(casters, at_casters),
        };
        (through - direction * before, pdf)
    }
}
