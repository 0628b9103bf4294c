//! What options may say.

use std::str::FromStr;

use clap::ValueEnum;
use foton_film::ToneMap;
use foton_integrator::{DirectLight, LayerKind, Method, RadiusRule, RadiusScale};
use foton_session::Preset;

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
    /// By shadow rays, unless most of them would be in vain
    Auto,
    /// By photons, like all other light
    Photons,
    /// By shadow rays: sharp shadows from the first pass on, no noise from points, spots and suns
    ShadowRays,
}

/// `--guide`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Guide {
    /// From the second pass on
    Auto,
    /// Never: photons start as their emitters shine
    Off,
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

/// `--tone-map`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum ToneMapName {
    /// No compression: each channel is clipped
    Linear,
    /// Khronos PBR Neutral
    PbrNeutral,
    /// The base look of AgX
    #[value(name = "agx")]
    AgX,
}

impl From<ToneMapName> for ToneMap {
    fn from(name: ToneMapName) -> Self {
        match name {
            ToneMapName::Linear => Self::Linear,
            ToneMapName::PbrNeutral => Self::PbrNeutral,
            ToneMapName::AgX => Self::AgX,
        }
    }
}

/// `--radius-rule`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Rule {
    /// Each radius shrinks with the photons found there
    Local,
    /// All radii shrink by a common factor, from the photons emitted
    Global,
    /// Each radius shrinks with the photons found there, as far as bias outweighs noise
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
    #[value(name = "ppm")]
    ProgressivePhotonMapping,
    /// Stochastic progressive photon mapping: new eye samples in each pass, so that edges, gloss and reflections converge too
    #[value(name = "sppm")]
    StochasticProgressivePhotonMapping,
    /// Path tracing with shadow rays: hardly any bias, but it misses light that mirrors and glass cast from small emitters
    #[value(name = "path")]
    PathTracing,
    /// Whitted's ray tracing: shadow rays, perfect reflection and refraction, nothing else
    #[value(name = "whitted")]
    WhittedRayTracing,
    /// The one that suits the scene, by its camera and surfaces; foton says which and why
    #[value(name = "auto")]
    Auto,
    /// Two-pass photon mapping: maps of photons that stay, shown by final gathering. Fast, with a bias that passes do not lower
    #[value(name = "photon-map")]
    PhotonMapping,
    /// Each of them in turn, for the same time: OUT becomes a contact sheet, and a table says how much they differ
    #[value(name = "all")]
    All,
}

impl Integrator {
    /// Whether several methods are asked for.
    pub(crate) const fn is_all(self) -> bool {
        matches!(self, Self::All)
    }

    /// The method; `None` for all of them, and where the scene decides.
    pub(crate) const fn method(self) -> Option<Method> {
        match self {
            Self::All | Self::Auto => None,
            Self::ProgressivePhotonMapping => Some(Method::Ppm),
            Self::StochasticProgressivePhotonMapping => Some(Method::Sppm),
            Self::PathTracing => Some(Method::Path),
            Self::WhittedRayTracing => Some(Method::Whitted),
            Self::PhotonMapping => Some(Method::PhotonMap),
        }
    }
}

impl From<Direct> for DirectLight {
    fn from(direct: Direct) -> Self {
        match direct {
            Direct::Auto => Self::Auto,
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

/// `--show`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Show {
    /// Light straight from emitters
    Direct,
    /// Light by mirrors and glass alone
    Caustic,
    /// Light by surfaces that scatter
    Indirect,
    /// Emitters, seen directly or by mirrors and glass
    Emission,
    /// Photons of the last pass as dots: direct yellow, caustic white, indirect blue
    Photons,
}

impl Show {
    /// The kind of light, if it is one.
    pub(crate) const fn kind(self) -> Option<LayerKind> {
        match self {
            Self::Direct => Some(LayerKind::Direct),
            Self::Caustic => Some(LayerKind::Caustic),
            Self::Indirect => Some(LayerKind::Indirect),
            Self::Emission => Some(LayerKind::Emission),
            Self::Photons => None,
        }
    }
}
