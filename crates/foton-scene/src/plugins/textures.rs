//! Textures of scene files, with their parameters.

use super::Plugin;
use crate::parameter::{Kind, Parameter};

/// The picture.
pub const FILENAME: Parameter = Parameter::other("filename", Kind::File, "required")
    .help("The picture: PNG, JPEG, BMP, TGA, PNM, EXR or HDR. Its v begins at the top.");

/// Whether numbers are taken as they are.
pub const RAW: Parameter = Parameter::boolean("raw")
    .help("Takes numbers as they are, instead of undoing sRGB's curve.")
    .default_text("true where `gamma` is 1");

/// The curve of old files.
pub const GAMMA: Parameter = Parameter::other("gamma", Kind::Number, "none")
    .help("Of files of version 0: 1 means `raw`, all others sRGB's curve.");

/// Names of filters.
pub const FILTERS: &[&str] = &["bilinear", "nearest"];

/// How pixels are interpolated.
pub const FILTER_TYPE: Parameter = Parameter::choice("filter_type", FILTERS)
    .help("How pixels are interpolated. `trilinear` and `ewa` are read as bilinear, with a warning.");

/// Names of ways to repeat.
pub const WRAPS: &[&str] = &["repeat", "mirror", "clamp"];

/// What lies outside the picture.
pub const WRAP_MODE: Parameter =
    Parameter::choice("wrap_mode", WRAPS).help("What lies outside of coordinates 0 to 1.");

/// A transform of texture coordinates.
pub const TO_UV: Parameter =
    Parameter::other("to_uv", Kind::Transform, "identity").help("Applied to texture coordinates.");

const fn old_number(name: &'static str, default: f64) -> Parameter {
    Parameter::number(name, default, (f64::MIN, f64::MAX)).help("Of old files, where there is no `to_uv`.")
}

/// Offset of old files along u.
pub const UOFFSET: Parameter = old_number("uoffset", 0.0);
/// Offset of old files along v.
pub const VOFFSET: Parameter = old_number("voffset", 0.0);
/// Scale of old files along u.
pub const USCALE: Parameter = old_number("uscale", 1.0);
/// Scale of old files along v.
pub const VSCALE: Parameter = old_number("vscale", 1.0);

const fn square(name: &'static str, default: f64) -> Parameter {
    Parameter { textured: false, ..Parameter::share(name, default) }.help("Colour of every other square.")
}

/// One colour of a checkerboard.
pub const COLOR0: Parameter = square("color0", 0.4);
/// The other colour.
pub const COLOR1: Parameter = square("color1", 0.2);

const MEMORY: &str = "It steers another renderer's memory.";

/// A picture.
pub const BITMAP: Plugin = Plugin {
    name: "bitmap",
    label: "",
    help: "A picture.",
    parameters: &[
        FILENAME,
        RAW,
        GAMMA,
        FILTER_TYPE,
        WRAP_MODE,
        TO_UV,
        UOFFSET,
        VOFFSET,
        USCALE,
        VSCALE,
        Parameter::ignored("format", MEMORY),
        Parameter::ignored("accel", MEMORY),
        Parameter::ignored("max_anisotropy", MEMORY),
        Parameter::ignored("cache", MEMORY),
        Parameter::unsupported("channel"),
    ],
};

/// Squares of two colours.
pub const CHECKERBOARD: Plugin = Plugin {
    name: "checkerboard",
    label: "",
    help: "Squares of two colours, four of them in coordinates 0 to 1.",
    parameters: &[COLOR0, COLOR1, TO_UV, UOFFSET, VOFFSET, USCALE, VSCALE],
};

/// All of them.
pub const ALL: &[Plugin] = &[BITMAP, CHECKERBOARD];
