//! Light that needs no photons: emitters that eye samples see, and what shadow rays bring. Both are new in each pass, which counts by its
//! photons as it does for theirs.

use foton_math::Rgb;
use foton_transport::codec::{Reader, StateError, Writer};
use rayon::prelude::*;

/// Sums of a pixel.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    /// Σ nⱼ xⱼ of radiance from emitters, seen directly or by specular bounces.
    emission: [f64; 3],
    /// The same of direct light by shadow rays.
    direct: [f64; 3],
}

/// The sums of all pixels, and what the last pass added to them.
pub(crate) struct Seen {
    sums: Vec<Sums>,
    /// Mean over a pixel's samples of what they see of emitters: of the samples that are laid out.
    pub(super) emission: Vec<Rgb>,
    /// Direct light of the last pass; empty without shadow rays.
    direct: Vec<Rgb>,
}

impl Seen {
    pub(super) fn new(emission: Vec<Rgb>) -> Self {
        Self { sums: vec![Sums::default(); emission.len()], emission, direct: Vec::new() }
    }

    /// Adds the pass of so many photons.
    pub(super) fn add(&mut self, photons: u64, direct: Vec<Rgb>) {
        self.direct = direct;
        let (emission, direct, n) = (&self.emission, &self.direct, photons as f64);
        self.sums.par_iter_mut().enumerate().for_each(|(pixel, sums)| {
            add(&mut sums.emission, emission[pixel], n);
            if let Some(direct) = direct.get(pixel) {
                add(&mut sums.direct, *direct, n);
            }
        });
    }

    /// Luminance of what the last pass saw of a pixel without its photons.
    pub(crate) fn last(&self, pixel: usize) -> f64 {
        let direct = self.direct.get(pixel).map_or(0.0, |direct| direct.luminance());
        f64::from(self.emission[pixel].luminance()) + f64::from(direct)
    }

    /// Luminance sums of a pixel, times photons: of emitters, and of direct light.
    pub(crate) fn luminance_sums(&self, pixel: usize) -> [f64; 2] {
        let Sums { emission, direct } = self.sums[pixel];
        [emission, direct].map(|sum| sum.iter().zip(Rgb::LUMINANCE).map(|(s, w)| s * f64::from(w)).sum())
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
        self.sums.iter().flat_map(|s| s.emission.into_iter().chain(s.direct)).for_each(|sum| out.f64(sum));
    }

    pub(super) fn read(&mut self, input: &mut Reader<'_>) -> Result<(), StateError> {
        for Sums { emission, direct } in &mut self.sums {
            for sum in emission.iter_mut().chain(direct) {
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

fn mean(sum: &[f64; 3], photons: u64) -> Rgb {
    let scale = if photons == 0 { 0.0 } else { 1.0 / photons as f64 };
    Rgb::from_array(sum.map(|s| (s * scale) as f32))
}
