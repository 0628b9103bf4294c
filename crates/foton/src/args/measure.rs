//! The arguments of `foton measure`.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args as ClapArgs;

use super::options::{SceneOptions, SettingsOptions};
use super::parse::{duration, exr, name};

/// `foton measure`.
#[derive(Debug, ClapArgs)]
#[command(mut_arg("seed", |seed| seed.help("Seed of the eye samples; runs have photons of the seeds after it")))]
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
    #[command(flatten, next_help_heading = "Settings at the star's centre")]
    pub(crate) settings: SettingsOptions,
    #[command(flatten)]
    pub(crate) scene_options: SceneOptions,
    /// Print one JSON object a line on stdout
    #[arg(long)]
    pub(crate) json: bool,
}
