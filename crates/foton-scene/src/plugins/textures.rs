//! Textures of scene files, with their parameters.

use super::Plugin;
use crate::parameter::{Kind, Parameter};

/// The picture.
pub const FILENAME: Parameter = Parameter::other("filename", Kind::File, "required").help(
    "The picture: PNG, JPEG, WebP, BMP, TGA, PNM, PFM, EXR or HDR. Its v begins at the top. Alpha does not change its colours.",
);

/// Whether numbers are taken as they are.
pub const RAW: Parameter = Parameter::boolean("raw")
    .help("Takes numbers as they are, instead of undoing sRGB's curve.")
    .default_text("true where `gamma` is 1");

/// The curve of old files.
pub const GAMMA: Parameter = Parameter::other("gamma", Kind::Number, "none")
    .help("Of old files: the power by which numbers of 8 and 16 bits become linear; 1 means `raw`, −1 sRGB's curve.");

/// Names of channels.
pub const CHANNELS: &[&str] = &["r", "g", "b", "a", "x", "y", "z"];

/// One channel for all.
pub const CHANNEL: Parameter =
    Parameter { kind: Kind::Choice(CHANNELS), ..Parameter::other("channel", Kind::Number, "all") }
        .help("Of old files: the channel that is taken as grey. `a` is not read from EXR and PFM files.");

/// Names of filters.
pub const FILTERS: &[&str] = &["bilinear", "nearest"];

/// How pixels are interpolated.
pub const FILTER_TYPE: Parameter = Parameter::choice("filter_type", FILTERS)
    .help("How pixels are interpolated. Where an eye sample covers several pixels, it sees their mean by either; so `trilinear` and `ewa` of old files are the same as `bilinear`.");

/// Names of ways to repeat.
pub const WRAPS: &[&str] = &["repeat", "mirror", "clamp"];

/// What lies outside the picture.
pub const WRAP_MODE: Parameter =
    Parameter::choice("wrap_mode", WRAPS).help("What lies outside of coordinates 0 to 1.");

const fn along(name: &'static str) -> Parameter {
    Parameter::choice(name, WRAPS).help("Of old files, where there is no `wrap_mode`: u and v wrap alike.")
}

/// What lies outside along u.
pub const WRAP_MODE_U: Parameter = along("wrap_mode_u");
/// What lies outside along v.
pub const WRAP_MODE_V: Parameter = along("wrap_mode_v");

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
    Parameter::share(name, default).help("Colour of every other square.")
}

/// One colour of a checkerboard.
pub const COLOR0: Parameter = square("color0", 0.4);
/// The other colour.
pub const COLOR1: Parameter = square("color1", 0.2);

/// Colour between the lines of a grid.
pub const BACKGROUND: Parameter =
    Parameter { textured: false, ..Parameter::share("color0", 0.2) }.help("Colour between the lines.");
/// Colour of the lines of a grid.
pub const LINES: Parameter =
    Parameter { textured: false, ..Parameter::share("color1", 0.4) }.help("Colour of the lines.");
/// Half the width of the lines of a grid.
pub const LINE_WIDTH: Parameter = Parameter::number("line_width", 0.01, (0.0, 1.0))
    .help("How far the lines reach to either side of whole coordinates.");

/// Factor on a texture.
pub const SCALE: Parameter = Parameter::colour("scale", 1.0).help("Factor on the texture inside.");

/// The name of an attribute.
pub const NAME: Parameter = Parameter::other("name", Kind::Name, "required")
    .help("The attribute: `vertex_color`, `face_color` or another that begins with `vertex_` or `face_`.");
/// Factor on an attribute.
pub const ATTRIBUTE_SCALE: Parameter =
    Parameter::number("scale", 1.0, (0.0, 1e30)).help("Factor on the values.");

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
        WRAP_MODE_U,
        WRAP_MODE_V,
        CHANNEL,
    ],
};

/// Squares of two colours.
pub const CHECKERBOARD: Plugin = Plugin {
    name: "checkerboard",
    label: "",
    help: "Squares of two colours, four of them in coordinates 0 to 1.",
    parameters: &[COLOR0, COLOR1, TO_UV, UOFFSET, VOFFSET, USCALE, VSCALE],
};

/// Lines along whole coordinates.
pub const GRIDTEXTURE: Plugin = Plugin {
    name: "gridtexture",
    label: "",
    help: "Lines along whole coordinates, of files of version 0.",
    parameters: &[BACKGROUND, LINES, LINE_WIDTH, TO_UV, UOFFSET, VOFFSET, USCALE, VSCALE],
};

/// A factor.
pub const SCALED: Plugin = Plugin {
    name: "scale",
    label: "",
    help: "Around one texture: a factor on its colours, of files of version 0.",
    parameters: &[SCALE],
};

/// What a mesh states.
pub const MESH_ATTRIBUTE: Plugin = Plugin {
    name: "mesh_attribute",
    label: "",
    help: "What a mesh states of its vertices or faces. From a PLY file: `r`, `g`, `b` or `red`, `green`, `blue` are `vertex_color`; `name_r`, `name_g`, `name_b` are `vertex_name_color`; `name_x` to `name_z` or `name_0` to `name_2`, or one of them alone, are `vertex_name`; of faces they begin with `face_`. Colours in whole numbers are sRGB. Vertex colours of a serialized mesh are `vertex_color`.",
    parameters: &[NAME, ATTRIBUTE_SCALE],
};

/// The colours of vertices.
pub const VERTEXCOLORS: Plugin = Plugin {
    name: "vertexcolors",
    label: "",
    help: "The colours of a mesh's vertices, of files of version 0: the attribute `vertex_color`.",
    parameters: &[],
};

/// All of them.
pub const ALL: &[Plugin] = &[BITMAP, CHECKERBOARD, MESH_ATTRIBUTE, GRIDTEXTURE, SCALED, VERTEXCOLORS];
