//! The arguments of `foton measure`.

use std::num::NonZeroU32;
use std::path::PathBuf;
use std::time::Duration;

use clap::Args as ClapArgs;
use foton_integrator::{Alpha, RadiusFloor, RenderSettings};

use super::parse::{alpha, define, duration, exr, name, radius, radius_floor};
use super::values::{Direct, Radius, Rule, Size};

/// `foton measure`.
#[derive(Debug, ClapArgs)]
pub(crate) struct Measure {
    /// Scene file to read: Mitsuba XML, OBJ, PLY or STL
    pub(crate) scene: PathBuf,
    /// Folder for tables and page; a sweep that is there goes on
    #[arg(short, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Image of radiance to compare with, .exr [a long run of the sweep's own, of the same eye samples]
    #[arg(long, value_name = "REF.exr", value_parser = name(exr))]
    pub(crate) reference: Option<PathBuf>,
    /// Time for all of it, e.g. 90s, 10m, 1.5h
    #[arg(long, value_name = "TIME", default_value = "10m", value_parser = duration)]
    pub(crate) budget: Duration,
    /// Runs of each configuration, with photons of their own
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u64).range(2..=1000))]
    pub(crate) seeds: u64,
    /// Photons a pass at the star's centre [as the scene says, else that of `render`]
    #[arg(long, value_name = "N")]
    pub(crate) photons: Option<NonZeroU32>,
    /// Share of new photons kept at the star's centre [as the scene says, else that of `render`]
    #[arg(long, value_name = "A", value_parser = alpha)]
    pub(crate) alpha: Option<Alpha>,
    /// First radius at the star's centre: in world units, or x0.5 for half of what the pixel's footprint gives
    #[arg(long, value_name = "R|xF", value_parser = radius)]
    pub(crate) radius: Option<Radius>,
    /// Smallest radius in spacings of the eye samples; 0 for none
    #[arg(long, value_name = "N", value_parser = radius_floor, default_value_t = RenderSettings::default().ppm.radius_floor)]
    pub(crate) radius_floor: RadiusFloor,
    /// How radii shrink at the star's centre
    #[arg(long, value_name = "RULE", value_enum, default_value_t = RenderSettings::default().ppm.radius_rule.into())]
    pub(crate) radius_rule: Rule,
    /// How light straight from emitters is estimated at the star's centre
    #[arg(long, value_name = "HOW", value_enum, default_value_t = Direct::Photons)]
    pub(crate) direct: Direct,
    /// Seed of the eye samples; runs have photons of the seeds after it
    #[arg(long, value_name = "N", default_value_t = RenderSettings::default().seed)]
    pub(crate) seed: u64,
    /// Threads [as many as the machine has]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Size of the whole image; small ones tell as much, sooner [as the scene says]
    #[arg(long, value_name = "WxH")]
    pub(crate) size: Option<Size>,
    /// Eye samples a pixel
    #[arg(long, value_name = "N", default_value_t = RenderSettings::default().samples_per_pixel)]
    pub(crate) spp: NonZeroU32,
    /// Longest path in edges, as Mitsuba counts them [as the scene says]
    #[arg(long, value_name = "N")]
    pub(crate) max_depth: Option<u32>,
    /// The sensor to look through, by its id [the first]
    #[arg(long, value_name = "NAME")]
    pub(crate) sensor: Option<String>,
    /// Set a parameter of the scene file
    #[arg(short = 'D', value_name = "name=value", value_parser = define)]
    pub(crate) defines: Vec<(String, String)>,
    /// Print one JSON object a line on stdout
    #[arg(long)]
    pub(crate) json: bool,
}
