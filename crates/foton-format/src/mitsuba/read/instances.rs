//! `<shape type="instance">`: the shapes of a `shapegroup` once more, at another place. Each becomes a shape of its own; meshes share
//! their vertices. Mitsuba 3 was asked: an instance that is mirrored is not turned inside out, whatever its shapes are.

use std::collections::HashSet;

use foton_math::glam::DAffine3;
use foton_scene::description::Geometry;
use foton_scene::plugins::shapes::{INSTANCE, SHAPEGROUP, TO_WORLD};

use crate::mitsuba::document::{Element, NodeId};
use crate::mitsuba::read::properties::Object;
use crate::mitsuba::read::reader::Reader;

impl Reader<'_> {
    /// Reads an instance.
    pub(super) fn instance(&mut self, node: NodeId, element: &Element) {
        let mut p = self.properties(node, INSTANCE.name);
        let to_world = p.transform(TO_WORLD.name, &mut self.report).map_or(DAffine3::IDENTITY, |t| t.value);
        let nested = p.nested("shape");
        let is_group = |object: &Object<'_>| {
            object.element.attribute("type").is_some_and(|t| t.value == SHAPEGROUP.name)
        };
        let group = nested.first().copied().filter(|object| nested.len() == 1 && is_group(object));
        p.finish(&mut self.report);
        let Some(group) = group else {
            self.report
                .error(element.place, "an instance needs one shapegroup inside, or a reference to one");
            return;
        };
        let name = self.name(element, "instance", self.description.shapes.len() + 1);
        let members: Vec<NodeId> = self.members(group.node);
        let is_hidden = self.document.is_hidden(node);
        for member in members.iter().copied() {
            if self.files.cancel().is_requested() || self.report.is_full() {
                return;
            }
            let first = self.description.shapes.len();
            self.shape(member);
            // What is moved or taken away is the instance.
            self.nodes.shapes.truncate(first);
            self.nodes.shapes.resize(self.description.shapes.len(), node);
            for (i, shape) in self.description.shapes.iter_mut().enumerate().skip(first) {
                shape.to_world = to_world * shape.to_world;
                // One that is alone in its group has the name of the instance.
                shape.name = if members.len() == 1 { name.clone() } else { format!("{name}/{}", shape.name) };
                if is_hidden {
                    self.description.hidden.shapes.insert(i);
                }
                if self.description.motion.shapes.contains_key(&i) {
                    self.report.error(group.place, "what moves cannot stand inside a shapegroup yet");
                }
                let is_round = !matches!(shape.geometry, Geometry::Mesh(_));
                if is_round && super::transform::even_scale(to_world.matrix3, 1e-4).is_none() {
                    let message =
                        "the transform of an instance with spheres, disks or cylinders must scale evenly";
                    self.report.error(element.place, message);
                }
            }
        }
    }

    /// Reads a group by itself: nothing of it is seen, but its problems are.
    pub(super) fn shapegroup(&mut self, node: NodeId) {
        let mut p = self.properties(node, SHAPEGROUP.name);
        p.nested("shape");
        p.finish(&mut self.report);
    }

    /// The shapes of a group. Groups and instances inside one are refused, as by Mitsuba.
    fn members(&mut self, group: NodeId) -> Vec<NodeId> {
        let mut p = self.properties(group, SHAPEGROUP.name);
        let mut seen = HashSet::new();
        let mut members = Vec::new();
        for object in p.nested("shape") {
            let plugin = object.element.attribute("type").map_or("", |t| t.value.as_str());
            if [INSTANCE.name, SHAPEGROUP.name].contains(&plugin) {
                self.report.error(object.place, "a shapegroup cannot hold instances or other groups");
            } else if seen.insert(object.node) {
                members.push(object.node);
            }
        }
        members
    }
}
