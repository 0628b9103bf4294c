//! Settings for a purpose, as `foton measure` found them: docs/measure.md has the figures.

use std::num::NonZeroU32;

use foton_integrator::{RadiusScale, Settings};

/// What an image is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preset {
    /// Something to look at within seconds: large discs hide noise, at the price of sharp edges.
    Preview,
    /// The defaults.
    Balanced,
    /// Minutes and more: small discs from the beginning, since there will be photons enough.
    Final,
}

impl Preset {
    /// `settings` with what the preset says of photons and radii.
    #[must_use]
    pub fn apply(self, settings: Settings) -> Settings {
        let (power, scale) = match self {
            Self::Preview => (16, 2.0),
            Self::Balanced => return settings,
            Self::Final => (20, 0.5),
        };
        Settings {
            photons_per_pass: NonZeroU32::new(1 << power).unwrap_or(settings.photons_per_pass),
            radius_scale: RadiusScale::new(scale).unwrap_or_default(),
            ..settings
        }
    }
}
