//! The first radius of a hit point, and the smallest.
//!
//! r₀ = c √(A/π), where A is the area that the pixel covers on the surface: neighbouring discs overlap as much on a near wall
//! as on a far floor. Through mirrors and glass the footprint is that of the unfolded path (curved ones focus or spread it;
//! the clamp bounds what that can do). Radii stay below a share of the scene, so that the first passes do not blur it all.
//!
//! Eye samples stand still, so light that is narrower than the gaps between them is seen only by discs that are as wide as the
//! gaps. A radius that shrank below them would let a narrow beam fall between the samples: it would be lost from the picture. So
//! no radius falls below a multiple of √(A/n), the spacing of a pixel's n samples. Out of focus these lie in the circle of confusion,
//! whose area is then added to A: a lens has blurred there already what such a radius blurs.

use std::f32::consts::PI;

use foton_math::glam::Vec3;
use foton_scene::Scene;

/// c: a disc of four footprints' radius holds some 16 footprints.
const FOOTPRINTS: f32 = 4.0;

/// The largest first radius as a share of the scene's bounding radius.
const MAX_SHARE: f32 = 0.05;

/// Cosines below this count as this: a footprint at grazing angles stays finite.
const MIN_COSINE: f32 = 0.05;

/// The rule, for one scene and setting. Lengths in scene units.
#[derive(Clone, Copy, Debug)]
pub struct FirstRadius {
    fixed: Option<f32>,
    /// Factor on what the rule gives.
    scale: f32,
    largest: f32,
    /// The floor over the square root of a pixel's footprint.
    floor: f32,
}

impl FirstRadius {
    /// `radius` is that of every hit point in world units, or `None` for one by the pixel's footprint; `scale` is a factor on either, and
    /// `floor` the smallest radius in spacings of the eye samples.
    #[must_use]
    pub fn new(scene: &Scene, radius: Option<f64>, scale: f64, floor: f64, samples_per_pixel: u32) -> Self {
        Self {
            // A disc beyond the whole scene finds what one of its size finds, and its square must stay finite.
            fixed: radius.map(|r| scene.normalisation().length(r).min(2.0 * scene.bounds().radius())),
            scale: scale as f32,
            largest: MAX_SHARE * scene.bounds().radius(),
            floor: floor as f32 / (samples_per_pixel as f32).sqrt(),
        }
    }

    /// Squares of the first radius and of the smallest at `position`, where a pixel covers `area` and a lens spreads each of its points
    /// over `confusion`.
    pub fn first_and_smallest2(&self, area: f32, confusion: f32, position: Vec3) -> (f32, f32) {
        let radius = self.fixed.unwrap_or_else(|| (FOOTPRINTS * (area / PI).sqrt()).min(self.largest));
        let resolved = smallest_radius(position.abs().max_element());
        let first = (radius * self.scale).max(resolved);
        let smallest = (self.floor * (area + confusion).sqrt()).clamp(resolved, first);
        (first * first, smallest * smallest)
    }
}

/// An area across the line of sight, on a surface that is seen at `cosine` to its normal.
pub(super) fn on_surface(area: f32, cosine: f32) -> f32 {
    area / cosine.max(MIN_COSINE)
}

/// Eight units in the last place of the largest coordinate: below that positions are too coarse for a disc.
fn smallest_radius(largest_coordinate: f32) -> f32 {
    let exponent = largest_coordinate.max(f32::MIN_POSITIVE).log2().floor();
    8.0 * f32::EPSILON * exponent.exp2()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a pixel of so many steradians covers.
    fn footprint(solid_angle: f32, distance: f32, cosine: f32) -> f32 {
        on_surface(distance * distance * solid_angle, cosine)
    }

    #[test]
    fn the_radius_grows_with_the_footprint_and_is_clamped() {
        let rule = FirstRadius { fixed: None, scale: 1.0, largest: 10.0, floor: 0.5 };
        let here = Vec3::splat(2000.0);
        let of = |rule: &FirstRadius, distance, cosine| {
            let (first2, smallest2) = rule.first_and_smallest2(footprint(1e-4, distance, cosine), 0.0, here);
            (first2.sqrt(), smallest2.sqrt())
        };
        let r = |distance, cosine| of(&rule, distance, cosine).0;
        assert!((r(20.0, 1.0) / r(10.0, 1.0) - 2.0).abs() < 1e-5);
        assert!((r(10.0, 0.25) / r(10.0, 1.0) - 2.0).abs() < 1e-5);
        assert!((r(1e9, 1.0) - 10.0).abs() < 1e-5 && r(0.0, 1.0) == smallest_radius(2000.0));
        let fixed = FirstRadius { fixed: Some(50.0), ..rule };
        assert_eq!(of(&fixed, 1.0, 1.0).0, 50.0);
        let half = FirstRadius { scale: 0.5, ..rule };
        assert!((r(20.0, 1.0) / of(&half, 20.0, 1.0).0 - 2.0).abs() < 1e-5);
    }

    #[test]
    fn the_smallest_radius_is_a_multiple_of_the_samples_spacing_and_never_above_the_first() {
        let rule = FirstRadius { fixed: None, scale: 1.0, largest: 10.0, floor: 0.5 };
        let smallest = |rule: &FirstRadius, at: f32| {
            rule.first_and_smallest2(footprint(1e-4, 20.0, 1.0), 0.0, Vec3::new(0.0, at, 0.0)).1.sqrt()
        };
        // √(20² · 10⁻⁴) is 0.2.
        assert!((smallest(&rule, 1.0) - 0.1).abs() < 1e-6);
        assert!((smallest(&FirstRadius { fixed: Some(0.03), ..rule }, 1.0) - 0.03).abs() < 1e-6);
        // A lens spreads them further, as far as the first radius, 0.45.
        let out_of_focus = |confusion| rule.first_and_smallest2(0.04, confusion, Vec3::ZERO).1.sqrt();
        assert!((out_of_focus(0.12) - 0.2).abs() < 1e-6 && (out_of_focus(9.0) - 0.451_352).abs() < 1e-5);
        let none = FirstRadius { floor: 0.0, ..rule };
        assert!((smallest(&none, 1500.0) / smallest_radius(1500.0) - 1.0).abs() < 1e-5);
        assert!(
            smallest(&none, 1.0) < 1e-5,
            "what is near the middle of a large scene has finer coordinates"
        );
    }

    #[test]
    fn the_smallest_radius_is_eight_ulps() {
        assert_eq!(smallest_radius(1500.0), 8.0 * (f32::from_bits(1500f32.to_bits() + 1) - 1500.0));
    }
}
