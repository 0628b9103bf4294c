//! BSDFs of scene files that stand around others.

use super::Plugin;
use crate::bsdf::{COATING, ROUGH_COATING};
use crate::parameter::{Kind, Parameter};

/// How much of a surface is there.
pub const OPACITY: Parameter = Parameter::share("opacity", 0.5)
    .label("Opacity")
    .help("Share of light that meets the surface; the rest passes straight through.");

/// A surface with holes.
pub const MASK: Plugin = Plugin {
    name: "mask",
    label: "",
    help: "Around one BSDF: a surface with holes, or one that is thin.",
    parameters: &[OPACITY],
};

/// Both sides of a surface.
pub const TWOSIDED: Plugin = Plugin {
    name: "twosided",
    label: "",
    help: "Around one BSDF, which then holds on both sides, or two: the front's and the back's. Other BSDFs that do not transmit light are black behind.",
    parameters: &[],
};

/// The second BSDF's share of a blend.
pub const WEIGHT: Parameter = Parameter { textured: true, ..Parameter::number("weight", 0.5, (0.0, 1.0)) }
    .help("Share of the second BSDF; the first has the rest.");

/// Two BSDFs, one over the other.
pub const BLENDBSDF: Plugin = Plugin {
    name: "blendbsdf",
    label: "",
    help: "Around two BSDFs: a blend of both.",
    parameters: &[WEIGHT],
};

/// The shares of a mixture.
pub const WEIGHTS: Parameter = Parameter::other("weights", Kind::Numbers, "required")
    .help("Shares of the BSDFs, in their order. What is missing to 1 is absorbed; where they sum to more, they are scaled to 1.");

/// Many BSDFs of constant shares.
pub const MIXTUREBSDF: Plugin = Plugin {
    name: "mixturebsdf",
    label: "",
    help: "Around any number of BSDFs: a mixture by constant shares, of files of version 0.",
    parameters: &[WEIGHTS],
};

/// How much a bump map stands out.
pub const SCALE: Parameter = Parameter::number("scale", 1.0, (f64::MIN, f64::MAX))
    .help("Factor on the displacement that the texture states, in world units.");

const FLIP: Parameter = Parameter::ignored(
    "flip_invalid_normals",
    "Normals that would point into the surface are mirrored at it.",
);
/// Whether Mitsuba 3 darkens light at grazing angles.
pub const SHADOWING: Parameter = Parameter::ignored(
    "use_shadowing_function",
    "Light at grazing angles is not darkened, as with `false` in Mitsuba 3.",
);

/// A surface whose normals a height perturbs.
pub const BUMPMAP: Plugin = Plugin {
    name: "bumpmap",
    label: "",
    help: "Around one BSDF and a texture of any name, which states how far the surface stands out: shading normals follow it, its silhouette does not.",
    parameters: &[SCALE, FLIP, SHADOWING],
};

/// The picture of normals.
pub const NORMALS: Parameter = Parameter { textured: true, ..Parameter::other("normalmap", Kind::Texture, "required") }
    .help("The normal in the frame of the tangent along u, the bitangent and the shading normal: each component n as (n + 1)/2. It should be `raw`.");

/// The picture of normals, in old files.
pub const NORMALS_FILE: Parameter = Parameter::other("filename", Kind::File, "none")
    .help("Of old files, instead of a texture: a picture of normals, taken as it is.");

/// A surface whose normals a picture says.
pub const NORMALMAP: Plugin = Plugin {
    name: "normalmap",
    label: "",
    help: "Around one BSDF: shading normals from a picture.",
    parameters: &[NORMALS, NORMALS_FILE, FLIP, SHADOWING],
};

/// A clear coat.
pub const COATING_PLUGIN: Plugin = Plugin {
    name: "coating",
    label: "",
    help: "Around one BSDF: a smooth clear coat, which may absorb light (Weidlich and Wilkie). Light that it sends back to the base is lost. Mitsuba 3 does not have it.",
    parameters: COATING,
};

/// A rough clear coat.
pub const ROUGHCOATING_PLUGIN: Plugin = Plugin {
    name: "roughcoating",
    label: "",
    help: "Around one BSDF: a rough clear coat. Through it light refracts as through a smooth one. Mitsuba 3 does not have it.",
    parameters: ROUGH_COATING,
};

/// All of them.
pub const ALL: &[Plugin] =
    &[COATING_PLUGIN, ROUGHCOATING_PLUGIN, TWOSIDED, MASK, BLENDBSDF, MIXTUREBSDF, BUMPMAP, NORMALMAP];
