//! What is declared of a parameter.

use foton_math::Rgb;

use crate::description::Colour;

/// A parameter of a plugin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Its name in files, that of Mitsuba 3.
    pub name: &'static str,
    /// Names that it had in files of version 0, capitals already turned into underscores.
    pub old_names: &'static [&'static str],
    /// What kind of value it takes.
    pub kind: Kind,
    /// Its values where it is a number, both ends included; where it is a colour, those of each channel.
    pub range: (f64, f64),
    /// The unit in files, if it has one.
    pub unit: &'static str,
    /// What it is where a file does not say: a number, all channels of a colour, or 1 for true.
    pub default: f64,
    /// What stands in the documentation for a default that is no number.
    pub default_text: &'static str,
    /// Its name in the window; empty: it is not there.
    pub label: &'static str,
    /// What it does, in one or two sentences.
    pub help: &'static str,
    /// Whether a texture may stand for it.
    pub textured: bool,
    /// Parameters that cannot stand beside it.
    pub excludes: &'static [&'static str],
    /// What survives when a surface becomes another model in the window.
    pub role: Option<Role>,
    /// Whether the window shows it only to those who ask for more.
    pub advanced: bool,
    /// The range of its slider in the window, and whether that is logarithmic; empty: the range.
    pub slider: Option<(f64, f64, bool)>,
}

/// What kind of value a parameter takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A colour whose channels are shares of light, in [0, 1].
    Share,
    /// A colour that is not a share of light: radiance, intensity, part of a complex index of refraction.
    Colour,
    /// A number.
    Number,
    /// A whole number.
    Integer,
    /// An index of refraction: a number, or the name of a substance.
    Refraction,
    /// True or false.
    Boolean,
    /// One of some words.
    Choice(&'static [&'static str]),
    /// A length in millimetres, such as `50mm`.
    Millimetres,
    /// The name of a metal.
    Metal,
    /// A point or a direction.
    Vector,
    /// A transform.
    Transform,
    /// The path of a file.
    File,
    /// Numbers, separated by commas or spaces.
    Numbers,
    /// A texture.
    Texture,
    /// The name of something.
    Name,
    /// Read and without effect: it steers another renderer's sampling.
    Ignored,
    /// Refused where it is given, since leaving it out would change the image.
    Unsupported,
}

/// What survives when a surface becomes another model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The colour of a surface, or of what lies under its coat.
    BaseColour,
    /// The index of refraction inside.
    InsideIor,
    /// The index of refraction outside.
    OutsideIor,
    /// The roughness α.
    Roughness,
    /// The square root of the roughness α.
    RootRoughness,
}

impl Parameter {
    const fn new(name: &'static str, kind: Kind) -> Self {
        Self {
            name,
            old_names: &[],
            kind,
            range: (f64::NEG_INFINITY, f64::INFINITY),
            unit: "",
            default: 0.0,
            default_text: "",
            label: "",
            help: "",
            textured: false,
            excludes: &[],
            role: None,
            advanced: false,
            slider: None,
        }
    }

    /// A share of light, which a texture may give.
    #[must_use]
    pub const fn share(name: &'static str, default: f64) -> Self {
        Self { range: (0.0, 1.0), default, textured: true, ..Self::new(name, Kind::Share) }
    }

    /// A colour that is not a share of light and not below zero.
    #[must_use]
    pub const fn colour(name: &'static str, default: f64) -> Self {
        Self { range: (0.0, f64::INFINITY), default, ..Self::new(name, Kind::Colour) }
    }

    /// A number.
    #[must_use]
    pub const fn number(name: &'static str, default: f64, range: (f64, f64)) -> Self {
        Self { range, default, ..Self::new(name, Kind::Number) }
    }

    /// An index of refraction, above zero.
    #[must_use]
    pub const fn refraction(name: &'static str, default: f64) -> Self {
        Self {
            range: (f32::MIN_POSITIVE as f64, f32::MAX as f64),
            default,
            slider: Some((1.0, 4.0, false)),
            ..Self::new(name, Kind::Refraction)
        }
    }

    /// True or false; false by default.
    #[must_use]
    pub const fn boolean(name: &'static str) -> Self {
        Self { default_text: "false", ..Self::new(name, Kind::Boolean) }
    }

    /// One of some words, of which the first is the default.
    #[must_use]
    pub const fn choice(name: &'static str, words: &'static [&'static str]) -> Self {
        Self { default_text: words[0], ..Self::new(name, Kind::Choice(words)) }
    }

    /// A value of any other kind, with what the documentation says of its default.
    #[must_use]
    pub const fn other(name: &'static str, kind: Kind, default_text: &'static str) -> Self {
        Self { default_text, ..Self::new(name, kind) }
    }

    /// Read and without effect.
    #[must_use]
    pub const fn ignored(name: &'static str, help: &'static str) -> Self {
        Self { help, ..Self::new(name, Kind::Ignored) }
    }

    /// Refused where it is given.
    #[must_use]
    pub const fn unsupported(name: &'static str) -> Self {
        Self { help: "Not supported yet.", ..Self::new(name, Kind::Unsupported) }
    }

    /// With what it does.
    #[must_use]
    pub const fn help(self, help: &'static str) -> Self {
        Self { help, ..self }
    }

    /// With its name in the window.
    #[must_use]
    pub const fn label(self, label: &'static str) -> Self {
        Self { label, ..self }
    }

    /// With the names that it once had.
    #[must_use]
    pub const fn once(self, old_names: &'static [&'static str]) -> Self {
        Self { old_names, ..self }
    }

    /// With its unit.
    #[must_use]
    pub const fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    /// With parameters that cannot stand beside it.
    #[must_use]
    pub const fn excludes(self, excludes: &'static [&'static str]) -> Self {
        Self { excludes, ..self }
    }

    /// For which a texture may stand.
    #[must_use]
    pub const fn textured(self) -> Self {
        Self { textured: true, ..self }
    }

    /// With what survives when its surface becomes another model.
    #[must_use]
    pub const fn role(self, role: Role) -> Self {
        Self { role: Some(role), ..self }
    }

    /// Shown in the window only to those who ask for more.
    #[must_use]
    pub const fn advanced(self) -> Self {
        Self { advanced: true, ..self }
    }

    /// With the range of its slider, and whether that is logarithmic.
    #[must_use]
    pub const fn slider(self, min: f64, max: f64, logarithmic: bool) -> Self {
        Self { slider: Some((min, max, logarithmic)), ..self }
    }

    /// With what the documentation says of its default.
    #[must_use]
    pub const fn default_text(self, default_text: &'static str) -> Self {
        Self { default_text, ..self }
    }

    /// Its default in single precision.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, reason = "optics is single precision")]
    pub const fn default_number(&self) -> f32 {
        self.default as f32
    }

    /// Its default in every channel.
    #[must_use]
    pub const fn default_colour(&self) -> Colour {
        Colour::Constant(Rgb::splat(self.default_number()))
    }

    /// Its range in single precision.
    #[allow(clippy::cast_possible_truncation, reason = "optics is single precision")]
    pub(crate) const fn limits(&self) -> [f32; 2] {
        [self.range.0 as f32, self.range.1 as f32]
    }

    /// Whether a number lies within its range; NaN does not.
    #[must_use]
    pub fn holds(&self, value: f64) -> bool {
        (self.range.0..=self.range.1).contains(&value)
    }
}
