//! The command line. Its words are stable: scripts rely on them.

mod measure;
mod together;

use std::num::NonZeroU32;
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Duration;

use clap::builder::{OsStringValueParser, TypedValueParser};
use clap::{Args as ClapArgs, Parser, Subcommand, ValueEnum};
use foton_integrator::{Alpha, DirectLight, LayerKind, RadiusFloor, RadiusRule, RadiusScale, RenderSettings};
use foton_session::Preset;
use foton_session::snapshot::Format;

pub(crate) use measure::Measure;

/// Progressive photon mapping that a person can watch, steer and trust.
#[derive(Debug, Parser)]
#[command(version, args_conflicts_with_subcommands = true)]
pub(crate) struct Args {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
    /// Scene to open in the window: Mitsuba XML, OBJ, PLY or STL; without one, the scene that ships with foton. Where there can
    /// be no window, it is rendered for a minute
    pub(crate) scene: Option<PathBuf>,
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
    /// Say what a scene contains, what that switches on, and what a render of it would take
    Info(Info),
    /// Say how far an image is from a reference: RMSE, relMSE, means, FLIP
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
    /// Scene file to read: Mitsuba XML, OBJ, PLY or STL
    pub(crate) scene: PathBuf,
    /// Scene file to write; meshes and textures go into folders beside it
    #[arg(value_name = "OUT.xml", value_parser = name(xml))]
    pub(crate) output: PathBuf,
    /// Set a parameter of the scene file
    #[arg(short = 'D', value_name = "name=value", value_parser = define)]
    pub(crate) defines: Vec<(String, String)>,
}

/// `foton info`.
#[derive(Debug, ClapArgs)]
pub(crate) struct Info {
    /// Scene file (Mitsuba 3 XML)
    pub(crate) scene: PathBuf,
    /// The sensor to look through, by its id [the first]
    #[arg(long, value_name = "NAME")]
    pub(crate) sensor: Option<String>,
    /// Refuse to read or build beyond this much memory, e.g. 800M, 8G [80 % of what is free]
    #[arg(long, value_name = "SIZE", value_parser = bytes)]
    pub(crate) memory: Option<u64>,
    /// Set a parameter of the scene file
    #[arg(short = 'D', value_name = "name=value", value_parser = define)]
    pub(crate) defines: Vec<(String, String)>,
    /// Print one JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
}

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
    /// How light is transported; more than progressive photon mapping is to come
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

/// `--error`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ErrorWish {
    /// Not estimated.
    Off,
    /// Stop below this.
    Below(f64),
}

/// `--direct`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Direct {
    /// By photons, like all other light
    Photons,
    /// By shadow rays: sharp shadows from the first pass on
    ShadowRays,
}

/// `--radius`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Radius {
    /// In world units.
    World(f64),
    /// Times what the pixel's footprint gives.
    Footprint(RadiusScale),
}

impl Radius {
    /// What settings say of it; without one, what the scene suggests, times `scale`.
    pub(crate) fn split(
        wish: Option<Self>,
        suggested: Option<f64>,
        scale: RadiusScale,
    ) -> (Option<f64>, RadiusScale) {
        match wish {
            None => (suggested, scale),
            Some(Self::World(radius)) => (Some(radius), RadiusScale::default()),
            Some(Self::Footprint(scale)) => (None, scale),
        }
    }
}

/// `--preset`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum PresetName {
    /// Small passes: the next picture comes sooner
    Preview,
    /// The defaults
    Balanced,
    /// A larger α: less noise after minutes
    Final,
}

impl From<PresetName> for Preset {
    fn from(name: PresetName) -> Self {
        match name {
            PresetName::Preview => Self::Preview,
            PresetName::Balanced => Self::Balanced,
            PresetName::Final => Self::Final,
        }
    }
}

/// `--radius-rule`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Rule {
    /// Each by the photons that it finds
    Local,
    /// All by one factor, by the photons emitted
    Global,
    /// Each by the photons that it finds, as far as blur outweighs noise there
    Adaptive,
}

impl From<Rule> for RadiusRule {
    fn from(rule: Rule) -> Self {
        match rule {
            Rule::Local => Self::Local,
            Rule::Global => Self::Global,
            Rule::Adaptive => Self::Adaptive,
        }
    }
}

impl From<RadiusRule> for Rule {
    fn from(rule: RadiusRule) -> Self {
        match rule {
            RadiusRule::Local => Self::Local,
            RadiusRule::Global => Self::Global,
            RadiusRule::Adaptive => Self::Adaptive,
        }
    }
}

/// `--integrator`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Integrator {
    /// Progressive photon mapping
    Render,
}

impl From<Direct> for DirectLight {
    fn from(direct: Direct) -> Self {
        match direct {
            Direct::Photons => Self::Photons,
            Direct::ShadowRays => Self::ShadowRays,
        }
    }
}

/// Image size in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Size {
    pub(crate) width: u32,
    pub(crate) height: u32,
}

impl FromStr for Size {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        let side = |s: &str| s.parse::<u32>().ok().filter(|n| (1..=1 << 16).contains(n));
        s.split_once(['x', 'X', '×'])
            .and_then(|(w, h)| Some(Self { width: side(w)?, height: side(h)? }))
            .ok_or_else(|| {
                "expected WIDTHxHEIGHT in pixels, such as 640x480, each from 1 to 65536".to_owned()
            })
    }
}

/// `--every`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Every {
    PowersOfTwo,
    Nth(u64),
}

impl Every {
    /// The first pass after which an image is due.
    pub(crate) const fn first(self) -> u64 {
        match self {
            Self::PowersOfTwo => 1,
            Self::Nth(n) => n,
        }
    }

    /// Whether an image is due after `pass` passes.
    pub(crate) const fn is_due(self, pass: u64) -> bool {
        match self {
            Self::PowersOfTwo => pass.is_power_of_two(),
            Self::Nth(n) => pass.is_multiple_of(n),
        }
    }
}

impl FromStr for Every {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        match (s, s.parse::<u64>()) {
            ("pow2", _) => Ok(Self::PowersOfTwo),
            (_, Ok(n)) if n > 0 => Ok(Self::Nth(n)),
            _ => Err("expected pow2 or a number of passes above 0".to_owned()),
        }
    }
}

/// Help that ends with a default.
fn with_default(help: &str, default: impl std::fmt::Display) -> String {
    format!("{help}{default}]")
}

fn alpha(s: &str) -> Result<Alpha, String> {
    s.parse().ok().and_then(Alpha::new).ok_or_else(|| "expected a number above 0 and up to 1".to_owned())
}

fn radius_floor(s: &str) -> Result<RadiusFloor, String> {
    s.parse()
        .ok()
        .and_then(RadiusFloor::new)
        .ok_or_else(|| "expected a number of spacings, 0 or more".to_owned())
}

fn radius(s: &str) -> Result<Radius, String> {
    let wish = match s.strip_prefix(['x', 'X', '×']) {
        Some(factor) => factor.parse().ok().and_then(RadiusScale::new).map(Radius::Footprint),
        None => s.parse().ok().filter(|r: &f64| *r > 0.0 && r.is_finite()).map(Radius::World),
    };
    wish.ok_or_else(|| "expected a length above 0 in world units, or a factor such as x0.5".to_owned())
}

/// A parser of file names, which need not be text.
fn name<T: Clone + Send + Sync + 'static>(
    parse: impl Fn(PathBuf) -> Result<T, String> + Clone + Send + Sync + 'static,
) -> impl TypedValueParser<Value = T> {
    OsStringValueParser::new().try_map(move |name| parse(name.into()))
}

fn exr(path: PathBuf) -> Result<PathBuf, String> {
    let fits = Format::of(&path) == Some(Format::Exr);
    fits.then_some(path)
        .ok_or_else(|| "expected a name that ends in .exr: only those hold radiance".to_owned())
}

fn image(path: PathBuf) -> Result<(PathBuf, Format), String> {
    let format = Format::of(&path).ok_or_else(|| "expected a name that ends in .exr or .png".to_owned())?;
    Ok((path, format))
}

fn xml(path: PathBuf) -> Result<PathBuf, String> {
    let fits = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("xml"));
    fits.then_some(path).ok_or_else(|| "expected a name that ends in .xml".to_owned())
}

fn layer(s: &str) -> Result<LayerKind, String> {
    LayerKind::from_name(s).ok_or_else(|| {
        let names: Vec<_> = LayerKind::ALL.iter().map(|k| k.name()).collect();
        format!("expected any of {}", names.join(", "))
    })
}

fn define(s: &str) -> Result<(String, String), String> {
    s.split_once('=')
        .filter(|(name, _)| !name.is_empty())
        .map(|(name, value)| (name.to_owned(), value.to_owned()))
        .ok_or_else(|| "expected name=value".to_owned())
}

/// A number with one of the given units.
fn with_unit(s: &str, units: &[(&str, f64)]) -> Option<f64> {
    let (unit, factor) = units.iter().find(|(unit, _)| s.ends_with(unit))?;
    let number: f64 = s.strip_suffix(unit)?.trim().parse().ok()?;
    (number > 0.0 && number.is_finite()).then_some(number * factor)
}

fn error_wish(s: &str) -> Result<ErrorWish, String> {
    if s == "off" {
        return Ok(ErrorWish::Off);
    }
    with_unit(s, &[("%", 0.01), ("", 1.0)])
        .filter(|share| *share < 1.0)
        .map(ErrorWish::Below)
        .ok_or_else(|| "expected a share between 0 and 1, such as 2% or 0.02, or off".to_owned())
}

fn duration(s: &str) -> Result<Duration, String> {
    with_unit(s, &[("ms", 1e-3), ("s", 1.0), ("m", 60.0), ("h", 3600.0), ("", 1.0)])
        .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
        .ok_or_else(|| "expected a time above 0, such as 90s, 10m or 1.5h".to_owned())
}

fn bytes(s: &str) -> Result<u64, String> {
    let unit = |power: i32| 1024f64.powi(power);
    let units = [("K", unit(1)), ("M", unit(2)), ("G", unit(3)), ("T", unit(4)), ("", 1.0)];
    with_unit(s.trim_end_matches("iB"), &units)
        .map(|b| b as u64)
        .ok_or_else(|| "expected a size above 0, such as 800M or 8G (powers of 1024)".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_sound() {
        use clap::CommandFactory;
        Args::command().debug_assert();
    }

    #[test]
    fn times_sizes_and_schedules_are_read_and_nonsense_is_refused() {
        assert_eq!(duration("1.5m"), Ok(Duration::from_secs(90)));
        assert_eq!(duration("250ms"), Ok(Duration::from_millis(250)));
        assert_eq!(duration("7"), Ok(Duration::from_secs(7)));
        assert_eq!((bytes("8G"), bytes("1.5MiB")), (Ok(8 << 30), Ok(3 << 19)));
        for bad in ["", "-1s", "0s", "s", "NaNs", "1e300h", "tomorrow"] {
            assert!(duration(bad).is_err(), "{bad}");
        }
        assert_eq!((error_wish("2%"), error_wish("off")), (Ok(ErrorWish::Below(0.02)), Ok(ErrorWish::Off)));
        for bad in ["0", "-1%", "100%", "1", "low"] {
            assert!(error_wish(bad).is_err(), "{bad}");
        }
        assert_eq!("640x480".parse(), Ok(Size { width: 640, height: 480 }));
        for bad in ["640", "0x3", "axb", "70000x1", "-1x5"] {
            assert!(bad.parse::<Size>().is_err(), "{bad}");
        }
        assert_eq!(("pow2".parse(), "3".parse()), (Ok(Every::PowersOfTwo), Ok(Every::Nth(3))));
        assert!("0".parse::<Every>().is_err());
        assert!(Every::Nth(3).is_due(6) && !Every::Nth(3).is_due(7) && Every::PowersOfTwo.is_due(8));
        let half = RadiusScale::new(0.5).map(Radius::Footprint);
        assert_eq!((radius("0.2").ok(), radius("x0.5").ok()), (Some(Radius::World(0.2)), half));
        for bad in ["0", "-1", "x", "x0", "0.5x", "xNaN", "inf"] {
            assert!(radius(bad).is_err(), "{bad}");
        }
        assert!(exr("a.exr".into()).is_ok() && exr("a.png".into()).is_err());
        for bad in ["0", "1.01", "NaN", "-1"] {
            assert!(alpha(bad).is_err(), "{bad}");
        }
    }
}
