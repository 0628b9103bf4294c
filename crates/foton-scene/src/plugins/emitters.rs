//! Emitters of scene files, with their parameters.

use super::Plugin;
use crate::parameter::{Kind, Parameter};

/// Brightnesses and powers that a slider offers.
const BRIGHTNESS: (f64, f64, bool) = (1e-4, 1e6, true);

const fn emission(name: &'static str, label: &'static str, unit: &'static str) -> Parameter {
    Parameter { slider: Some(BRIGHTNESS), ..Parameter::colour(name, 1.0) }
        .label(label)
        .unit(unit)
        .help("Of its strongest channel. Noise and speed do not change with it.")
}

/// Emitted radiance.
pub const RADIANCE: Parameter = emission("radiance", "Radiance", "W/(m²·sr)");

/// The same of a surface, which a texture may give.
pub const RADIANCE_OF_SURFACE: Parameter = Parameter { textured: true, ..RADIANCE };

/// Emitted radiant intensity.
pub const INTENSITY: Parameter = emission("intensity", "Intensity", "W/sr");

/// Irradiance of a surface that faces the light.
pub const IRRADIANCE: Parameter = emission("irradiance", "Irradiance", "W/m²");

/// Where a point emitter is.
pub const POSITION: Parameter = Parameter::other("position", Kind::Vector, "0, 0, 0")
    .help("Where it is, in world units.")
    .excludes(&["to_world"]);

/// The way parallel light goes.
pub const DIRECTION: Parameter = Parameter::other("direction", Kind::Vector, "0, 0, 1")
    .help("The direction in which the light travels; need not be normalised.")
    .excludes(&["to_world"]);

/// Where an emitter stands, and which way it is turned.
pub const TO_WORLD: Parameter =
    Parameter::other("to_world", Kind::Transform, "identity").help("Emitter to world.");

/// Half angle beyond which a spot emits nothing.
pub const CUTOFF_ANGLE: Parameter = Parameter::number("cutoff_angle", 20.0, (f64::MIN_POSITIVE, 180.0))
    .label("Cone")
    .unit("°")
    .help("Half angle of the cone, beyond which there is no light. A narrow one wastes no photons.")
    .slider(0.1, 180.0, false);

/// Half angle within which a spot is brightest.
pub const BEAM_WIDTH: Parameter = Parameter::number("beam_width", 15.0, (0.0, 180.0))
    .label("Beam")
    .unit("°")
    .help("Half angle within which it is brightest; from there it fades to the cone's edge.")
    .default_text("¾ of `cutoff_angle`");

/// The picture of an environment map.
pub const FILENAME: Parameter = Parameter::other("filename", Kind::File, "required").help(
    "Radiance by direction, as EXR, HDR or any other picture: rows are latitudes, +y of the emitter is up.",
);

/// Factor on the radiance of an environment map.
pub const SCALE: Parameter =
    Parameter { slider: Some(BRIGHTNESS), ..Parameter::number("scale", 1.0, (0.0, 1e30)) }
        .label("Brightness")
        .unit("×")
        .help("Factor on the picture's radiance.");

/// A surface that emits.
pub const AREA: Plugin = Plugin {
    name: "area",
    label: "",
    help: "Inside a shape: its surface emits this radiance, the same in all directions of its outer side. Photons and shadow rays start in proportion to it.",
    parameters: &[RADIANCE_OF_SURFACE],
};

/// A point.
pub const POINT: Plugin = Plugin {
    name: "point",
    label: "point light",
    help: "The same radiant intensity in all directions from one point.",
    parameters: &[INTENSITY, POSITION, TO_WORLD],
};

/// A point that shines in a cone.
pub const SPOT: Plugin = Plugin {
    name: "spot",
    label: "spot light",
    help: "A point that shines along its +z, fading linearly in the angle between two cones.",
    parameters: &[INTENSITY, TO_WORLD, CUTOFF_ANGLE, BEAM_WIDTH, Parameter::unsupported("texture")],
};

/// Parallel light.
pub const DIRECTIONAL: Plugin = Plugin {
    name: "directional",
    label: "directional light",
    help: "Parallel light from infinitely far away.",
    parameters: &[IRRADIANCE, DIRECTION, TO_WORLD],
};

/// An even sky.
pub const CONSTANT: Plugin = Plugin {
    name: "constant",
    label: "even sky",
    help: "The same radiance from every direction, from infinitely far away.",
    parameters: &[RADIANCE, Parameter::ignored("to_world", "It looks the same from everywhere.")],
};

/// An environment map.
pub const ENVMAP: Plugin = Plugin {
    name: "envmap",
    label: "environment map",
    help: "Radiance from infinitely far away, by direction, from a picture.",
    parameters: &[
        FILENAME,
        SCALE,
        TO_WORLD,
        Parameter::ignored("mis_compensation", "Photons are always emitted in proportion to the radiance."),
    ],
};

/// All of them.
pub const ALL: &[Plugin] = &[AREA, POINT, SPOT, CONSTANT, DIRECTIONAL, ENVMAP];
