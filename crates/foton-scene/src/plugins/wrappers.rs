//! BSDFs of scene files that stand around others.

use super::Plugin;
use crate::parameter::Parameter;

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

/// All of them.
pub const ALL: &[Plugin] = &[TWOSIDED, MASK];
