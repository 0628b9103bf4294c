//! Shapes as plugins of Mitsuba 3, instances of a group among them.

use foton_film::WriteError;
use foton_math::glam::DAffine3;
use foton_scene::description::{Geometry, Keyframes, ShapeDescription};
use foton_scene::plugins::{emitters, shapes};

use super::Writer;
use super::groups::plugin_of;
use super::xml::{number, vector};
use crate::mitsuba::read::shapes::is_turned_inside_out;

impl Writer<'_> {
    /// Writes a shape as an instance of a group, and the group before the first one.
    pub(super) fn instance(
        &mut self,
        shape: &ShapeDescription,
        (id, is_hidden): (&str, bool),
        group: &mut Option<String>,
    ) -> Result<(), WriteError> {
        let group = match group {
            Some(group) => &*group,
            None => {
                let new = self.id(&format!("{id}-group"));
                self.xml.open("shape", &[("type", shapes::SHAPEGROUP.name), ("id", &new)]);
                // Whatever mirrors an instance, outside stays outside.
                let prototype = ShapeDescription { to_world: DAffine3::IDENTITY, ..shape.clone() };
                self.element(&prototype, (id, None), (false, None))?;
                self.xml.close("shape");
                &*group.insert(new)
            }
        };
        let xml = &mut self.xml;
        xml.open("shape", &[("type", shapes::INSTANCE.name), ("id", id)]);
        if is_hidden {
            xml.hidden();
        }
        xml.leaf("ref", &[("id", group)]);
        xml.transform("to_world", &shape.to_world);
        xml.close("shape");
        Ok(())
    }

    pub(super) fn shape(
        &mut self,
        shape: &ShapeDescription,
        id: &str,
        more: (bool, Option<&Keyframes>),
    ) -> Result<(), WriteError> {
        self.element(shape, (id, Some(id)), more)
    }

    /// Writes a shape under a name that its file may have, and an id if it has one.
    fn element(
        &mut self,
        shape: &ShapeDescription,
        (name, id): (&str, Option<&str>),
        (is_hidden, keyframes): (bool, Option<&Keyframes>),
    ) -> Result<(), WriteError> {
        let plugin = plugin_of(&shape.geometry);
        let filename = match &shape.geometry {
            Geometry::Mesh(mesh) if plugin == "ply" => Some(self.mesh(mesh, name)?),
            _ => None,
        };
        let xml = &mut self.xml;
        let mut attributes = vec![("type", plugin)];
        attributes.extend(id.map(|id| ("id", id)));
        xml.open("shape", &attributes);
        if is_hidden {
            xml.hidden();
        }
        match &shape.geometry {
            Geometry::Sphere { centre, radius } => {
                xml.value("point", shapes::CENTER.name, &vector(*centre));
                xml.value("float", shapes::RADIUS.name, &number(*radius));
            }
            Geometry::Cylinder { from, to, radius } => {
                xml.value("point", shapes::P0.name, &vector(*from));
                xml.value("point", shapes::P1.name, &vector(*to));
                xml.value("float", shapes::RADIUS.name, &number(*radius));
            }
            Geometry::Disc => {}
            Geometry::Mesh(mesh) => {
                if let Some(file) = filename {
                    xml.value("string", shapes::FILENAME.name, &file);
                    if mesh.normals.is_empty() {
                        xml.value("boolean", shapes::FACE_NORMALS.name, "true");
                    }
                }
            }
        }
        xml.placement("to_world", &shape.to_world, keyframes);
        let turned = is_mirrored(&shape.to_world) && is_turned_inside_out(plugin, &shape.geometry);
        if shape.flip_normals != turned {
            xml.value("boolean", shapes::FLIP_NORMALS.name, "true");
        }
        if let Some(material) = self.material_ids.get(shape.material) {
            xml.leaf("ref", &[("id", material)]);
        }
        if let Some(radiance) = shape.radiance {
            xml.open("emitter", &[("type", emitters::AREA.name)]);
            self.colour(emitters::RADIANCE.name, radiance);
            self.xml.close("emitter");
        }
        self.xml.close("shape");
        Ok(())
    }
}

fn is_mirrored(to_world: &DAffine3) -> bool {
    to_world.matrix3.determinant() < 0.0
}
