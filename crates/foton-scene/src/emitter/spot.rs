//! A point emitter with a cone.

use std::f32::consts::FRAC_PI_2;

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Frame, Rgb, warp};

use super::aim::Aim;
use super::emission::{Emission, Illumination, from_point};
use super::extent::Extent;

/// A point emitter with a cone.
#[derive(Clone, Debug)]
pub(crate) struct Spot {
    pub(crate) position: Vec3,
    pub(crate) frame: Frame,
    pub(crate) intensity: Rgb,
    pub(crate) cone: Cone,
}

/// How a spot's light fades around its axis. Half angles in radians.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cone {
    /// Beyond it there is no light.
    pub(crate) cutoff: f32,
    /// Within it the light is full.
    pub(crate) beam: f32,
}

impl Cone {
    /// Relative intensity along a unit vector of the emitter's space: 1 inside the beam, falling linearly with the angle to 0 at the
    /// cutoff, as in Mitsuba 3.
    pub(super) fn falloff(&self, local: Vec3) -> f32 {
        let angle = local.x.hypot(local.y).atan2(local.z);
        if angle >= self.cutoff {
            0.0
        } else if angle <= self.beam {
            1.0
        } else {
            (self.cutoff - angle) / (self.cutoff - self.beam)
        }
    }

    /// 1 − cos of the cutoff, by a form that does not cancel for a narrow beam.
    pub(super) fn one_minus_cos(&self) -> f32 {
        2.0 * (self.cutoff * 0.5).sin().powi(2)
    }
}

impl Spot {
    /// Relative intensity along a unit direction of the scene.
    pub(crate) fn falloff(&self, direction: Vec3) -> f32 {
        self.cone.falloff(self.frame.to_local(direction))
    }

    pub(super) fn emit(&self, aim: &Aim, u: Vec2) -> Emission {
        let own = |u| self.frame.to_outer(warp::square_to_cone(u, self.cone.one_minus_cos()));
        let uniform = warp::square_to_cone_pdf(self.cone.one_minus_cos());
        let (direction, pdf) = if aim.is_empty() {
            (own(u), uniform)
        } else {
            aim.divergent(self.position, u, own, |d| if self.falloff(d) > 0.0 { uniform } else { 0.0 })
        };
        Emission { origin: self.position, direction, power: self.intensity * (self.falloff(direction) / pdf) }
    }

    pub(super) fn extent(&self) -> Extent {
        Extent {
            axis: self.frame.normal,
            // Beyond a right angle of the axis it is as if normals spread.
            normals: (self.cone.cutoff - FRAC_PI_2).max(0.0),
            reach: self.cone.cutoff.min(FRAC_PI_2),
            ..Extent::of_point(self.position, self.intensity.luminance())
        }
    }

    pub(super) fn illuminate(&self, position: Vec3) -> Option<Illumination> {
        let direction = (position - self.position).try_normalize()?;
        from_point(self.position, position, self.intensity * self.falloff(direction))
    }

    /// ∫ I dω / I = 2π (1 − cos b + ∫_b^c (c − θ)/(c − b) sin θ dθ), and the integral is cos b − (sin c − sin b)/(c − b).
    pub(super) fn power_factor(&self) -> f32 {
        let (c, b) = (f64::from(self.cone.cutoff), f64::from(self.cone.beam));
        let fade = if c > b { b.cos() - (c.sin() - b.sin()) / (c - b) } else { 0.0 };
        (2.0 * std::f64::consts::PI * (1.0 - b.cos() + fade)) as f32
    }
}
