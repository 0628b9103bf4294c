//! Presets: settings for a quick preview, general use or a long render, as `foton measure` found them. docs/measure.md has the
//! figures.

use std::num::NonZeroU32;

use foton_integrator::{Alpha, PpmSettings, RenderSettings};

/// What an image is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preset {
    /// Something to look at within seconds: small passes answer sooner and cost a few per cent of error at equal time.
    Preview,
    /// The defaults.
    Balanced,
    /// Minutes and more: radii that have adapted for that long are better off with a larger α, which leaves them where they are
    /// unless bias clearly outweighs noise.
    Final,
}

impl Preset {
    /// `settings` with what the preset says.
    #[must_use]
    pub fn apply(self, settings: RenderSettings) -> RenderSettings {
        match self {
            Self::Preview => RenderSettings {
                ppm: PpmSettings {
                    photons_per_pass: NonZeroU32::new(1 << 16).unwrap_or(settings.ppm.photons_per_pass),
                    ..settings.ppm
                },
                ..settings
            },
            Self::Balanced => settings,
            Self::Final => RenderSettings {
                ppm: PpmSettings { alpha: Alpha::new(0.8).unwrap_or(settings.ppm.alpha), ..settings.ppm },
                ..settings
            },
        }
    }
}
