//! Hit points and photons, for display. World units. Methods without any have none to show.

use foton_math::glam::DVec3;

use super::{Render, Running};
use crate::ppm::{Disc, PhotonPath, Radii, StoredPhoton};

impl Render {
    /// The spread of radii as it is now.
    #[must_use]
    pub fn radii(&self) -> Radii {
        each!(&self.0, r => r.radii())
    }

    /// The discs of a pixel's hit points, in the order of its samples. `pixel` counts along rows from the top left; one beyond
    /// the image has none.
    #[must_use]
    pub fn discs(&self, pixel: usize) -> Vec<Disc> {
        each!(&self.0, r => r.discs(pixel))
    }

    /// Photons of the last pass, `at_most` of them, spread evenly over the scene's cells.
    #[must_use]
    pub fn stored_photons(&self, at_most: usize) -> Vec<StoredPhoton> {
        each!(&self.0, r => r.stored_photons(at_most))
    }

    /// Photons of the last pass within `radius` of a point, `at_most` of them.
    #[must_use]
    pub fn photons_near(&self, position: DVec3, radius: f64, at_most: usize) -> Vec<StoredPhoton> {
        each!(&self.0, r => r.photons_near(position, radius, at_most))
    }

    /// Paths of photons of the last pass, or of the one under way, that count for a pixel's hit points, `at_most` of them; of passes in
    /// several batches some. They are traced again for that. `pixel` counts along rows from the top left; one beyond the image has none.
    #[must_use]
    pub fn paths_to(&self, pixel: usize, at_most: usize) -> Vec<PhotonPath> {
        each!(&self.0, r => r.paths_to(pixel, at_most))
    }

    /// Mean radius of each pixel's hit points, in world units; 0 without hit points.
    #[must_use]
    pub fn mean_radii(&self) -> Vec<f32> {
        each!(&self.0, r => r.mean_radii())
    }

    /// Photons found by each pixel's hit points in all passes.
    #[must_use]
    pub fn photons_found(&self) -> Vec<u32> {
        each!(&self.0, r => r.photons_found())
    }

    /// Per pixel, the share of its hit points that have found no photon in any pass: unknown, not dark.
    #[must_use]
    pub fn unknown_share(&self) -> Vec<f32> {
        each!(&self.0, r => r.unknown_share())
    }
}
