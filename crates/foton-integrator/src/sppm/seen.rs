//! Light that needs no photons: emitters that eye samples see, and what shadow rays bring. Both are new in each pass, which counts by its
//! photons as it does for theirs.

use foton_math::Rgb;
use foton_transport::codec::{Reader, StateError, Writer};
use rayon::prelude::*;

use crate::white::WHITE;

/// Sums of a pixel.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    /// Σ nⱼ xⱼ of radiance from emitters, seen directly or by specular bounces.
    emission: [f64; 3],
    /// The same of direct light by shadow rays.
    direct: [f64; 3],
    /// The same of luminance from emitters, of which none counts as brighter than white.
    up_to_white: f64,
}

/// The sums of all pixels, and what the last pass added to them.
pub(crate) struct Seen {
    sums: Vec<Sums>,
    /// Mean over a pixel's samples of what they see of emitters: of the samples that are laid out.
    pub(super) emission: Vec<Rgb>,
    /// Direct light of the last pass; empty without shadow rays.
    direct: Vec<Rgb>,
    /// The luminance of white in the last pass (W/m²/sr).
    white: f64,
}

impl Seen {
    pub(super) fn new(emission: Vec<Rgb>) -> Self {
        Self {
            sums: vec![Sums::default(); emission.len()],
            emission,
            direct: Vec::new(),
            white: f64::INFINITY,
        }
    }

    /// Adds the pass of so many photons. `by_photons` is what photons have brought to all pixels in all passes, this one too: luminance
    /// times photons; `seen` pixels have seen something reflect, and `all` photons have been emitted.
    pub(super) fn add(&mut self, photons: u64, direct: Vec<Rgb>, (by_photons, seen, all): (f64, usize, u64)) {
        self.direct = direct;
        let (emission, direct, n) = (&self.emission, &self.direct, photons as f64);
        let by_rays = self.sums.iter().map(|sums| luminance(&sums.direct)).sum::<f64>()
            + n * direct.iter().map(|direct| f64::from(direct.luminance())).sum::<f64>();
        self.white = WHITE * (by_photons + by_rays) / (seen.max(1) as f64 * all.max(1) as f64);
        let white = self.white;
        self.sums.par_iter_mut().enumerate().for_each(|(pixel, sums)| {
            add(&mut sums.emission, emission[pixel], n);
            sums.up_to_white += n * f64::from(emission[pixel].luminance()).min(white);
            if let Some(direct) = direct.get(pixel) {
                add(&mut sums.direct, *direct, n);
            }
        });
    }

    /// Luminance of what the last pass saw of a pixel without its photons, emitters up to white.
    pub(crate) fn last(&self, pixel: usize) -> f64 {
        let direct = self.direct.get(pixel).map_or(0.0, |direct| direct.luminance());
        f64::from(self.emission[pixel].luminance()).min(self.white) + f64::from(direct)
    }

    /// Luminance sums of a pixel, times photons: of emitters up to white, and of direct light.
    pub(crate) fn luminance_sums(&self, pixel: usize) -> [f64; 2] {
        let Sums { direct, up_to_white, .. } = &self.sums[pixel];
        [*up_to_white, luminance(direct)]
    }

    /// Radiance of emitters after so many photons.
    pub(crate) fn emission(&self, pixel: usize, photons: u64) -> Rgb {
        mean(&self.sums[pixel].emission, photons)
    }

    /// Direct light by shadow rays after so many photons.
    pub(crate) fn direct(&self, pixel: usize, photons: u64) -> Rgb {
        mean(&self.sums[pixel].direct, photons)
    }

    pub(super) fn write(&self, out: &mut Writer) {
        let numbers =
            |s: &Sums| s.emission.into_iter().chain(s.direct).chain([s.up_to_white]).collect::<Vec<_>>();
        self.sums.iter().flat_map(numbers).for_each(|sum| out.f64(sum));
    }

    pub(super) fn read(&mut self, input: &mut Reader<'_>) -> Result<(), StateError> {
        for Sums { emission, direct, up_to_white } in &mut self.sums {
            for sum in emission.iter_mut().chain(direct).chain([up_to_white]) {
                *sum = input.finite()?;
            }
        }
        Ok(())
    }

    /// Bytes held a pixel.
    pub(crate) const BYTES_PER_PIXEL: usize = size_of::<Sums>() + 2 * size_of::<Rgb>();
}

fn add(sum: &mut [f64; 3], light: Rgb, photons: f64) {
    sum.iter_mut().zip(light.to_array()).for_each(|(sum, light)| *sum += photons * f64::from(light));
}

fn luminance(sum: &[f64; 3]) -> f64 {
    sum.iter().zip(Rgb::LUMINANCE).map(|(s, weight)| s * f64::from(weight)).sum()
}

fn mean(sum: &[f64; 3], photons: u64) -> Rgb {
    let scale = if photons == 0 { 0.0 } else { 1.0 / photons as f64 };
    Rgb::from_array(sum.map(|s| (s * scale) as f32))
}
