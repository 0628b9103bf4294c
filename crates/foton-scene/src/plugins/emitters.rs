//! Emitters of scene files, with their parameters.

use super::Plugin;
use super::sensors::{FOCAL_LENGTH, FOV, FOV_AXIS};
use crate::description::EmitterKind;
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
    parameters: &[INTENSITY, TO_WORLD, CUTOFF_ANGLE, BEAM_WIDTH, TEXTURE],
};

/// What colours a spot's light.
pub const TEXTURE: Parameter = Parameter { textured: true, ..Parameter::colour("texture", 1.0) }
    .help("What colours its light: a picture over the square around the cone.");

/// What a projector throws.
pub const PROJECTED: Parameter =
    Parameter { textured: true, ..emission("irradiance", "Irradiance", "W/m²") }
        .help("What a white surface at distance 1 sends back: a picture, or a colour.");

/// Factor on what a projector throws.
pub const PROJECTED_SCALE: Parameter =
    Parameter { slider: Some(BRIGHTNESS), ..Parameter::number("scale", 1.0, (0.0, 1e30)) }
        .label("Brightness")
        .unit("×")
        .help("Factor on the picture.");

/// A picture that is thrown.
pub const PROJECTOR: Plugin = Plugin {
    name: "projector",
    label: "projector",
    help: "A picture thrown along its +z, with a field of view as a camera has it. A scale of `to_world` is a factor on its light, as in Mitsuba 3.",
    parameters: &[PROJECTED, PROJECTED_SCALE, TO_WORLD, FOV, FOV_AXIS, FOCAL_LENGTH],
};

/// The intensities of a measured lamp.
pub const INTENSITIES: Parameter = Parameter::other("filename", Kind::File, "required").help(
    "Radiant intensity by direction: an IES profile (LM-63) in W/sr of its candela, or a picture whose rows are angles from +z.",
);

/// Factor on the intensity of a measured lamp.
pub const INTENSITY_SCALE: Parameter =
    Parameter { slider: Some(BRIGHTNESS), ..Parameter::number("scale", 1.0, (0.0, 1e30)) }
        .label("Brightness")
        .unit("×")
        .help("Factor on the intensity.");

/// A measured lamp.
pub const GONIOMETRIC: Plugin = Plugin {
    name: "goniometric",
    label: "measured lamp",
    help: "A point with an intensity for each direction, as measured lamps and pbrt's scenes have it; Mitsuba has none.",
    parameters: &[INTENSITIES, INTENSITY_SCALE, TO_WORLD],
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

/// How hazy the air is.
pub const TURBIDITY: Parameter = Parameter::number("turbidity", 3.0, (1.0, 10.0))
    .help("How hazy the air is: 2 on a very clear day in the mountains, 3 on a clear one, 10 in haze.");

/// What the ground reflects.
pub const ALBEDO: Parameter = Parameter { textured: false, ..Parameter::share("albedo", 0.3) }
    .help("Share of light that the ground reflects into the sky. 0.15 in files of version 0.");

/// Where the sun is.
pub const SUN_DIRECTION: Parameter = Parameter::other("sun_direction", Kind::Vector, "by place and time")
    .help("Where the sun is, in the world.");

/// Factor on the sky's radiance.
pub const SKY_SCALE: Parameter =
    Parameter::number("sky_scale", 1.0, (0.0, 1e30)).help("Factor on the sky's radiance.");

/// Factor on the sun's radiance.
pub const SUN_SCALE: Parameter =
    Parameter::number("sun_scale", 1.0, (0.0, 1e30)).help("Factor on the sun's radiance.");

/// Factor on all of it.
pub const SCALE_OF_SKY: Parameter =
    Parameter::number("scale", 1.0, (0.0, 1e30)).help("Factor on the radiance, of files of version 0.");

/// How large the sun is.
pub const SUN_APERTURE: Parameter = Parameter::number("sun_aperture", 0.5358, (0.01, 90.0))
    .unit("°")
    .help("How large the sun is; its power does not depend on that.");

/// How much larger the sun is than it is.
pub const SUN_RADIUS_SCALE: Parameter = Parameter::number("sun_radius_scale", 1.0, (0.02, 100.0))
    .help("Factor on the sun's size, of files of version 0; its power does not depend on that.");

const fn place(name: &'static str, default: f64, range: (f64, f64), help: &'static str) -> Parameter {
    Parameter::number(name, default, range).help(help)
}

/// The place, by degrees of latitude and longitude and hours of its clock before Greenwich, and the date and time there.
pub const PLACE_AND_TIME: [Parameter; 9] = [
    place("latitude", 35.6894, (-90.0, 90.0), "Degrees to the north, where there is no `sun_direction`."),
    place("longitude", 139.6917, (-180.0, 180.0), "Degrees to the east."),
    place("timezone", 9.0, (-14.0, 14.0), "Hours that the clock is ahead of Greenwich."),
    place("year", 2010.0, (-4000.0, 9999.0), "The year."),
    place("month", 7.0, (1.0, 12.0), "The month."),
    place("day", 10.0, (1.0, 31.0), "The day."),
    place("hour", 15.0, (0.0, 24.0), "The hour by the clock."),
    place("minute", 0.0, (0.0, 60.0), "The minute."),
    place("second", 0.0, (0.0, 60.0), "The second."),
];

const COMPLEX_SUN: Parameter = Parameter::ignored("complex_sun", "The sun is an even disc.");
const RESOLUTION: Parameter = Parameter::ignored("resolution", "The map has 2048 × 1025 pixels.");
const EXTEND: Parameter = Parameter::ignored("extend", "Below the horizon it is black.");
const STRETCH: Parameter = Parameter::unsupported("stretch");

/// The sky with its sun.
pub const SUNSKY: Plugin = Plugin {
    name: "sunsky",
    label: "",
    help: "A clear sky with its sun, after Hošek and Wilkie, as an environment map: +z is up, in files of version 0 +y.",
    parameters: &[
        TURBIDITY,
        ALBEDO,
        SUN_DIRECTION,
        SKY_SCALE,
        SUN_SCALE,
        SCALE_OF_SKY,
        SUN_APERTURE,
        SUN_RADIUS_SCALE,
        TO_WORLD,
        PLACE_AND_TIME[0],
        PLACE_AND_TIME[1],
        PLACE_AND_TIME[2],
        PLACE_AND_TIME[3],
        PLACE_AND_TIME[4],
        PLACE_AND_TIME[5],
        PLACE_AND_TIME[6],
        PLACE_AND_TIME[7],
        PLACE_AND_TIME[8],
        COMPLEX_SUN,
        RESOLUTION,
        EXTEND,
        STRETCH,
    ],
};

/// The sky alone.
pub const SKY: Plugin = Plugin { name: "sky", help: "The sky of `sunsky` without its sun.", ..SUNSKY };

/// The sun alone.
pub const SUN: Plugin = Plugin { name: "sun", help: "The sun of `sunsky` without its sky.", ..SUNSKY };

/// All of them.
pub const ALL: &[Plugin] =
    &[AREA, POINT, SPOT, PROJECTOR, GONIOMETRIC, CONSTANT, DIRECTIONAL, ENVMAP, SUNSKY, SKY, SUN];

/// The plugin of an emitter that is not a surface.
#[must_use]
pub const fn of(kind: &EmitterKind) -> Plugin {
    match kind {
        EmitterKind::Point { .. } => POINT,
        EmitterKind::Spot { .. } => SPOT,
        EmitterKind::Projector { .. } => PROJECTOR,
        EmitterKind::Goniometric { .. } => GONIOMETRIC,
        EmitterKind::Constant { .. } => CONSTANT,
        EmitterKind::Directional { .. } => DIRECTIONAL,
        EmitterKind::Environment { .. } => ENVMAP,
    }
}
