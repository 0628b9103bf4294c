//! Cameras of scene files, with their parameters.

use super::Plugin;
use crate::description::{Projection, SensorDescription};
use crate::parameter::{Kind, Parameter};

/// Where a camera stands, and which way it looks.
pub const TO_WORLD: Parameter = Parameter::other("to_world", Kind::Transform, "identity")
    .help("Camera to world: it looks along its +z, and +x points to the image's left. It must not scale.");

/// Angle of view.
pub const FOV: Parameter = Parameter::number("fov", 0.0, (f64::MIN_POSITIVE, 180.0))
    .label("Field of view")
    .unit("°")
    .help("Angle of view along `fov_axis`, below 180.")
    .default_text("by `focal_length`")
    .excludes(&["focal_length"]);

/// What the angle of view spans.
pub const FOV_AXIS: Parameter =
    Parameter::choice("fov_axis", &["x", "y", "diagonal", "smaller", "larger"]).help("What `fov` spans.");

/// Angle of view as that of a lens on 35 mm film.
pub const FOCAL_LENGTH: Parameter = Parameter::other("focal_length", Kind::Millimetres, "`50mm`")
    .help("Sets the angle of view to that of such a lens on 35 mm film; it blurs nothing.")
    .excludes(&["fov"]);

/// Where the camera begins to see.
pub const NEAR_CLIP: Parameter = Parameter::number("near_clip", 0.0, (f64::MIN_POSITIVE, f64::MAX))
    .help("Nothing nearer is seen, in world units along the camera's z.")
    .default_text("no bound");

/// Where the camera ends to see.
pub const FAR_CLIP: Parameter = Parameter::number("far_clip", 0.0, (f64::MIN_POSITIVE, f64::MAX))
    .help("Nothing farther is seen, in world units along the camera's z; beyond `near_clip`.")
    .default_text("no bound");

/// Radius of a lens.
pub const APERTURE_RADIUS: Parameter = Parameter::number("aperture_radius", 0.0, (0.0, f64::MAX))
    .label("Aperture radius")
    .unit("units")
    .help("Radius of the lens in world units: the larger, the more is blurred that is out of focus. 0 is a pinhole.")
    .default_text("required");

/// What a lens shows sharp.
pub const FOCUS_DISTANCE: Parameter = Parameter::number("focus_distance", 1e4, (f64::MIN_POSITIVE, f64::MAX))
    .label("Focus distance")
    .unit("units")
    .help("Depth along the camera's z at which things are sharp, in world units.")
    .default_text("`far_clip`, or 10000");

const fn offset(name: &'static str, help: &'static str) -> Parameter {
    Parameter::number(name, 0.0, (f64::MIN, f64::MAX)).help(help)
}

/// Where the middle of the image looks.
pub const OFFSETS: [Parameter; 2] = [
    offset(
        "principal_point_offset_x",
        "Where the middle of the image looks: so many of its widths to the right of the camera's z.",
    ),
    offset(
        "principal_point_offset_y",
        "Where the middle of the image looks: so many of its heights down from the camera's z.",
    ),
];

/// Where an orthographic camera stands, which way it looks, and how much it sees.
pub const TO_WORLD_AND_SCALE: Parameter = Parameter::other("to_world", Kind::Transform, "identity").help(
    "Camera to world: it looks along its +z, and +x points to the image's left. Without a scale the image is 2 units wide.",
);

/// When a camera begins to see.
pub const SHUTTER_OPEN: Parameter = Parameter::number("shutter_open", 0.0, (f64::MIN, f64::MAX))
    .help("When the shutter opens, in the time of `<animation>`.");

/// When a camera ends to see.
pub const SHUTTER_CLOSE: Parameter = Parameter::number("shutter_close", 0.0, (f64::MIN, f64::MAX))
    .help("When the shutter closes: what moves until then is blurred.")
    .default_text("`shutter_open`");

/// A camera with a pinhole.
pub const PERSPECTIVE: Plugin = Plugin {
    name: "perspective",
    label: "camera",
    help: "A camera with a pinhole, which shows everything sharp.",
    parameters: &[
        TO_WORLD,
        FOV,
        FOV_AXIS,
        FOCAL_LENGTH,
        NEAR_CLIP,
        FAR_CLIP,
        OFFSETS[0],
        OFFSETS[1],
        SHUTTER_OPEN,
        SHUTTER_CLOSE,
    ],
};

/// A camera with a lens.
pub const THINLENS: Plugin = Plugin {
    name: "thinlens",
    label: "camera with a lens",
    help: "A camera with a thin lens, which blurs what is nearer or farther than the plane in focus.",
    parameters: &[
        APERTURE_RADIUS,
        FOCUS_DISTANCE,
        TO_WORLD,
        FOV,
        FOV_AXIS,
        FOCAL_LENGTH,
        NEAR_CLIP,
        FAR_CLIP,
        OFFSETS[0],
        OFFSETS[1],
        SHUTTER_OPEN,
        SHUTTER_CLOSE,
    ],
};

/// A camera without perspective.
pub const ORTHOGRAPHIC: Plugin = Plugin {
    name: "orthographic",
    label: "orthographic camera",
    help: "A camera without perspective: rays are parallel to its z, and the scale of `to_world` says how much it sees.",
    parameters: &[
        TO_WORLD_AND_SCALE,
        NEAR_CLIP,
        FAR_CLIP,
        OFFSETS[0],
        OFFSETS[1],
        SHUTTER_OPEN,
        SHUTTER_CLOSE,
    ],
};

/// A camera without perspective that has a lens.
pub const TELECENTRIC: Plugin = Plugin {
    name: "telecentric",
    label: "orthographic camera with a lens",
    help: "An orthographic camera with a thin lens, as in Mitsuba 0.6.",
    parameters: &[
        APERTURE_RADIUS,
        FOCUS_DISTANCE,
        TO_WORLD_AND_SCALE,
        NEAR_CLIP,
        FAR_CLIP,
        OFFSETS[0],
        OFFSETS[1],
        SHUTTER_OPEN,
        SHUTTER_CLOSE,
    ],
};

/// All of them.
pub const ALL: &[Plugin] = &[PERSPECTIVE, THINLENS, ORTHOGRAPHIC, TELECENTRIC];

/// The plugin of a camera.
#[must_use]
pub const fn of(sensor: &SensorDescription) -> Plugin {
    match (sensor.projection, sensor.lens.is_some()) {
        (Projection::Perspective, false) => PERSPECTIVE,
        (Projection::Perspective, true) => THINLENS,
        (Projection::Orthographic, false) => ORTHOGRAPHIC,
        (Projection::Orthographic, true) => TELECENTRIC,
    }
}

/// The depths between which a camera sees, by their names, as files state them: of an orthographic one Mitsuba stretches the nearer one as
/// `to_world` does the camera's z, but not what lies between them.
pub fn clips(sensor: &SensorDescription) -> impl Iterator<Item = (&'static str, f64)> {
    let depth_scale = match sensor.projection {
        Projection::Perspective => 1.0,
        Projection::Orthographic => sensor.to_world.matrix3.z_axis.length(),
    };
    let near = sensor.near_clip.map(|near| near / depth_scale);
    let moved_by = near.map_or(0.0, |near| near * depth_scale - near);
    let far = sensor.far_clip.map(|far| far - moved_by);
    [near.map(|near| (NEAR_CLIP.name, near)), far.map(|far| (FAR_CLIP.name, far))].into_iter().flatten()
}
