//! `foton render`.

use std::num::NonZeroU32;
use std::path::PathBuf;
use std::time::Duration;

use clap::Args as ClapArgs;
use foton_integrator::{Alpha, LayerKind, RadiusFloor, RenderSettings};
use foton_session::snapshot::Format;

use super::parse::{
    alpha, bytes, define, duration, error_wish, image, layer, name, radius, radius_floor, with_default,
};
use super::values::{Direct, ErrorWish, Every, Integrator, PresetName, Radius, Rule, Size};

/// `foton render`.
#[derive(Debug, ClapArgs)]
pub(crate) struct RenderArgs {
    /// Scene file (Mitsuba 3 XML)
    pub(crate) scene: PathBuf,
    /// Image to write, .exr (linear radiance) or .png (tone-mapped). Here and elsewhere links are followed, also one to a file that
    /// is not there yet, and a file that anything is read from is not written to
    #[arg(short, value_name = "OUT.{exr,png}", value_parser = name(image))]
    pub(crate) output: (PathBuf, Format),
    /// Stop after this many passes
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) passes: Option<u64>,
    /// Stop after this much rendering, e.g. 90s, 10m, 1.5h [without any stop rule: 60s]
    #[arg(long, value_name = "TIME", value_parser = duration)]
    pub(crate) time: Option<Duration>,
    /// Stop when the error is certainly below this, e.g. 2% or 0.02: root mean square over the mean reflected light, eye
    /// samples as they are. `off` leaves the estimate out, which saves a little time
    #[arg(long, value_name = "SHARE|off", value_parser = error_wish)]
    pub(crate) error: Option<ErrorWish>,
    /// RenderSettings for a purpose: something to look at soon, the defaults, or minutes of rendering. What is set by itself comes
    /// before it, and it comes before what the scene says
    #[arg(long, value_name = "NAME", value_enum)]
    pub(crate) preset: Option<PresetName>,
    #[arg(long, value_name = "N", help = with_default(
        "Photons emitted in a pass: fewer answer sooner, more cost less a photon [as the scene says, else ",
        RenderSettings::default().ppm.photons_per_pass,
    ))]
    pub(crate) photons: Option<NonZeroU32>,
    #[arg(long, value_name = "A", value_parser = alpha, help = with_default(
        "Share of new photons kept, in (0, 1]: small shrinks radii fast (less bias, more noise) [as the scene says, else ",
        RenderSettings::default().ppm.alpha,
    ))]
    pub(crate) alpha: Option<Alpha>,
    /// First radius: in world units, or x0.5 for half of what each pixel's footprint gives (x1)
    #[arg(long, value_name = "R|xF", value_parser = radius)]
    pub(crate) radius: Option<Radius>,
    /// How radii shrink
    #[arg(long, value_name = "RULE", value_enum, default_value_t = RenderSettings::default().ppm.radius_rule.into())]
    pub(crate) radius_rule: Rule,
    /// Smallest radius in spacings of the eye samples, which stand still: light narrower than what discs cover is lost between
    /// them. 0 for none
    #[arg(long, value_name = "N", value_parser = radius_floor, default_value_t = RenderSettings::default().ppm.radius_floor)]
    pub(crate) radius_floor: RadiusFloor,
    /// Seed of all random numbers
    #[arg(long, value_name = "N", default_value_t = RenderSettings::default().seed)]
    pub(crate) seed: u64,
    /// Threads [as many as the machine has]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Size of the whole image; a crop of it shrinks or grows along [as the scene says]
    #[arg(long, value_name = "WxH")]
    pub(crate) size: Option<Size>,
    /// Eye samples a pixel
    #[arg(long, value_name = "N", default_value_t = RenderSettings::default().samples_per_pixel)]
    pub(crate) spp: NonZeroU32,
    /// Longest path in edges, as Mitsuba counts them: 1 emitters seen directly, 2 one bounce [as the scene says]
    #[arg(long, value_name = "N")]
    pub(crate) max_depth: Option<u32>,
    /// How light straight from emitters is estimated
    #[arg(long, value_name = "HOW", value_enum, default_value_t = Direct::Photons)]
    pub(crate) direct: Direct,
    /// Light transport method
    #[arg(long, value_name = "NAME", value_enum, default_value_t = Integrator::Render)]
    pub(crate) integrator: Integrator,
    /// The sensor to look through, by its id [the first]
    #[arg(long, value_name = "NAME")]
    pub(crate) sensor: Option<String>,
    /// Refuse to start beyond this much memory, e.g. 800M, 8G [80 % of what is free]
    #[arg(long, value_name = "SIZE", value_parser = bytes)]
    pub(crate) memory: Option<u64>,
    /// Set a parameter of the scene file
    #[arg(short = 'D', value_name = "name=value", value_parser = define)]
    pub(crate) defines: Vec<(String, String)>,
    /// Also write OUT-000016.exr and so on, at powers of two or every N passes
    #[arg(long, value_name = "pow2|N")]
    pub(crate) every: Option<Every>,
    /// Keep the state of the render in this file, every so often and when it ends or is interrupted
    #[arg(long, value_name = "FILE")]
    pub(crate) checkpoint: Option<PathBuf>,
    /// How often, e.g. 30s, 10m
    #[arg(long, value_name = "TIME", default_value = "30s", value_parser = duration, requires = "checkpoint")]
    pub(crate) checkpoint_every: Duration,
    /// Go on from a checkpoint of the same scene and settings, with the same bits as without a break; --passes and --time count
    /// from its beginning, --alpha, --photons and --preset change it from the next pass on
    #[arg(long, value_name = "FILE")]
    pub(crate) resume: Option<PathBuf>,
    /// Layers to put into an EXR, each once: direct, caustic, indirect, emission, radius, photon_count, shape_id,
    /// error_noise, error_bias, error_total
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = layer)]
    pub(crate) layers: Vec<LayerKind>,
    /// Stop at the first value that is not finite (NaN or infinite), say where it arose, and write the image of the passes before.
    /// Otherwise such values are left out and counted
    #[arg(long)]
    pub(crate) strict: bool,
    /// Print one JSON object a line on stdout
    #[arg(long)]
    pub(crate) json: bool,
}
