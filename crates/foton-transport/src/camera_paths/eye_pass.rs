//! The eye pass: from the sensor through mirrors, glass and narrow gloss to the surfaces that spread light, each sample once.
//! Methods that follow new samples in each pass have an eye pass for each.
//!
//! At each surface a hit point gathers light for the lobes that spread it, and the path goes on by the specular ones. Where there
//! are several of those, it splits, weighted by Fresnel, while its weight and depth are worth it and the sample's share of hit
//! points lasts; after that it chooses one at random. Emission seen by specular bounces alone is added up here, and no photons
//! are stored for it.

use std::num::NonZeroU32;

use foton_math::{Purpose, Rgb};
use foton_scene::{Scene, Sensor};

use super::hit_point::{Gloss, HitPoint};
use super::radius::FirstRadius;
use crate::lobes::{LobePolicy, LobeUse};
use crate::not_finite::LeftOut;

/// The value of the shape-id layer where a pixel sees nothing.
pub const NO_SHAPE: u32 = u32::MAX;

/// What the eye pass finds in some pixels.
#[derive(Default)]
pub struct EyePaths {
    /// Samples of each pixel that were followed: the first so many.
    pub samples: u32,
    /// Pixel by pixel.
    pub hit_points: Vec<HitPoint>,
    /// How those scatter that are not Lambertian.
    pub gloss: Vec<Gloss>,
    /// Hit points of each pixel.
    pub counts: Vec<u32>,
    /// Emitted light that each pixel sees directly or by specular bounces, summed over its samples.
    pub emission: Vec<Rgb>,
    /// Shape that each pixel's first sample meets first; [`NO_SHAPE`] for none.
    pub shapes: Vec<u32>,
    /// Rays traced.
    pub rays: u64,
    /// Paths dropped because their weight or light was not a finite number.
    pub dropped: u64,
    /// The first of those values.
    pub left_out: Option<LeftOut>,
}

impl EyePaths {
    /// Adds what was found in the pixels after these.
    pub fn append(&mut self, part: Self) {
        let before = self.gloss.len() as u32;
        self.hit_points.extend(
            part.hit_points.into_iter().map(|h| HitPoint { gloss: h.gloss.map(|g| g.after(before)), ..h }),
        );
        self.gloss.extend(part.gloss);
        self.counts.extend(part.counts);
        self.emission.extend(part.emission);
        self.shapes.extend(part.shapes);
        self.rays += part.rays;
        self.dropped += part.dropped;
        self.left_out = self.left_out.or(part.left_out);
    }

    /// Mean emitted light that each pixel sees directly or by specular bounces.
    pub fn mean_emission(&self) -> Vec<Rgb> {
        self.emission.iter().map(|&sum| sum / self.samples as f32).collect()
    }

    /// Where each pixel's hit points begin, and one entry more.
    pub fn pixel_start(&self) -> Vec<u32> {
        let mut start = Vec::with_capacity(self.counts.len() + 1);
        let mut sum = 0;
        start.push(0);
        for &count in &self.counts {
            sum += count;
            start.push(sum);
        }
        start
    }
}

/// Everything the eye pass needs to know.
pub struct EyePass<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Index of the sensor.
    pub sensor: usize,
    /// Eye samples a pixel.
    pub samples_per_pixel: NonZeroU32,
    /// How many passes were before this one, where each follows new samples.
    pub pass: Option<u64>,
    /// Hit points that one eye sample may make by splitting at glass.
    pub hit_points_per_sample: NonZeroU32,
    /// The first radius of each hit point, and the smallest.
    pub radius: FirstRadius,
    /// Longest whole path in edges.
    pub max_depth: u32,
    /// Which lobes paths follow.
    pub policy: LobePolicy,
    /// What that means in this scene.
    pub uses: LobeUse,
    /// The seed of all random streams.
    pub seed: u64,
    /// What the streams are for.
    pub purpose: Purpose,
}

impl EyePass<'_> {
    pub(super) fn sensor(&self) -> &Sensor {
        &self.scene.sensors()[self.sensor]
    }
}
