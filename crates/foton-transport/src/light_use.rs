//! What each emitter's photons are good for: how many start there, and how many come near anything that is seen.

use std::ops::AddAssign;

/// An emitter with at least this share of the photons deserves a warning.
const LARGE_SHARE: f64 = 0.1;
/// It is starved when less than this share of its photons is stored anywhere.
const FEW: f64 = 0.01;
/// Fewer photons than this prove nothing.
const ENOUGH: u64 = 10_000;

/// Photons of one emitter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LightUse {
    /// Emitted.
    pub emitted: u64,
    /// Of those, stored at least once: where a hit point's disc may find them.
    pub reached: u64,
    /// Of those, dropped at once: their power was NaN or infinite.
    pub dropped: u64,
}

impl LightUse {
    /// Counts a photon.
    pub fn count(&mut self, reached: bool) {
        self.emitted += 1;
        self.reached += u64::from(reached);
    }

    /// The share of its photons that came near anything that is seen; 0 without photons.
    #[must_use]
    pub fn hit_rate(&self) -> f64 {
        self.reached as f64 / (self.emitted as f64).max(1.0)
    }

    /// Whether it takes a large share of `photons` and almost none of them come near anything that is seen.
    #[must_use]
    pub fn is_starved(&self, photons: u64) -> bool {
        photons >= ENOUGH && self.emitted as f64 >= LARGE_SHARE * photons as f64 && self.hit_rate() < FEW
    }
}

impl AddAssign for LightUse {
    fn add_assign(&mut self, other: Self) {
        self.emitted += other.emitted;
        self.reached += other.reached;
        self.dropped += other.dropped;
    }
}
