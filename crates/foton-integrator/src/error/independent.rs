//! The error of images whose pixels are independent: each pass follows eye samples of its own, and no two pixels share any light.
//!
//! What is known of a pixel is how much passes scatter. Antialiasing, gloss and lenses are part of that; bias is not. As everywhere,
//! light on paths that none has found yet where others have is no part of it.
//!
//! Emitters that are seen, directly or in mirrors, are often a hundred times as bright as what they light. Their edges, which no picture
//! shows but as white, would then be all of the error. So they count as no brighter than [`WHITE`].

use foton_transport::codec::{Reader, StateError, Writer};

use super::estimate::{ErrorEstimate, Sums, TileError};
use super::moments::{Halves, Moments, Scatter, Weights};
use super::{TILE, state};
use crate::white::WHITE;

/// What a pass found at a pixel, in luminance (W/m²/sr).
#[derive(Clone, Copy, Debug)]
pub(crate) struct PassPixel {
    /// Its own estimate of emitters that are seen.
    pub(crate) emission: f64,
    /// The same of light that is reflected.
    pub(crate) reflected: f64,
    /// Σ over all passes of that.
    pub(crate) reflected_so_far: f64,
    /// Whether anything reflects there.
    pub(crate) scatters: bool,
}

#[derive(Clone, Copy, Debug, Default)]
struct Pixel {
    moments: Moments,
    /// Σ over passes of light, that of the second sequence taken off.
    difference: f64,
    /// Whether any sample has seen something reflect.
    is_seen: bool,
}

#[derive(Clone, Copy, Debug, Default)]
struct Tile {
    pixels: u32,
    unknown: u32,
    /// Σ over seen pixels.
    mean: f64,
    /// The same of variances: as the two sequences differ, and as passes scatter, which is more where these are stratified.
    variance: f64,
    scattered: f64,
}

/// Sums over all passes so far.
pub(crate) struct Independent {
    pixels: Vec<Pixel>,
    tiles: Vec<Tile>,
    width: usize,
    weights: Weights,
    halves: Halves,
    scatter: Scatter,
    estimate: Option<ErrorEstimate>,
}

impl Independent {
    pub(crate) fn new(width: usize, pixels: usize) -> Self {
        let height = pixels.div_ceil(width.max(1));
        Self {
            pixels: vec![Pixel::default(); pixels],
            tiles: vec![Tile::default(); width.div_ceil(TILE) * height.div_ceil(TILE)],
            width,
            weights: Weights::default(),
            halves: Halves::default(),
            scatter: Scatter::default(),
            estimate: None,
        }
    }

    /// Adds a pass; all count alike.
    pub(crate) fn add(&mut self, pass: impl Fn(usize) -> PassPixel) {
        self.halves.add(self.weights.photons as u64, 1.0);
        self.weights.add(1.0);
        let passes = self.weights.photons;
        let mut sums = Sums::default();
        for (index, pixel) in self.pixels.iter_mut().enumerate() {
            let PassPixel { reflected_so_far, scatters, .. } = pass(index);
            pixel.is_seen |= scatters;
            if pixel.is_seen {
                sums.seen += 1.0;
                sums.light += reflected_so_far / passes;
            }
        }
        let white = WHITE * sums.light / sums.seen.max(1.0);
        self.tiles.fill(Tile::default());
        let shares = self.weights.shares();
        for index in 0..self.pixels.len() {
            let PassPixel { emission, reflected, .. } = pass(index);
            let light = reflected + emission.min(white);
            let pixel = &mut self.pixels[index];
            pixel.moments.add(light, 1.0);
            pixel.difference += self.halves.sign() * light;
            if !pixel.is_seen {
                continue;
            }
            let (mean, scattered) = pixel.moments.mean_and_variance_by(&shares);
            let variance = self.halves.variance(mean, pixel.difference);
            let is_unknown = mean <= 0.0;
            sums.variance += variance;
            sums.deviation += (light - mean).powi(2);
            sums.unknown += f64::from(u8::from(is_unknown));
            let tile = self.tile_of(index);
            let tile = &mut self.tiles[tile];
            tile.pixels += 1;
            tile.unknown += u32::from(is_unknown);
            tile.mean += mean;
            tile.variance += variance;
            tile.scattered += scattered;
        }
        if passes > 1.0 && sums.seen > 0.0 {
            self.scatter.add(sums.deviation / sums.seen / (1.0 - 1.0 / passes));
        }
        // Of two sequences each has one mean.
        self.estimate = sums.estimate(&self.weights, &self.scatter, 1.0);
    }

    /// The figure after the last pass.
    pub(crate) const fn estimate(&self) -> Option<ErrorEstimate> {
        self.estimate
    }

    /// All tiles of 8 × 8 pixels, row by row.
    pub(crate) fn tiles(&self) -> Vec<TileError> {
        let of = |tile: &Tile| {
            let pixels = f64::from(tile.pixels.max(1));
            TileError {
                pixels: tile.pixels,
                mean: tile.mean / pixels,
                noise: tile.variance.sqrt() / pixels,
                unknown: tile.unknown,
                ..TileError::default()
            }
        };
        self.tiles.iter().map(of).collect()
    }

    /// Standard deviation of each pixel's luminance: as its passes scatter, in proportion to what the tile knows of the two sequences, since
    /// the difference of a single pixel's says little.
    pub(crate) fn noise(&self) -> Vec<f32> {
        let shares = self.weights.shares();
        let of = |(index, pixel): (usize, &Pixel)| {
            let tile = &self.tiles[self.tile_of(index)];
            let share = if tile.scattered > 0.0 { tile.variance / tile.scattered } else { 1.0 };
            (pixel.moments.mean_and_variance_by(&shares).1 * share).sqrt() as f32
        };
        self.pixels.iter().enumerate().map(of).collect()
    }

    fn tile_of(&self, pixel: usize) -> usize {
        pixel / self.width / TILE * self.width.div_ceil(TILE) + pixel % self.width / TILE
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        self.pixels.len() * Self::BYTES_PER_PIXEL + self.tiles.len() * size_of::<Tile>()
    }

    /// Bytes held per pixel, without the tiles'.
    pub(crate) const BYTES_PER_PIXEL: usize = size_of::<Pixel>();

    pub(crate) fn write(&self, out: &mut Writer) {
        self.weights.numbers().iter().for_each(|&n| out.f64(n));
        self.scatter.numbers().iter().for_each(|&n| out.f64(n));
        state::write_estimate(self.estimate, out);
        self.halves.numbers().iter().for_each(|&n| out.f64(n));
        for pixel in &self.pixels {
            pixel.moments.numbers().iter().chain([&pixel.difference]).for_each(|&n| out.f64(n));
            out.u64(pixel.is_seen.into());
        }
        for tile in &self.tiles {
            [tile.mean, tile.variance, tile.scattered].iter().for_each(|&n| out.f64(n));
            [tile.pixels, tile.unknown].iter().for_each(|&n| out.u64(n.into()));
        }
    }

    pub(crate) fn read(&mut self, input: &mut Reader<'_>) -> Result<(), StateError> {
        self.weights = Weights::of(state::numbers(input)?);
        self.scatter = Scatter::of(state::numbers(input)?);
        self.estimate = state::read_estimate(input)?;
        self.halves = Halves::of(state::numbers(input)?);
        for pixel in &mut self.pixels {
            pixel.moments = Moments::of(state::numbers(input)?);
            pixel.difference = input.finite()?;
            pixel.is_seen = input.u64()? != 0;
        }
        for tile in &mut self.tiles {
            [tile.mean, tile.variance, tile.scattered] = state::numbers(input)?;
            tile.pixels = u32::try_from(input.count()?).map_err(|_| StateError::Impossible)?;
            tile.unknown = u32::try_from(input.count()?).map_err(|_| StateError::Impossible)?;
        }
        Ok(())
    }
}
