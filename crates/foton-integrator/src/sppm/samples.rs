//! The eye samples of a pass, followed band by band of the picture, so that the work can make way between two of them.

use std::num::NonZeroU32;

use foton_math::Purpose;
use foton_scene::Scene;
use foton_transport::camera_paths::{EyePass, EyePaths};
use foton_transport::{Cancel, Halt, ShouldSuspend, Suspended};
use rayon::prelude::*;

use super::pixels::Pixels;
use crate::by_block::ByBlock;
use crate::ppm::eye_samples::eye_pass;
use crate::settings::RenderSettings;

/// About this many samples are followed in one task.
const SAMPLES: u32 = 1 << 13;

/// Rows of a band at most: packets of sixteen neighbours are square in it.
const MAX_ROWS: u32 = 8;

/// Eye samples under way.
#[derive(Default)]
pub(super) struct Samples {
    bands: Vec<Option<Band>>,
}

/// What a band has found, with the first r² of its hit points.
struct Band {
    paths: EyePaths,
    first_radius2: Vec<f32>,
}

impl Samples {
    /// Follows the samples of the pass after so many others. Hit points get the radii that their pixels have come to; their first r² are
    /// given back beside them.
    ///
    /// # Errors
    /// When cancelled, none has then been followed; and when suspended, to be called again.
    pub(super) fn follow(
        &mut self,
        (scene, settings, pass): (&Scene, &RenderSettings, u64),
        pixels: &Pixels,
        cancel: &Cancel,
        should_suspend: ShouldSuspend<'_>,
    ) -> Result<(EyePaths, Vec<f32>), Halt> {
        let max_depth = settings.max_depth_in(scene);
        let eye = EyePass { pass: Some(pass), ..eye_pass(scene, settings, max_depth, Purpose::Eye) };
        let sensor = &scene.sensors()[settings.sensor];
        let in_band = rows(sensor.width, settings.samples_per_pixel) * sensor.width;
        let all = sensor.width * sensor.height;
        let bands = ByBlock { done: &mut self.bands, should_suspend };
        bands.places(all.div_ceil(in_band) as usize).enumerate().for_each(|(band, place)| {
            let first = band as u32 * in_band;
            place.fill(|| Band::follow(&eye, first..all.min(first + in_band), pixels, cancel));
        });
        if let Err(cancelled) = cancel.check() {
            self.bands.clear();
            return Err(cancelled.into());
        }
        if self.bands.iter().any(Option::is_none) {
            return Err(Suspended.into());
        }
        let mut paths = EyePaths { samples: settings.samples_per_pixel.get(), ..EyePaths::default() };
        let found = self.bands.iter().flatten().map(|band| band.first_radius2.len()).sum();
        let mut first_radius2 = Vec::with_capacity(found);
        paths.hit_points.reserve_exact(found);
        for band in self.bands.drain(..).flatten() {
            paths.append(band.paths);
            first_radius2.extend(band.first_radius2);
        }
        Ok((paths, first_radius2))
    }

    /// Whether some samples of a pass have been followed, and the pass goes on.
    pub(super) fn is_begun(&self) -> bool {
        self.bands.iter().any(Option::is_some)
    }

    /// Gives up what has been followed.
    pub(super) fn clear(&mut self) {
        self.bands.clear();
    }
}

/// Rows of a band in an image of that width.
fn rows(width: u32, samples_per_pixel: NonZeroU32) -> u32 {
    (SAMPLES / width.saturating_mul(samples_per_pixel.get()).max(1)).clamp(1, MAX_ROWS)
}

impl Band {
    fn follow(eye: &EyePass<'_>, range: std::ops::Range<u32>, pixels: &Pixels, cancel: &Cancel) -> Self {
        let mut paths = eye.follow(range.clone(), cancel);
        let first_radius2 = paths.hit_points.iter().map(|h| h.radius2).collect();
        let mut hit_points = paths.hit_points.iter_mut();
        for (pixel, count) in range.zip(&paths.counts) {
            let factor = pixels.factor(pixel as usize);
            for hit_point in hit_points.by_ref().take(*count as usize) {
                hit_point.radius2 = radius2(factor, hit_point.radius2, hit_point.smallest2) as f32;
            }
        }
        Self { paths, first_radius2 }
    }
}

/// The r² of a hit point whose pixel has come to that factor.
pub(super) fn radius2(factor: f64, first: f32, smallest: f32) -> f64 {
    (factor * f64::from(first)).max(f64::from(smallest))
}
