//! The samples of a pass at a block of pixels.

use std::ops::Range;

use foton_math::{Purpose, Stream};
use foton_scene::Scene;
use foton_transport::camera_paths::PixelSamples;
use foton_transport::{Differential, LeftOut, Omissions, Quantity, Surface};

use super::estimator::Estimator;
use super::sample::{EyeSample, Numbers, Seen, scrambles};
use crate::settings::RenderSettings;

/// Pixels of a block.
pub(super) const BLOCK: usize = 256;

/// What a block's pixels have seen in a pass: sums over the samples of each.
pub(super) struct Block {
    pub(super) pixels: Vec<Seen>,
    pub(super) rays: u64,
    pub(super) omissions: Omissions,
}

/// What it takes to follow the samples of a pass.
pub(super) struct Sampling<'a> {
    pub(super) scene: &'a Scene,
    pub(super) settings: &'a RenderSettings,
    pub(super) estimator: &'a Estimator,
    /// Passes before this one.
    pub(super) before: u64,
}

impl Sampling<'_> {
    pub(super) fn block(&self, pixels: Range<usize>) -> Block {
        let mut block =
            Block { pixels: Vec::with_capacity(pixels.len()), rays: 0, omissions: Omissions::default() };
        for pixel in pixels {
            let seen = self.pixel(pixel, &mut block.omissions);
            block.rays += seen.rays;
            block.pixels.push(seen);
        }
        block
    }

    fn pixel(&self, pixel: usize, omissions: &mut Omissions) -> Seen {
        let sensor = &self.scene.sensors()[self.settings.sensor];
        let (x, y) = (pixel % sensor.width as usize, pixel / sensor.width as usize);
        let corner = foton_math::glam::Vec2::new(x as f32, y as f32);
        // Passes take turns with two sequences that are independent of each other: by their difference the noise of both is known.
        let (sequence, turn) = (self.before % 2, self.before / 2);
        let key = if sequence == 0 { 0 } else { u64::MAX };
        let mut scramble = Stream::new(self.settings.seed, Purpose::Eye, key, pixel as u64);
        let places = PixelSamples::new(&mut scramble);
        let directions = PixelSamples::new(&mut scramble);
        let lights = scrambles(&mut scramble);
        let lens = PixelSamples::shuffled(&mut scramble);
        let samples = u64::from(self.settings.samples_per_pixel.get());
        let mut sum = Seen::default();
        for i in 0..samples {
            let index = self.before * samples + i;
            // A sequence has 2³² points; what comes after them begins anew, with other numbers along the path.
            let point = (turn * samples + i) as u32;
            let place = places.point(point);
            let stream = Stream::new(self.settings.seed, Purpose::Path, index, pixel as u64);
            let ray = sensor.eye_ray(corner + 0.5 + sensor.filter.offset(place), lens.point(point));
            let sample = EyeSample {
                ray,
                differential: Differential::of_eye(self.scene, sensor, &ray, 1, true),
                numbers: Numbers::new(stream, point, lights, directions.point(point)),
            };
            let mut seen = Seen::default();
            self.estimator.follow(self.scene, sample, &mut seen);
            sum.rays += seen.rays;
            sum.scatters |= seen.scatters;
            sum.shape = if i == 0 { seen.shape } else { sum.shape };
            if seen.all().is_finite() {
                sum.emission += seen.emission;
                sum.reflected.iter_mut().zip(seen.reflected).for_each(|(sum, light)| *sum += light);
            } else {
                omissions.add(seen.left_out.unwrap_or(LeftOut {
                    quantity: Quantity::PixelSum,
                    light: None,
                    surface: Surface::Unknown,
                    position: sensor.origin(),
                }));
            }
        }
        sum
    }
}
