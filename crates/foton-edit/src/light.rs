//! Fields of lights: what they emit, with colour and brightness apart, and setting them.

use std::f64::consts::PI;

use foton_math::Rgb;
use foton_math::glam::{DMat3, DQuat, DVec3};
use foton_scene::description::{Colour, EmitterKind, ShapeDescription};
use foton_scene::parameter::Parameter;
use foton_scene::plugins::{emitters, sensors};

use super::camera::{FOV_RANGE, UpAxis};
use super::field::{FieldId, Fields, Value};
use super::geometry;

/// Powers that a slider offers.
const POWERS: (f64, f64, bool) = (1e-4, 1e6, true);

const COLOUR: &str = "Linear; its strongest channel counts as 1, so that brightness stays what it is.";

/// The factor from a spot's intensity to its power: ∫ over its cones, the falloff linear in the angle.
fn spot_solid_angle(cutoff_degrees: f64, beam_degrees: f64) -> f64 {
    let (c, b) = (cutoff_degrees.to_radians(), beam_degrees.min(cutoff_degrees).to_radians());
    let mean_cosine = if c - b > 1e-9 { (c.sin() - b.sin()) / (c - b) } else { c.cos() };
    2.0 * PI * (1.0 - mean_cosine)
}

fn strength(light: Rgb) -> f64 {
    f64::from(light.max_component())
}

/// The colour with its strongest channel 1; white where there is no light.
fn hue(light: Rgb) -> [f32; 3] {
    let most = light.max_component();
    if most > 0.0 && most.is_finite() {
        light.map(|x| (x / most).clamp(0.0, 1.0)).to_array()
    } else {
        [1.0; 3]
    }
}

/// Brightness, colour and power; `watts` is the power of a light of 1.
fn emission_fields(light: Rgb, emission: &Parameter, watts: Option<f64>, out: &mut Fields) {
    out.parameter(FieldId::Brightness, emission, strength(light));
    out.colour(FieldId::LightColour, "Light colour", hue(light), COLOUR);
    if let Some(watts) = watts {
        let power = f64::from(light.mean()) * watts;
        let help = "Over all directions, the mean of the channels: what photons share among them.";
        out.number(FieldId::Power, ("Power", "W"), power, POWERS, help);
    }
}

/// Sets brightness, colour or power. Light that has none gets a white one.
fn set_emission(light: &mut Rgb, watts: Option<f64>, field: FieldId, value: Value) {
    let bright = if light.is_black() { Rgb::WHITE } else { *light };
    let to = |size: f64, is: f64| bright * (size / is) as f32;
    match (field, value) {
        (FieldId::Brightness, Value::Number(x)) => *light = to(x, strength(bright)),
        (FieldId::Power, Value::Number(x)) => {
            *light = to(x, f64::from(bright.mean()) * watts.unwrap_or(1.0));
        }
        (FieldId::LightColour, Value::Colour(c)) => {
            let most = c.iter().copied().fold(0.0, f32::max);
            if most > 0.0 {
                *light = Rgb::from_array(c) * (strength(*light) as f32 / most);
            }
        }
        _ => {}
    }
}

/// Appends the fields of a shape that emits.
pub(crate) fn surface_fields(shape: &ShapeDescription, out: &mut Fields) {
    if let Some(Colour::Constant(radiance)) = shape.radiance {
        let watts = PI * geometry::area(shape);
        emission_fields(radiance, &emitters::RADIANCE, Some(watts), out);
    }
}

pub(crate) fn set_surface(shape: &mut ShapeDescription, field: FieldId, value: Value) {
    let watts = PI * geometry::area(shape);
    if let Some(Colour::Constant(radiance)) = &mut shape.radiance {
        set_emission(radiance, Some(watts), field, value);
    }
}

/// The factor to its power, where that is finite.
fn watts(kind: &EmitterKind) -> Option<f64> {
    match *kind {
        EmitterKind::Point { .. } => Some(4.0 * PI),
        EmitterKind::Spot { cutoff_degrees, beam_degrees, texture: None, .. } => {
            Some(spot_solid_angle(cutoff_degrees, beam_degrees))
        }
        _ => None,
    }
}

/// The kind of a light in words.
pub(crate) const fn kind_name(kind: &EmitterKind) -> &'static str {
    emitters::of(kind).label
}

/// Where a light comes from, if it has a direction.
fn origin(kind: &EmitterKind) -> Option<DVec3> {
    kind.axis().and_then(|axis| (-axis).try_normalize())
}

/// Appends the fields of a light without a surface, but its position.
pub(crate) fn fields(kind: &EmitterKind, up: UpAxis, out: &mut Fields) {
    if let Some(from) = origin(kind) {
        let (azimuth, elevation) = up.angles(from);
        let help = "Around the up axis, where its light comes from.";
        let azimuth = azimuth.to_degrees();
        out.number(FieldId::Azimuth, ("Azimuth", "°"), azimuth, (-180.0, 180.0, false), help);
        let help = "Above the horizon, where its light comes from.";
        let elevation = elevation.to_degrees();
        out.number(FieldId::Elevation, ("Elevation", "°"), elevation, (-89.9, 89.9, false), help);
    }
    let watts = watts(kind);
    match kind {
        EmitterKind::Point { intensity, .. } => {
            emission_fields(*intensity, &emitters::INTENSITY, watts, out);
        }
        EmitterKind::Spot { intensity, cutoff_degrees, beam_degrees, .. } => {
            emission_fields(*intensity, &emitters::INTENSITY, watts, out);
            out.parameter(FieldId::Cutoff, &emitters::CUTOFF_ANGLE, *cutoff_degrees);
            let beam = Parameter { range: (0.0, *cutoff_degrees), ..emitters::BEAM_WIDTH };
            out.parameter(FieldId::Beam, &beam, *beam_degrees);
        }
        EmitterKind::Constant { radiance } => {
            emission_fields(*radiance, &emitters::RADIANCE, watts, out);
        }
        EmitterKind::Directional { irradiance, .. } => {
            emission_fields(*irradiance, &emitters::IRRADIANCE, watts, out);
        }
        EmitterKind::Projector { irradiance, scale, fov_degrees, .. } => {
            if let Colour::Constant(c) = irradiance {
                emission_fields(*c * *scale as f32, &emitters::PROJECTED, watts, out);
            } else {
                out.parameter(FieldId::Brightness, &emitters::PROJECTED_SCALE, *scale);
            }
            let fov = Parameter { range: FOV_RANGE, ..sensors::FOV };
            out.parameter(FieldId::Cutoff, &fov, *fov_degrees);
        }
        EmitterKind::Goniometric { scale, .. } => {
            out.parameter(FieldId::Brightness, &emitters::INTENSITY_SCALE, f64::from(*scale));
        }
        EmitterKind::Environment { scale, .. } => {
            out.parameter(FieldId::Brightness, &emitters::SCALE, f64::from(*scale));
        }
    }
}

/// Sets a field of a light without a surface; the value fits the field.
pub(crate) fn set(kind: &mut EmitterKind, up: UpAxis, field: FieldId, value: Value) {
    if let (FieldId::Azimuth | FieldId::Elevation, Value::Number(degrees), Some(from)) =
        (field, value, origin(kind))
    {
        let (mut azimuth, mut elevation) = up.angles(from);
        if field == FieldId::Azimuth {
            azimuth = degrees.to_radians();
        } else {
            elevation = degrees.to_radians();
        }
        let now = up.direction(azimuth, elevation);
        rotate(kind, DQuat::from_rotation_arc(from, now));
        return;
    }
    let watts = watts(kind);
    match (kind, field, value) {
        (EmitterKind::Spot { cutoff_degrees, beam_degrees, .. }, FieldId::Cutoff, Value::Number(x)) => {
            *cutoff_degrees = x;
            *beam_degrees = beam_degrees.min(x);
        }
        (EmitterKind::Spot { beam_degrees, .. }, FieldId::Beam, Value::Number(x)) => *beam_degrees = x,
        (EmitterKind::Projector { fov_degrees, .. }, FieldId::Cutoff, Value::Number(x)) => *fov_degrees = x,
        (EmitterKind::Projector { irradiance: Colour::Constant(light), scale, .. }, ..) => {
            *light *= *scale as f32;
            *scale = 1.0;
            set_emission(light, watts, field, value);
        }
        (EmitterKind::Projector { scale, .. }, FieldId::Brightness, Value::Number(x)) => *scale = x,
        (
            EmitterKind::Environment { scale, .. } | EmitterKind::Goniometric { scale, .. },
            FieldId::Brightness,
            Value::Number(x),
        ) => *scale = x as f32,
        (
            EmitterKind::Point { intensity: light, .. }
            | EmitterKind::Spot { intensity: light, .. }
            | EmitterKind::Constant { radiance: light }
            | EmitterKind::Directional { irradiance: light, .. },
            ..,
        ) => set_emission(light, watts, field, value),
        (
            EmitterKind::Projector { .. } | EmitterKind::Goniometric { .. } | EmitterKind::Environment { .. },
            ..,
        ) => {}
    }
}

/// Turns a light; whether it has a direction to turn.
pub(crate) fn rotate(kind: &mut EmitterKind, rotation: DQuat) -> bool {
    match kind {
        EmitterKind::Spot { to_world, .. }
        | EmitterKind::Projector { to_world, .. }
        | EmitterKind::Goniometric { to_world, .. }
        | EmitterKind::Environment { to_world, .. } => {
            to_world.matrix3 = DMat3::from_quat(rotation) * to_world.matrix3;
        }
        EmitterKind::Directional { direction, .. } => *direction = rotation * *direction,
        EmitterKind::Point { .. } | EmitterKind::Constant { .. } => return false,
    }
    true
}
