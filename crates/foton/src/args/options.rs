//! Options that several commands share.

use std::num::NonZeroU32;

use clap::Args as ClapArgs;
use foton_integrator::{Alpha, RadiusFloor, RenderSettings};

use super::parse::{alpha, define, radius, radius_floor, with_default};
use super::values::{Direct, Guide, Radius, Rule, Size};

/// The word for all sensors; a sensor of that name comes first.
pub(crate) const ALL_SENSORS: &str = "all";

// The structs have no doc comments: clap would take them for descriptions of the commands.

// How a scene file is read.
#[derive(Clone, Debug, Default, ClapArgs)]
pub(crate) struct ReadOptions {
    /// Set a parameter of the scene file
    #[arg(short = 'D', value_name = "name=value", value_parser = define, requires = "scene")]
    pub(crate) defines: Vec<(String, String)>,
    /// Open a scene without the files that are not there: meshes are left out, textures are magenta
    #[arg(long)]
    pub(crate) allow_missing: bool,
}

// What a scene file is read with, and the sensor.
#[derive(Debug, ClapArgs)]
pub(crate) struct SceneOptions {
    /// The sensor to look through, by its id [default: the first]. `foton render` takes `all`: every sensor in one go, with photons
    /// that all of them share, as OUT-NAME.exr
    #[arg(long, value_name = "NAME")]
    pub(crate) sensor: Option<String>,
    #[command(flatten)]
    pub(crate) read: ReadOptions,
}

// Settings of a render; of a sweep, those at the centre of its star.
#[derive(Debug, ClapArgs)]
pub(crate) struct SettingsOptions {
    #[arg(long, value_name = "N", help = with_default(
        "Photons per pass: fewer show a result sooner, more cost less per photon [default: from the scene, else ",
        RenderSettings::default().ppm.photons_per_pass,
    ))]
    pub(crate) photons: Option<NonZeroU32>,
    #[arg(long, value_name = "A", value_parser = alpha, help = with_default(
        "Fraction of new photons retained, in (0, 1]: smaller values shrink radii faster (less bias, more noise) [default: from the \
         scene, else ",
        RenderSettings::default().ppm.alpha,
    ))]
    pub(crate) alpha: Option<Alpha>,
    /// First radius: in world units, or x0.5 for half the default, which follows the pixel footprint
    #[arg(long, value_name = "R|xF", value_parser = radius)]
    pub(crate) radius: Option<Radius>,
    /// How radii shrink
    #[arg(long, value_name = "RULE", value_enum, default_value_t = RenderSettings::default().ppm.radius_rule.into())]
    pub(crate) radius_rule: Rule,
    /// Smallest radius, in spacings of the eye samples; narrower light may fall between them. 0: no limit
    #[arg(long, value_name = "N", value_parser = radius_floor, default_value_t = RenderSettings::default().ppm.radius_floor)]
    pub(crate) radius_floor: RadiusFloor,
    /// Seed of all random numbers
    #[arg(long, value_name = "N", default_value_t = RenderSettings::default().seed)]
    pub(crate) seed: u64,
    /// Seed of the photons alone: other noise over the same eye samples [default: as --seed]
    #[arg(long, value_name = "N")]
    pub(crate) photon_seed: Option<u64>,
    /// Threads [default: as many as the machine has]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Size of the whole image; a crop window is scaled with it [default: from the scene]
    #[arg(long, value_name = "WxH")]
    pub(crate) size: Option<Size>,
    /// Eye samples per pixel: of the whole render by ppm, of each pass by other methods [default: 4, or 1 in each pass]
    #[arg(long, value_name = "N")]
    pub(crate) spp: Option<NonZeroU32>,
    /// Longest path in edges, as Mitsuba counts them. 1: directly visible emitters only; 2: one bounce [default: from the scene]
    #[arg(long, value_name = "N")]
    pub(crate) max_depth: Option<u32>,
    /// How light straight from emitters is estimated
    #[arg(long, value_name = "HOW", value_enum, default_value_t = Direct::Auto)]
    pub(crate) direct: Direct,
    /// Whether photons start where those of earlier passes were worth their cost
    #[arg(long, value_name = "WHEN", value_enum, default_value_t = Guide::Auto)]
    pub(crate) guide: Guide,
}
