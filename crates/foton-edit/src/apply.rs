//! Edits: from one description to the next.

use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::DVec3;
use foton_scene::description::{Colour, SceneDescription};

use super::additions::{self, NewThing, Site};
use super::camera::Camera;
use super::edit_error::EditError;
use super::field::{Field, FieldId, Value};
use super::inspect::{inspect, up_axis};
use super::remake::{self, Make};
use super::target::Target;
use super::{geometry, light, material, names, placing, things};

/// A change of a scene.
#[derive(Clone, Debug)]
pub enum Edit {
    /// Moves a shape or light, in world units.
    Move {
        /// What moves.
        target: Target,
        /// By how much.
        by: [f64; 3],
    },
    /// Turns a shape about its middle, or a light.
    Turn {
        /// What turns.
        target: Target,
        /// About which axis of the world.
        axis: [f64; 3],
        /// By how much, counter-clockwise seen from where the axis points.
        radians: f64,
    },
    /// Scales a shape about its middle.
    Scale {
        /// What is scaled.
        target: Target,
        /// By how much along each of its own axes.
        factors: [f64; 3],
    },
    /// Turns a light so that it shines at a point.
    Aim {
        /// Which light.
        target: Target,
        /// The point, in the world.
        at: [f64; 3],
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
    /// Gives a shape another material.
    Remake {
        /// Index of the shape.
        shape: usize,
        /// What it becomes.
        make: Make,
        /// The new material's name; one with a number where it is taken.
        name: String,
        /// Whether all shapes that share the old material get it.
        all: bool,
    },
    /// Gives a thing another name, which nothing has yet.
    Rename {
        /// Which one.
        target: Target,
        /// The name.
        name: String,
    },
    /// Hides a thing, or shows it again.
    Hide {
        /// Which one.
        target: Target,
        /// Whether it is hidden from now on.
        hide: bool,
    },
    /// Copies a thing.
    Duplicate {
        /// Which one.
        target: Target,
        /// How far from the old one the copy is, in world units.
        by: [f64; 3],
    },
    /// Takes a thing out of the scene.
    Delete(Target),
    /// Adds a thing.
    Add {
        /// What.
        thing: NewThing,
        /// Where.
        site: Site,
    },
    /// Adds the shapes of another description.
    Import {
        /// What the file is called.
        name: String,
        /// The other description.
        from: Arc<SceneDescription>,
        /// Where.
        site: Site,
    },
    /// Moves a camera, or changes its field of view.
    Look {
        /// Index of the sensor.
        sensor: usize,
        /// The camera as it is to be.
        camera: Box<Camera>,
    },
}

impl Edit {
    /// What it does, as a step of the history: `move ring`.
    #[must_use]
    pub fn name(&self, description: &SceneDescription) -> String {
        let of = |target: &Target| match names::of(description, *target) {
            "" => "nothing",
            name => name,
        };
        match self {
            Self::Move { target, .. } => format!("move {}", of(target)),
            Self::Turn { target, .. } => format!("rotate {}", of(target)),
            Self::Scale { target, .. } => format!("scale {}", of(target)),
            Self::Aim { target, .. } => format!("aim {}", of(target)),
            Self::SetField { target, field, .. } => match find(description, *target, *field) {
                Ok(field) => format!("{} of {}", field.label.to_lowercase(), of(target)),
                Err(_) => format!("edit {}", of(target)),
            },
            Self::OwnMaterial { shape } => format!("own material for {}", of(&Target::Shape(*shape))),
            Self::Remake { shape, name, .. } => format!("{name} for {}", of(&Target::Shape(*shape))),
            Self::Rename { target, .. } => format!("rename {}", of(target)),
            Self::Hide { target, hide: true } => format!("hide {}", of(target)),
            Self::Hide { target, hide: false } => format!("show {}", of(target)),
            Self::Duplicate { target, .. } => format!("duplicate {}", of(target)),
            Self::Delete(target) => format!("delete {}", of(target)),
            Self::Add { thing, .. } => format!("add {}", thing.name().to_lowercase()),
            Self::Import { name, .. } => format!("import {name}"),
            Self::Look { .. } => "move camera".to_owned(),
        }
    }

    /// Whether it changes nothing, whatever it is of: a drag that ends where it began.
    #[must_use]
    pub fn is_nothing(&self) -> bool {
        match self {
            Self::Move { by, .. } => *by == [0.0; 3],
            Self::Turn { radians, .. } => *radians == 0.0,
            Self::Scale { factors, .. } => *factors == [1.0; 3],
            _ => false,
        }
    }

    /// The description after it.
    ///
    /// # Errors
    /// When the scene has nothing like it, or the value does not fit; see [`EditError`].
    pub fn apply(&self, description: &SceneDescription) -> Result<SceneDescription, EditError> {
        Ok(self.apply_and_select(description)?.0)
    }

    /// The description after it, and what it made, if it made anything.
    ///
    /// # Errors
    /// As [`Edit::apply`].
    pub fn apply_and_select(
        &self,
        description: &SceneDescription,
    ) -> Result<(SceneDescription, Option<Target>), EditError> {
        let mut next = description.clone();
        let mut made = None;
        match self {
            Self::Move { target, by } => placing::translate(&mut next, *target, (*by).into())?,
            Self::Turn { target, axis, radians } => {
                placing::turn(&mut next, *target, (*axis).into(), *radians)?;
            }
            Self::Scale { target, factors } => placing::scale(&mut next, *target, (*factors).into())?,
            Self::Aim { target, at } => placing::aim(&mut next, *target, (*at).into())?,
            Self::SetField { target, field, value } => {
                let found = find(description, *target, *field)?;
                if !found.accepts(*value) {
                    return Err(EditError::BadValue(found.label, *value));
                }
                set(&mut next, *target, &found, *value)?;
            }
            Self::OwnMaterial { shape } => own_material(&mut next, *shape)?,
            Self::Remake { shape, make, name, all } => {
                remake::remake(&mut next, *shape, *make, name, *all)?;
            }
            Self::Rename { target, name } => things::rename(&mut next, *target, name)?,
            Self::Hide { target, hide } => things::hide(&mut next, *target, *hide)?,
            Self::Duplicate { target, by } => {
                made = Some(things::duplicate(&mut next, *target, (*by).into())?);
            }
            Self::Delete(target) => things::delete(&mut next, *target)?,
            Self::Add { thing, site } => made = Some(additions::add(&mut next, *thing, *site)?),
            Self::Import { from, site, .. } => made = additions::import(&mut next, from, *site),
            Self::Look { sensor, camera } => {
                let sensor = next.sensors.get_mut(*sensor).ok_or(EditError::NoTarget)?;
                *sensor = camera.applied_to(sensor);
            }
        }
        Ok((next, made))
    }
}

fn find(description: &SceneDescription, target: Target, id: FieldId) -> Result<Field, EditError> {
    let inspection = inspect(description, target).ok_or(EditError::NoTarget)?;
    let found = inspection.fields.into_iter().find(|f| f.id == id);
    found.ok_or(EditError::NoField(inspection.title))
}

/// Sets a field that the target has to a value that it accepts.
fn set(
    description: &mut SceneDescription,
    target: Target,
    field: &Field,
    value: Value,
) -> Result<(), EditError> {
    if let (Value::Number(to), Value::Number(from)) = (value, field.value) {
        match field.id {
            FieldId::Position(axis) => {
                let mut by = DVec3::ZERO;
                by[usize::from(axis)] = to - from;
                return placing::translate(description, target, by);
            }
            FieldId::Rotation(axis) => {
                return placing::set_angle(description, target, usize::from(axis), to);
            }
            FieldId::Extent(axis) => {
                let mut factors = DVec3::ONE;
                factors[usize::from(axis)] = to / from;
                return placing::scale(description, target, factors);
            }
            _ => {}
        }
    }
    let up = up_axis(description);
    match target {
        Target::Emitter(i) => light::set(&mut description.emitters[i].kind, up, field.id, value),
        Target::Sensor(i) => {
            let sensor = &mut description.sensors[i];
            match (field.id, value) {
                (FieldId::Width, Value::Number(n)) => sensor.resize(n.round() as u32, sensor.height),
                (FieldId::Height, Value::Number(n)) => sensor.resize(sensor.width, n.round() as u32),
                _ => {}
            }
        }
        Target::Shape(i) => set_shape(description, i, field, value),
    }
    Ok(())
}

fn set_shape(description: &mut SceneDescription, index: usize, field: &Field, value: Value) {
    let shape = &mut description.shapes[index];
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

fn own_material(description: &mut SceneDescription, shape: usize) -> Result<(), EditError> {
    let of = description.shapes.get(shape).ok_or(EditError::NoTarget)?;
    let mut own = description.materials.get(of.material).ok_or(EditError::NoTarget)?.clone();
    own.name = names::free(description, &format!("{} of {}", own.name, of.name));
    description.shapes[shape].material = description.materials.len();
    description.materials.push(own);
    Ok(())
}
