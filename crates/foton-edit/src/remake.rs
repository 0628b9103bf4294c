//! Other materials for shapes: under a name of their own, so that nothing called gold is glass.

use foton_scene::description::{Material, SceneDescription};

use super::edit_error::EditError;
use super::field::Side;
use super::presets::presets;
use super::{material, names};

/// What a material becomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Make {
    /// A preset, by its place in [`presets`].
    Preset(usize),
    /// Another kind on a side, by its place in the list of kinds.
    Kind(Side, usize),
}

/// The material that a shape's becomes.
fn made(old: &Material, make: Make) -> Option<Material> {
    match make {
        Make::Preset(index) => Some(presets().get(index)?.material(String::new())),
        Make::Kind(side, kind) => {
            let mut new = old.clone();
            material::set_kind(&mut new, side, kind);
            Some(new)
        }
    }
}

/// Gives a shape, or with `all` every shape that has its material, another one of that name, or of one like
/// it that is free. The old one stays in the scene.
pub(crate) fn remake(
    description: &mut SceneDescription,
    shape: usize,
    make: Make,
    name: &str,
    all: bool,
) -> Result<(), EditError> {
    let old = description.shapes.get(shape).ok_or(EditError::NoTarget)?.material;
    let name = names::free(description, names::typed(name)?);
    let new = description.materials.get(old).and_then(|old| made(old, make)).ok_or(EditError::NoTarget)?;
    let index = description.materials.len();
    description.materials.push(Material { name, ..new });
    for (i, other) in description.shapes.iter_mut().enumerate() {
        if i == shape || (all && other.material == old) {
            other.material = index;
        }
    }
    Ok(())
}
