//! A ray with the interval in which hits count.

use glam::Vec3;

/// Points `origin + t · direction` with `t_min ≤ t ≤ t_max`.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where `t = 0`.
    pub origin: Vec3,
    /// Unit length, so that `t` is a distance in scene units.
    pub direction: Vec3,
    /// The nearest distance that counts as a hit.
    pub t_min: f32,
    /// The farthest distance that counts as a hit.
    pub t_max: f32,
}

impl Ray {
    /// A ray without an end. Its origin is expected to be offset from the surface that it leaves.
    #[must_use]
    #[inline]
    pub const fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, direction, t_min: 0.0, t_max: f32::INFINITY }
    }

    /// The point at distance `t`.
    #[must_use]
    #[inline]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}
