//! Edits: from one description to the next.

use foton_input::quoted;
use foton_math::glam::DVec3;
use foton_scene::description::{Colour, EmitterKind, SceneDescription};
use thiserror::Error;

use foton_math::Rgb;

use super::camera::Camera;
use super::field::{Field, FieldId, Value};
use super::inspect::{inspect, up_axis};
use super::target::Target;
use super::{geometry, light, material};

/// A change of a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// Moves a shape or light, in world units.
    Move {
        /// What moves.
        target: Target,
        /// By how much.
        by: [f64; 3],
    },
    /// Sets what an inspector shows.
    SetField {
        /// Whose field.
        target: Target,
        /// Which field.
        field: FieldId,
        /// Its new value, one that the field [accepts](Field::accepts).
        value: Value,
    },
    /// Gives a shape a copy of its material, so that edits of it change no other shape.
    OwnMaterial {
        /// Index of the shape.
        shape: usize,
    },
    /// Moves a camera, or changes its field of view.
    Look {
        /// Index of the sensor.
        sensor: usize,
        /// The camera as it is to be.
        camera: Box<Camera>,
    },
}

/// Why an edit cannot be made.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum EditError {
    /// The shape, light or camera is not there.
    #[error("there is no such thing in the scene")]
    NoTarget,
    /// It has no such field.
    #[error("{} has no such field", quoted(.0))]
    NoField(String),
    /// The value is of another kind, or out of range.
    #[error("{0} cannot be {1:?}")]
    BadValue(&'static str, Value),
    /// Light from infinity has no place.
    #[error("{} has no place to move from", quoted(.0))]
    CannotMove(String),
    /// A move by NaN, or to infinity.
    #[error("that is not a place")]
    NotFinite,
}

impl Edit {
    /// What it does, as a step of the history: `move ring`.
    #[must_use]
    pub fn name(&self, description: &SceneDescription) -> String {
        match self {
            Self::Move { target, .. } => format!("move {}", title(description, *target)),
            Self::SetField { target, field, .. } => match find(description, *target, *field) {
                Ok(field) => format!("{} of {}", field.label.to_lowercase(), title(description, *target)),
                Err(_) => format!("edit {}", title(description, *target)),
            },
            Self::OwnMaterial { shape } => {
                format!("own material for {}", title(description, Target::Shape(*shape)))
            }
            Self::Look { .. } => "move camera".to_owned(),
        }
    }

    /// The description after it.
    ///
    /// # Errors
    /// When the scene has nothing like it, or the value does not fit; see [`EditError`].
    pub fn apply(&self, description: &SceneDescription) -> Result<SceneDescription, EditError> {
        let mut next = description.clone();
        match *self {
            Self::Move { target, by } => translate(&mut next, target, by.into())?,
            Self::SetField { target, field, value } => {
                let found = find(description, target, field)?;
                if !found.accepts(value) {
                    return Err(EditError::BadValue(found.label, value));
                }
                set(&mut next, target, &found, value)?;
            }
            Self::OwnMaterial { shape } => own_material(&mut next, shape)?,
            Self::Look { sensor, ref camera } => {
                let sensor = next.sensors.get_mut(sensor).ok_or(EditError::NoTarget)?;
                *sensor = camera.applied_to(sensor);
            }
        }
        Ok(next)
    }
}

fn title(description: &SceneDescription, target: Target) -> &str {
    let name = match target {
        Target::Shape(i) => description.shapes.get(i).map(|s| &s.name),
        Target::Emitter(i) => description.emitters.get(i).map(|e| &e.name),
    };
    name.map_or("nothing", String::as_str)
}

fn find(description: &SceneDescription, target: Target, id: FieldId) -> Result<Field, EditError> {
    let inspection = inspect(description, target).ok_or(EditError::NoTarget)?;
    let found = inspection.fields.into_iter().find(|f| f.id == id);
    found.ok_or(EditError::NoField(inspection.title))
}

fn translate(description: &mut SceneDescription, target: Target, by: DVec3) -> Result<(), EditError> {
    let finite = |p: DVec3| if p.is_finite() { Ok(()) } else { Err(EditError::NotFinite) };
    finite(by)?;
    match target {
        Target::Shape(i) => {
            let shape = description.shapes.get_mut(i).ok_or(EditError::NoTarget)?;
            geometry::translate(shape, by);
            finite(geometry::centre(shape))
        }
        Target::Emitter(i) => {
            let emitter = description.emitters.get_mut(i).ok_or(EditError::NoTarget)?;
            let position = match &mut emitter.kind {
                EmitterKind::Point { position, .. } => position,
                EmitterKind::Spot { to_world, .. } => &mut to_world.translation,
                _ => return Err(EditError::CannotMove(emitter.name.clone())),
            };
            *position += by;
            finite(*position)
        }
    }
}

/// Sets a field that the target has to a value that it accepts.
fn set(
    description: &mut SceneDescription,
    target: Target,
    field: &Field,
    value: Value,
) -> Result<(), EditError> {
    if let (FieldId::Position(axis), Value::Number(to), Value::Number(from)) = (field.id, value, field.value)
    {
        let mut by = DVec3::ZERO;
        by[usize::from(axis)] = to - from;
        return translate(description, target, by);
    }
    let up = up_axis(description);
    match target {
        Target::Emitter(i) => light::set(&mut description.emitters[i].kind, up, field.id, value),
        Target::Shape(i) => {
            let shape = &mut description.shapes[i];
            let material = &mut description.materials[shape.material];
            match (field.id, value, field.value) {
                (FieldId::Size | FieldId::Radius, Value::Number(to), Value::Number(from)) => {
                    geometry::scale(shape, to / from);
                }
                (FieldId::Material(side, property), ..) => material::set(material, side, property, value),
                (FieldId::Opacity, Value::Number(share), _) => {
                    let share = Colour::Constant(Rgb::splat(share as f32));
                    material.opacity = (share != Colour::Constant(Rgb::WHITE)).then_some(share);
                }
                _ => light::set_surface(shape, field.id, value),
            }
        }
    }
    Ok(())
}

fn own_material(description: &mut SceneDescription, shape: usize) -> Result<(), EditError> {
    let shape = description.shapes.get_mut(shape).ok_or(EditError::NoTarget)?;
    let mut own = description.materials.get(shape.material).ok_or(EditError::NoTarget)?.clone();
    let base = format!("{} of {}", own.name, shape.name);
    own.name.clone_from(&base);
    let mut number = 1;
    while description.materials.iter().any(|m| m.name == own.name) {
        number += 1;
        own.name = format!("{base} {number}");
    }
    shape.material = description.materials.len();
    description.materials.push(own);
    Ok(())
}
