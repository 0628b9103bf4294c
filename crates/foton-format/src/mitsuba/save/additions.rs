//! New shapes, emitters and cameras in a document.

use std::sync::Arc;

use foton_scene::description::{
    EmitterDescription, EmitterKind, Geometry, SensorDescription, ShapeDescription,
};

use super::changes::Changes;
use super::materials;
use super::tree::Obstacle;
use crate::mitsuba::document::NodeId;
use crate::mitsuba::write::{emitter_xml, shape_xml};

impl Changes<'_> {
    /// The white space before elements of the scene.
    fn indentation(&self) -> String {
        let root = self.document.root();
        let first = self.document.elements_in(root).next().map(|(child, _)| child);
        first.map_or_else(String::new, |child| self.document.indentation(root, child))
    }

    /// Puts an element at the end of the scene, under a name.
    fn append(&mut self, element: NodeId, name: &str) {
        self.document.set_attribute(element, "id", &name.replace('$', "\\$"));
        self.document.append_child(self.document.root(), element);
    }

    pub(super) fn add_shape(&mut self, new: &ShapeDescription) -> Result<NodeId, Obstacle> {
        let indentation = self.indentation();
        if let Some(text) = shape_xml(new) {
            let node = self.document.build_text(&text, &indentation)?;
            let material = self.material(new.material, &format!("{indentation}    "))?;
            self.document.append_child(node, material);
            self.append(node, &new.name);
            return Ok(node);
        }
        let is_copy = |old: &ShapeDescription| match (&old.geometry, &new.geometry) {
            (Geometry::Mesh(old), Geometry::Mesh(new)) => Arc::ptr_eq(old, new),
            _ => false,
        };
        let source = self.old.shapes.iter().position(is_copy);
        let source =
            source.ok_or_else(|| format!("the mesh of \"{}\" is in no file of the scene", new.name))?;
        let old = &self.old.shapes[source];
        let node = self.own(self.scene.nodes.shapes.get(source).copied(), "shape", &old.name)?;
        let copy = self.document.copy(node, ["", ""])?;
        self.shape(Some(copy), old, new)?;
        self.append(copy, &new.name);
        Ok(copy)
    }

    pub(super) fn add_emitter(&mut self, new: &EmitterDescription) -> Result<NodeId, Obstacle> {
        if let Some(text) = emitter_xml(new) {
            let node = self.document.build_text(&text, &self.indentation())?;
            self.append(node, &new.name);
            return Ok(node);
        }
        let is_copy = |old: &EmitterDescription| match (&old.kind, &new.kind) {
            (EmitterKind::Environment { bitmap: old, .. }, EmitterKind::Environment { bitmap: new, .. })
            | (EmitterKind::Goniometric { bitmap: old, .. }, EmitterKind::Goniometric { bitmap: new, .. }) => {
                Arc::ptr_eq(old, new)
            }
            (old, new) => {
                let same_kind = std::mem::discriminant(old) == std::mem::discriminant(new);
                same_kind && new.texture().is_some() && old.texture() == new.texture()
            }
        };
        let source = self.old.emitters.iter().position(is_copy);
        let source = source.ok_or_else(|| format!("the picture of \"{}\" is in no file", new.name))?;
        let old = &self.old.emitters[source];
        let node = self.own(self.scene.nodes.emitters.get(source).copied(), "emitter", &old.name)?;
        let copy = self.document.copy(node, ["", ""])?;
        self.emitter(copy, &old.kind, &new.kind)?;
        self.append(copy, &new.name);
        Ok(copy)
    }

    /// A camera, made of the first one: that has what descriptions do not say.
    pub(super) fn add_sensor(&mut self, new: &SensorDescription) -> Result<(), Obstacle> {
        let old = self.old.sensors.first().ok_or("the file has no camera to make one of")?;
        let node = self.own(self.scene.nodes.sensors.first().copied(), "sensor", &old.name)?;
        let copy = self.document.copy(node, ["", ""])?;
        self.sensor(copy, old, new)?;
        self.append(copy, &new.name);
        Ok(())
    }

    /// The id of a material that stands in the document, as it is written there; one that has none gets one.
    pub(super) fn id_of_material(&mut self, index: usize) -> Option<String> {
        if let Some(id) = self.placed.get(&index) {
            return Some(id.clone());
        }
        let node = self.scene.nodes.materials.get(index).copied().flatten()?;
        let element = self.document.element(node).filter(|e| e.name == "bsdf")?;
        if let Some(id) = element.attribute("id") {
            return Some(id.value.clone());
        }
        let id = self.free_id(&self.old.materials[index].name).replace('$', "\\$");
        self.document.set_attribute(node, "id", &id);
        Some(id)
    }

    /// What says in a new shape which material it has: a reference, or the material itself where it is new.
    fn material(&mut self, index: usize, indentation: &str) -> Result<NodeId, Obstacle> {
        if let Some(id) = self.id_of_material(index) {
            return self.document.build("ref", &[("id", &id)], Vec::new());
        }
        let material = self.edited.materials.get(index).ok_or("a material is not there")?;
        let id = self.free_id(&material.name).replace('$', "\\$");
        let node = materials::build(&mut self.document, material, indentation)?;
        self.document.set_attribute(node, "id", &id);
        self.placed.insert(index, id);
        Ok(node)
    }
}
