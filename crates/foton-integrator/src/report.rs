//! What the start of a render and its passes report.

/// What the start of a render found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Start {
    /// Hit points.
    pub hit_points: u64,
    /// Eye rays traced.
    pub eye_rays: u64,
    /// Eye paths given up because their weight or light was not a finite number.
    pub dropped: u64,
}

/// What one pass did, and how things stand after it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PassReport {
    /// Passes so far.
    pub pass: u64,
    /// Photons emitted so far.
    pub photons: u64,
    /// Photons emitted in this pass.
    pub photons_in_pass: u64,
    /// Photons stored in this pass.
    pub stored: u64,
    /// Rays traced in this pass, shadow rays included.
    pub rays: u64,
    /// Photon–packet tests in this pass.
    pub candidates: u64,
    /// Photon–hit-point pairs that counted in this pass.
    pub accepted: u64,
    /// Share of hit points that have found no photon in any pass: unknown, not dark.
    pub no_photon_share: f64,
    /// Hit points whose radius is at the smallest that coordinates resolve.
    pub floored: u64,
}
