//! The eye pass over all samples of all pixels.

use std::sync::atomic::{AtomicUsize, Ordering};

use foton_math::glam::Vec2;
use foton_math::{Cancel, Cancelled, Ray, Rgb, Stream};
use rayon::prelude::*;

use super::earlier::Earlier;
use super::eye_pass::{EyePass, EyePaths, NO_SHAPE};
use super::pixel_samples::{OfPixel, SamplePoints};
use super::walk::Walk;
use crate::not_finite::{self, LeftOut, Quantity};

/// Pixels of one task.
const CHUNK: usize = 1024;

/// Tasks for each thread whose hit points are held apart from the others', before they are joined.
const HELD: usize = 16;

/// Room for so many hit points of a task at first.
const MAX_RESERVED: usize = 1 << 14;

impl EyePass<'_> {
    /// Follows the first `samples` of all pixels, of which `earlier` has some, if any. `tell` is told by many threads what share of the
    /// pixels is done. In how many steps samples are followed changes no bit of what is found.
    ///
    /// # Errors
    /// When cancelled.
    pub fn run(
        &self,
        earlier: EyePaths,
        samples: u32,
        cancel: &Cancel,
        tell: &(dyn Fn(f64) + Sync),
    ) -> Result<EyePaths, Cancelled> {
        let (earlier, done) = (Earlier::new(earlier), AtomicUsize::new(0));
        let all = self.sensor().width as usize * self.sensor().height as usize;
        let of_chunk = |chunk: usize| {
            let pixels = (chunk * CHUNK..all.min((chunk + 1) * CHUNK)).map(|p| p as u32);
            let of = pixels.len();
            let part = self.go_on(&earlier, samples, pixels, cancel);
            let so_far = done.fetch_add(of, Ordering::Relaxed) + of;
            tell(so_far as f64 / all as f64);
            cancel.check().map(|()| part)
        };
        let mut paths = EyePaths { samples, ..EyePaths::default() };
        let (chunks, held) = (all.div_ceil(CHUNK), HELD * rayon::current_num_threads());
        for first in (0..chunks).step_by(held) {
            let some = first..chunks.min(first + held);
            let parts: Vec<EyePaths> = some.into_par_iter().map(of_chunk).collect::<Result<_, _>>()?;
            parts.into_iter().for_each(|part| paths.append(part));
        }
        earlier.add_counts_to(&mut paths);
        Ok(paths)
    }

    /// Follows all samples of some pixels; once cancelled no more of them.
    pub fn follow(&self, pixels: impl Iterator<Item = u32>, cancel: &Cancel) -> EyePaths {
        self.go_on(&Earlier::new(EyePaths::default()), self.samples_per_pixel.get(), pixels, cancel)
    }

    /// Follows a single sample from the sensor on, into `paths`: for methods that have new eye samples in each pass. Returns the emitted
    /// light that it sees.
    pub fn follow_one(&self, ray: Ray, mut stream: Stream, paths: &mut EyePaths) -> Rgb {
        let [facet, emitter] = [stream.next_2d(), stream.next_2d()];
        let points = SamplePoints { place: Vec2::ZERO, lens: Vec2::ZERO, facet, emitter };
        paths.shapes.push(NO_SHAPE);
        Walk::new(self, stream, &points, true, paths, &mut Vec::new()).follow_ray(ray)
    }

    fn go_on(
        &self,
        earlier: &Earlier,
        samples: u32,
        pixels: impl Iterator<Item = u32>,
        cancel: &Cancel,
    ) -> EyePaths {
        let mut paths = EyePaths { samples, ..EyePaths::default() };
        // Most samples find one hit point: growing from nothing would copy them again and again.
        let samples_of_all = pixels.size_hint().0.saturating_mul(samples as usize);
        paths.hit_points.reserve(samples_of_all.min(MAX_RESERVED));
        let mut branches = Vec::new();
        for pixel in pixels {
            let before = paths.hit_points.len();
            let mut emission = earlier.append_to(&mut paths, pixel as usize);
            let of_pass = self.samples_per_pixel.get();
            let of_pixel = OfPixel::new((self.seed, self.purpose), pixel, self.pass, of_pass);
            for sample in earlier.samples()..samples {
                if cancel.is_requested() {
                    return paths;
                }
                let index = u64::from(pixel) * u64::from(of_pass) + u64::from(sample);
                let points = of_pixel.points(sample);
                let stream = Stream::new(self.seed, self.purpose, of_pixel.stream_pass(), index);
                let sum = emission
                    + Walk::new(self, stream, &points, sample == 0, &mut paths, &mut branches).follow(
                        pixel,
                        points.place,
                        points.lens,
                    );
                if sum.is_finite() {
                    emission = sum;
                } else {
                    paths.dropped += 1;
                    // A sum of numbers that is none has no other place.
                    paths.left_out.get_or_insert(LeftOut {
                        quantity: Quantity::SeenEmission,
                        light: None,
                        surface: not_finite::Surface::Unknown,
                        position: self.sensor().origin(),
                    });
                }
            }
            paths.counts.push((paths.hit_points.len() - before) as u32);
            paths.emission.push(emission);
        }
        paths
    }
}
