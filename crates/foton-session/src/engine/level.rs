//! How much of the whole picture is rendered: little at first, so that there is soon something to see.

use std::num::NonZeroU32;

use foton_integrator::{PpmSettings, RadiusRule, RadiusScale, RenderSettings};

/// How much of the whole picture is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Level {
    /// Few pixels: eye pass and first pass take some tens of milliseconds on two cores.
    Small,
    /// More of them, where those of the whole picture are very many.
    Middle,
    /// All pixels, with the first so many of their eye samples, which the levels after it need not follow again, and smooth light.
    Samples(u32),
    /// All of it.
    Whole,
}

/// Factor on the first radius in pictures that are not the whole: smooth light after a pass or two is worth its bias. Pixels of a
/// picture of fewer are larger, and radii go by them.
const SMOOTH: f64 = 2.0;
const SMOOTHER: f64 = 4.0;

/// Each round of eye samples has this many times those before it, so that following the others is most of the time.
const GROWTH: u32 = 4;

impl Level {
    /// Pixels at most.
    pub(super) const fn pixels(self) -> u32 {
        match self {
            Self::Small => 160 * 120,
            Self::Middle => 480 * 360,
            Self::Samples(_) | Self::Whole => u32::MAX,
        }
    }

    /// Passes that are rendered before the next level, if nothing moves.
    pub(super) const fn passes(self) -> u64 {
        match self {
            Self::Small => 1,
            Self::Middle | Self::Samples(_) => 2,
            Self::Whole => u64::MAX,
        }
    }

    /// Photons of a pass at most.
    const fn photons(self) -> NonZeroU32 {
        match self {
            Self::Small => NonZeroU32::new(1 << 13).unwrap(),
            Self::Middle | Self::Samples(_) => NonZeroU32::new(1 << 16).unwrap(),
            Self::Whole => NonZeroU32::MAX,
        }
    }

    /// Factor on first radii.
    pub(super) const fn widened(self) -> f64 {
        match self {
            Self::Small | Self::Middle => SMOOTH,
            Self::Samples(_) => SMOOTHER,
            Self::Whole => 1.0,
        }
    }

    /// The level after this one, of a picture of so many pixels with so many eye samples each. Where the whole has few of them anyway, there
    /// is nothing in between.
    pub(super) fn next(self, pixels: u64, settings: &RenderSettings) -> Self {
        let (samples, middle) = (settings.samples_per_pixel.get(), u64::from(Self::Middle.pixels()));
        if settings.method.renews_eye_samples() {
            // Its passes are rounds themselves.
            return if self == Self::Small && pixels > 4 * middle { Self::Middle } else { Self::Whole };
        }
        let is_quick = pixels * u64::from(samples) <= 2 * middle;
        match self {
            Self::Small if is_quick => Self::Whole,
            Self::Small if pixels > 4 * middle => Self::Middle,
            Self::Small | Self::Middle => Self::Samples(1),
            // Half of the samples are too many to be followed by all of them.
            Self::Samples(n) if u64::from(n) * u64::from(2 * GROWTH) <= u64::from(samples) => {
                Self::Samples(n * GROWTH)
            }
            Self::Samples(_) | Self::Whole => Self::Whole,
        }
    }

    /// The settings of its passes, where those of the whole are `settings`. One or two do not tell how far radii are to adapt.
    pub(super) fn settings(self, settings: &RenderSettings) -> RenderSettings {
        if self == Self::Whole {
            return settings.clone();
        }
        let photons = self.photons();
        RenderSettings {
            error: false,
            ppm: PpmSettings {
                photons_per_pass: settings.ppm.photons_per_pass.min(photons),
                first_pass: photons,
                radius_rule: RadiusRule::Local,
                ..settings.ppm
            },
            ..settings.clone()
        }
    }

    /// The settings of a picture of fewer pixels.
    pub(super) fn settings_of_fewer_pixels(self, settings: &RenderSettings) -> RenderSettings {
        let scale = settings.ppm.radius_scale;
        let settings = self.settings(settings);
        RenderSettings {
            samples_per_pixel: NonZeroU32::MIN,
            ppm: PpmSettings {
                radius_scale: RadiusScale::new(self.widened() * scale.get()).unwrap_or(scale),
                ..settings.ppm
            },
            ..settings
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foton_integrator::Method;

    fn levels_by(method: Method, pixels: u64, samples: u32) -> Vec<Level> {
        let samples_per_pixel = NonZeroU32::new(samples).expect("not zero");
        let settings = RenderSettings { method, samples_per_pixel, ..RenderSettings::default() };
        let all = std::iter::successors(Some(Level::Small), |level| {
            (*level != Level::Whole).then(|| level.next(pixels, &settings))
        });
        all.collect()
    }

    fn levels(pixels: u64, samples: u32) -> Vec<Level> {
        levels_by(Method::Ppm, pixels, samples)
    }

    #[test]
    fn passes_that_follow_eye_samples_of_their_own_need_no_rounds() {
        use Level::{Middle, Small, Whole};
        assert_eq!(levels_by(Method::Path, 960 * 640, 4), [Small, Whole]);
        assert_eq!(levels_by(Method::Path, 1920 * 1080, 8), [Small, Middle, Whole]);
    }

    #[test]
    fn a_picture_grows_by_pixels_then_by_samples() {
        use Level::{Middle, Samples, Small, Whole};
        assert_eq!(levels(320 * 240, 4), [Small, Whole]);
        assert_eq!(levels(960 * 640, 1), [Small, Samples(1), Whole]);
        assert_eq!(levels(960 * 640, 2), [Small, Samples(1), Whole]);
        assert_eq!(levels(960 * 640, 4), [Small, Samples(1), Whole]);
        assert_eq!(levels(960 * 640, 7), [Small, Samples(1), Whole]);
        assert_eq!(levels(1920 * 1080, 8), [Small, Middle, Samples(1), Samples(4), Whole]);
        assert_eq!(levels(960 * 640, 64), [Small, Samples(1), Samples(4), Samples(16), Whole]);
        assert_eq!(levels(960 * 640, u32::MAX).len(), 18);
    }
}
