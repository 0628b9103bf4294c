//! How wrong the image still is, from the passes alone: noise from how much their estimates scatter, bias from where in the
//! discs light falls.
//!
//! **Bias.** A disc of radius r measures the mean of E over it, E + (r²/8)∇²E + … With s = d²/r² for a photon at distance d,
//! B̂ = Σ 6(s − ½) Φ/(π r²) has that same expectation: over the disc s is uniform, so the factor's mean is 0 and the Laplacian's
//! part is 6 Var(s) r²/4 · ∇²E = (r²/8)∇²E. Summed pass by pass with each pass's own radius, as L is, it is the bias of L.
//! Among all radial weights with this expectation, the one linear in s has the smallest variance: Var B̂ = 36 Var(s) Var L =
//! 3 Var L (4 for two concentric discs, 4.5 for the derivative kernel of `[HJJ10]`), and B̂ and L are uncorrelated.
//!
//! `classes.rs` estimates what direct, caustic and indirect light contribute.
//!
//! Luminance only: photons carry all channels, so their errors go together.

mod classes;
mod estimate;
mod independent;
mod moments;
mod pass;
mod state;
mod unlit;

pub use classes::ClassError;
pub(crate) use classes::Question;
pub use estimate::{ErrorEstimate, TileError};
pub(crate) use independent::{Independent, PassPixel};
pub(crate) use pass::{Pass, PassFacts};

use crate::ppm::{Direct, HitPoints, Noise, Radiance, SlotMoments};
use crate::sppm::Renewal;
use classes::Classes;
use estimate::Sums;
use moments::{Halves, Moments, Scatter, Shares, Weights};
use unlit::Unlit;

/// Pixels along the side of a tile.
const TILE: usize = 8;

/// The bias plane averages squares over this many pixels to each side.
const SMOOTHED: usize = 2;

/// The second moments of a pixel, beside its sum.
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
    /// What need not be looked for again at pixels that a pass brings nothing. Empty where passes have new eye samples.
    unlit: Vec<Unlit>,
    pixels: Vec<Pixel>,
    /// Σ ± aⱼ by pixel, where passes take turns with two sequences of eye samples; else empty.
    differences: Vec<f64>,
    tiles: Vec<Tile>,
    width: usize,
    samples: f64,
    weights: Weights,
    halves: Halves,
    scatter: Scatter,
    classes: Classes,
    /// What discs may hide, and the variance of that, when they were last summed.
    foci: [f64; 2],
    estimate: Option<ErrorEstimate>,
}

impl ErrorSums {
    /// `renewed`: whether passes have new eye samples.
    pub(crate) fn new(hit_points: &HitPoints, width: u32, samples: u32, renewed: bool) -> Self {
        let (width, pixels) = (width as usize, hit_points.pixel_start.len() - 1);
        let height = pixels.div_ceil(width.max(1));
        let mut tiles = vec![Tile::default(); width.div_ceil(TILE) * height.div_ceil(TILE)];
        for pixel in 0..pixels {
            let tile = pixel / width / TILE * width.div_ceil(TILE) + pixel % width / TILE;
            let is_seen = hit_points.pixel_start[pixel] < hit_points.pixel_start[pixel + 1];
            tiles[tile].pixels += u32::from(is_seen);
        }
        Self {
            unlit: vec![Unlit::UNKNOWN; if renewed { 0 } else { pixels }],
            pixels: vec![Pixel::default(); pixels],
            differences: vec![0.0; if renewed { pixels } else { 0 }],
            tiles,
            width,
            samples: f64::from(samples),
            weights: Weights::default(),
            halves: Halves::default(),
            scatter: Scatter::default(),
            classes: Classes::default(),
            foci: [0.0; 2],
            estimate: None,
        }
    }

    /// The figure after the last pass.
    pub(crate) const fn estimate(&self) -> Option<ErrorEstimate> {
        self.estimate
    }

    /// Pixels of a tile.
    fn pixels_of(&self, tile: usize) -> impl Iterator<Item = usize> {
        let (width, height) = (self.width, self.pixels.len().div_ceil(self.width.max(1)));
        let across = width.div_ceil(TILE);
        let (x, y) = (tile % across * TILE, tile / across * TILE);
        let row = move |y: usize| (x..(x + TILE).min(width)).map(move |x| y * width + x);
        (y..(y + TILE).min(height)).flat_map(row)
    }

    /// The variance of a visit to a pixel: of each tile, where that knows any.
    fn per_visit(&self, direct: &Direct) -> Vec<f64> {
        let tiles: Vec<Noise> = (0..self.tiles.len()).map(|t| direct.noise(self.pixels_of(t))).collect();
        let all = tiles.iter().fold(Noise::default(), |all, tile| all.plus(*tile)).per_visit(0.0);
        tiles.iter().map(|tile| tile.per_visit(all)).collect()
    }

    /// All tiles of 8 × 8 pixels, row by row.
    pub(crate) fn tiles(&self, direct: Option<&Direct>) -> Vec<TileError> {
        let per_visit = direct.map_or_else(Vec::new, |direct| self.per_visit(direct));
        let of = |(index, tile): (usize, &Tile)| {
            let pixels = f64::from(tile.pixels.max(1));
            let (mut mean, mut variance) = tile.light.mean_and_variance(&self.weights);
            for pixel in direct.iter().flat_map(|direct| self.pixels_of(index).map(|p| direct.known(p))) {
                let (more, its_variance) = pixel.mean_and_variance(per_visit[index]);
                (mean, variance) = (mean + more, variance + its_variance);
            }
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
        self.tiles.iter().enumerate().map(of).collect()
    }

    /// Standard deviation and bias of each pixel's luminance. The bias is a root mean square over the 5 × 5 pixels around it,
    /// since a single pixel's is hardly known.
    pub(crate) fn planes(
        &self,
        radiance: &Radiance,
        direct: Option<&Direct>,
        renewal: Option<&Renewal>,
    ) -> (Vec<f32>, Vec<f32>) {
        let shares = self.weights.shares();
        let direct_variances = direct.map_or_else(Vec::new, |direct| self.direct_variances(direct));
        let mean = |index: usize| {
            let seen = renewal.map_or(0.0, |renewal| renewal.seen.luminance_sums(index).into_iter().sum());
            (radiance.luminance_sum(index) + seen) * shares.per_photon
        };
        let of = |(index, pixel): (usize, &Pixel)| {
            let mut sums = Sums::default();
            pixel.sum_up(mean(index), pixel.variance(mean(index), &shares), &shares, &mut sums);
            (sums.variance + direct_variances.get(index).unwrap_or(&0.0), sums.bias2)
        };
        let (mut variance, bias2): (Vec<f64>, Vec<f64>) = self.pixels.iter().enumerate().map(of).unzip();
        if !self.differences.is_empty() {
            // Passes scatter by more than their mean is noisy, about as much more in pixels that are near each other.
            let of = |(index, difference): (usize, &f64)| self.halves.variance(mean(index), *difference);
            let true_ones = self.smoothed(&self.differences.iter().enumerate().map(of).collect::<Vec<_>>());
            let scattered = self.smoothed(&variance);
            for ((variance, truth), scattered) in variance.iter_mut().zip(true_ones).zip(scattered) {
                *variance *= truth / scattered.max(f64::MIN_POSITIVE);
            }
        }
        let root = |values: Vec<f64>| values.into_iter().map(|v| v.max(0.0).sqrt() as f32).collect();
        (root(variance), root(self.smoothed(&bias2)))
    }

    /// Means over the pixels around each.
    fn smoothed(&self, values: &[f64]) -> Vec<f64> {
        let (width, height) = (self.width, self.pixels.len().div_ceil(self.width.max(1)));
        let smooth = |index: usize| {
            let (x, y) = (index % width, index / width);
            let rows = y.saturating_sub(SMOOTHED)..=(y + SMOOTHED).min(height - 1);
            let columns = x.saturating_sub(SMOOTHED)..(x + SMOOTHED + 1).min(width);
            let count = (rows.clone().count() * columns.len()) as f64;
            rows.map(|y| values[y * width..][columns.clone()].iter().sum::<f64>()).sum::<f64>() / count
        };
        (0..values.len()).map(smooth).collect()
    }

    /// That of direct light by pixel: a mean over the tile's, since a single pixel's is hardly known.
    fn direct_variances(&self, direct: &Direct) -> Vec<f64> {
        let mut variances = vec![0.0; self.pixels.len()];
        for (tile, per_visit) in self.per_visit(direct).into_iter().enumerate() {
            for pixel in self.pixels_of(tile) {
                variances[pixel] = per_visit / direct.known(pixel).visits();
            }
        }
        variances
    }

    /// The estimated bias of each pixel.
    pub(crate) fn bias(&self) -> Vec<f64> {
        let per_photon = self.weights.shares().per_photon;
        self.pixels.iter().map(|pixel| pixel.bias * per_photon).collect()
    }

    /// Bytes held.
    pub(crate) const fn bytes(&self) -> usize {
        Self::bytes_per_pixel(!self.differences.is_empty()) * self.pixels.len()
            + size_of::<Tile>() * self.tiles.len()
    }

    /// Bytes held per hit point that a pass brings something.
    pub(crate) const BYTES_PER_HIT_POINT: usize = size_of::<SlotMoments>();
    /// Bytes held per pixel, without the tiles' two; `renewed` as in [`ErrorSums::new`].
    pub(crate) const fn bytes_per_pixel(renewed: bool) -> usize {
        size_of::<Pixel>() + if renewed { size_of::<f64>() } else { size_of::<Unlit>() }
    }
}

impl Pixel {
    /// That of the mean, from how much passes scatter.
    fn variance(&self, mean: f64, shares: &Shares) -> f64 {
        shares.variance(mean, self.squares, self.cross)
    }

    /// Adds a pixel of that reflected luminance, and that variance of all it sees.
    fn sum_up(&self, mean: f64, variance: f64, shares: &Shares, sums: &mut Sums) {
        let bias = self.bias * shares.per_photon;
        let bias_variance = shares.variance(bias, f64::from(self.bias_squares), f64::from(self.bias_cross));
        sums.seen += 1.0;
        sums.light += mean;
        sums.variance += variance;
        sums.bias2 += bias * bias - bias_variance;
        sums.bias_variance += bias_variance;
    }
}
