//! The arguments of `foton measure`.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args as ClapArgs;

use super::options::{SceneOptions, SettingsOptions};
use super::parse::{duration, exr, name};

/// `foton measure`.
#[derive(Debug, ClapArgs)]
#[command(mut_arg("seed", |seed| seed.help("Seed of the eye samples; the runs' photons use the seeds after it")))]
pub(crate) struct Measure {
    /// Scene file to read: Mitsuba XML, pbrt, glTF, OBJ, PLY, STL or OFF
    pub(crate) scene: PathBuf,
    /// Output folder for tables and a page; an unfinished sweep there is continued
    #[arg(short, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Image of radiance to compare with, .exr [default: a long render with the same eye samples]
    #[arg(long, value_name = "REF.exr", value_parser = name(exr))]
    pub(crate) reference: Option<PathBuf>,
    /// Time for all of it, e.g. 90s, 10m, 1.5h
    #[arg(long, value_name = "TIME", default_value = "10m", value_parser = duration)]
    pub(crate) budget: Duration,
    /// Independent runs per configuration, each with its own seed
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u64).range(2..=1000))]
    pub(crate) seeds: u64,
    #[command(flatten, next_help_heading = "Baseline settings")]
    pub(crate) settings: SettingsOptions,
    #[command(flatten)]
    pub(crate) scene_options: SceneOptions,
    /// Print one JSON object a line on stdout
    #[arg(long)]
    pub(crate) json: bool,
}
