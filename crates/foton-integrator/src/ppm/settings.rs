//! The settings of progressive photon mapping. Values that make no sense cannot be made.

use std::fmt;
use std::num::NonZeroU32;

/// The fraction of each pass's new photons that a hit point retains, in (0, 1]: a small one shrinks radii fast (less bias, more
/// noise), and 1 never shrinks them.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Alpha(f64);

impl Alpha {
    /// `None` unless `0 < alpha ≤ 1`.
    #[must_use]
    pub fn new(alpha: f64) -> Option<Self> {
        (alpha > 0.0 && alpha <= 1.0).then_some(Self(alpha))
    }

    /// The value.
    #[must_use]
    pub const fn get(self) -> f64 {
        self.0
    }
}

impl Default for Alpha {
    /// 2/3: noise and bias then fall at the same rate, and the best initial radius does not depend on the number of passes
    /// `[KD13]`.
    fn default() -> Self {
        Self(2.0 / 3.0)
    }
}

impl fmt::Display for Alpha {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// How light that comes straight from an emitter is estimated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DirectLight {
    /// By shadow rays, unless a pilot finds that most of them would be in vain.
    #[default]
    Auto,
    /// By photons, like all other light.
    Photons,
    /// By shadow rays from hit points, about a quarter of each pass; shadow edges are then sharp from the first pass on.
    ShadowRays,
}

impl DirectLight {
    /// All ways.
    pub const ALL: [Self; 3] = [Self::Auto, Self::Photons, Self::ShadowRays];

    /// The name in files and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Photons => "photons",
            Self::ShadowRays => "shadow-rays",
        }
    }

    /// The way of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|way| way.name() == name)
    }
}

/// A factor on first radii, above zero.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct RadiusScale(f64);

impl RadiusScale {
    /// `None` unless above zero and finite.
    #[must_use]
    pub fn new(scale: f64) -> Option<Self> {
        (scale > 0.0 && scale.is_finite()).then_some(Self(scale))
    }

    /// The value.
    #[must_use]
    pub const fn get(self) -> f64 {
        self.0
    }
}

impl Default for RadiusScale {
    fn default() -> Self {
        Self(1.0)
    }
}

impl fmt::Display for RadiusScale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// The smallest radius in spacings of the eye samples; 0 for none.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct RadiusFloor(f64);

impl RadiusFloor {
    /// Radii may shrink as far as coordinates resolve.
    pub const NONE: Self = Self(0.0);

    /// `None` unless zero or more, and finite.
    #[must_use]
    pub fn new(spacings: f64) -> Option<Self> {
        (spacings >= 0.0 && spacings.is_finite()).then_some(Self(spacings))
    }

    /// The value.
    #[must_use]
    pub const fn get(self) -> f64 {
        self.0
    }
}

impl Default for RadiusFloor {
    fn default() -> Self {
        Self(1.0)
    }
}

impl fmt::Display for RadiusFloor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// How radii shrink.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RadiusRule {
    /// Each by the photons that its own hit point finds: fast where there is light `[PPM08]`.
    Local,
    /// All by one factor that the photons emitted alone decide: r² ∝ Γ(n+α)/(Γ(1+α) Γ(n+1)) after n equal passes `[KZ11]`.
    Global,
    /// Each by the photons that its own hit point finds, and only as far as bias outweighs noise there; after `[KD13]`. Costs 64 bytes a
    /// hit point and some time.
    #[default]
    Adaptive,
}

impl RadiusRule {
    /// All rules.
    pub const ALL: [Self; 3] = [Self::Local, Self::Global, Self::Adaptive];

    /// The name in files and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Local => "local",
            Self::Global => "global",
            Self::Adaptive => "adaptive",
        }
    }

    /// The rule of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|rule| rule.name() == name)
    }

    /// The factor that all r² take after a pass of `photons` that follows `emitted` others; `None` where each has its own.
    ///
    /// `[KZ11]` has r²ᵢ₊₁/r²ᵢ = (i + α)/(i + 1) after pass i. Counted in photons, so that passes may differ:
    /// 1 − (1−α) n/(E + n) with E photons up to and with this pass of n.
    pub(crate) fn common(self, alpha: Alpha, emitted: u64, photons: u64) -> Option<f64> {
        let (n, total) = (photons as f64, (emitted + photons) as f64);
        (self == Self::Global).then(|| 1.0 - (1.0 - alpha.get()) * n / (total + n))
    }
}

/// How photons are emitted and gathered, and how radii shrink.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PpmSettings {
    /// How fast radii shrink. May change between passes.
    pub alpha: Alpha,
    /// Photons emitted in a pass, once passes have grown. May change between passes.
    pub photons_per_pass: NonZeroU32,
    /// Photons emitted in the first pass, for an early picture: passes double from there to `photons_per_pass`. A render begins with fewer
    /// where discs are so wide that each photon meets very many.
    pub first_pass: NonZeroU32,
    /// First radius of every hit point in world units; `None`: from the pixel's footprint.
    pub radius: Option<f64>,
    /// Factor on the first radius, whichever it is.
    pub radius_scale: RadiusScale,
    /// How far radii shrink: eye samples are frozen, and narrower light would fall between discs that are smaller than their spacing.
    pub radius_floor: RadiusFloor,
    /// How radii shrink.
    pub radius_rule: RadiusRule,
    /// How direct light is estimated.
    pub direct_light: DirectLight,
    /// Whether photons start where those of earlier passes were worth their cost, in scenes where that can pay.
    pub guided: bool,
    /// Hit points that one eye sample may make by splitting at glass.
    pub hit_points_per_sample: NonZeroU32,
}

impl Default for PpmSettings {
    fn default() -> Self {
        let number = |n| NonZeroU32::new(n).unwrap_or(NonZeroU32::MIN);
        Self {
            alpha: Alpha::default(),
            photons_per_pass: number(1 << 18),
            first_pass: number(1 << 14),
            radius: None,
            radius_scale: RadiusScale::default(),
            radius_floor: RadiusFloor::default(),
            radius_rule: RadiusRule::default(),
            direct_light: DirectLight::default(),
            guided: true,
            hit_points_per_sample: number(8),
        }
    }
}

impl PpmSettings {
    /// Photons that the pass after `passes` others emits.
    #[must_use]
    pub fn photons_after(&self, passes: u64) -> NonZeroU32 {
        let doublings = u32::try_from(passes).unwrap_or(u32::MAX);
        let grown = 2u32.saturating_pow(doublings).saturating_mul(self.first_pass.get());
        NonZeroU32::new(grown).map_or(self.photons_per_pass, |grown| grown.min(self.photons_per_pass))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_double_up_to_the_photons_asked_for() {
        let number = |n| NonZeroU32::new(n).expect("above zero");
        let settings =
            PpmSettings { photons_per_pass: number(100), first_pass: number(15), ..PpmSettings::default() };
        let photons: Vec<u32> = (0..5).map(|pass| settings.photons_after(pass).get()).collect();
        assert_eq!(photons, [15, 30, 60, 100, 100]);
        assert_eq!(settings.photons_after(1 << 40).get(), 100);
        let small = PpmSettings { photons_per_pass: number(7), ..settings };
        assert_eq!(small.photons_after(0).get(), 7, "never more than asked for");
    }

    #[test]
    fn common_factors_multiply_to_their_gamma_formula() {
        // Γ(n+α)/(Γ(1+α) Γ(n+1)) for n = 1000 by its own recurrence, and passes of twice the photons count twice.
        let alpha = Alpha::new(0.7).expect("in range");
        let product = |sizes: &[u64]| {
            let mut emitted = 0;
            sizes.iter().fold(1.0, |r2, &n| {
                let factor = RadiusRule::Global.common(alpha, emitted, n).expect("common");
                emitted += n;
                r2 * factor
            })
        };
        let expected: f64 = (1..1000).map(|i| (f64::from(i) + 0.7) / (f64::from(i) + 1.0)).product();
        assert!((product(&[5; 999]) / expected - 1.0).abs() < 1e-12);
        assert!((product(&[10; 500]) / product(&[5; 1000]) / 2f64.powf(0.3) - 1.0).abs() < 1e-2);
        assert_eq!(RadiusRule::Local.common(alpha, 1, 1), None);
    }

    #[test]
    fn alpha_is_in_the_half_open_unit_interval() {
        for bad in [0.0, -0.5, 1.0 + 1e-9, f64::NAN, f64::INFINITY] {
            assert_eq!(Alpha::new(bad), None, "{bad}");
        }
        assert!(Alpha::new(1e-3).is_some() && Alpha::new(1.0).is_some());
    }
}
