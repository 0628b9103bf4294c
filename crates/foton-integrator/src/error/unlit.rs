//! What a pass need not look for again at a pixel that it brings nothing: it is as the last pass that brought something has left it.

/// Sums over the hit points of a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unlit {
    /// Squares of what discs may hide, and the variance of that: see `RadiusStatistics::focus`.
    foci: [f64; 2],
    /// Luminance per unit of power that the pixel would gain if each of its hit points without a photon found one; not a number where that
    /// is not known.
    one_photon: f64,
    /// Whether foci are as they were when they were last summed.
    has_foci: bool,
}

impl Unlit {
    /// Nothing is known.
    pub(super) const UNKNOWN: Self = Self { foci: [0.0; 2], one_photon: f64::NAN, has_foci: false };

    /// Photons have come.
    pub(super) const fn forget(&mut self) {
        (self.has_foci, self.one_photon) = (false, f64::NAN);
    }

    /// The foci, summed unless they are known.
    pub(super) fn foci(&mut self, sum: impl FnOnce() -> [f64; 2]) -> [f64; 2] {
        if !self.has_foci {
            (self.foci, self.has_foci) = (sum(), true);
        }
        self.foci
    }

    /// What one photon at each unknown hit point would bring, per unit of power; summed unless it is known and `radii_stay`.
    pub(super) fn one_photon(&mut self, radii_stay: bool, sum: impl FnOnce() -> f64) -> f64 {
        if self.one_photon.is_nan() || !radii_stay {
            self.one_photon = sum();
        }
        self.one_photon
    }
}
