//! Adding a pass to the sums behind the error.

use rayon::prelude::*;

use super::classes::Question;
use super::estimate::{ErrorEstimate, Sums};
use super::moments::{Shares, Weights};
use super::{ErrorSums, Pixel, SlotMoments, TILE, Tile};
use crate::ppm::{Direct, HitPoints, Irradiance, Noise, Radiance};

/// A pass that has been added to the image.
pub(crate) struct Pass<'a, const LAYERS: usize> {
    pub(crate) hit_points: &'a HitPoints,
    pub(crate) irradiance_slots: &'a [Irradiance<LAYERS>],
    pub(crate) radiance: &'a Radiance,
    /// Direct light by shadow rays, with what it has just got; `None` where photons bring it.
    pub(crate) direct: Option<&'a Direct>,
    pub(crate) facts: PassFacts,
}

/// What is known of a pass beside its light.
#[derive(Clone, Copy)]
pub(crate) struct PassFacts {
    /// Photons that it emitted.
    pub(crate) photons: u64,
    /// Mean power of a photon where it leaves its emitter, or, where photons are aimed and differ much, of those near hit points.
    pub(crate) power: f64,
    /// What was summed over the photons of one class.
    pub(crate) question: Question,
    /// How many were before it.
    pub(crate) before: u64,
}

/// What the pixels of a tile add to it in a pass.
#[derive(Clone, Copy, Default)]
struct OfTile {
    light: f64,
    bias: f64,
    focus2: f64,
    unknown: u32,
    direct: Noise,
}

/// What a pixel's own pass says.
struct Addend {
    light: f64,
    bias: f64,
    /// How far squared light of all passes may be above what discs see (see `RadiusStatistics::focus`).
    focus: f64,
    /// The variance of that: whether a sample lies in a focus is chance.
    focus_variance: f64,
    /// Of one class: its bias, or a sum of squares.
    answer: f64,
}

impl<const LAYERS: usize> Pass<'_, LAYERS> {
    /// Whether what discs may hide is summed again: not in every pass, since it hardly changes and is a thirtieth of the time.
    const fn sums_foci(&self) -> bool {
        self.facts.before < 3 || self.facts.before % 4 == 3
    }

    fn addend(&self, pixel: usize, moment_slots: &[SlotMoments], per_sample: f64) -> Addend {
        let (hit_points, sums_foci) = (self.hit_points, self.sums_foci());
        let range = hit_points.pixel_start[pixel] as usize..hit_points.pixel_start[pixel + 1] as usize;
        let (mut bias, mut answer, mut focus, mut focus_variance) = (0.0, 0.0, 0.0, 0.0);
        for (&slot, &weight) in hit_points.slot_of[range.clone()].iter().zip(&hit_points.weights[range]) {
            if sums_foci
                && let radius_statistics = &hit_points.radius_statistics_slots[slot as usize]
                && let excess = radius_statistics.focus()
                && excess > 0.0
            {
                // One sample in 1 + excess is as bright as the focus: its square has this mean and about this variance.
                let square = (f64::from(weight.luminance()) * radius_statistics.light()).powi(2) * excess;
                focus += square;
                focus_variance += square * square * (1.0 + excess);
            }
            let irradiance = self.irradiance_slots[slot as usize][0];
            let luminance = irradiance.luminance();
            if luminance > 0.0 {
                let seen = (weight * irradiance).luminance() / luminance;
                let SlotMoments { bias: moment, answer: of_class } = moment_slots[slot as usize];
                bias += f64::from(seen * moment);
                // A photon reaches all hit points of a pixel about alike.
                answer +=
                    f64::from(seen * if self.facts.question.noise { of_class.sqrt() } else { of_class });
            }
        }
        let light = self.radiance.last[pixel];
        answer *= per_sample;
        if self.facts.question.noise {
            answer *= answer;
        }
        let per_sample2 = per_sample * per_sample;
        let (focus, focus_variance) = (focus * per_sample2, focus_variance * per_sample2 * per_sample2);
        Addend { light: f64::from(light.luminance()), bias: bias * per_sample, focus, focus_variance, answer }
    }

    /// Luminance per emitted photon that a pixel would gain if each of its hit points without a photon found one.
    fn one_photon(&self, pixel: usize, samples: f64) -> f64 {
        let hit_points = self.hit_points;
        let range = hit_points.pixel_start[pixel] as usize..hit_points.pixel_start[pixel + 1] as usize;
        let unknown = range.filter_map(|h| {
            let statistics = &hit_points.statistics_slots[hit_points.slot_of[h] as usize];
            let area = std::f64::consts::PI * statistics.radius2();
            let specular = hit_points.gloss(hit_points.slot_of[h] as usize).is_some_and(|g| g.specular);
            (statistics.is_unknown() && !specular)
                .then(|| f64::from(hit_points.weights[h].luminance()) / area)
        });
        unknown.sum::<f64>() * self.facts.power / samples
    }
}

/// The factors of a pass that are the same for all pixels.
struct Scales {
    weights: Weights,
    shares: Shares,
    samples: f64,
    photons: f64,
    per_sample: f64,
    per_photon: f64,
    /// One over the photons of the passes before.
    per_earlier: f64,
}

impl<const LAYERS: usize> Pass<'_, LAYERS> {
    /// Adds the pass to a row of tiles, whose first pixel is `first`.
    fn add_to_tiles(
        &self,
        (first, width): (usize, usize),
        pixels: &mut [Pixel],
        tiles: &mut [Tile],
        moment_slots: &[SlotMoments],
        scales: &Scales,
    ) -> Sums {
        let mut sums = Sums::default();
        let mut addends = vec![OfTile::default(); tiles.len()];
        for (i, pixel) in pixels.iter_mut().enumerate() {
            let index = first + i;
            if self.hit_points.pixel_start[index] == self.hit_points.pixel_start[index + 1] {
                continue;
            }
            let addend = self.addend(index, moment_slots, scales.per_sample);
            self.add_to_pixel(index, pixel, &addend, scales, &mut sums, &mut addends[i % width / TILE]);
        }
        for (tile, of_tile) in tiles.iter_mut().zip(addends) {
            tile.light.add(of_tile.light, scales.photons);
            tile.bias.add(of_tile.bias, scales.photons);
            tile.unknown = of_tile.unknown;
            sums.add_direct(&of_tile.direct);
            if self.sums_foci() {
                tile.focus2 = of_tile.focus2;
            }
        }
        sums
    }

    #[inline]
    fn add_to_pixel(
        &self,
        index: usize,
        pixel: &mut Pixel,
        addend: &Addend,
        scales: &Scales,
        sums: &mut Sums,
        of_tile: &mut OfTile,
    ) {
        let Scales { weights, shares, .. } = scales;
        let answer = if self.facts.question.noise {
            addend.answer
        } else {
            pixel.bias * scales.per_earlier * addend.answer
        };
        sums.answer += if answer.is_finite() { answer } else { 0.0 };
        pixel.add(addend, scales.photons);
        let mean = self.radiance.luminance_sum(index) * shares.per_photon;
        pixel.sum_up(mean, shares, sums);
        let focus2 = addend.focus * shares.per_photon * shares.per_photon;
        sums.focus2 += focus2;
        sums.focus_variance += addend.focus_variance * shares.per_photon.powi(4);
        sums.deviation += (addend.light * scales.per_photon - mean).powi(2);
        let direct = self.direct.map(|direct| direct.known(index));
        let all = mean + direct.map_or(0.0, |direct| direct.mean);
        if let Some(direct) = direct {
            sums.light += direct.mean;
            of_tile.direct.add(&direct);
        }
        // Where photons can add nothing, what rays do not find is dark.
        let mut is_unknown = all <= 0.0 && (direct.is_none() || self.facts.power > 0.0);
        if is_unknown || direct.is_some() {
            // Shadow rays say nothing about indirect light.
            let one_photon = self.one_photon(index, scales.samples) / weights.photons;
            is_unknown |= one_photon > all;
            sums.unknown2 += one_photon.powi(2);
        }
        sums.unknown += f64::from(u8::from(is_unknown));
        of_tile.light += addend.light;
        of_tile.bias += addend.bias;
        of_tile.focus2 += focus2;
        of_tile.unknown += u32::from(is_unknown);
    }
}

impl ErrorSums {
    /// Adds a pass that has been added to `radiance` already.
    pub(crate) fn add<const LAYERS: usize>(&mut self, pass: &Pass<'_, LAYERS>) {
        let photons = pass.facts.photons as f64;
        let before = self.weights.photons;
        self.weights.add(photons);
        let mut sums = self.add_to_pixels(pass, before);
        sums.close_direct();
        if pass.sums_foci() {
            self.foci = [sums.focus2, sums.focus_variance];
        } else {
            [sums.focus2, sums.focus_variance] = self.foci;
        }
        let share = photons / self.weights.photons;
        if share < 1.0 && sums.seen > 0.0 {
            self.scatter.add(photons * sums.deviation / sums.seen / (1.0 - share));
        }
        self.classes.add(pass.facts.question, sums.answer, photons, before);
        self.estimate = sums.estimate(&self.weights, &self.scatter).map(|whole| {
            let squares = (whole.noise * whole.noise, whole.bias * whole.bias);
            let bias2 = sums.bias2.max(0.0);
            let trust = if bias2 > 0.0 { bias2 / (bias2 + sums.bias_variance) } else { 0.0 };
            let direct = pass.direct.map(|_| sums.direct_variance);
            ErrorEstimate { classes: self.classes.split(squares, trust, direct, &self.weights), ..whole }
        });
    }

    /// Adds a pass to pixels and tiles; `before` photons were emitted before it.
    fn add_to_pixels<const LAYERS: usize>(&mut self, pass: &Pass<'_, LAYERS>, before: f64) -> Sums {
        let photons = pass.facts.photons as f64;
        let (width, samples, weights) = (self.width, self.samples, self.weights);
        let scales = Scales {
            weights,
            shares: weights.shares(),
            samples,
            photons,
            per_sample: 1.0 / samples,
            per_photon: 1.0 / photons,
            per_earlier: 1.0 / before,
        };
        let moment_slots = &self.moment_slots;
        let bands = self.pixels.par_chunks_mut(TILE * width);
        let sums: Vec<Sums> = bands
            .zip(self.tiles.par_chunks_mut(width.div_ceil(TILE)))
            .enumerate()
            .map(|(band, (pixels, tiles))| {
                let at = (band * TILE * width, width);
                pass.add_to_tiles(at, pixels, tiles, moment_slots, &scales)
            })
            .collect();
        sums.into_iter().fold(Sums::default(), Sums::plus)
    }
}

impl Pixel {
    fn add(&mut self, addend: &Addend, photons: f64) {
        self.squares += addend.light * addend.light;
        self.cross += photons * addend.light;
        self.bias += addend.bias;
        self.bias_squares += (addend.bias * addend.bias) as f32;
        self.bias_cross += (photons * addend.bias) as f32;
    }
}
