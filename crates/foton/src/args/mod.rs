//! The command line. Its words are stable: scripts rely on them.

mod measure;
mod options;
mod parse;
mod photon_map;
mod render;
#[cfg(test)]
mod tests;
mod together;
mod values;

use std::path::PathBuf;

use clap::{Args as ClapArgs, Parser, Subcommand};
use foton_scene::description::Crop;
use foton_session::snapshot::Format;

pub(crate) use measure::Measure;
use options::SceneOptions;
pub(crate) use options::{ALL_SENSORS, ReadOptions, SettingsOptions};
use parse::{bytes, image, name, region, xml};
pub(crate) use render::RenderArgs;
pub(crate) use values::{ErrorWish, Every, Guide, Radius, Size};

/// Progressive photon mapping renderer with a live window.
#[derive(Debug, Parser)]
#[command(version, args_conflicts_with_subcommands = true)]
pub(crate) struct Args {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
    /// Scene to open in the window: Mitsuba XML, pbrt, glTF, OBJ, PLY, STL or OFF; without one, the scene that ships with foton. Where there can
    /// be no window, it is rendered for a minute
    pub(crate) scene: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) read: ReadOptions,
    /// Write a line of JSON for each frame that the window draws
    #[arg(long, value_name = "FILE")]
    pub(crate) frame_log: Option<PathBuf>,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render a scene to an image file
    Render(Box<RenderArgs>),
    /// Write any readable scene as Mitsuba 3 XML with PLY meshes
    Convert(Convert),
    /// Show what a scene contains, which features it enables, and what a render needs
    Info(Info),
    /// Compare an image with a reference: RMSE, relMSE, means, FLIP
    Compare(Compare),
    /// Measure what accuracy costs in a scene: sweeps over α, photons, radii and direct light, as tables and a page
    Measure(Box<Measure>),
}

/// `foton compare`.
#[derive(Debug, ClapArgs)]
pub(crate) struct Compare {
    /// Image to judge, .exr or .png
    #[arg(value_parser = name(image))]
    pub(crate) a: (PathBuf, Format),
    /// Its reference, .exr or .png
    #[arg(value_parser = name(image))]
    pub(crate) b: (PathBuf, Format),
    /// Picture of where they differ, .png (relative error as colours) or .exr (the numbers)
    #[arg(short, value_name = "DIFF.{exr,png}", value_parser = name(image))]
    pub(crate) output: Option<(PathBuf, Format)>,
    /// Print one JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
}

/// `foton convert`.
#[derive(Debug, ClapArgs)]
pub(crate) struct Convert {
    /// Scene file to read: Mitsuba XML, pbrt, glTF, OBJ, PLY, STL or OFF
    pub(crate) scene: PathBuf,
    /// Scene file to write; meshes and textures go into folders beside it
    #[arg(value_name = "OUT.xml", value_parser = name(xml))]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) read: ReadOptions,
}

/// `foton info`.
#[derive(Debug, ClapArgs)]
pub(crate) struct Info {
    /// Scene file: Mitsuba XML, pbrt, glTF, OBJ, PLY, STL or OFF
    pub(crate) scene: PathBuf,
    #[command(flatten)]
    pub(crate) scene_options: SceneOptions,
    /// Estimate a render of a part of the image
    #[arg(long, value_name = "X,Y,W,H", value_parser = region)]
    pub(crate) region: Option<Crop>,
    /// Refuse to read or build beyond this much memory, e.g. 800M, 8G [80 % of what is free]
    #[arg(long, value_name = "SIZE", value_parser = bytes)]
    pub(crate) memory: Option<u64>,
    /// Print one JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
}
