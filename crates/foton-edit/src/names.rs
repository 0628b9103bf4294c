//! Names of things: every shape, light, camera, material and texture has one of its own.

use foton_input::printable;
use foton_scene::description::SceneDescription;

use super::edit_error::EditError;
use super::target::Target;

/// Characters of a name at most, as files have them.
const MAX_NAME: usize = 200;

/// The name of a thing; empty where there is none.
#[must_use]
pub fn of(description: &SceneDescription, target: Target) -> &str {
    let name = match target {
        Target::Shape(i) => description.shapes.get(i).map(|s| &s.name),
        Target::Emitter(i) => description.emitters.get(i).map(|e| &e.name),
        Target::Sensor(i) => description.sensors.get(i).map(|s| &s.name),
    };
    name.map_or("", String::as_str)
}

/// The place of a name.
pub(crate) fn of_mut(description: &mut SceneDescription, target: Target) -> Option<&mut String> {
    match target {
        Target::Shape(i) => description.shapes.get_mut(i).map(|s| &mut s.name),
        Target::Emitter(i) => description.emitters.get_mut(i).map(|e| &mut e.name),
        Target::Sensor(i) => description.sensors.get_mut(i).map(|s| &mut s.name),
    }
}

fn is_taken(description: &SceneDescription, name: &str) -> bool {
    let SceneDescription { sensors, materials, textures, shapes, emitters, .. } = description;
    shapes.iter().any(|s| s.name == name)
        || emitters.iter().any(|e| e.name == name)
        || sensors.iter().any(|s| s.name == name)
        || materials.iter().any(|m| m.name == name)
        || textures.iter().any(|t| t.name == name)
}

/// A name like the one that is wanted: with a number, where that is taken. A number at its end counts on: `ball-2`, `ball-3`.
pub(crate) fn free(description: &SceneDescription, wanted: &str) -> String {
    if !is_taken(description, wanted) {
        return wanted.to_owned();
    }
    let (base, last) = match wanted.rsplit_once('-') {
        Some((base, number)) if !base.is_empty() => match number.parse::<u32>() {
            Ok(number) => (base, u64::from(number)),
            Err(_) => (wanted, 1),
        },
        _ => (wanted, 1),
    };
    let mut number = last;
    loop {
        number += 1;
        let name = format!("{base}-{number}");
        if !is_taken(description, &name) {
            return name;
        }
    }
}

/// The name that a person typed, without white space around it.
///
/// # Errors
/// Where it is empty, too long or cannot be shown.
pub(crate) fn typed(name: &str) -> Result<&str, EditError> {
    let trimmed = name.trim();
    let is_good = !trimmed.is_empty() && trimmed.chars().count() <= MAX_NAME && printable(trimmed) == trimmed;
    if is_good { Ok(trimmed) } else { Err(EditError::BadName(trimmed.chars().take(MAX_NAME).collect())) }
}

/// The same, where nothing has that name.
///
/// # Errors
/// As [`typed`], and where it is taken.
pub(crate) fn typed_free<'a>(description: &SceneDescription, name: &'a str) -> Result<&'a str, EditError> {
    let name = typed(name)?;
    if is_taken(description, name) { Err(EditError::NameTaken(name.to_owned())) } else { Ok(name) }
}
