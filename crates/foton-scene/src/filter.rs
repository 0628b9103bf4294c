//! Reconstruction filters, sampled: an eye sample lands around its pixel's centre with the filter's own density.
//!
//! All samples of a pixel then weigh the same, and a pixel's value is a plain mean. Source: Ernst, Stamminger and Greiner,
//! "Filter Importance Sampling" (2006). `[ESG06]`

use foton_math::glam::Vec2;

use crate::description::Filter;

/// Entries in the table of a Gaussian's quantiles; linear in between, the error is below 10⁻³ pixels.
const QUANTILES: usize = 1024;

/// A filter ready to be sampled.
#[derive(Clone, Debug)]
pub struct FilterSampler {
    kind: Kind,
}

#[derive(Clone, Debug)]
enum Kind {
    Box { radius: f32 },
    Tent { radius: f32 },
    Table { quantiles: Vec<f32> },
}

impl FilterSampler {
    /// Prepares a filter.
    #[must_use]
    pub fn new(filter: Filter) -> Self {
        let kind = match filter {
            Filter::Box { radius } => Kind::Box { radius: radius as f32 },
            Filter::Tent { radius } => Kind::Tent { radius: radius as f32 },
            Filter::Gaussian { stddev } => Kind::Table { quantiles: gaussian_quantiles(stddev) },
        };
        Self { kind }
    }

    /// The offset from the pixel's centre, in pixels, for a point of the unit square. Monotone on each axis, so that
    /// stratified points give stratified offsets.
    #[must_use]
    pub fn offset(&self, u: Vec2) -> Vec2 {
        Vec2::new(self.offset_1d(u.x), self.offset_1d(u.y))
    }

    fn offset_1d(&self, u: f32) -> f32 {
        match &self.kind {
            Kind::Box { radius } => (2.0 * u - 1.0) * radius,
            Kind::Tent { radius } => {
                let centred = 2.0 * u - 1.0;
                (1.0 - (1.0 - centred.abs()).max(0.0).sqrt()).copysign(centred) * radius
            }
            Kind::Table { quantiles } => {
                let x = u * QUANTILES as f32;
                let i = (x as usize).min(QUANTILES - 1);
                quantiles[i] + (quantiles[i + 1] - quantiles[i]) * (x - i as f32)
            }
        }
    }
}

/// Positions below which a share i / `QUANTILES` of the cut-off Gaussian's area lies.
fn gaussian_quantiles(stddev: f64) -> Vec<f32> {
    let radius = 4.0 * stddev;
    let height = |x: f64| (-0.5 * (x / stddev).powi(2)).exp() - (-8f64).exp();
    let steps = 64 * QUANTILES;
    let width = 2.0 * radius / steps as f64;
    let position = |i: usize| -radius + (i as f64 + 0.5) * width;
    let total: f64 = (0..steps).map(|i| height(position(i))).sum();
    let mut quantiles = vec![-radius as f32];
    let mut area = 0.0;
    for i in 0..steps {
        area += height(position(i)) / total;
        while quantiles.len() < QUANTILES && area * QUANTILES as f64 >= quantiles.len() as f64 {
            quantiles.push((position(i) + 0.5 * width) as f32);
        }
    }
    quantiles.resize(QUANTILES + 1, radius as f32);
    quantiles
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean and variance of the offsets over a fine grid of u.
    fn moments(filter: Filter) -> (f64, f64) {
        let sampler = FilterSampler::new(filter);
        let n = 100_000;
        let offsets: Vec<f64> =
            (0..n).map(|i| f64::from(sampler.offset(Vec2::splat((i as f32 + 0.5) / n as f32)).x)).collect();
        let mean = offsets.iter().sum::<f64>() / f64::from(n);
        (mean, offsets.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / f64::from(n))
    }

    #[test]
    fn offsets_have_the_moments_of_their_filter() {
        let (mean, variance) = moments(Filter::Box { radius: 0.5 });
        assert!(mean.abs() < 1e-6 && (variance - 1.0 / 12.0).abs() < 1e-5);
        let (mean, variance) = moments(Filter::Tent { radius: 1.0 });
        assert!(mean.abs() < 1e-6 && (variance - 1.0 / 6.0).abs() < 1e-5);
        // Cutting and lowering at 4σ takes a little off the variance: numerically 0.2496 at σ = 0.5.
        let (mean, variance) = moments(Filter::Gaussian { stddev: 0.5 });
        assert!(mean.abs() < 1e-4 && (variance - 0.248).abs() < 2e-3, "{mean} {variance}");
    }
}
