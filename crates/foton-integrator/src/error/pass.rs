//! Adding a pass to the sums behind the error.

use rayon::prelude::*;

use super::classes::Question;
use super::estimate::{ErrorEstimate, Sums};
use super::moments::{Halves, Shares, Weights};
use super::unlit::Unlit;
use super::{ErrorSums, Pixel, TILE, Tile};
use crate::ppm::adaptive::RadiusStatistics;
use crate::ppm::{Arrived, Direct, HitPoints, Noise, Radiance, SlotMoments};
use crate::sppm::Renewal;

/// A pass that has been added to the image.
pub(crate) struct Pass<'a, const LAYERS: usize> {
    pub(crate) hit_points: &'a HitPoints,
    pub(crate) arrived: &'a Arrived<LAYERS>,
    pub(crate) radiance: &'a Radiance,
    /// Direct light by shadow rays, with what it has just got; `None` where photons bring it.
    pub(crate) direct: Option<&'a Direct>,
    /// Where hit points were of this pass alone: what pixels keep, with what has just been added.
    pub(crate) renewal: Option<&'a Renewal>,
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
    /// Whether radii shrink where no photon comes, too.
    pub(crate) radii_shrink_alike: bool,
}

/// What the pixels of a tile add to it in a pass.
#[derive(Clone, Copy, Default)]
struct OfTile {
    pixels: u32,
    light: f64,
    bias: f64,
    focus2: f64,
    unknown: u32,
    direct: Noise,
}

/// What a pixel's own pass says.
struct Addend {
    /// Of its photons and, where eye samples are new in each pass, all else that those saw.
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

    /// What a pixel's own pass says; `unlit` is what is kept of it, where hit points stay.
    fn addend(&self, pixel: usize, unlit: Option<&mut Unlit>, per_sample: f64) -> Addend {
        let [mut bias, mut answer] = [0.0; 2];
        if self.radiance.is_lit(pixel) {
            [bias, answer] = self.moments(pixel);
        }
        let [focus, focus_variance] = match (self.sums_foci(), unlit, self.renewal) {
            (false, ..) => [0.0; 2],
            (true, Some(unlit), _) => unlit.foci(|| self.foci(pixel)),
            (true, None, None) => self.foci(pixel),
            (true, None, Some(renewal)) => {
                renewal.pixels.radius_statistics(pixel).map_or([0.0; 2], |sums| hidden(sums, 1.0))
            }
        };
        let light = f64::from(self.radiance.last[pixel].luminance());
        let seen = self.renewal.map_or(0.0, |renewal| renewal.seen.last(pixel) * self.facts.photons as f64);
        answer *= per_sample;
        if self.facts.question.noise {
            answer *= answer;
        }
        let per_sample2 = per_sample * per_sample;
        let (focus, focus_variance) = (focus * per_sample2, focus_variance * per_sample2 * per_sample2);
        Addend { light: light + seen, bias: bias * per_sample, focus, focus_variance, answer }
    }

    /// A pixel's bias and its answer about a class, summed over its samples.
    fn moments(&self, pixel: usize) -> [f64; 2] {
        let (hit_points, range) = (self.hit_points, self.hit_points.of_pixel(pixel));
        let [mut bias, mut answer] = [0.0; 2];
        for (&slot, &weight) in hit_points.slot_of[range.clone()].iter().zip(&hit_points.weights[range]) {
            let Some((irradiance, moments)) = self.arrived.with_moments(slot as usize) else { continue };
            let luminance = irradiance.luminance();
            if luminance > 0.0 {
                let seen = (weight * irradiance).luminance() / luminance;
                let SlotMoments { bias: moment, answer: of_class } = moments;
                bias += f64::from(seen * moment);
                // A photon reaches all hit points of a pixel about alike.
                answer +=
                    f64::from(seen * if self.facts.question.noise { of_class.sqrt() } else { of_class });
            }
        }
        [bias, answer]
    }

    /// Squares of what a pixel's discs may hide, and the variance of that, summed over its samples.
    fn foci(&self, pixel: usize) -> [f64; 2] {
        let (hit_points, range) = (self.hit_points, self.hit_points.of_pixel(pixel));
        let mut foci = [0.0; 2];
        for (&slot, &weight) in hit_points.slot_of[range.clone()].iter().zip(&hit_points.weights[range]) {
            let radius_statistics = hit_points.radius_statistics[hit_points.place(slot as usize)].sums();
            let square = hidden(&radius_statistics, f64::from(weight.luminance()));
            foci.iter_mut().zip(square).for_each(|(sum, square)| *sum += square);
        }
        foci
    }

    /// Luminance per unit of power that a pixel would gain if each of its hit points without a photon found one, summed over its samples.
    fn one_photon(&self, pixel: usize) -> f64 {
        let hit_points = self.hit_points;
        let unknown = hit_points.of_pixel(pixel).filter_map(|h| {
            let statistics = hit_points.statistics_of(hit_points.slot_of[h] as usize);
            let area = std::f64::consts::PI * statistics.radius2();
            let specular = hit_points.gloss(hit_points.slot_of[h] as usize).is_some_and(|g| g.specular);
            let is_unknown =
                self.renewal.map_or(statistics.is_unknown(), |renewal| renewal.pixels.is_unknown(pixel));
            (is_unknown && !specular).then(|| f64::from(hit_points.weights[h].luminance()) / area)
        });
        unknown.sum()
    }
}

/// The square of what a disc may hide, and the variance of that: one sample in 1 + excess is as bright as the focus.
fn hidden(radius_statistics: &RadiusStatistics, weight: f64) -> [f64; 2] {
    let excess = radius_statistics.focus();
    if excess <= 0.0 {
        return [0.0; 2];
    }
    let square = (weight * radius_statistics.light()).powi(2) * excess;
    [square, square * square * (1.0 + excess)]
}

/// The factors of a pass that are the same for all pixels.
struct Scales {
    weights: Weights,
    shares: Shares,
    halves: Halves,
    samples: f64,
    photons: f64,
    per_sample: f64,
    per_photon: f64,
    /// One over the photons of the passes before.
    per_earlier: f64,
}

/// A row of tiles, and what is kept of its pixels.
struct Band<'a> {
    pixels: &'a mut [Pixel],
    /// Empty, as the next, where there are none.
    differences: &'a mut [f64],
    unlit: &'a mut [Unlit],
    tiles: &'a mut [Tile],
}

/// What is kept of a pixel.
struct Kept<'a> {
    pixel: &'a mut Pixel,
    difference: Option<f64>,
    unlit: Option<&'a mut Unlit>,
}

impl<const LAYERS: usize> Pass<'_, LAYERS> {
    /// Adds the pass to a row of tiles, whose first pixel is `first`.
    fn add_to_tiles(
        &self,
        (first, width): (usize, usize),
        Band { pixels, differences, unlit, tiles }: Band<'_>,
        scales: &Scales,
    ) -> Sums {
        let mut sums = Sums::default();
        let mut addends = vec![OfTile::default(); tiles.len()];
        for (i, pixel) in pixels.iter_mut().enumerate() {
            let index = first + i;
            if self.renewal.is_none() && self.hit_points.of_pixel(index).is_empty() {
                continue;
            }
            let mut unlit = unlit.get_mut(i);
            if let Some(unlit) = unlit.as_mut().filter(|_| self.radiance.is_lit(index)) {
                unlit.forget();
            }
            let addend = self.addend(index, unlit.as_deref_mut(), scales.per_sample);
            let difference = differences.get_mut(i).map(|difference| {
                *difference += scales.halves.sign() * addend.light;
                *difference
            });
            let of_tile = &mut addends[i % width / TILE];
            of_tile.light += addend.light;
            // A pixel that sees emitters alone may see something reflect in a later pass.
            if self.renewal.is_none_or(|renewal| renewal.pixels.is_seen(index)) {
                let kept = Kept { pixel, difference, unlit };
                self.add_to_pixel(index, kept, &addend, scales, &mut sums, of_tile);
            } else {
                pixel.add(&addend, scales.photons);
            }
        }
        for (tile, of_tile) in tiles.iter_mut().zip(addends) {
            tile.light.add(of_tile.light, scales.photons);
            tile.bias.add(of_tile.bias, scales.photons);
            (tile.pixels, tile.unknown) = (of_tile.pixels, of_tile.unknown);
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
        Kept { pixel, difference, unlit }: Kept<'_>,
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
        let by_photons = self.radiance.luminance_sum(index) * shares.per_photon;
        let [seen, reflected] = self.renewal.map_or([0.0; 2], |renewal| {
            let [emission, direct] = renewal.seen.luminance_sums(index).map(|sum| sum * shares.per_photon);
            [emission + direct, direct]
        });
        let mean = by_photons + seen;
        let variance = match difference {
            Some(difference) => scales.halves.variance(mean, difference),
            None => pixel.variance(mean, shares),
        };
        pixel.sum_up(by_photons + reflected, variance, shares, sums);
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
        if is_unknown || direct.is_some() || self.renewal.is_some() {
            // Shadow rays say nothing about indirect light.
            let per_power = match unlit {
                Some(unlit) => unlit.one_photon(!self.facts.radii_shrink_alike, || self.one_photon(index)),
                None => self.one_photon(index),
            };
            let one_photon = per_power * self.facts.power / scales.samples / weights.photons;
            is_unknown |= one_photon > all;
            sums.unknown2 += one_photon.powi(2);
        }
        sums.unknown += f64::from(u8::from(is_unknown));
        of_tile.pixels += 1;
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
        self.halves.add(pass.facts.before, photons);
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
        let concentration = if pass.renewal.is_some() { 1.0 } else { self.weights.concentration() };
        self.estimate = sums.estimate(&self.weights, &self.scatter, concentration).map(|whole| {
            let squares = (whole.noise * whole.noise, whole.bias * whole.bias);
            let bias2 = sums.bias2.max(0.0);
            let trust = if bias2 > 0.0 { bias2 / (bias2 + sums.bias_variance) } else { 0.0 };
            let mut direct = pass.direct.map(|_| sums.direct_variance);
            if pass.renewal.is_some_and(|renewal| renewal.lights.is_some()) {
                // What photons do not explain: shadow rays, and what differs from eye sample to eye sample.
                direct = Some((sums.variance - self.classes.noise_of_photons(&self.weights)).max(0.0));
            }
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
            halves: self.halves,
            samples,
            photons,
            per_sample: 1.0 / samples,
            per_photon: 1.0 / photons,
            per_earlier: 1.0 / before,
        };
        let pixels = self.pixels.par_chunks_mut(TILE * width);
        let (differences, unlit) = (
            rows(&mut self.differences, TILE * width, pixels.len()),
            rows(&mut self.unlit, TILE * width, pixels.len()),
        );
        let sums: Vec<Sums> = pixels
            .zip(differences.into_par_iter().zip(unlit))
            .zip(self.tiles.par_chunks_mut(width.div_ceil(TILE)))
            .enumerate()
            .map(|(band, ((pixels, (differences, unlit)), tiles))| {
                let at = (band * TILE * width, width);
                pass.add_to_tiles(at, Band { pixels, differences, unlit, tiles }, &scales)
            })
            .collect();
        sums.into_iter().fold(Sums::default(), Sums::plus)
    }
}

/// Values of pixels in so many rows of so many; empty rows of none.
fn rows<T>(values: &mut [T], length: usize, count: usize) -> Vec<&mut [T]> {
    let mut rows: Vec<&mut [T]> = values.chunks_mut(length).collect();
    rows.resize_with(count, Default::default);
    rows
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
