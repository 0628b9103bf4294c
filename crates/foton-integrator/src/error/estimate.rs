//! The error of an image in one figure, and of its tiles.

use super::classes::ClassError;
use super::moments::{Scatter, Weights};
use crate::ppm::Noise;

/// The variance of a squared difference of direct light over its squared mean: 2 for a normal variable, more where some rays find an
/// emitter and others do not.
const OF_DIRECT: f64 = 8.0;

/// Half of the outer 10 % of a normal distribution lie beyond this many standard deviations.
const Z_90: f64 = 1.645;

/// At a straight edge of light, root mean square over the disc's width: the estimated bias over the true one. There bias is no
/// Laplacian; right on the edge both sides cancel.
const SEEN_AT_EDGES: f64 = 0.55;

/// How far an image is from the one that endless passes would make: where eye samples are followed once, over those same samples.
///
/// All shares are relative to the mean reflected luminance of those pixels that see anything reflect; the error is the root
/// mean square over the same pixels. Left out, because passes cannot show it: what eye samples miss that stand still (antialiasing
/// and gloss are frozen with them), light on paths that no photon has found yet where others have, and most of the bias right at
/// edges, which is no Laplacian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorEstimate {
    /// √(noise² + bias²).
    pub total: f64,
    /// What more photons alone would take away; hit points that no photon has found count as if one were about to.
    pub noise: f64,
    /// Bias from the radius.
    pub bias: f64,
    /// The error is above this nineteen times in twenty, as far as the figure goes.
    pub low: f64,
    /// The error is below this nineteen times in twenty, even if all the bias is that of straight edges, of which the estimate
    /// sees 0.55 alone, and if light is as concentrated within discs as their photons are.
    pub high: f64,
    /// What light that is concentrated within discs as their photons are would add; edges of light count too. Where it is most of
    /// [`ErrorEstimate::high`], a few bright pixels decide.
    pub focus: f64,
    /// Share of pixels that see something reflect and have found no light at all, or behind shadow rays so few photons that one more
    /// would bring more light than is known: unknown, not dark.
    pub unknown_share: f64,
    /// Number of equal passes that those so far are worth: passes grow at first.
    pub effective_passes: f64,
    /// The mean that the others are relative to (W/m²/sr).
    pub mean_luminance: f64,
    /// What direct, caustic and indirect light contribute, in this order: their squares add up to those of noise and bias.
    /// `None` until passes have had a turn with each.
    pub classes: Option<[ClassError; 3]>,
}

/// The mean over the seen pixels of a square of 8 × 8 and what is known of its error. Luminance, W/m²/sr.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TileError {
    /// Pixels that see something reflect.
    pub pixels: u32,
    /// Reflected luminance.
    pub mean: f64,
    /// Standard deviation of the mean.
    pub noise: f64,
    /// What bias added to the mean, as estimated: to be subtracted.
    pub bias: f64,
    /// Standard deviation of `bias`; independent of the noise of the mean.
    pub bias_noise: f64,
    /// Standard deviation of what eye samples see of light that is narrower than discs: each lies within it or beside it by chance.
    pub focus: f64,
    /// Of those pixels, how many have found no light: unknown, not dark.
    pub unknown: u32,
}

impl ErrorEstimate {
    /// Whether the upper end goes by light that is narrower than discs (foci, beams) rather than by edges: then a few bright pixels
    /// may hold most of the error, and how much is uncertain.
    #[must_use]
    pub fn is_of_narrow_light(&self) -> bool {
        self.focus > self.bias / SEEN_AT_EDGES && self.focus > 0.5 * self.total
    }
}

impl TileError {
    /// A bound of the tile's error that `z` standard deviations of noise belong to: √max(0, B² − Var B) + z √(σ² + F²), F what
    /// samples see of narrow light. It holds for tiles that are not unknown.
    #[must_use]
    pub fn bound(&self, z: f64) -> f64 {
        let bias2 = self.bias * self.bias - self.bias_noise * self.bias_noise;
        bias2.max(0.0).sqrt() + z * self.noise.hypot(self.focus)
    }

    /// Whether most of it has found no light, so that nothing can be said of its error.
    #[must_use]
    pub const fn is_unknown(&self) -> bool {
        2 * self.unknown > self.pixels
    }
}

/// Sums over pixels.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    /// Pixels that see something reflect.
    pub(super) seen: f64,
    /// Luminance.
    pub(super) light: f64,
    /// Variances of it.
    pub(super) variance: f64,
    /// B² − Var B.
    pub(super) bias2: f64,
    /// Var B.
    pub(super) bias_variance: f64,
    /// Squares of what discs may hide.
    pub(super) focus2: f64,
    /// Their variance.
    pub(super) focus_variance: f64,
    /// Squared deviations of the last pass from the mean.
    pub(super) deviation: f64,
    /// Pixels without light.
    pub(super) unknown: f64,
    /// Squares of what a photon would bring there.
    pub(super) unknown2: f64,
    /// What the pass found of one class.
    pub(super) answer: f64,
    /// Of direct light by shadow rays: all pixels' noise, its variance, and pixels of tiles that do not know any.
    pub(super) direct: Noise,
    pub(super) direct_variance: f64,
    pub(super) direct_unknown: f64,
}

impl Sums {
    pub(super) fn plus(self, o: Self) -> Self {
        Self {
            seen: self.seen + o.seen,
            light: self.light + o.light,
            variance: self.variance + o.variance,
            bias2: self.bias2 + o.bias2,
            bias_variance: self.bias_variance + o.bias_variance,
            focus2: self.focus2 + o.focus2,
            focus_variance: self.focus_variance + o.focus_variance,
            deviation: self.deviation + o.deviation,
            unknown: self.unknown + o.unknown,
            unknown2: self.unknown2 + o.unknown2,
            answer: self.answer + o.answer,
            direct: self.direct.plus(o.direct),
            direct_variance: self.direct_variance + o.direct_variance,
            direct_unknown: self.direct_unknown + o.direct_unknown,
        }
    }

    /// Takes a tile's direct light by shadow rays.
    pub(super) fn add_direct(&mut self, tile: &Noise) {
        self.direct = self.direct.plus(*tile);
        if tile.known() > 0.0 {
            self.direct_variance += tile.sum(0.0);
        } else {
            self.direct_unknown += tile.sum(1.0);
        }
    }

    /// The variance of direct light by shadow rays, once all tiles are in.
    pub(super) fn close_direct(&mut self) {
        self.direct_variance += self.direct_unknown * self.direct.per_visit(0.0);
        self.direct_unknown = 0.0;
    }

    /// The figure; `None` while there are too few passes, or no light, to say anything.
    ///
    /// The mean over pixels of σ² is unbiased whether or not they share photons; how far it can be trusted is not, and follows
    /// from how much whole passes scatter. B̂ is as noisy as √3 σ, so its own variance is taken off its square before anything
    /// else is done. With K = 2/ρ² independent parts, the realised mean of (b + ε)² has variance ρ²(σ⁴ + 2 b² σ²).
    ///
    /// `concentration` is one over the number of independent estimates that σ² is a mean of.
    pub(super) fn estimate(
        &self,
        weights: &Weights,
        scatter: &Scatter,
        concentration: f64,
    ) -> Option<ErrorEstimate> {
        // Where shadow rays bring all light, photons do not scatter.
        let rho2 = if scatter.is_at_rest() { 0.0 } else { scatter.relative_variance()? };
        let mean = self.light / self.seen;
        if self.seen == 0.0 || mean <= 0.0 {
            return None;
        }
        let relative = |sum: f64| sum / self.seen / (mean * mean);
        let (photons2, unknown2) = (relative(self.variance), relative(self.unknown2));
        let direct2 = relative(self.direct_variance);
        let noise2 = photons2 + direct2;
        let (bias2, bias_variance) = (relative(self.bias2).max(0.0), relative(self.bias_variance));
        let of_noise = (1.0 + concentration) * photons2 * photons2 + 2.0 * bias2 * noise2;
        // Pixels' direct light is independent.
        let of_direct = OF_DIRECT / self.direct.known().max(1.0) * direct2 * direct2;
        let of_bias = bias_variance * bias_variance + 2.0 * bias2 * bias_variance;
        let effective_passes = 1.0 / weights.concentration();
        let of_focus = relative(self.focus_variance) / (self.seen * mean * mean);
        let sigma = (rho2 * (of_noise + of_bias) + of_focus + of_direct).sqrt();
        // Student's t in place of the normal's quantile, to first order.
        let t = Z_90 * (1.0 + (Z_90 * Z_90 + 1.0) / (4.0 * (effective_passes - 1.0).max(1.0)));
        let total2 = noise2 + unknown2 + bias2;
        // An upper bound of bias: that of edges, or that of light which is concentrated as the photons in the discs are.
        let focus2 = relative(self.focus2);
        let max_bias2 = (SEEN_AT_EDGES.powi(-2) * bias2).max(focus2);
        Some(ErrorEstimate {
            total: total2.sqrt(),
            noise: (noise2 + unknown2).sqrt(),
            bias: bias2.sqrt(),
            low: (total2 - t * sigma).max(0.0).sqrt(),
            high: (total2 - bias2 + max_bias2 + t * sigma).sqrt(),
            focus: focus2.sqrt(),
            unknown_share: self.unknown / self.seen,
            effective_passes,
            mean_luminance: mean,
            classes: None,
        })
    }
}
