//! Sums of direct light over the visits to all pixels.

use std::ops::Range;

use foton_math::Rgb;
use foton_scene::Scene;
use foton_transport::codec::{Reader, StateError, Writer};
use foton_transport::direct_light::Lights;

use super::choice::noise;
use super::lit::Lit;
use super::noise::{Known, Noise};
use super::order::Order;
use crate::ppm::hit_points::HitPoints;
use crate::settings::RenderSettings;

/// What photons cost, in shadow rays for each ray of theirs: tracing them, and what is gathered of them. Measured in the default scene.
const RAYS_PER_RAY: f64 = 2.5;

/// What a pass costs a hit point whatever its photons, in shadow rays.
const RAYS_PER_HIT_POINT: f64 = 0.1;

/// Rays over what the rest of a pass costs, at most: then they are a quarter of the whole.
const LARGEST_SHARE: f64 = 1.0 / 3.0;

/// The noise of a visit from which on they are. Below that the share falls with its root: then rays and photons lower the error alike.
const NOISY: f64 = 0.1;

/// A pass lights a pixel this often at most.
const MAX_VISITS: u64 = 16;

/// Sums over the visits to all pixels.
pub(crate) struct Direct {
    pub(crate) lights: Lights,
    /// Eye samples a pixel.
    pub(crate) samples: u32,
    /// Rays over what the rest of a pass costs.
    share: f64,
    pub(crate) order: Order,
    /// Places that have been lit, in the order of turns.
    lit: u64,
    /// Of points, spots and suns, per pixel: the same each time.
    fixed: Vec<Rgb>,
    /// Of the other emitters.
    pixels: Vec<Pixel>,
    /// Rays of a visit at most, per place; without those that are traced once.
    rays_per_place: f64,
    hit_points: f64,
}

#[derive(Clone, Copy, Debug, Default)]
struct Pixel {
    /// Σ over visits of radiance.
    sum: [f64; 3],
    /// The same in luminance, that of the second sequence taken off that of the first.
    difference: f64,
    /// Visits.
    count: u32,
}

impl Direct {
    /// Nothing has been lit.
    pub(crate) fn new(
        scene: &Scene,
        settings: &RenderSettings,
        hit_points: &HitPoints,
        samples: u32,
    ) -> Self {
        let (width, lights) = (scene.sensors()[settings.sensor].width as usize, Lights::new(scene));
        let noise = noise(scene, &lights, settings);
        let pixels = hit_points.pixel_start.len() - 1;
        let order = Order::new(width, pixels.div_ceil(width.max(1)));
        let hit_points = hit_points.len() as f64;
        Self {
            rays_per_place: hit_points * f64::from(lights.rays()) / order.places() as f64,
            lights,
            samples,
            share: LARGEST_SHARE * (noise / NOISY).sqrt().clamp(0.1, 1.0),
            order,
            lit: 0,
            fixed: vec![Rgb::BLACK; pixels],
            pixels: vec![Pixel::default(); pixels],
            hit_points,
        }
    }

    /// What a pass lights whose photons took so many rays: all pixels first, then as many places as have their turn.
    pub(crate) fn turns(&self, rays: u64) -> Range<u64> {
        let all = self.order.places();
        let places = if self.lit < all {
            all - self.lit
        } else if self.rays_per_place > 0.0 {
            let rest = RAYS_PER_RAY * rays as f64 + RAYS_PER_HIT_POINT * self.hit_points;
            let places = (self.share * rest / self.rays_per_place) as u64;
            // Without photons to trace a pass is for rays alone. Each square has a pixel lit, so that its noise gets known.
            let least = if rays == 0 { all } else { self.order.squares() };
            places.clamp(least, MAX_VISITS * all)
        } else {
            0
        };
        self.lit..self.lit + places
    }

    /// Adds what a pass has lit, block by block.
    pub(crate) fn add(&mut self, blocks: impl Iterator<Item = Lit>) {
        for block in blocks {
            for (i, light) in block.light.into_iter().enumerate() {
                if let Some(pixel) = self.order.pixel(self.lit) {
                    self.pixels[pixel].add(light);
                    if let Some(fixed) = block.fixed.get(i) {
                        self.fixed[pixel] = *fixed;
                    }
                }
                self.lit += 1;
            }
        }
    }

    /// Radiance of a pixel.
    pub(crate) fn radiance(&self, pixel: usize) -> Rgb {
        let Pixel { sum, count, .. } = self.pixels[pixel];
        let scale = 1.0 / f64::from(count.max(1));
        let fixed = self.fixed[pixel].to_array();
        Rgb::from_array([0, 1, 2].map(|c| (f64::from(fixed[c]) + sum[c] * scale) as f32))
    }

    /// Luminance of a pixel with its noise.
    pub(crate) fn known(&self, pixel: usize) -> Known {
        let Pixel { sum, difference, count } = self.pixels[pixel];
        let (n, sum) = (f64::from(count), luminance(sum));
        let [first, second] = [count.div_ceil(2), count / 2].map(f64::from);
        // With σ² the variance of a visit, that of the mean is σ²/n, and of the difference of means σ² (1/a + 1/b).
        let variance = || {
            let difference = 0.5 * ((sum + difference) / first - (sum - difference) / second);
            difference * difference * first * second / (n * n)
        };
        let mean = f64::from(self.fixed[pixel].luminance()) + sum / n.max(1.0);
        Known { mean, variance: (count > 1).then(variance), visits: count }
    }

    /// The noise of some pixels.
    pub(crate) fn noise(&self, pixels: impl Iterator<Item = usize>) -> Noise {
        pixels.fold(Noise::default(), |mut noise, pixel| {
            noise.add(&self.known(pixel));
            noise
        })
    }

    pub(crate) fn write(&self, out: &mut Writer) {
        out.u64(self.lit);
        for (fixed, pixel) in self.fixed.iter().zip(&self.pixels) {
            out.rgb(*fixed);
            pixel.sum.iter().for_each(|&sum| out.f64(sum));
            out.f64(pixel.difference);
        }
    }

    pub(crate) fn read(&mut self, input: &mut Reader<'_>) -> Result<(), StateError> {
        self.lit = input.count()?;
        for (fixed, pixel) in self.fixed.iter_mut().zip(&mut self.pixels) {
            *fixed = input.rgb()?;
            for sum in &mut pixel.sum {
                *sum = input.finite()?;
            }
            pixel.difference = input.finite()?;
            pixel.count =
                u32::try_from(self.lit / self.order.places()).map_err(|_| StateError::Impossible)?;
        }
        let begun = (0..self.lit % self.order.places()).filter_map(|place| self.order.pixel(place));
        for pixel in begun {
            self.pixels[pixel].count += 1;
        }
        Ok(())
    }

    /// Bytes held.
    pub(crate) const fn bytes(&self) -> usize {
        self.pixels.len() * Self::BYTES_PER_PIXEL
    }

    /// Bytes held per pixel.
    pub(crate) const BYTES_PER_PIXEL: usize = size_of::<Rgb>() + size_of::<Pixel>();
}

impl Pixel {
    fn add(&mut self, light: Rgb) {
        let light = light.to_array().map(f64::from);
        self.sum.iter_mut().zip(light).for_each(|(sum, light)| *sum += light);
        let luminance = luminance(light);
        self.difference += if self.count.is_multiple_of(2) { luminance } else { -luminance };
        self.count += 1;
    }
}

fn luminance(light: [f64; 3]) -> f64 {
    light.iter().zip(Rgb::LUMINANCE).map(|(l, weight)| l * f64::from(weight)).sum()
}
