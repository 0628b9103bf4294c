//! Settings that a file asks for.

/// Settings that a file asks for, by the integrators `sppm` and `ppm` of Mitsuba 0.6.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Suggested {
    /// Photons emitted in a pass (`photon_count`), at least 1.
    pub photons_per_pass: Option<u32>,
    /// First radius of the hit points in world units (`initial_radius`), above zero.
    pub radius: Option<f64>,
    /// The share of new photons that a hit point keeps (`alpha`), in (0, 1].
    pub alpha: Option<f64>,
    /// When to stop (`max_passes`), at least 1.
    pub passes: Option<u32>,
}
