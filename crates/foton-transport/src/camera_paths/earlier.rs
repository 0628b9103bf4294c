//! Eye samples that were followed before, taken over pixel by pixel.

use foton_math::Rgb;

use super::eye_pass::{EyePaths, NO_SHAPE};
use super::hit_point::{GlossIndex, HitPoint};

/// What was found of the first samples of each pixel, and where.
pub(super) struct Earlier {
    paths: EyePaths,
    /// The hit points of pixel p are `start[p]..start[p + 1]`.
    start: Vec<u32>,
}

impl Earlier {
    pub(super) fn new(paths: EyePaths) -> Self {
        Self { start: paths.pixel_start(), paths }
    }

    /// Samples of each pixel that were followed.
    pub(super) const fn samples(&self) -> u32 {
        self.paths.samples
    }

    /// Appends what a pixel's samples found, as if they had just been followed; returns the emitted light that they see.
    pub(super) fn append_to(&self, paths: &mut EyePaths, pixel: usize) -> Rgb {
        if self.samples() == 0 {
            paths.shapes.push(NO_SHAPE);
            return Rgb::BLACK;
        }
        let range = self.start[pixel] as usize..self.start[pixel + 1] as usize;
        for hit_point in &self.paths.hit_points[range] {
            let gloss = hit_point.gloss.and_then(|gloss| {
                paths.gloss.push(self.paths.gloss[gloss.get()]);
                GlossIndex::last_of(paths.gloss.len())
            });
            paths.hit_points.push(HitPoint { gloss, ..*hit_point });
        }
        paths.shapes.push(self.paths.shapes[pixel]);
        self.paths.emission[pixel]
    }

    /// Adds what was counted on the way, without what was found.
    pub(super) fn add_counts_to(&self, paths: &mut EyePaths) {
        paths.rays += self.paths.rays;
        paths.dropped += self.paths.dropped;
        paths.left_out = self.paths.left_out.or(paths.left_out);
    }
}
