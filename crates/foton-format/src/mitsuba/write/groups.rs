//! Which shapes become instances: those that share a mesh and all that Mitsuba's instances cannot have of their own. A group of them is
//! a `shapegroup` with one shape.

use std::collections::HashMap;
use std::sync::Arc;

use foton_scene::description::{Geometry, Mesh, SceneDescription, ShapeDescription};

use super::mesh;

/// What instances of a group have in common: the mesh by its address, the material, and whether normals are turned around.
type Common = (*const Mesh, usize, bool);

/// The groups of a scene.
pub(super) struct Groups {
    /// How many shapes there are of each, and the id of its group once that is written.
    all: HashMap<Common, (usize, Option<String>)>,
    /// What moves stands for itself, by its index.
    moving: Vec<usize>,
}

impl Groups {
    pub(super) fn of_scene(scene: &SceneDescription) -> Self {
        let moving = scene.motion.shapes.keys().copied().collect();
        let mut groups = Self { all: HashMap::new(), moving };
        for (i, shape) in scene.shapes.iter().enumerate() {
            if let Some(common) = groups.common(shape, i) {
                groups.all.entry(common).or_default().0 += 1;
            }
        }
        groups
    }

    /// `None` for what cannot be an instance: Mitsuba's do not shine, and what its own plugins describe needs no group.
    fn common(&self, shape: &ShapeDescription, index: usize) -> Option<Common> {
        let Geometry::Mesh(mesh) = &shape.geometry else { return None };
        let stands_alone =
            shape.radiance.is_some() || self.moving.contains(&index) || plugin_of(&shape.geometry) != "ply";
        if stands_alone { None } else { Some((Arc::as_ptr(mesh), shape.material, shape.flip_normals)) }
    }

    /// The id of the group of a shape, which is to be written if there is none yet; `None` for a shape that shares nothing.
    pub(super) fn of(&mut self, shape: &ShapeDescription, index: usize) -> Option<&mut Option<String>> {
        let common = self.common(shape, index)?;
        self.all.get_mut(&common).filter(|(count, _)| *count > 1).map(|(_, id)| id)
    }
}

/// The plugin that describes a surface.
pub(super) fn plugin_of(geometry: &Geometry) -> &'static str {
    match geometry {
        Geometry::Sphere { .. } => "sphere",
        Geometry::Disc => "disk",
        Geometry::Cylinder { .. } => "cylinder",
        Geometry::Mesh(mesh) if mesh::same(mesh, &Mesh::rectangle()) => "rectangle",
        Geometry::Mesh(mesh) if mesh::same(mesh, &Mesh::cube()) => "cube",
        Geometry::Mesh(_) => "ply",
    }
}
