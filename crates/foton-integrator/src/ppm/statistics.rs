//! The progressive update of one hit point: its radius shrinks so that the density of photons is preserved.
//!
//! In the running-mean form of `[PPM08]`: with M photons in the disc of this pass, N' = N + αM and r'² = ρ r² with
//! ρ = (N + αM)/(N + M). Light is summed as Φ/(π r²) with the radius of its own pass and needs no correction afterwards, so
//! α may change between passes without rescaling the past. N is double precision: in single precision it stalls at 2²⁴ and
//! radii freeze in silence.

use foton_transport::codec::{Reader, StateError, Writer};

use super::settings::Alpha;

/// The photon statistics of a hit point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Statistics {
    /// N = Σ αⱼ Mⱼ.
    accumulated: f64,
    /// r² in square scene units.
    radius2: f64,
    /// Σ Mⱼ.
    found: u64,
}

impl Statistics {
    /// A slot without a hit point.
    pub(crate) const EMPTY_SLOT: Self = Self { accumulated: 0.0, radius2: -1.0, found: 0 };

    /// A hit point without photons. `radius2` in square scene units.
    #[must_use]
    pub const fn new(radius2: f32) -> Self {
        Self { accumulated: 0.0, radius2: radius2 as f64, found: 0 }
    }

    /// Of a hit point that has gathered in one pass alone, with what its pixel knows.
    pub(crate) const fn of_display(radius2: f64, found: u64) -> Self {
        Self::of(0.0, radius2, found)
    }

    /// What [`Statistics::accumulated`] and the others have told.
    pub(crate) const fn of(accumulated: f64, radius2: f64, found: u64) -> Self {
        Self { accumulated, radius2, found }
    }

    /// N.
    pub(crate) const fn accumulated(&self) -> f64 {
        self.accumulated
    }

    /// r² in square scene units.
    #[must_use]
    pub const fn radius2(&self) -> f64 {
        self.radius2
    }

    /// Photons found in all passes.
    #[must_use]
    pub const fn photons_found(&self) -> u64 {
        self.found
    }

    /// Whether no pass has found a photon: what arrives here is unknown, not zero.
    #[must_use]
    pub const fn is_unknown(&self) -> bool {
        self.found == 0
    }

    pub(crate) fn write(&self, out: &mut Writer) {
        out.f64(self.accumulated);
        out.f64(self.radius2);
        out.u64(self.found);
    }

    pub(crate) fn read(input: &mut Reader<'_>) -> Result<Self, StateError> {
        Ok(Self { accumulated: input.finite()?, radius2: input.finite()?, found: input.count()? })
    }

    /// Takes a pass into account that found `photons` within the radius. `smallest2` bounds r² from below; returns whether it
    /// did. A pass that finds nothing changes nothing.
    pub fn refine(&mut self, photons: u64, alpha: Alpha, smallest2: f64) -> bool {
        if photons == 0 {
            return false;
        }
        let (n, m, alpha) = (self.accumulated, photons as f64, alpha.get());
        // 1 − (1−α)M/(N+M) loses no digits when N is far larger than M; (N+αM)/(N+M) would not.
        let rho = if n == 0.0 { alpha } else { 1.0 - (1.0 - alpha) * m / (n + m) };
        self.accumulated = n + alpha * m;
        self.shrink(photons, rho, smallest2)
    }

    /// Counts photons and multiplies r² by `rho`; `smallest2` bounds it from below; returns whether it did.
    pub(crate) fn shrink(&mut self, photons: u64, rho: f64, smallest2: f64) -> bool {
        self.found += photons;
        let shrunk = self.radius2 * rho;
        let floored = shrunk < smallest2;
        self.radius2 = if floored { smallest2.min(self.radius2) } else { shrunk };
        floored
    }
}

#[cfg(test)]
mod tests;
