//! The first radius of a hit point.
//!
//! r₀ = c √(A/π), where A is the area that the pixel covers on the surface: neighbouring discs overlap as much on a near wall
//! as on a far floor. Through mirrors and glass the footprint is that of the unfolded path (curved ones focus or spread it;
//! the clamp bounds what that can do). Radii stay below a share of the scene, so that the first passes do not blur it all.

use std::f32::consts::PI;

use foton_scene::{Scene, Surface};

use crate::settings::Settings;

/// c: a disc of four footprints' radius holds some 16 footprints.
const FOOTPRINTS: f32 = 4.0;

/// The largest first radius as a share of the scene's bounding radius.
const LARGEST_SHARE: f32 = 0.05;

/// Cosines below this count as this: a footprint at grazing angles stays finite.
const SMALLEST_COSINE: f32 = 0.05;

/// The rule, for one scene and setting. Lengths in scene units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FirstRadius {
    fixed: Option<f32>,
    /// Factor on what the rule gives.
    scale: f32,
    largest: f32,
    smallest: f32,
}

impl FirstRadius {
    pub(crate) fn new(scene: &Scene, settings: &Settings) -> Self {
        let largest_coordinate = scene.bounds().min.abs().max(scene.bounds().max.abs()).max_element();
        Self {
            // A disc beyond the whole scene finds what one of its size finds, and its square must stay finite.
            fixed: settings
                .radius
                .map(|r| scene.normalisation().length(r).min(2.0 * scene.bounds().radius())),
            scale: settings.radius_scale.get() as f32,
            largest: LARGEST_SHARE * scene.bounds().radius(),
            smallest: smallest_radius(largest_coordinate),
        }
    }

    /// The squared first radius at a point that a pixel of `solid_angle` sees after `distance` in all, at `cosine` to the
    /// surface's normal.
    pub(crate) fn radius2(&self, solid_angle: f32, distance: f32, cosine: f32) -> f32 {
        let radius = self.fixed.unwrap_or_else(|| {
            let area = distance * distance * solid_angle / cosine.max(SMALLEST_COSINE);
            (FOOTPRINTS * (area / PI).sqrt()).min(self.largest)
        });
        let radius = (radius * self.scale).max(self.smallest);
        radius * radius
    }

    /// The square below which no radius shrinks.
    pub(crate) fn smallest2(&self) -> f64 {
        f64::from(self.smallest) * f64::from(self.smallest)
    }
}

/// Eight units in the last place of the largest coordinate: below that positions are too coarse for a disc.
fn smallest_radius(largest_coordinate: f32) -> f32 {
    let exponent = largest_coordinate.max(f32::MIN_POSITIVE).log2().floor();
    8.0 * f32::EPSILON * exponent.exp2()
}

/// Squared half-thickness of the slab around the tangent plane in which photons count, over the squared radius.
///
/// A plane needs none, but a neighbouring step or a parallel sheet must stay out. A curved surface leaves its tangent plane
/// by r/2R, and is let in as long as normals agree.
pub(crate) fn slab2(surface: &Surface) -> f32 {
    if surface.curved { 1.0 } else { 0.01 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_radius_grows_with_the_footprint_and_is_clamped() {
        let rule = FirstRadius { fixed: None, scale: 1.0, largest: 10.0, smallest: 0.01 };
        let r = |distance, cosine| rule.radius2(1e-4, distance, cosine).sqrt();
        assert!((r(20.0, 1.0) / r(10.0, 1.0) - 2.0).abs() < 1e-5);
        assert!((r(10.0, 0.25) / r(10.0, 1.0) - 2.0).abs() < 1e-5);
        assert!((r(1e9, 1.0) - 10.0).abs() < 1e-5 && (r(0.0, 1.0) - 0.01).abs() < 1e-7);
        let fixed = FirstRadius { fixed: Some(50.0), ..rule };
        assert_eq!(fixed.radius2(1e-4, 1.0, 1.0), 2500.0);
        let half = FirstRadius { scale: 0.5, ..rule };
        assert!((half.radius2(1e-4, 20.0, 1.0) / rule.radius2(1e-4, 20.0, 1.0) - 0.25).abs() < 1e-5);
    }

    #[test]
    fn the_smallest_radius_is_eight_ulps() {
        assert_eq!(smallest_radius(1500.0), 8.0 * (f32::from_bits(1500f32.to_bits() + 1) - 1500.0));
    }
}
