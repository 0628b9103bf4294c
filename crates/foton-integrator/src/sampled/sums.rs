//! Sums over passes, pixel by pixel, and what they say of the error.

use foton_math::Rgb;
use foton_transport::camera_paths::NO_SHAPE;
use foton_transport::codec::{Reader, StateError, Writer};
use foton_transport::photon_map::PathClass;

use super::block::Block;
use super::sample::Seen;
use crate::error::{Independent, PassPixel};

/// Path classes.
const CLASSES: usize = PathClass::ALL.len();

/// Light by pixel.
pub(super) struct PixelSums {
    /// Σ over passes of the mean over their samples.
    all: Vec<[f64; 3]>,
    emission: Vec<[f64; 3]>,
    classes: Option<Vec<[[f64; 3]; CLASSES]>>,
    /// The last pass's mean.
    pub(super) last: Vec<Rgb>,
    pub(super) shapes: Vec<u32>,
    pub(super) error: Option<Independent>,
    passes: f64,
}

impl PixelSums {
    pub(super) fn new((width, height): (u32, u32), by_class: bool, error: bool) -> Self {
        let pixels = width as usize * height as usize;
        Self {
            all: vec![[0.0; 3]; pixels],
            emission: vec![[0.0; 3]; pixels],
            classes: by_class.then(|| vec![[[0.0; 3]; CLASSES]; pixels]),
            last: vec![Rgb::BLACK; pixels],
            shapes: vec![NO_SHAPE; pixels],
            error: error.then(|| Independent::new(width as usize, pixels)),
            passes: 0.0,
        }
    }

    /// Adds a pass of so many samples a pixel.
    pub(super) fn add(&mut self, blocks: impl Iterator<Item = Block>, samples: u32) {
        let is_first = self.passes == 0.0;
        self.passes += 1.0;
        let mut seen = Vec::with_capacity(self.all.len());
        blocks.for_each(|block| seen.extend(block.pixels));
        for (pixel, seen) in seen.iter().enumerate() {
            self.add_to_pixel(pixel, seen, samples as f32);
            if is_first {
                self.shapes[pixel] = seen.shape.unwrap_or(NO_SHAPE);
            }
        }
        if let Some(mut error) = self.error.take() {
            error.add(|pixel| PassPixel {
                emission: f64::from(seen[pixel].emission.luminance()) / f64::from(samples),
                reflected: f64::from((seen[pixel].all() - seen[pixel].emission).luminance())
                    / f64::from(samples),
                reflected_so_far: luminance(self.all[pixel]) - luminance(self.emission[pixel]),
                scatters: seen[pixel].scatters,
            });
            self.error = Some(error);
        }
    }

    fn add_to_pixel(&mut self, pixel: usize, seen: &Seen, samples: f32) {
        let all = seen.all() / samples;
        self.last[pixel] = all;
        add_to(&mut self.all[pixel], all);
        add_to(&mut self.emission[pixel], seen.emission / samples);
        if let Some(classes) = &mut self.classes {
            classes[pixel]
                .iter_mut()
                .zip(seen.reflected)
                .for_each(|(sum, light)| add_to(sum, light / samples));
        }
    }

    pub(super) fn radiance(&self, pixel: usize) -> Rgb {
        self.all.get(pixel).map_or(Rgb::BLACK, |sum| self.mean(sum))
    }

    pub(super) fn image(&self) -> Vec<Rgb> {
        self.all.iter().map(|sum| self.mean(sum)).collect()
    }

    pub(super) fn emission(&self) -> Vec<Rgb> {
        self.emission.iter().map(|sum| self.mean(sum)).collect()
    }

    /// `None` where light is not summed by class.
    pub(super) fn class(&self, class: PathClass) -> Option<Vec<Rgb>> {
        let classes = self.classes.as_ref()?;
        Some(classes.iter().map(|sums| self.mean(&sums[class as usize])).collect())
    }

    pub(super) const fn has_classes(&self) -> bool {
        self.classes.is_some()
    }

    fn mean(&self, sum: &[f64; 3]) -> Rgb {
        let scale = 1.0 / self.passes.max(1.0);
        Rgb::from_array(sum.map(|s| (s * scale) as f32))
    }

    pub(super) fn bytes(&self) -> usize {
        let by_class = if self.classes.is_some() { size_of::<[[f64; 3]; CLASSES]>() } else { 0 };
        let error = self.error.as_ref().map_or(0, Independent::bytes);
        self.all.len() * (Self::BYTES_PER_PIXEL + by_class) + error
    }

    /// Without light by class and the error.
    pub(super) const BYTES_PER_PIXEL: usize = 2 * size_of::<[f64; 3]>() + size_of::<Rgb>() + size_of::<u32>();
    /// More by class.
    pub(super) const BYTES_BY_CLASS: usize = size_of::<[[f64; 3]; CLASSES]>();

    pub(super) fn write(&self, out: &mut Writer) {
        out.f64(self.passes);
        for pixel in 0..self.all.len() {
            self.all[pixel].iter().chain(&self.emission[pixel]).for_each(|&sum| out.f64(sum));
            out.rgb(self.last[pixel]);
            out.u64(self.shapes[pixel].into());
        }
        self.classes.iter().flatten().flatten().flatten().for_each(|&sum| out.f64(sum));
        if let Some(error) = &self.error {
            error.write(out);
        }
    }

    pub(super) fn read(&mut self, input: &mut Reader<'_>) -> Result<(), StateError> {
        self.passes = input.finite()?;
        for pixel in 0..self.all.len() {
            for sum in self.all[pixel].iter_mut().chain(&mut self.emission[pixel]) {
                *sum = input.finite()?;
            }
            self.last[pixel] = input.rgb()?;
            self.shapes[pixel] = u32::try_from(input.count()?).map_err(|_| StateError::Impossible)?;
        }
        for sum in self.classes.iter_mut().flatten().flatten().flatten() {
            *sum = input.finite()?;
        }
        if let Some(error) = &mut self.error {
            error.read(input)?;
        }
        Ok(())
    }
}

fn add_to(sum: &mut [f64; 3], light: Rgb) {
    sum.iter_mut().zip(light.to_array()).for_each(|(sum, light)| *sum += f64::from(light));
}

fn luminance(light: [f64; 3]) -> f64 {
    light.iter().zip(Rgb::LUMINANCE).map(|(l, weight)| l * f64::from(weight)).sum()
}
