//! Radii that shrink where bias dominates, and stay where noise does: the adaptive rule, after `[KD13]`.
//!
//! Noise of variance V/(n r²) and bias B r² add up to the minimum where bias² = noise²/2, so each hit point goes by the quotient
//! R = bias²/(noise²/2) of what it has gathered so far. α stands for the odds that a photon is retained, α : 1 − α; here they are
//! α : (1 − α) R, so that α has its usual meaning where the two are in balance, nothing shrinks where there is no bias, and radii go to zero
//! wherever there is some, since noise does.
//!
//! Bias is seen in two ways, each with its own noise taken off. The Laplacian's is that of the error estimate (`error/mod.rs`).
//! Right on an edge of light both sides cancel in it, but the middle of the light is off the middle of the disc: by g of its
//! radius, bias is about 6 g² of the light there (0.54 for 0.5 at a straight edge through the middle), and has the order of the
//! Laplacian's where light is smooth.

use std::f64::consts::PI;

use foton_transport::codec::{Reader, StateError, Writer};
use foton_transport::photon_map::LANES;

use super::settings::Alpha;

/// Bias over light, per square of how far the light's middle is off.
const OF_OFFSET: f64 = 6.0;

/// How many times its own variance is taken off a square.
const CAUTION: f64 = 2.0;

/// The largest R: beyond it radii shrink no faster.
const MAX_BALANCE: f64 = 30.0;

/// Light may seem concentrated by chance, by this over the root of its photons: the spread of even light has a standard deviation of
/// 0.29 r², 0.58 of its mean.
const BY_CHANCE: f64 = 2.0;

/// Sums over the photons of a packet's lanes, of luminance Φ: whether path classes are summed separately changes none of their bits.
pub(crate) struct DiscMoments {
    /// Σ Φ.
    pub(crate) light: [f32; LANES],
    /// Σ Φ².
    pub(crate) squares: [f32; LANES],
    /// Σ Φ d, d from the photon to the hit point.
    pub(crate) offset: [[f32; LANES]; 3],
}

impl DiscMoments {
    pub(crate) const NONE: Self =
        Self { light: [0.0; LANES], squares: [0.0; LANES], offset: [[0.0; LANES]; 3] };
}

/// Moments of a hit point's light over all passes, each with its own radius.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct RadiusStatistics {
    /// Σ Φ/(π r²).
    pub(super) light: f64,
    /// Σ (Φ/(π r²))²: the variance of that.
    pub(super) variance: f64,
    /// Σ 6(s − ½) Φ/(π r²), s = d²/r².
    pub(super) laplacian: f64,
    /// Σ Φ d/(π r³).
    pub(super) offset: [f64; 3],
    /// Σ |d − d̄|²/r², d̄ the mean of a pass, over as many equal photons as would be as noisy; and how many more than one those
    /// were in each pass.
    pub(super) spread: f64,
    pub(super) freedom: f64,
}

impl RadiusStatistics {
    /// Takes what a lane has found in a disc of that r²; `moment` is Σ Φ d². Sums that are no finite numbers are left out.
    pub(crate) fn add(&mut self, radius2: f32, lane: usize, moment: f32, disc: &DiscMoments) {
        let squares = disc.squares[lane];
        // The squares are the first to be too large.
        if !(squares + moment).is_finite() {
            return;
        }
        let radius2 = f64::from(radius2);
        let per_area = 1.0 / (PI * radius2);
        let (flux, moment) = (f64::from(disc.light[lane]), f64::from(moment));
        self.light += flux * per_area;
        self.variance += f64::from(squares) * per_area * per_area;
        self.laplacian += (6.0 * moment / radius2 - 3.0 * flux) * per_area;
        let per_length = per_area / radius2.sqrt();
        let mut offset2 = 0.0;
        for (sum, offset) in self.offset.iter_mut().zip(&disc.offset) {
            let offset = f64::from(offset[lane]);
            *sum += offset * per_length;
            offset2 += offset * offset;
        }
        let per_photon = flux / f64::from(squares);
        let freedom = flux * per_photon - 1.0;
        // Of one photon there is no spread, and rounding must not make one.
        if freedom > 1e-3 {
            self.spread += (moment - offset2 / flux).max(0.0) * per_photon / radius2;
            self.freedom += freedom;
        }
    }

    /// Adds what a hit point of a pass has found, whose light counts by a weight. A photon reaches all hit points of a pixel about
    /// alike, so the roots of their variances add up.
    pub(crate) fn add_hit_point(&mut self, other: &Self, weight: f64) {
        self.light += weight * other.light;
        self.variance = (self.variance.sqrt() + weight * other.variance.sqrt()).powi(2);
        self.laplacian += weight * other.laplacian;
        self.offset.iter_mut().zip(other.offset).for_each(|(sum, offset)| *sum += weight * offset);
        self.spread += other.spread;
        self.freedom += other.freedom;
    }

    /// Adds what another pass has found.
    pub(crate) fn add_pass(&mut self, pass: &Self) {
        self.light += pass.light;
        self.variance += pass.variance;
        self.laplacian += pass.laplacian;
        self.offset.iter_mut().zip(pass.offset).for_each(|(sum, offset)| *sum += offset);
        self.spread += pass.spread;
        self.freedom += pass.freedom;
    }

    /// One of that light, variance and Laplacian.
    #[cfg(test)]
    pub(crate) fn of_laplacian(light: f64, variance: f64, laplacian: f64) -> Self {
        Self { light, variance, laplacian, ..Self::default() }
    }

    /// Squares of the sums that tell bias: of the Laplacian, and of the offset.
    pub(crate) fn squares(&self) -> [f64; 2] {
        [self.laplacian * self.laplacian, self.offset.iter().map(|o| o * o).sum()]
    }

    /// R: bias² over half the noise², at most [`MAX_BALANCE`]; 1 while nothing is known.
    fn balance(&self) -> f64 {
        // Over a disc 36 (s − ½)² is 3 on average, and d²/r² a half.
        self.balance_beside([3.0 * self.variance, 0.5 * self.variance])
    }

    /// The same where the variances of the sums that [`RadiusStatistics::squares`] has the squares of are known otherwise.
    fn balance_beside(&self, noise: [f64; 2]) -> f64 {
        if self.light <= 0.0 || self.variance <= 0.0 {
            return 1.0;
        }
        let [laplacian2, offset2] = self.squares();
        let (laplacian2, offset2) = (laplacian2 - CAUTION * noise[0], offset2 - CAUTION * noise[1]);
        let at_edges = OF_OFFSET * offset2.max(0.0) / self.light;
        let bias2 = laplacian2.max(0.0) + at_edges * at_edges;
        // NaN where both sums are infinite: `min` then takes the maximum.
        (bias2 / (0.5 * self.variance)).min(MAX_BALANCE)
    }

    /// How far light may be above what the disc sees, squared and relative to that: r²/ρ² − 1 where it lies within a circle of radius
    /// ρ, as its spread about its own middle tells, ρ²/2 for r²/2 of even light; less what so few photons may show by chance.
    ///
    /// That is the mean squared error over the disc, whose points are within the circle or beside it: of a focus finer than the disc,
    /// and of a shadow's edge through it, where it is 0.56. The Laplacian sees neither for what it is.
    pub(crate) fn focus(&self) -> f64 {
        // Each pass about its own middle: with another radius that is elsewhere in the disc.
        let (spread, photons) = (self.spread, self.freedom);
        if spread >= 0.5 * photons || self.light <= 0.0 {
            return 0.0;
        }
        // A few photons tell of no circle that is smaller than their share of the disc.
        let ratio = (0.5 * photons / spread.max(f64::MIN_POSITIVE)).min(photons);
        let by_chance = BY_CHANCE / photons.sqrt();
        // NaN where both sums are infinite.
        if ratio.is_finite() { (ratio - 1.0 - by_chance).max(0.0) } else { 0.0 }
    }

    /// Σ Φ/(π r²) in luminance over all passes: irradiance, once it is divided by the photons emitted.
    pub(crate) const fn light(&self) -> f64 {
        self.light
    }

    /// The share of new photons to retain, which is `alpha` where bias and noise are in balance.
    pub(crate) fn alpha(&self, alpha: Alpha) -> Alpha {
        retained(alpha, self.balance())
    }

    /// The same where the variances of what tells bias are known otherwise.
    pub(crate) fn alpha_beside(&self, alpha: Alpha, noise: [f64; 2]) -> Alpha {
        retained(alpha, self.balance_beside(noise))
    }

    pub(crate) fn write(&self, out: &mut Writer) {
        let Self { light, variance, laplacian, offset: [x, y, z], spread, freedom } = *self;
        [light, variance, laplacian, x, y, z, spread, freedom].into_iter().for_each(|n| out.f64(n));
    }

    pub(crate) fn read(input: &mut Reader<'_>) -> Result<Self, StateError> {
        let mut next = || input.finite();
        Ok(Self {
            light: next()?,
            variance: next()?,
            laplacian: next()?,
            offset: [next()?, next()?, next()?],
            spread: next()?,
            freedom: next()?,
        })
    }
}

/// The share of new photons to retain where bias² over half the noise² is that.
fn retained(alpha: Alpha, balance: f64) -> Alpha {
    let a = alpha.get();
    Alpha::new(a / (a + (1.0 - a) * balance)).unwrap_or(alpha)
}

#[cfg(test)]
mod tests;
