//! From hit points to pixels: each pass's estimate, and the running mean of all passes.

use foton_math::Rgb;
use foton_transport::Omissions;
use foton_transport::codec::{Reader, StateError, Writer};
use rayon::prelude::*;

use super::hit_points::{HitPoints, Irradiance};

/// Pixels of one task.
const BLOCK: usize = 1024;

/// Sums of radiance per pixel; `LAYERS` is 3 to sum path classes separately, or 1.
pub(crate) struct Radiance<const LAYERS: usize> {
    /// Radiance that each pixel sees of emitters, directly or by specular bounces.
    pub(crate) emission: Vec<Rgb>,
    /// Σ over passes of Σ W Φ/(π r²) / samples; divided by the photons emitted it is reflected radiance.
    sums: Vec<[[f64; 3]; LAYERS]>,
    /// The last pass's addend: its own estimate of the pixel, times its photons. An error figure squares this.
    pub(crate) last: Vec<[Rgb; LAYERS]>,
    samples: f32,
}

impl<const LAYERS: usize> Radiance<LAYERS> {
    pub(crate) fn new(emission: Vec<Rgb>, samples: u32) -> Self {
        let pixels = emission.len();
        Self {
            emission,
            sums: vec![[[0.0; 3]; LAYERS]; pixels],
            last: vec![[Rgb::BLACK; LAYERS]; pixels],
            samples: samples as f32,
        }
    }

    /// Adds a pass; says what it left out because it was not finite.
    pub(crate) fn add(
        &mut self,
        hit_points: &HitPoints,
        irradiance_slots: &[Irradiance<LAYERS>],
    ) -> Omissions {
        let samples = self.samples;
        let blocks = self.last.par_chunks_mut(BLOCK).zip(self.sums.par_chunks_mut(BLOCK)).enumerate();
        blocks
            .map(|(block, (last, sums))| {
                let mut omissions = Omissions::default();
                for (i, (last, sum)) in last.iter_mut().zip(sums).enumerate() {
                    let pixel = block * BLOCK + i;
                    let range = hit_points.pixel_start[pixel]..hit_points.pixel_start[pixel + 1];
                    *last = [Rgb::BLACK; LAYERS];
                    for h in range.clone() {
                        let irradiance = &irradiance_slots[hit_points.slot_of[h as usize] as usize];
                        let weight = hit_points.weights[h as usize];
                        for (last, irradiance) in last.iter_mut().zip(irradiance) {
                            *last += weight * *irradiance;
                        }
                    }
                    for (last, sum) in last.iter_mut().zip(sum) {
                        *last = *last / samples;
                        if !last.is_finite() {
                            *last = Rgb::BLACK;
                            omissions.add(hit_points.left_out_at(range.start));
                        }
                        for (sum, add) in sum.iter_mut().zip(last.to_array()) {
                            *sum += f64::from(add);
                        }
                    }
                }
                omissions
            })
            .reduce(Omissions::default, Omissions::followed_by)
    }

    /// Reflected radiance of one class (or of all, where classes are not separate) after `photons` in all.
    pub(crate) fn layer(&self, layer: usize, photons: u64) -> Vec<Rgb> {
        let scale = if photons == 0 { 0.0 } else { 1.0 / photons as f64 };
        let rgb = |s: &[f64; 3]| Rgb::from_array(s.map(|c| (c * scale) as f32));
        self.sums.iter().map(|s| rgb(&s[layer])).collect()
    }

    /// All radiance, emission included.
    pub(crate) fn total(&self, photons: u64) -> Vec<Rgb> {
        (0..self.sums.len()).map(|pixel| self.pixel(pixel, photons)).collect()
    }

    /// All radiance of one pixel, emission included; black beyond the image.
    pub(crate) fn pixel(&self, pixel: usize, photons: u64) -> Rgb {
        let (Some(emission), Some(sums)) = (self.emission.get(pixel), self.sums.get(pixel)) else {
            return Rgb::BLACK;
        };
        let scale = if photons == 0 { 0.0 } else { 1.0 / photons as f64 };
        let channel = |c: usize| sums.iter().map(|s| s[c]).sum::<f64>() * scale;
        let e = emission.to_array();
        Rgb::from_array([0, 1, 2].map(|c| (f64::from(e[c]) + channel(c)) as f32))
    }

    pub(crate) fn write(&self, out: &mut Writer) {
        for (sums, last) in self.sums.iter().zip(&self.last) {
            sums.iter().flatten().for_each(|&sum| out.f64(sum));
            last.iter().for_each(|&last| out.rgb(last));
        }
    }

    pub(crate) fn read(&mut self, input: &mut Reader<'_>) -> Result<(), StateError> {
        for (sums, last) in self.sums.iter_mut().zip(&mut self.last) {
            for sum in sums.iter_mut().flatten() {
                *sum = input.finite()?;
            }
            for last in last {
                *last = input.rgb()?;
            }
        }
        Ok(())
    }

    /// Luminance of a pixel's reflected radiance, times the photons emitted.
    pub(crate) fn luminance_sum(&self, pixel: usize) -> f64 {
        let [r, g, b] = [0, 1, 2].map(|c| self.sums[pixel].iter().map(|s| s[c]).sum::<f64>());
        let [red, green, blue] = Rgb::LUMINANCE;
        f64::from(red) * r + f64::from(green) * g + f64::from(blue) * b
    }

    /// Bytes held.
    pub(crate) const fn bytes(&self) -> usize {
        self.sums.len() * Self::BYTES_PER_PIXEL
    }

    /// Bytes held per pixel.
    pub(crate) const BYTES_PER_PIXEL: usize =
        size_of::<Rgb>() + size_of::<[[f64; 3]; LAYERS]>() + size_of::<[Rgb; LAYERS]>();
}
