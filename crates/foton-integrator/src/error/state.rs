//! The sums behind the error as numbers, for checkpoints.

use foton_transport::codec::{Reader, StateError, Writer};

use super::classes::{ClassError, Classes};
use super::estimate::ErrorEstimate;
use super::moments::{Halves, Moments, Scatter, Weights};
use super::unlit::Unlit;
use super::{ErrorSums, Pixel, Tile};

impl ErrorSums {
    pub(crate) fn write(&self, out: &mut Writer) {
        let mut put = |numbers: &[f64]| numbers.iter().for_each(|&n| out.f64(n));
        put(&self.weights.numbers());
        put(&self.scatter.numbers());
        put(&self.classes.numbers());
        put(&self.foci);
        write_estimate(self.estimate, out);
        let mut put = |numbers: &[f64]| numbers.iter().for_each(|&n| out.f64(n));
        for p in &self.pixels {
            put(&[p.squares, p.cross, p.bias, p.bias_squares.into(), p.bias_cross.into()]);
        }
        if !self.differences.is_empty() {
            put(&self.halves.numbers());
            put(&self.differences);
            self.tiles.iter().for_each(|t| put(&[t.pixels.into()]));
        }
        for t in &self.tiles {
            put(&t.light.numbers());
            put(&t.bias.numbers());
            put(&[t.focus2, t.unknown.into()]);
        }
    }

    pub(crate) fn read(&mut self, input: &mut Reader<'_>) -> Result<(), StateError> {
        self.weights = Weights::of(numbers(input)?);
        self.scatter = Scatter::of(numbers(input)?);
        self.classes = Classes::of(numbers(input)?);
        self.foci = numbers(input)?;
        self.estimate = read_estimate(input)?;
        self.unlit.fill(Unlit::UNKNOWN);
        for pixel in &mut self.pixels {
            let [squares, cross, bias, bias_squares, bias_cross] = numbers(input)?;
            let (bias_squares, bias_cross) = (bias_squares as f32, bias_cross as f32);
            *pixel = Pixel { squares, cross, bias, bias_squares, bias_cross };
        }
        if !self.differences.is_empty() {
            self.halves = Halves::of(numbers(input)?);
            for difference in &mut self.differences {
                [*difference] = numbers(input)?;
            }
            for tile in &mut self.tiles {
                let [pixels] = numbers(input)?;
                tile.pixels = pixels as u32;
            }
        }
        for tile in &mut self.tiles {
            let (light, bias) = (Moments::of(numbers(input)?), Moments::of(numbers(input)?));
            let [focus2, unknown] = numbers(input)?;
            *tile = Tile { light, bias, focus2, unknown: unknown as u32, ..*tile };
        }
        Ok(())
    }
}

pub(super) fn write_estimate(estimate: Option<ErrorEstimate>, out: &mut Writer) {
    let mut put = |numbers: &[f64]| numbers.iter().for_each(|&n| out.f64(n));
    put(&[f64::from(u8::from(estimate.is_some()))]);
    if let Some(e) = estimate {
        put(&[e.total, e.noise, e.bias, e.low, e.high]);
        put(&[e.focus, e.unknown_share, e.effective_passes, e.mean_luminance]);
        put(&[f64::from(u8::from(e.classes.is_some()))]);
        e.classes.iter().flatten().for_each(|c| put(&[c.noise, c.bias]));
    }
}

pub(super) fn read_estimate(input: &mut Reader<'_>) -> Result<Option<ErrorEstimate>, StateError> {
    let [is_known] = numbers(input)?;
    if is_known <= 0.0 {
        return Ok(None);
    }
    let [total, noise, bias, low, high, focus, unknown_share, effective_passes, mean_luminance] =
        numbers(input)?;
    let [has_classes] = numbers(input)?;
    let class = |[noise, bias]: [f64; 2]| ClassError { noise, bias };
    let mut classes = None;
    if has_classes > 0.0 {
        classes = Some([class(numbers(input)?), class(numbers(input)?), class(numbers(input)?)]);
    }
    Ok(Some(ErrorEstimate {
        total,
        noise,
        bias,
        low,
        high,
        focus,
        unknown_share,
        effective_passes,
        mean_luminance,
        classes,
    }))
}

pub(super) fn numbers<const N: usize>(input: &mut Reader<'_>) -> Result<[f64; N], StateError> {
    let mut numbers = [0.0; N];
    for number in &mut numbers {
        *number = input.f64()?;
    }
    Ok(numbers)
}
