//! What a scene has: renaming, hiding, duplicating and deleting it.

use std::collections::BTreeSet;

use foton_math::glam::DVec3;
use foton_scene::description::{Hidden, SceneDescription};

use super::edit_error::EditError;
use super::target::Target;
use super::{names, placing};

/// Whether it is there.
fn check(description: &SceneDescription, target: Target) -> Result<(), EditError> {
    let (index, count) = match target {
        Target::Shape(i) => (i, description.shapes.len()),
        Target::Emitter(i) => (i, description.emitters.len()),
        Target::Sensor(i) => (i, description.sensors.len()),
    };
    if index < count { Ok(()) } else { Err(EditError::NoTarget) }
}

/// Gives it another name.
pub(crate) fn rename(
    description: &mut SceneDescription,
    target: Target,
    name: &str,
) -> Result<(), EditError> {
    check(description, target)?;
    let name = names::typed(name)?;
    if name == names::of(description, target) {
        return Ok(());
    }
    let name = names::typed_free(description, name)?.to_owned();
    if let Some(place) = names::of_mut(description, target) {
        *place = name;
    }
    Ok(())
}

/// What is hidden of a target's kind; `None` for cameras.
fn hidden_mut(hidden: &mut Hidden, target: Target) -> Option<(&mut BTreeSet<usize>, usize)> {
    match target {
        Target::Shape(i) => Some((&mut hidden.shapes, i)),
        Target::Emitter(i) => Some((&mut hidden.emitters, i)),
        Target::Sensor(_) => None,
    }
}

/// Whether a person has hidden it.
pub(crate) fn is_hidden(description: &SceneDescription, target: Target) -> bool {
    match target {
        Target::Shape(i) => description.hidden.shapes.contains(&i),
        Target::Emitter(i) => description.hidden.emitters.contains(&i),
        Target::Sensor(_) => false,
    }
}

/// Hides it, or shows it again.
pub(crate) fn hide(description: &mut SceneDescription, target: Target, hide: bool) -> Result<(), EditError> {
    check(description, target)?;
    let (hidden, index) = hidden_mut(&mut description.hidden, target).ok_or(EditError::CannotHide)?;
    if hide {
        hidden.insert(index);
    } else {
        hidden.remove(&index);
    }
    Ok(())
}

/// Whether a light all around may be added.
pub(crate) fn check_sky(description: &SceneDescription) -> Result<(), EditError> {
    let any = description.emitters.iter().any(|e| e.kind.is_around());
    if any { Err(EditError::OneSky) } else { Ok(()) }
}

/// Puts a copy beside it, at the end of its list.
pub(crate) fn duplicate(
    description: &mut SceneDescription,
    target: Target,
    by: DVec3,
) -> Result<Target, EditError> {
    check(description, target)?;
    let name = names::free(description, names::of(description, target));
    let copy = match target {
        Target::Shape(i) => {
            description.shapes.push(description.shapes[i].clone());
            description.motion.copy_shape(i, description.shapes.len() - 1);
            Target::Shape(description.shapes.len() - 1)
        }
        Target::Emitter(i) => {
            let kind = &description.emitters[i].kind;
            if kind.is_around() {
                return Err(EditError::OneSky);
            }
            description.emitters.push(description.emitters[i].clone());
            Target::Emitter(description.emitters.len() - 1)
        }
        Target::Sensor(i) => {
            description.sensors.push(description.sensors[i].clone());
            description.motion.copy_sensor(i, description.sensors.len() - 1);
            Target::Sensor(description.sensors.len() - 1)
        }
    };
    if let Some(place) = names::of_mut(description, copy) {
        *place = name;
    }
    match placing::translate(description, copy, by) {
        // Light from infinity is everywhere already.
        Ok(()) | Err(EditError::CannotMove(_)) => Ok(copy),
        Err(error) => Err(error),
    }
}

/// Takes it out of the scene.
pub(crate) fn delete(description: &mut SceneDescription, target: Target) -> Result<(), EditError> {
    check(description, target)?;
    match target {
        Target::Shape(i) => drop(description.shapes.remove(i)),
        Target::Emitter(i) => drop(description.emitters.remove(i)),
        Target::Sensor(_) if description.sensors.len() == 1 => return Err(EditError::LastCamera),
        Target::Sensor(i) => drop(description.sensors.remove(i)),
    }
    match target {
        Target::Shape(i) => description.motion.remove_shape(i),
        Target::Sensor(i) => description.motion.remove_sensor(i),
        Target::Emitter(_) => {}
    }
    if let Some((hidden, gone)) = hidden_mut(&mut description.hidden, target) {
        *hidden = hidden.iter().filter(|i| **i != gone).map(|i| if *i > gone { i - 1 } else { *i }).collect();
    }
    Ok(())
}
