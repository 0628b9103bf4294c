//! The arguments of `foton render`.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args as ClapArgs;
use foton_integrator::{LayerKind, Method};
use foton_scene::description::Crop;
use foton_session::Shown;
use foton_session::snapshot::{self, Format, Look};

use super::options::{SceneOptions, SettingsOptions};
use super::parse::{bytes, duration, error_wish, exr, image, layer, name, region, stops};
use super::photon_map::PhotonMapOptions;
use super::values::{ErrorWish, Every, Integrator, PresetName, Show, ToneMapName};

/// `foton render`.
#[derive(Debug, ClapArgs)]
pub(crate) struct RenderArgs {
    /// Scene file: Mitsuba XML, pbrt, glTF, OBJ, PLY, STL or OFF
    pub(crate) scene: PathBuf,
    /// Image to write, .exr (linear radiance) or .png (tone-mapped). Symbolic links are followed, even to files that do not exist
    /// yet; input files are never overwritten
    #[arg(short, value_name = "OUT.{exr,png}", value_parser = name(image))]
    pub(crate) output: (PathBuf, Format),
    /// Stop after this many passes
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) passes: Option<u64>,
    /// Stop after this much rendering, e.g. 90s, 10m, 1.5h [without any stop rule: 60s]
    #[arg(long, value_name = "TIME", value_parser = duration)]
    pub(crate) time: Option<Duration>,
    /// Stop when the upper bound of the estimated error falls below this, e.g. 2% or 0.02 (relative RMSE for the current eye
    /// samples). `off` disables the estimate, which saves a little time
    #[arg(long, value_name = "SHARE|off", value_parser = error_wish)]
    pub(crate) error: Option<ErrorWish>,
    /// Preset for a quick preview, general use or a long render. Explicit options override it; it overrides the scene's
    /// suggestions
    #[arg(long, value_name = "NAME", value_enum)]
    pub(crate) preset: Option<PresetName>,
    #[command(flatten)]
    pub(crate) settings: SettingsOptions,
    /// Light transport method
    #[arg(long, value_name = "NAME", value_enum, default_value_t = Integrator::ProgressivePhotonMapping)]
    pub(crate) integrator: Integrator,
    /// With --integrator all, the image that the others are compared with [default: the one with the smallest estimated error]
    #[arg(long, value_name = "REF.exr", value_parser = name(exr))]
    pub(crate) reference: Option<PathBuf>,
    #[command(flatten, next_help_heading = "Two-pass photon mapping (--integrator photon-map)")]
    pub(crate) photon_map: PhotonMapOptions,
    #[command(flatten, next_help_heading = "Options")]
    pub(crate) scene_options: SceneOptions,
    /// Render only a part of the image: W x H pixels from column X and row Y of the whole, in place of a crop window of the scene.
    /// The image has that size. Photons and radii go by what is seen in it, so its pixels are those of the whole image only up
    /// to noise; the same region has the same bits every time
    #[arg(long, value_name = "X,Y,W,H", value_parser = region)]
    pub(crate) region: Option<Crop>,
    /// Refuse to start beyond this much memory, e.g. 800M, 8G [80 % of what is free]
    #[arg(long, value_name = "SIZE", value_parser = bytes)]
    pub(crate) memory: Option<u64>,
    /// Also write OUT-000016.exr and so on, at powers of two or every N passes
    #[arg(long, value_name = "pow2|N")]
    pub(crate) every: Option<Every>,
    /// Write the state of the render to this file, every so often and when it ends or is interrupted
    #[arg(long, value_name = "FILE")]
    pub(crate) checkpoint: Option<PathBuf>,
    /// Interval between checkpoint writes, e.g. 30s, 10m
    #[arg(long, value_name = "TIME", default_value = "30s", value_parser = duration, requires = "checkpoint")]
    pub(crate) checkpoint_every: Duration,
    /// Resume a checkpoint of the same scene and settings; the result is bit-identical to an uninterrupted render. --passes and
    /// --time count from its beginning; --alpha, --photons and --preset take effect from the next pass on
    #[arg(long, value_name = "FILE")]
    pub(crate) resume: Option<PathBuf>,
    /// Layers to put into an EXR, each once: direct, caustic, indirect, emission, radius, photon_count, shape_id,
    /// error_noise, error_bias, error_total
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = layer)]
    pub(crate) layers: Vec<LayerKind>,
    /// What the image shows instead of all light: some of direct, caustic, indirect and emission, added up; or photons, those of the
    /// last pass as dots
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub(crate) show: Vec<Show>,
    /// Exposure of a PNG in stops, each of which doubles the light [default: 0]
    #[arg(long, value_name = "STOPS", value_parser = stops, allow_negative_numbers = true)]
    pub(crate) exposure: Option<f32>,
    /// Tone map of a PNG [default: pbr-neutral]
    #[arg(long, value_name = "NAME", value_enum)]
    pub(crate) tone_map: Option<ToneMapName>,
    /// Stop at the first value that is not finite (NaN or infinite), say where it arose, and write the image of the passes before.
    /// Otherwise such values are left out and counted
    #[arg(long)]
    pub(crate) strict: bool,
    /// Print one JSON object a line on stdout
    #[arg(long)]
    pub(crate) json: bool,
}

impl RenderArgs {
    /// Where the image of a method goes, where several are asked for.
    pub(crate) fn image_of(&self, method: Method) -> PathBuf {
        snapshot::suffixed(&self.output.0, method.name()).with_extension("exr")
    }

    /// What images show of the render.
    pub(crate) fn shown(&self) -> Shown {
        let kinds: Vec<LayerKind> = self.show.iter().filter_map(|show| show.kind()).collect();
        match self.show.first() {
            None => Shown::All,
            Some(Show::Photons) => Shown::Photons,
            Some(_) => Shown::Light(kinds),
        }
    }

    /// Layers that the images show or hold.
    pub(crate) fn all_layers(&self) -> Vec<LayerKind> {
        self.layers.iter().copied().chain(self.show.iter().filter_map(|show| show.kind())).collect()
    }

    /// How a PNG shows radiance.
    pub(crate) fn look(&self) -> Look {
        let default = Look::default();
        Look {
            tone_map: self.tone_map.map_or(default.tone_map, Into::into),
            exposure_stops: self.exposure.unwrap_or(default.exposure_stops),
        }
    }
}
