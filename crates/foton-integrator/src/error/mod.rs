//! How wrong the image still is, from the passes alone: noise from how much their estimates scatter, bias from where in the
//! discs light falls.
//!
//! **Bias.** A disc of radius r measures the mean of E over it, E + (r²/8)∇²E + … With s = d²/r² for a photon at distance d,
//! B̂ = Σ 6(s − ½) Φ/(π r²) has that same expectation: over the disc s is uniform, so the factor's mean is 0 and the Laplacian's
//! part is 6 Var(s) r²/4 · ∇²E = (r²/8)∇²E. Summed pass by pass with each pass's own radius, as L is, it is the bias of L.
//! Among all radial weights with this expectation, the one linear in s has the smallest variance: Var B̂ = 36 Var(s) Var L =
//! 3 Var L (4 for two concentric discs, 4.5 for the derivative kernel of `[HJJ10]`), and B̂ and L are uncorrelated.
//!
//! `classes.rs` says what direct, caustic and indirect light contribute.
//!
//! Luminance only: photons carry all channels, so their errors go together.

mod classes;
mod estimate;
mod moments;
mod state;

use foton_math::Rgb;
use rayon::prelude::*;

pub use classes::ClassError;
pub(crate) use classes::Question;
pub use estimate::{ErrorEstimate, TileError};

use crate::ppm::{HitPoints, Irradiance, Radiance};
use classes::Classes;
use estimate::Sums;
use foton_transport::photon_map::LANES;
use moments::{Moments, Scatter, Shares, Weights};

/// Pixels along the side of a tile.
const TILE: usize = 8;

/// The bias plane averages squares over this many pixels to each side.
const SMOOTHED: usize = 2;

/// What a pixel keeps beside its sum.
#[derive(Clone, Copy, Debug, Default)]
struct Pixel {
    /// Σ aⱼ² and Σ nⱼ aⱼ of its luminance.
    squares: f64,
    cross: f64,
    /// The same and the sum for its bias, of which fewer digits are known.
    bias: f64,
    bias_squares: f32,
    bias_cross: f32,
}

#[derive(Clone, Copy, Debug, Default)]
struct Tile {
    pixels: u32,
    light: Moments,
    bias: Moments,
    /// Of the last pass, for all so far: squares of what discs may hide, and pixels that are unknown.
    focus2: f64,
    unknown: u32,
}

/// Sums over all passes so far.
pub(crate) struct ErrorSums {
    /// 6(s − ½)Φ/(π r²) of this pass by slot, in luminance, and the answer about one class.
    moment_slots: Vec<[f32; 2]>,
    pixels: Vec<Pixel>,
    tiles: Vec<Tile>,
    width: usize,
    samples: f64,
    weights: Weights,
    scatter: Scatter,
    classes: Classes,
    /// What discs may hide, and the variance of that, when it was last looked at.
    foci: [f64; 2],
    estimate: Option<ErrorEstimate>,
}

/// A pass that has been added to the image.
pub(crate) struct Pass<'a, const LAYERS: usize> {
    pub(crate) hit_points: &'a HitPoints,
    pub(crate) irradiance_slots: &'a [Irradiance<LAYERS>],
    pub(crate) radiance: &'a Radiance<LAYERS>,
    /// Photons that it emitted.
    pub(crate) photons: u64,
    /// Mean power of a photon where it leaves its emitter, or, where photons are aimed and differ much, of those near hit points.
    pub(crate) power: f64,
    /// What was asked of each of them.
    pub(crate) question: Question,
    /// Whether direct light came by shadow rays.
    pub(crate) shadow_rays: bool,
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
}

/// What a pixel's own pass says.
struct Addend {
    light: f64,
    bias: f64,
    /// How far squared light of all passes may be above what discs see (see `RadiusStatistics::focus`).
    focus: f64,
    /// The variance of that: whether a sample lies in a focus is chance.
    focus_variance: f64,
    /// Of one class: its blur, or a sum of squares.
    answer: f64,
}

impl<const LAYERS: usize> Pass<'_, LAYERS> {
    /// Whether it is looked at what discs may hide: not in every pass, since it hardly changes and is a thirtieth of the time.
    const fn looks_for_foci(&self) -> bool {
        self.before < 3 || self.before % 4 == 3
    }

    fn addend(&self, pixel: usize, moment_slots: &[[f32; 2]], per_sample: f64) -> Addend {
        let (hit_points, looks) = (self.hit_points, self.looks_for_foci());
        let range = hit_points.pixel_start[pixel] as usize..hit_points.pixel_start[pixel + 1] as usize;
        let (mut bias, mut answer, mut focus, mut focus_variance) = (0.0, 0.0, 0.0, 0.0);
        for (&slot, &weight) in hit_points.slot_of[range.clone()].iter().zip(&hit_points.weights[range]) {
            if looks
                && let radius_statistics = &hit_points.radius_statistics_slots[slot as usize]
                && let excess = radius_statistics.focus()
                && excess > 0.0
            {
                // One sample in 1 + excess is as bright as the focus: its square has this mean and about this variance.
                let square = (f64::from(weight.luminance()) * radius_statistics.light()).powi(2) * excess;
                focus += square;
                focus_variance += square * square * (1.0 + excess);
            }
            let irradiance: Rgb = self.irradiance_slots[slot as usize].iter().copied().sum();
            let luminance = irradiance.luminance();
            if luminance > 0.0 {
                let seen = (weight * irradiance).luminance() / luminance;
                let [moment, of_class] = moment_slots[slot as usize];
                bias += f64::from(seen * moment);
                // A photon reaches all hit points of a pixel about alike.
                answer += f64::from(seen * if self.question.noise { of_class.sqrt() } else { of_class });
            }
        }
        let light: Rgb = self.radiance.last[pixel].iter().copied().sum();
        answer *= per_sample;
        if self.question.noise {
            answer *= answer;
        }
        let per_sample2 = per_sample * per_sample;
        let (focus, focus_variance) = (focus * per_sample2, focus_variance * per_sample2 * per_sample2);
        Addend { light: f64::from(light.luminance()), bias: bias * per_sample, focus, focus_variance, answer }
    }

    /// Luminance per emitted photon that a pixel would gain if each of its hit points that know nothing found one.
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
        unknown.sum::<f64>() * self.power / samples
    }
}

impl ErrorSums {
    pub(crate) fn new(hit_points: &HitPoints, width: u32, samples: u32) -> Self {
        let (width, pixels) = (width as usize, hit_points.pixel_start.len() - 1);
        let height = pixels.div_ceil(width.max(1));
        let mut tiles = vec![Tile::default(); width.div_ceil(TILE) * height.div_ceil(TILE)];
        for pixel in 0..pixels {
            let tile = pixel / width / TILE * width.div_ceil(TILE) + pixel % width / TILE;
            let is_seen = hit_points.pixel_start[pixel] < hit_points.pixel_start[pixel + 1];
            tiles[tile].pixels += u32::from(is_seen);
        }
        Self {
            moment_slots: vec![[0.0; 2]; hit_points.packets.len() * LANES],
            pixels: vec![Pixel::default(); pixels],
            tiles,
            width,
            samples: f64::from(samples),
            weights: Weights::default(),
            scatter: Scatter::default(),
            classes: Classes::default(),
            foci: [0.0; 2],
            estimate: None,
        }
    }

    /// Where the gather puts each slot's moment.
    pub(crate) fn moment_slots(&mut self) -> &mut [[f32; 2]] {
        &mut self.moment_slots
    }

    /// Takes a pass that has been added to `radiance` already.
    pub(crate) fn add<const LAYERS: usize>(&mut self, pass: &Pass<'_, LAYERS>) {
        let photons = pass.photons as f64;
        let before = self.weights.photons;
        self.weights.add(photons);
        let (width, samples, weights) = (self.width, self.samples, self.weights);
        let shares = weights.shares();
        let (per_sample, per_photon, per_earlier) = (1.0 / samples, 1.0 / photons, 1.0 / before);
        let moment_slots = &self.moment_slots;
        let bands = self.pixels.par_chunks_mut(TILE * width);
        let sums: Vec<Sums> = bands
            .zip(self.tiles.par_chunks_mut(width.div_ceil(TILE)))
            .enumerate()
            .map(|(band, (pixels, tiles))| {
                let mut sums = Sums::default();
                let mut addends = vec![OfTile::default(); tiles.len()];
                for (i, pixel) in pixels.iter_mut().enumerate() {
                    let index = band * TILE * width + i;
                    if pass.hit_points.pixel_start[index] == pass.hit_points.pixel_start[index + 1] {
                        continue;
                    }
                    let addend = pass.addend(index, moment_slots, per_sample);
                    let answer = if pass.question.noise {
                        addend.answer
                    } else {
                        pixel.bias * per_earlier * addend.answer
                    };
                    sums.answer += if answer.is_finite() { answer } else { 0.0 };
                    pixel.add(&addend, photons);
                    let mean = pass.radiance.luminance_sum(index) * shares.per_photon;
                    pixel.sum_up(mean, &shares, &mut sums);
                    let focus2 = addend.focus * shares.per_photon * shares.per_photon;
                    sums.focus2 += focus2;
                    sums.focus_variance += addend.focus_variance * shares.per_photon.powi(4);
                    sums.deviation += (addend.light * per_photon - mean).powi(2);
                    let mut is_unknown = mean <= 0.0;
                    if is_unknown || pass.shadow_rays {
                        // Shadow rays know nothing of indirect light.
                        let one_photon = pass.one_photon(index, samples) / weights.photons;
                        is_unknown |= one_photon > mean;
                        sums.unknown2 += one_photon.powi(2);
                    }
                    sums.unknown += f64::from(u8::from(is_unknown));
                    let of_tile = &mut addends[i % width / TILE];
                    of_tile.light += addend.light;
                    of_tile.bias += addend.bias;
                    of_tile.focus2 += focus2;
                    of_tile.unknown += u32::from(is_unknown);
                }
                for (tile, of_tile) in tiles.iter_mut().zip(addends) {
                    tile.light.add(of_tile.light, photons);
                    tile.bias.add(of_tile.bias, photons);
                    tile.unknown = of_tile.unknown;
                    if pass.looks_for_foci() {
                        tile.focus2 = of_tile.focus2;
                    }
                }
                sums
            })
            .collect();
        let mut sums = sums.into_iter().fold(Sums::default(), Sums::plus);
        if pass.looks_for_foci() {
            self.foci = [sums.focus2, sums.focus_variance];
        } else {
            [sums.focus2, sums.focus_variance] = self.foci;
        }
        let share = photons / self.weights.photons;
        if share < 1.0 && sums.seen > 0.0 {
            self.scatter.add(photons * sums.deviation / sums.seen / (1.0 - share));
        }
        self.classes.add(pass.question, sums.answer, photons, before);
        self.estimate = sums.estimate(&self.weights, &self.scatter).map(|whole| {
            let squares = (whole.noise * whole.noise, whole.bias * whole.bias);
            let bias2 = sums.bias2.max(0.0);
            let trust = if bias2 > 0.0 { bias2 / (bias2 + sums.bias_variance) } else { 0.0 };
            let variance = pass.shadow_rays.then_some(sums.variance);
            ErrorEstimate { classes: self.classes.split(squares, trust, variance, &self.weights), ..whole }
        });
    }

    /// The figure after the last pass.
    pub(crate) const fn estimate(&self) -> Option<ErrorEstimate> {
        self.estimate
    }

    /// All tiles of 8 × 8 pixels, row by row.
    pub(crate) fn tiles(&self) -> Vec<TileError> {
        let of = |tile: &Tile| {
            let pixels = f64::from(tile.pixels.max(1));
            let (mean, variance) = tile.light.mean_and_variance(&self.weights);
            let (bias, bias_variance) = tile.bias.mean_and_variance(&self.weights);
            TileError {
                pixels: tile.pixels,
                mean: mean / pixels,
                noise: variance.sqrt() / pixels,
                bias: bias / pixels,
                bias_noise: bias_variance.sqrt() / pixels,
                focus: tile.focus2.sqrt() / pixels,
                unknown: tile.unknown,
            }
        };
        self.tiles.iter().map(of).collect()
    }

    /// Standard deviation and bias of each pixel's luminance. The bias is a root mean square over the 5 × 5 pixels around it,
    /// since a single pixel's is hardly known.
    pub(crate) fn planes<const LAYERS: usize>(&self, radiance: &Radiance<LAYERS>) -> (Vec<f32>, Vec<f32>) {
        let shares = self.weights.shares();
        let of = |(index, pixel): (usize, &Pixel)| {
            let mut sums = Sums::default();
            pixel.sum_up(radiance.luminance_sum(index) * shares.per_photon, &shares, &mut sums);
            (sums.variance, sums.bias2)
        };
        let (variance, bias2): (Vec<f64>, Vec<f64>) = self.pixels.iter().enumerate().map(of).unzip();
        let (width, height) = (self.width, self.pixels.len().div_ceil(self.width.max(1)));
        let smooth = |index: usize| {
            let (x, y) = (index % width, index / width);
            let rows = y.saturating_sub(SMOOTHED)..=(y + SMOOTHED).min(height - 1);
            let columns = x.saturating_sub(SMOOTHED)..(x + SMOOTHED + 1).min(width);
            let count = (rows.clone().count() * columns.len()) as f64;
            let sum: f64 = rows.map(|y| bias2[y * width..][columns.clone()].iter().sum::<f64>()).sum();
            (sum / count).max(0.0).sqrt() as f32
        };
        (variance.iter().map(|v| v.sqrt() as f32).collect(), (0..bias2.len()).map(smooth).collect())
    }

    /// The estimated bias of each pixel.
    pub(crate) fn bias(&self) -> Vec<f64> {
        let per_photon = self.weights.shares().per_photon;
        self.pixels.iter().map(|pixel| pixel.bias * per_photon).collect()
    }

    /// Bytes held.
    pub(crate) const fn bytes(&self) -> usize {
        Self::BYTES_PER_HIT_POINT * self.moment_slots.len()
            + Self::BYTES_PER_PIXEL * self.pixels.len()
            + size_of::<Tile>() * self.tiles.len()
    }

    /// Bytes held per hit point.
    pub(crate) const BYTES_PER_HIT_POINT: usize = size_of::<[f32; 2]>();
    /// Bytes held per pixel, without the tiles' two.
    pub(crate) const BYTES_PER_PIXEL: usize = size_of::<Pixel>();
}

impl Pixel {
    fn add(&mut self, addend: &Addend, photons: f64) {
        self.squares += addend.light * addend.light;
        self.cross += photons * addend.light;
        self.bias += addend.bias;
        self.bias_squares += (addend.bias * addend.bias) as f32;
        self.bias_cross += (photons * addend.bias) as f32;
    }

    fn sum_up(&self, mean: f64, shares: &Shares, sums: &mut Sums) {
        let bias = self.bias * shares.per_photon;
        let bias_variance = shares.variance(bias, f64::from(self.bias_squares), f64::from(self.bias_cross));
        sums.seen += 1.0;
        sums.light += mean;
        sums.variance += shares.variance(mean, self.squares, self.cross);
        sums.bias2 += bias * bias - bias_variance;
        sums.bias_variance += bias_variance;
    }
}
