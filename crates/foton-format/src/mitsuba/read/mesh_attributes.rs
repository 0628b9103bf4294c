//! Whether meshes state what textures on them show: an error names the texture that asks, the shape with its file, and what there is.

use std::collections::BTreeSet;

use foton_input::{quoted, shown_path};
use foton_scene::description::{Colour, Geometry, Mesh, TextureKind};

use crate::mitsuba::document::NodeId;
use crate::mitsuba::read::reader::Reader;
use crate::spelling::did_you_mean;

impl Reader<'_> {
    /// Checks the shape that was read last.
    pub(super) fn check_attributes(&mut self, node: NodeId) {
        let Some(shape) = self.description.shapes.last() else { return };
        let radiance = shape.radiance.and_then(texture);
        let mut open = vec![shape.material];
        let mut textures: Vec<usize> = radiance.into_iter().collect();
        let mut seen = BTreeSet::new();
        while let Some(index) = open.pop().filter(|i| seen.insert(*i)) {
            let Some(material) = self.description.materials.get(index) else { continue };
            textures.extend(material.textures());
            open.extend(material.mixture.iter().map(|blend| blend.material));
        }
        let mut missing = BTreeSet::new();
        while let Some(index) = textures.pop() {
            match self.description.textures.get(index).map(|t| &t.kind) {
                Some(TextureKind::Checkerboard { colours }) => {
                    textures.extend(colours.iter().copied().filter_map(texture));
                }
                Some(TextureKind::Attribute { name, .. }) if !has(&shape.geometry, name) => {
                    missing.insert((index, name.clone()));
                }
                _ => {}
            }
        }
        for (index, name) in missing {
            self.say_missing(node, index, &name);
        }
    }

    fn say_missing(&mut self, node: NodeId, index: usize, attribute: &str) {
        let Some(shape) = self.description.shapes.last() else { return };
        let names: Vec<String> = match &shape.geometry {
            Geometry::Mesh(mesh) => mesh.attributes.iter().map(|a| a.name.clone()).collect(),
            _ => Vec::new(),
        };
        let filename = self.document.elements_in(node).find_map(|(_, e)| {
            let is_it = e.attribute("name").is_some_and(|a| a.value == "filename");
            Some(shown_path(e.attribute("value").filter(|_| is_it)?.value.as_ref()))
        });
        let of = filename.map_or_else(String::new, |file| format!(" of {file}"));
        let hint = did_you_mean(attribute, names.iter().map(String::as_str));
        let shape = quoted(&shape.name);
        let place = self.textures.places.get(&index).copied().unwrap_or_default();
        let message = format!("the shape {shape}{of} has no attribute {}{hint}", quoted(attribute));
        if self.textures.lacking.insert((index, of)) {
            self.report.error(place, message);
            self.report.help(match names.is_empty() {
                true => "attributes are what PLY files state of their vertices and faces, and colours of OBJ files".to_owned(),
                false => format!("the mesh has {}", names.join(", ")),
            });
        }
    }
}

fn texture(colour: Colour) -> Option<usize> {
    if let Colour::Texture(index) = colour { Some(index) } else { None }
}

fn has(geometry: &Geometry, attribute: &str) -> bool {
    let states = |mesh: &Mesh| mesh.attributes.iter().any(|a| a.name == attribute);
    matches!(geometry, Geometry::Mesh(mesh) if states(mesh))
}
