//! What pixels keep between passes: the photons found, and by how much the radii of their hit points have shrunk.
//!
//! The hit points of a pixel lie elsewhere in each pass, on other surfaces too, so each has a first radius of its own, by its footprint.
//! What they share is the factor r²/r₀². The statistics of `[SPPM09]` hold for it as they do for a radius: N counts photons per area,
//! in parts of the first disc's.

use foton_transport::codec::{Reader, StateError, Writer};
use rayon::prelude::*;

use super::adaptive::PixelRadius;
use crate::ppm::adaptive::RadiusStatistics;
use crate::ppm::hit_points::HitPoints;
use crate::ppm::settings::Alpha;
use crate::ppm::statistics::Statistics;

/// Pixels of one task.
const BLOCK: usize = 1024;

/// How radii shrink after a pass.
#[derive(Clone, Copy)]
pub(crate) struct Shrinkage {
    pub(crate) alpha: Alpha,
    /// What all r² are multiplied by, where they shrink together.
    pub(crate) common: Option<f64>,
    /// Whether they go by bias.
    pub(crate) adapts: bool,
}

/// What all pixels keep.
pub(crate) struct Pixels {
    /// With the factor on first r² in place of r²; [`Statistics::EMPTY_SLOT`] until a sample has found a hit point.
    statistics: Vec<Statistics>,
    /// Mean first radius of the hit points of the last pass that had any.
    first_radii: Vec<f32>,
    /// What radii that adapt go by, and the error's upper end; each hit point counts by its weight. Empty where neither is asked for.
    radius_statistics: Vec<PixelRadius>,
    /// The factor of pixels without a hit point.
    first: f32,
}

impl Pixels {
    /// Pixels whose first radii are multiplied by a factor.
    pub(super) fn new(pixels: usize, widened: f32, radius_statistics: bool) -> Self {
        let radius_statistics = if radius_statistics { pixels } else { 0 };
        Self {
            statistics: vec![Statistics::EMPTY_SLOT; pixels],
            first_radii: vec![0.0; pixels],
            radius_statistics: vec![PixelRadius::default(); radius_statistics],
            first: widened * widened,
        }
    }

    /// Takes a pass into account that its hit points, of such first r², have gathered.
    pub(super) fn refine(&mut self, hit_points: &HitPoints, first_radius2: &[f32], how: Shrinkage) {
        let first = self.first;
        let mut blocks: Vec<&mut [_]> = self.radius_statistics.chunks_mut(BLOCK).collect();
        blocks.resize_with(self.statistics.len().div_ceil(BLOCK), Default::default);
        let pixels = self.statistics.par_chunks_mut(BLOCK).zip(self.first_radii.par_chunks_mut(BLOCK));
        pixels.zip(blocks).enumerate().for_each(|(block, ((pixels, radii), radius_statistics))| {
            for (i, (statistics, first_radius)) in pixels.iter_mut().zip(radii).enumerate() {
                let range = hit_points.of_pixel(block * BLOCK + i);
                if range.is_empty() {
                    continue;
                }
                if statistics.radius2() < 0.0 {
                    *statistics = Statistics::new(first);
                }
                let count = range.len() as f32;
                *first_radius = first_radius2[range.clone()].iter().map(|r2| r2.sqrt()).sum::<f32>() / count;
                let mut radius_statistics = radius_statistics.get_mut(i);
                let mut of_pass = RadiusStatistics::default();
                let mut found = 0;
                for h in range {
                    let slot = hit_points.slot_of[h] as usize;
                    found += hit_points.statistics_of(slot).photons_found();
                    if radius_statistics.is_some() {
                        let weight = f64::from(hit_points.weights[h].luminance());
                        of_pass.add_hit_point(
                            &hit_points.radius_statistics[hit_points.place(slot)].sums(),
                            weight,
                        );
                    }
                }
                if let Some(sums) = &mut radius_statistics {
                    sums.add(&of_pass);
                }
                match how.common {
                    Some(rho) => statistics.shrink(found, rho, 0.0),
                    None => {
                        let known = radius_statistics.filter(|_| how.adapts);
                        let alpha = known.map_or(how.alpha, |sums| sums.alpha(how.alpha));
                        statistics.refine(found, alpha, 0.0)
                    }
                };
            }
        });
    }

    /// What a pixel's r² are multiplied by.
    pub(crate) fn factor(&self, pixel: usize) -> f64 {
        let factor = self.statistics[pixel].radius2();
        if factor < 0.0 { f64::from(self.first) } else { factor }
    }

    /// Mean radius of a pixel's hit points, as it is after the last pass that had any; 0 without.
    pub(crate) fn mean_radius(&self, pixel: usize) -> f64 {
        self.factor(pixel).sqrt() * f64::from(self.first_radii[pixel])
    }

    /// Photons that a pixel has found in all passes.
    pub(crate) fn photons_found(&self, pixel: usize) -> u64 {
        self.statistics[pixel].photons_found()
    }

    /// Whether any sample has found a hit point.
    pub(crate) fn is_seen(&self, pixel: usize) -> bool {
        self.statistics[pixel].radius2() >= 0.0
    }

    /// Pixels of which some sample has found a hit point.
    pub(super) fn seen(&self) -> usize {
        (0..self.statistics.len()).filter(|&pixel| self.is_seen(pixel)).count()
    }

    /// Whether hit points have found no photon in any pass: what arrives there is unknown, not zero.
    pub(crate) fn is_unknown(&self, pixel: usize) -> bool {
        self.is_seen(pixel) && self.statistics[pixel].is_unknown()
    }

    /// Of the pixels that see a hit point, the share of those that are unknown.
    pub(super) fn unknown_share(&self) -> f64 {
        let count = |of: &dyn Fn(usize) -> bool| (0..self.statistics.len()).filter(|p| of(*p)).count();
        count(&|pixel| self.is_unknown(pixel)) as f64 / count(&|pixel| self.is_seen(pixel)).max(1) as f64
    }

    /// What radii go by.
    pub(crate) fn radius_statistics(&self, pixel: usize) -> Option<&RadiusStatistics> {
        self.radius_statistics.get(pixel).map(PixelRadius::sums)
    }

    pub(super) fn write(&self, out: &mut Writer) {
        self.statistics.iter().for_each(|s| s.write(out));
        self.first_radii.iter().for_each(|&radius| out.f64(radius.into()));
        self.radius_statistics.iter().for_each(|s| s.write(out));
    }

    pub(super) fn read(&mut self, input: &mut Reader<'_>) -> Result<(), StateError> {
        for statistics in &mut self.statistics {
            *statistics = Statistics::read(input)?;
        }
        for radius in &mut self.first_radii {
            *radius = input.finite()? as f32;
        }
        for radius_statistics in &mut self.radius_statistics {
            *radius_statistics = PixelRadius::read(input)?;
        }
        Ok(())
    }

    /// Bytes held a pixel.
    pub(crate) const fn bytes_per_pixel(radius_statistics: bool) -> usize {
        size_of::<Statistics>()
            + size_of::<f32>()
            + if radius_statistics { size_of::<PixelRadius>() } else { 0 }
    }
}
