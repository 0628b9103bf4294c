//! World units to scene units: a shift and a scaling by a power of two.
//!
//! A scene's half-size becomes 2^10 to 2^11 scene units. Absolute tolerances (the tree's, say) are then the same for a ring
//! of millimetres and for a harbour, and since the factor is a power of two a scene scaled by one gives the same bits.

use foton_math::glam::{DAffine3, DVec3, Vec3};

/// The exponent of the scene's half-size after scaling.
const HALF_SIZE_EXPONENT: i32 = 11;

/// Scenes whose half-size is 2 to the power of more than this, or less than its negative, are scaled as if it were that: beyond,
/// the factor itself is no number.
const MAX_EXPONENT: i32 = 1000;

/// The map between world units and scene units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normalisation {
    centre: DVec3,
    scale: f64,
}

impl Normalisation {
    /// Scene units that are world units.
    pub const IDENTITY: Self = Self { centre: DVec3::ZERO, scale: 1.0 };

    /// The map for a scene that spans `min` to `max` in world units. A scene without extent is only shifted.
    #[must_use]
    pub fn for_bounds(min: DVec3, max: DVec3) -> Self {
        // Halves first: the whole may be no number.
        let half = (max * 0.5 - min * 0.5).max_element();
        let centre = min * 0.5 + max * 0.5;
        if !(half > 0.0 && half.is_finite() && centre.is_finite()) {
            return Self { centre: if centre.is_finite() { centre } else { DVec3::ZERO }, scale: 1.0 };
        }
        let exponent = (half.log2().ceil() as i32).clamp(-MAX_EXPONENT, MAX_EXPONENT);
        Self { centre, scale: 2f64.powi(HALF_SIZE_EXPONENT - exponent) }
    }

    /// Scene units per world unit, a power of two.
    #[must_use]
    pub const fn scale(&self) -> f64 {
        self.scale
    }

    /// A point in scene units.
    #[must_use]
    pub fn point(&self, world: DVec3) -> Vec3 {
        ((world - self.centre) * self.scale).as_vec3()
    }

    /// One coordinate of a point in scene units.
    #[inline(always)]
    pub(crate) fn coordinate(&self, axis: usize, world: f64) -> f32 {
        ((world - self.centre[axis]) * self.scale) as f32
    }

    /// The map itself.
    #[must_use]
    pub(crate) fn to_affine(self) -> DAffine3 {
        DAffine3::from_scale(DVec3::splat(self.scale)) * DAffine3::from_translation(-self.centre)
    }

    /// A length in scene units.
    #[must_use]
    pub fn length(&self, world: f64) -> f32 {
        (world * self.scale) as f32
    }

    /// The farther half-size of a scene, in scene units.
    pub(crate) const HALF_SIZE: f64 = (1u64 << HALF_SIZE_EXPONENT) as f64;

    /// How far a point of the world is from the middle of the scene, along the axis on which it is farthest, in scene units.
    pub(crate) fn distance(&self, world: DVec3) -> f64 {
        ((world - self.centre) * self.scale).abs().max_element()
    }

    /// A point in world units.
    #[must_use]
    pub fn world_point(&self, point: Vec3) -> DVec3 {
        point.as_dvec3() / self.scale + self.centre
    }

    /// A length in world units.
    #[must_use]
    pub fn world_length(&self, length: f64) -> f64 {
        length / self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn power_of_two_multiples_of_a_scene_have_the_same_coordinates() {
        let (min, max, p) =
            (DVec3::new(-1.3, 0.2, 5.0), DVec3::new(2.7, 9.1, 7.7), DVec3::new(0.1, 3.3, 6.01));
        let at = |s: f64| Normalisation::for_bounds(min * s, max * s).point(p * s);
        assert_eq!(at(1.0), at(2f64.powi(-40)));
        assert_eq!(at(1.0), at(2f64.powi(33)));
        let half = at(1.0) - Normalisation::for_bounds(min, max).point(max);
        assert!(half.length() > 100.0);
    }
}
