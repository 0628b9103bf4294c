//! Moving, turning, scaling and aiming what a description has.

use foton_math::glam::{DAffine3, DMat3, DQuat, DVec3, EulerRot};
use foton_scene::description::{EmitterKind, Geometry, SceneDescription, ShapeDescription};

use super::edit_error::EditError;
use super::target::Target;
use super::{geometry, light};

fn finite(p: DVec3) -> Result<(), EditError> {
    if p.is_finite() { Ok(()) } else { Err(EditError::NotFinite) }
}

/// Moves a shape or a light that has a place.
pub(crate) fn translate(
    description: &mut SceneDescription,
    target: Target,
    by: DVec3,
) -> Result<(), EditError> {
    finite(by)?;
    match target {
        Target::Shape(i) => {
            let shape = description.shapes.get_mut(i).ok_or(EditError::NoTarget)?;
            geometry::translate(shape, by);
            finite(geometry::centre(shape))
        }
        Target::Emitter(i) => {
            let emitter = description.emitters.get_mut(i).ok_or(EditError::NoTarget)?;
            let Some(position) = emitter.kind.position_mut() else {
                return Err(EditError::CannotMove(emitter.name.clone()));
            };
            *position += by;
            finite(*position)
        }
        Target::Sensor(i) => {
            let sensor = description.sensors.get(i).ok_or(EditError::NoTarget)?;
            Err(EditError::CannotMove(sensor.name.clone()))
        }
    }
}

/// Turns a shape about its middle, or a light that has a direction, about an axis of the world.
pub(crate) fn turn(
    description: &mut SceneDescription,
    target: Target,
    axis: DVec3,
    radians: f64,
) -> Result<(), EditError> {
    let axis = axis.try_normalize().filter(|_| radians.is_finite()).ok_or(EditError::NotFinite)?;
    rotate(description, target, DQuat::from_axis_angle(axis, radians))
}

fn rotate(description: &mut SceneDescription, target: Target, rotation: DQuat) -> Result<(), EditError> {
    match target {
        Target::Shape(i) => {
            let shape = description.shapes.get_mut(i).ok_or(EditError::NoTarget)?;
            about_middle(shape, DMat3::from_quat(rotation));
            Ok(())
        }
        Target::Emitter(i) => {
            let emitter = description.emitters.get_mut(i).ok_or(EditError::NoTarget)?;
            let turned = light::rotate(&mut emitter.kind, rotation);
            if turned { Ok(()) } else { Err(EditError::CannotTurn(emitter.name.clone())) }
        }
        Target::Sensor(i) => {
            let sensor = description.sensors.get(i).ok_or(EditError::NoTarget)?;
            Err(EditError::CannotTurn(sensor.name.clone()))
        }
    }
}

/// Applies a linear map to a shape, its middle staying where it is.
fn about_middle(shape: &mut ShapeDescription, map: DMat3) {
    let c = geometry::centre(shape);
    let moved = DAffine3::from_mat3(map) * DAffine3::from_translation(-c);
    shape.to_world = DAffine3::from_translation(c) * moved * shape.to_world;
}

/// Scales a shape about its middle along its own axes. Where it emits, its power stays.
pub(crate) fn scale(
    description: &mut SceneDescription,
    target: Target,
    factors: DVec3,
) -> Result<(), EditError> {
    let Target::Shape(i) = target else {
        return Err(EditError::CannotScale(super::names::of(description, target).to_owned()));
    };
    let shape = description.shapes.get_mut(i).ok_or(EditError::NoTarget)?;
    let refused = || Err(EditError::CannotScale(shape.name.clone()));
    if !factors.is_finite() || factors.min_element() <= 0.0 {
        return refused();
    }
    if factors.x == factors.y && factors.y == factors.z {
        geometry::scale(shape, factors.x);
    } else if matches!(shape.geometry, Geometry::Mesh(_)) {
        geometry::stretch(shape, factors);
    } else {
        return refused();
    }
    finite(geometry::centre(shape))
}

/// The way a light shines that can be aimed: a spot or the like, or a shape that emits to one side.
pub(crate) fn aim_of(description: &SceneDescription, target: Target) -> Option<(DVec3, DVec3)> {
    match target {
        Target::Shape(i) => {
            let shape = description.shapes.get(i).filter(|s| s.radiance.is_some())?;
            Some((geometry::centre(shape), geometry::facing(shape)?))
        }
        Target::Emitter(i) => {
            let kind = &description.emitters.get(i)?.kind;
            Some((kind.position()?, kind.axis()?.try_normalize()?))
        }
        Target::Sensor(_) => None,
    }
}

/// Turns a light so that it shines at a point.
pub(crate) fn aim(description: &mut SceneDescription, target: Target, at: DVec3) -> Result<(), EditError> {
    let refused = || EditError::CannotAim(super::names::of(description, target).to_owned());
    let (from, was) = aim_of(description, target).ok_or_else(refused)?;
    let now = (at - from).try_normalize().ok_or_else(refused)?;
    rotate(description, target, DQuat::from_rotation_arc(was, now))
}

/// The rotation in a shape's or an emitter's transform, without scale and mirroring.
fn orientation(m: DMat3) -> DMat3 {
    let x = m.x_axis.normalize_or(DVec3::X);
    let y = (m.y_axis - x * m.y_axis.dot(x)).try_normalize().unwrap_or_else(|| x.any_orthonormal_vector());
    DMat3::from_cols(x, y, x.cross(y))
}

fn matrix(description: &SceneDescription, target: Target) -> Option<DMat3> {
    match target {
        Target::Shape(i) => match description.shapes.get(i)? {
            // Its orientation is that of its picture alone.
            ShapeDescription { geometry: Geometry::Sphere { .. }, .. } => None,
            shape => Some(shape.to_world.matrix3),
        },
        Target::Emitter(i) => match &description.emitters.get(i)?.kind {
            EmitterKind::Environment { to_world, .. } => Some(to_world.matrix3),
            _ => None,
        },
        Target::Sensor(_) => None,
    }
}

/// Angles in degrees about x, y and z, in this order, that make up a thing's orientation.
pub(crate) fn angles(description: &SceneDescription, target: Target) -> Option<[f64; 3]> {
    let rotation = DQuat::from_mat3(&orientation(matrix(description, target)?));
    let (x, y, z) = rotation.to_euler(EulerRot::XYZ);
    Some([x, y, z].map(f64::to_degrees))
}

/// Turns a thing so that one of its [`angles`] is another.
pub(crate) fn set_angle(
    description: &mut SceneDescription,
    target: Target,
    axis: usize,
    degrees: f64,
) -> Result<(), EditError> {
    let mut to = angles(description, target).ok_or(EditError::NoTarget)?;
    let of = |a: [f64; 3]| {
        let [x, y, z] = a.map(f64::to_radians);
        DQuat::from_euler(EulerRot::XYZ, x, y, z)
    };
    let was = of(to);
    to[axis] = degrees;
    rotate(description, target, of(to) * was.inverse())
}
