//! Where the emitted power went. Every event is counted where it happens; nothing is computed as a remainder.

use std::ops::AddAssign;

use foton_math::Rgb;

/// Power by its fate, summed over photons and not divided by their number; the mean of the channels, in double precision.
///
/// `emitted = absorbed + escaped + roulette + truncated + shading_normals + lost` up to rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ledger {
    /// Leaving emitters.
    pub emitted: f64,
    /// Absorbed by surfaces: what a BSDF's weight leaves out.
    pub absorbed: f64,
    /// Leaving the scene.
    pub escaped: f64,
    /// Ended by Russian roulette less what survivors gained: zero on average.
    pub roulette: f64,
    /// Still alive at the longest path length.
    pub truncated: f64,
    /// Lost less gained where interpolated normals differ from true ones, by their adjoint correction.
    pub shading_normals: f64,
    /// What of that was gained, counted apart: photons see the adjoint of a BSDF with interpolated normals, which may scatter more
    /// than arrives. Eye paths, which see the BSDF itself, never gain.
    pub shading_gain: f64,
    /// What dropped photons carried while it was still a number.
    pub lost: f64,
    /// Values that were NaN or infinite and were left out: photons, which were not traced on, and light at hit points and pixels.
    pub dropped: u64,
}

/// What went missing at a material and should not have: warnings name it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Loss {
    /// Power still alive at the longest path length, when it last met this material.
    pub truncated: f64,
    /// Photons whose power was no number after this material.
    pub dropped: u64,
}

impl AddAssign for Loss {
    fn add_assign(&mut self, o: Self) {
        self.truncated += o.truncated;
        self.dropped += o.dropped;
    }
}

impl Ledger {
    /// What is unaccounted for, as a share of what was emitted.
    #[must_use]
    pub fn imbalance(&self) -> f64 {
        let through = self.roulette + self.truncated + self.shading_normals + self.lost;
        let accounted = self.absorbed + self.escaped + through;
        if self.emitted > 0.0 { (self.emitted - accounted) / self.emitted } else { -accounted }
    }
}

impl AddAssign for Ledger {
    fn add_assign(&mut self, o: Self) {
        self.emitted += o.emitted;
        self.absorbed += o.absorbed;
        self.escaped += o.escaped;
        self.roulette += o.roulette;
        self.truncated += o.truncated;
        self.shading_normals += o.shading_normals;
        self.shading_gain += o.shading_gain;
        self.lost += o.lost;
        self.dropped += o.dropped;
    }
}

/// The mean of the channels in double precision.
pub(crate) fn energy(power: Rgb) -> f64 {
    (f64::from(power.r) + f64::from(power.g) + f64::from(power.b)) / 3.0
}

/// What of `power` a weight leaves out.
pub(crate) fn left_out(power: Rgb, weight: Rgb) -> f64 {
    let channel = |p: f32, w: f32| f64::from(p) * (1.0 - f64::from(w));
    (channel(power.r, weight.r) + channel(power.g, weight.g) + channel(power.b, weight.b)) / 3.0
}
