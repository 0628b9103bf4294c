//! What decides an image beside the scene, whatever the method.

use std::fmt;
use std::num::NonZeroU32;

use foton_scene::Scene;

use crate::photon_map::PhotonMapSettings;
use crate::ppm::settings::{Alpha, PpmSettings};

/// The longest path that is traced, whatever settings say. The ledger counts what that cuts off.
const MAX_PATH_EDGES: u32 = 250;

/// How light is transported.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Progressive photon mapping: hit points once, then photon passes.
    #[default]
    Ppm,
    /// Stochastic progressive photon mapping: new hit points for each photon pass.
    Sppm,
    /// Path tracing with shadow rays.
    Path,
    /// Whitted's ray tracing: shadow rays, perfect reflection and refraction.
    Whitted,
    /// Two-pass photon mapping: maps of photons that stay, looked up by eye samples.
    PhotonMap,
}

impl Method {
    /// All methods.
    pub const ALL: [Self; 5] = [Self::Ppm, Self::Sppm, Self::Path, Self::Whitted, Self::PhotonMap];

    /// The name in files and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ppm => "ppm",
            Self::Sppm => "sppm",
            Self::Path => "path",
            Self::Whitted => "whitted",
            Self::PhotonMap => "photon-map",
        }
    }

    /// The method of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name() == name)
    }

    /// What it is called in full.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Ppm => "Progressive photon mapping",
            Self::Sppm => "Stochastic progressive photon mapping",
            Self::Path => "Path tracing",
            Self::Whitted => "Whitted ray tracing",
            Self::PhotonMap => "Photon mapping",
        }
    }

    /// Eye samples a pixel, unless someone says otherwise: of the whole render, or of each pass where passes follow eye samples of their
    /// own.
    #[must_use]
    pub const fn default_samples(self) -> NonZeroU32 {
        match self {
            Self::Ppm => NonZeroU32::new(4).unwrap(),
            Self::Sppm | Self::Path | Self::Whitted | Self::PhotonMap => NonZeroU32::MIN,
        }
    }

    /// Whether each pass follows eye samples of its own: then the image converges with them, and so does what the error means.
    #[must_use]
    pub const fn renews_eye_samples(self) -> bool {
        !matches!(self, Self::Ppm)
    }

    /// Whether passes see a scene that moves at different times.
    #[must_use]
    pub const fn blurs_motion(self) -> bool {
        self.renews_eye_samples() && !matches!(self, Self::PhotonMap)
    }

    /// Whether light that mirrors and glass throw from points and suns is missing.
    #[must_use]
    pub const fn misses_caustics_of_points(self) -> bool {
        matches!(self, Self::Path | Self::Whitted)
    }

    /// Whether it finds all light in any scene, sooner or later, without bias that stays.
    #[must_use]
    pub const fn finds_all_light(self) -> bool {
        self.has_photons()
    }

    /// Whether hit points gather photons in discs that shrink from pass to pass: then radii, α and photons a pass mean something.
    #[must_use]
    pub const fn has_discs(self) -> bool {
        matches!(self, Self::Ppm | Self::Sppm)
    }

    /// Whether passes have photons.
    #[must_use]
    pub const fn has_photons(self) -> bool {
        matches!(self, Self::Ppm | Self::Sppm)
    }
}

/// Everything that decides an image, beside the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderSettings {
    /// The method.
    pub method: Method,
    /// Eye samples a pixel: of the whole render, or of each pass where [`Method::renews_eye_samples`].
    pub samples_per_pixel: NonZeroU32,
    /// Longest path in edges, as Mitsuba counts them; `None`: what the scene says.
    pub max_depth: Option<u32>,
    /// The seed of all random streams.
    pub seed: u64,
    /// The seed of the photons' random streams and the shadow rays'; `None`: that of all. Another one gives other noise over the same eye
    /// samples.
    pub photon_seed: Option<u64>,
    /// Index of the sensor.
    pub sensor: usize,
    /// Whether direct, caustic and indirect light are summed separately beside all light, whose bits that does not change (costs 24
    /// bytes a hit point, 72 a pixel and some time).
    pub layers: bool,
    /// Whether the error is estimated pass by pass (costs 8 bytes a hit point that a pass brings light, 32 more where radii do not adapt, 72 a pixel and
    /// some time).
    pub error: bool,
    /// Of progressive photon mapping.
    pub ppm: PpmSettings,
    /// Of two-pass photon mapping.
    pub photon_map: PhotonMapSettings,
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self {
            method: Method::default(),
            samples_per_pixel: Method::default().default_samples(),
            max_depth: None,
            seed: 0,
            photon_seed: None,
            sensor: 0,
            layers: false,
            error: false,
            ppm: PpmSettings::default(),
            photon_map: PhotonMapSettings::default(),
        }
    }
}

impl RenderSettings {
    /// The longest path of a render, in edges as Mitsuba counts them: what these settings say, or else the scene, but never
    /// more than 250.
    #[must_use]
    pub fn max_depth_in(&self, scene: &Scene) -> u32 {
        self.max_depth.or(scene.max_depth()).map_or(MAX_PATH_EDGES, |d| d.min(MAX_PATH_EDGES))
    }

    /// The seed of the photons' random streams.
    #[must_use]
    pub fn photon_seed(&self) -> u64 {
        self.photon_seed.unwrap_or(self.seed)
    }

    /// What is in force of the kind that a change is of.
    pub(crate) const fn in_force(&self, change: &SettingChange) -> SettingChange {
        match change {
            SettingChange::Alpha(_) => SettingChange::Alpha(self.ppm.alpha),
            SettingChange::PhotonsPerPass(_) => SettingChange::PhotonsPerPass(self.ppm.photons_per_pass),
            SettingChange::CutPass(_) => SettingChange::CutPass(NonZeroU32::MAX),
            SettingChange::PhotonsOnce(_) => SettingChange::PhotonsOnce(NonZeroU32::MAX),
        }
    }

    /// Takes a change on.
    pub const fn change(&mut self, change: SettingChange) {
        match change {
            SettingChange::Alpha(alpha) => self.ppm.alpha = alpha,
            SettingChange::PhotonsPerPass(photons) => self.ppm.photons_per_pass = photons,
            // Of one pass, not of those after it.
            SettingChange::CutPass(_) | SettingChange::PhotonsOnce(_) => {}
        }
    }
}

/// A change of settings during a run: it takes effect at the next pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SettingChange {
    /// A new [`PpmSettings::alpha`].
    Alpha(Alpha),
    /// A new [`PpmSettings::photons_per_pass`].
    PhotonsPerPass(NonZeroU32),
    /// The next pass alone ends after that many of its batches, as one of fewer photons.
    CutPass(NonZeroU32),
    /// The next pass alone has that many photons.
    PhotonsOnce(NonZeroU32),
}

impl SettingChange {
    /// Whether both change the same setting.
    pub(crate) fn is_of_the_kind_of(&self, other: &Self) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }
}

impl fmt::Display for SettingChange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Alpha(alpha) => write!(f, "alpha={alpha}"),
            Self::PhotonsPerPass(n) => write!(f, "photons={n}"),
            Self::CutPass(batches) => write!(f, "batches={batches}"),
            Self::PhotonsOnce(n) => write!(f, "photons_once={n}"),
        }
    }
}
