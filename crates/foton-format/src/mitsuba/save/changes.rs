//! What changed between two descriptions, made in the document of the first.

use std::collections::HashMap;

use foton_math::Rgb;
use foton_math::glam::DAffine3;
use foton_scene::description::{
    Colour, EmitterKind, FovAxis, Geometry, Lens, SceneDescription, SensorDescription, ShapeDescription,
};
use foton_scene::plugins::{emitters, sensors, shapes};

use super::materials;
use super::pairs::Pairs;
use super::tree::Obstacle;
use crate::mitsuba::document::{Document, Element, NodeId};
use crate::mitsuba::names::is_called;
use crate::mitsuba::write::xml::{colour, matrix, number, single, vector};
use crate::opened::MitsubaScene;

/// A document that becomes that of the edited scene.
pub(super) struct Changes<'a> {
    pub(super) document: Document,
    pub(super) scene: &'a MitsubaScene,
    pub(super) old: &'a SceneDescription,
    pub(super) edited: &'a SceneDescription,
    /// Ids of new materials that stand in the document already, as they are written there.
    pub(super) placed: HashMap<usize, String>,
}

impl<'a> Changes<'a> {
    pub(super) fn new(
        scene: &'a MitsubaScene,
        old: &'a SceneDescription,
        edited: &'a SceneDescription,
    ) -> Self {
        Self { document: scene.document.clone(), scene, old, edited, placed: HashMap::new() }
    }

    /// Makes all changes that are known here.
    pub(super) fn make(&mut self) -> Result<(), Obstacle> {
        let (old, new) = (self.old, self.edited);
        if new.materials.len() < old.materials.len() {
            return Err("materials were taken away".to_owned());
        }
        self.sensors(&Pairs::of_sensors(old, new))?;
        // New materials are made of the old ones: those come after.
        self.shapes(&Pairs::of_shapes(old, new))?;
        for (i, (old, new)) in old.materials.iter().zip(&new.materials).enumerate() {
            if old.scatters_differently(new) {
                let node = self.scene.nodes.materials.get(i).copied().flatten();
                // What scatters light below a surface goes where another material takes the place of its stand-in.
                let node =
                    self.own(node, "bsdf", &old.name).or_else(|_| self.own(node, "subsurface", &old.name))?;
                materials::change(&mut self.document, node, old, new)?;
            }
        }
        self.emitters(&Pairs::of_emitters(old, new))
    }

    /// The element if it stands in the scene's own file.
    pub(super) fn own(&self, node: Option<NodeId>, tag: &str, name: &str) -> Result<NodeId, Obstacle> {
        let element = node.and_then(|n| self.document.element(n));
        match node.zip(element) {
            Some((node, element)) if element.name == tag => Ok(node),
            Some((_, element)) if element.name == "include" => {
                Err(format!("\"{name}\" stands in an included file"))
            }
            _ => Err(format!("\"{name}\" has no element in the file")),
        }
    }

    pub(super) fn value(&mut self, node: NodeId, tag: &str, name: &str, value: &str) -> Result<(), Obstacle> {
        self.document.set_value(node, tag, name, Some(value))
    }

    fn remove(&mut self, node: NodeId, name: &str) -> Result<(), Obstacle> {
        self.document.set_value(node, "", name, None)
    }

    pub(super) fn transform(&mut self, node: NodeId, to_world: &DAffine3) -> Result<(), Obstacle> {
        if self.document.elements_in(node).any(|(_, element)| element.name == "animation") {
            return Err(
                "what an <animation> moves was moved as a whole, which its keyframes do not say".to_owned()
            );
        }
        if *to_world == DAffine3::IDENTITY {
            return self.remove(node, "to_world");
        }
        let matrix = self.document.build("matrix", &[("value", &matrix(to_world))], Vec::new())?;
        let new = self.document.build("transform", &[("name", "to_world")], vec![matrix])?;
        let is_old = |e: &Element| e.attribute("name").is_some_and(|a| is_called(&a.value, "to_world"));
        self.document.replace_child(node, is_old, Some(new));
        Ok(())
    }

    fn light(&mut self, node: NodeId, name: &str, old: Rgb, new: Rgb) -> Result<(), Obstacle> {
        if old == new { Ok(()) } else { self.value(node, "rgb", name, &colour(new)) }
    }

    pub(super) fn sensor(
        &mut self,
        node: NodeId,
        old: &SensorDescription,
        new: &SensorDescription,
    ) -> Result<(), Obstacle> {
        if old.to_world != new.to_world {
            self.transform(node, &new.to_world)?;
        }
        if (old.fov_degrees, old.fov_axis) != (new.fov_degrees, new.fov_axis) {
            self.field_of_view(node, new.fov_degrees, new.fov_axis)?;
        }
        for (name, old, new) in
            [("near_clip", old.near_clip, new.near_clip), ("far_clip", old.far_clip, new.far_clip)]
        {
            match new {
                Some(clip) if old != new => self.value(node, "float", name, &number(clip))?,
                None if old != new => self.remove(node, name)?,
                _ => {}
            }
        }
        if sensors::of(old) != sensors::of(new) {
            self.document.set_attribute(node, "type", sensors::of(new).name);
        }
        self.lens(node, old.lens, new.lens)?;
        if (old.width, old.height) != (new.width, new.height) {
            let film = self.document.elements_in(node).find(|(_, e)| e.name == "film").map(|(film, _)| film);
            let film = film.ok_or_else(|| format!("the film of \"{}\" stands elsewhere", old.name))?;
            self.value(film, "integer", "width", &new.width.to_string())?;
            self.value(film, "integer", "height", &new.height.to_string())?;
        }
        Ok(())
    }

    /// A camera with another lens, or with one where there was none; one without it is another plugin.
    fn lens(&mut self, node: NodeId, old: Option<Lens>, new: Option<Lens>) -> Result<(), Obstacle> {
        if old == new {
            return Ok(());
        }
        let values = [
            (sensors::APERTURE_RADIUS.name, new.map(|lens| lens.aperture_radius)),
            (sensors::FOCUS_DISTANCE.name, new.map(|lens| lens.focus_distance)),
        ];
        for (name, value) in values {
            match value {
                Some(value) => self.value(node, "float", name, &number(value))?,
                None => self.remove(node, name)?,
            }
        }
        Ok(())
    }

    pub(super) fn emitter(
        &mut self,
        node: NodeId,
        old: &EmitterKind,
        new: &EmitterKind,
    ) -> Result<(), Obstacle> {
        match (old, new) {
            (
                EmitterKind::Point { position: p, intensity: old },
                EmitterKind::Point { position, intensity },
            ) => {
                if p != position {
                    self.remove(node, "to_world")?;
                    self.value(node, "point", emitters::POSITION.name, &vector(*position))?;
                }
                self.light(node, emitters::INTENSITY.name, *old, *intensity)
            }
            (old @ EmitterKind::Spot { .. }, new @ EmitterKind::Spot { .. }) => self.spot(node, old, new),
            (EmitterKind::Constant { radiance: old }, EmitterKind::Constant { radiance }) => {
                self.light(node, emitters::RADIANCE.name, *old, *radiance)
            }
            (
                EmitterKind::Directional { direction: d, irradiance: old },
                EmitterKind::Directional { direction, irradiance },
            ) => {
                if d != direction {
                    self.remove(node, "to_world")?;
                    self.value(node, "vector", emitters::DIRECTION.name, &vector(*direction))?;
                }
                self.light(node, emitters::IRRADIANCE.name, *old, *irradiance)
            }
            (old @ EmitterKind::Projector { .. }, new @ EmitterKind::Projector { .. }) => {
                self.projector(node, old, new)
            }
            (
                EmitterKind::Environment { to_world: m, .. },
                EmitterKind::Environment { to_world, scale, .. },
            )
            | (
                EmitterKind::Goniometric { to_world: m, .. },
                EmitterKind::Goniometric { to_world, scale, .. },
            ) => {
                if m != to_world {
                    self.transform(node, to_world)?;
                }
                self.value(node, "float", emitters::SCALE.name, &single(*scale))
            }
            _ => Err("an emitter changed its kind".to_owned()),
        }
    }

    fn spot(&mut self, node: NodeId, old: &EmitterKind, new: &EmitterKind) -> Result<(), Obstacle> {
        let (
            EmitterKind::Spot { to_world: m, intensity: old, texture: was, .. },
            EmitterKind::Spot { to_world, intensity, cutoff_degrees, beam_degrees, texture },
        ) = (old, new)
        else {
            return Err("an emitter changed its kind".to_owned());
        };
        if was != texture {
            return Err("a light got another texture".to_owned());
        }
        if m != to_world {
            self.transform(node, to_world)?;
        }
        self.value(node, "float", emitters::CUTOFF_ANGLE.name, &number(*cutoff_degrees))?;
        self.value(node, "float", emitters::BEAM_WIDTH.name, &number(*beam_degrees))?;
        self.light(node, emitters::INTENSITY.name, *old, *intensity)
    }

    /// A scale of its transform is a factor on its light, which descriptions have in one: both are stated anew.
    fn projector(&mut self, node: NodeId, old: &EmitterKind, new: &EmitterKind) -> Result<(), Obstacle> {
        let (
            EmitterKind::Projector {
                to_world: m,
                irradiance: was,
                scale: factor,
                fov_degrees: angle,
                fov_axis: axis,
            },
            EmitterKind::Projector { to_world, irradiance, scale, fov_degrees, fov_axis },
        ) = (old, new)
        else {
            return Err("an emitter changed its kind".to_owned());
        };
        match (was, irradiance) {
            (Colour::Constant(old), Colour::Constant(new)) => {
                self.light(node, emitters::PROJECTED.name, *old, *new)?;
            }
            (was, is) if was == is => {}
            _ => return Err("a light got another texture".to_owned()),
        }
        if (m, factor) != (to_world, scale) {
            self.transform(node, to_world)?;
            self.value(node, "float", emitters::PROJECTED_SCALE.name, &number(*scale))?;
        }
        if (angle, axis) != (fov_degrees, fov_axis) {
            self.field_of_view(node, *fov_degrees, *fov_axis)?;
        }
        Ok(())
    }

    /// An angle of view, in place of any other that is stated.
    fn field_of_view(&mut self, node: NodeId, degrees: f64, axis: FovAxis) -> Result<(), Obstacle> {
        self.remove(node, "focal_length")?;
        self.value(node, "float", "fov", &number(degrees))?;
        self.value(node, "string", "fov_axis", axis.name())
    }

    pub(super) fn shape(
        &mut self,
        node: Option<NodeId>,
        old: &ShapeDescription,
        new: &ShapeDescription,
    ) -> Result<(), Obstacle> {
        let geometry = changed_geometry(&old.geometry, &new.geometry);
        let changed = geometry
            || old.to_world != new.to_world
            || old.radiance != new.radiance
            || old.material != new.material;
        if !changed {
            return Ok(());
        }
        let node = self.own(node, "shape", &old.name)?;
        match &new.geometry {
            Geometry::Sphere { centre, radius } if geometry => {
                self.value(node, "point", shapes::CENTER.name, &vector(*centre))?;
                self.value(node, "float", shapes::RADIUS.name, &number(*radius))?;
            }
            // A tube may have been brought into the world when it was read.
            Geometry::Cylinder { from, to, radius } if geometry || old.to_world != new.to_world => {
                self.value(node, "point", shapes::P0.name, &vector(*from))?;
                self.value(node, "point", shapes::P1.name, &vector(*to))?;
                self.value(node, "float", shapes::RADIUS.name, &number(*radius))?;
                self.transform(node, &new.to_world)?;
            }
            _ => {}
        }
        if old.to_world != new.to_world {
            self.transform(node, &new.to_world)?;
        }
        if old.radiance != new.radiance {
            self.radiance(node, new.radiance)?;
        }
        if old.material != new.material { self.other_material(node, old, new) } else { Ok(()) }
    }

    pub(super) fn radiance(&mut self, node: NodeId, radiance: Option<Colour>) -> Result<(), Obstacle> {
        let radiance = match radiance {
            Some(Colour::Texture(_)) => return Err("a light got another texture".to_owned()),
            Some(Colour::Constant(c)) => Some(c),
            None => None,
        };
        let inside = self.document.elements_in(node).find(|(_, e)| e.name == "emitter").map(|(n, _)| n);
        if let (Some(emitter), Some(radiance)) = (inside, radiance) {
            return self.value(emitter, "rgb", emitters::RADIANCE.name, &colour(radiance));
        }
        let new = match radiance {
            Some(radiance) => {
                let attributes = [("name", "radiance"), ("value", &*colour(radiance))];
                let value = self.document.build("rgb", &attributes, Vec::new())?;
                Some(self.document.build("emitter", &[("type", "area")], vec![value])?)
            }
            None => None,
        };
        self.replace_object(node, "emitter", new);
        Ok(())
    }

    /// Puts a plugin's element, or nothing, in the place of the one of that tag, or of the reference to it.
    pub(super) fn replace_object(&mut self, node: NodeId, tag: &str, new: Option<NodeId>) {
        let is_it =
            |e: &Element| e.name == tag || self.document.referred(e).is_some_and(|(_, t)| t.name == tag);
        let refers = |e: &Element| e.name == "ref" && is_it(e);
        let old: Vec<_> =
            self.document.elements_in(node).filter(|(_, e)| e.name == tag || refers(e)).collect();
        let places: Vec<_> = old.iter().map(|(_, e)| (e.name.clone(), e.place)).collect();
        let is_old = |e: &Element| places.contains(&(e.name.clone(), e.place));
        self.document.replace_child(node, is_old, new);
    }

    /// Gives a shape another material: by reference if it stands in the file, or else a copy of its old one that is changed.
    fn other_material(
        &mut self,
        node: NodeId,
        old: &ShapeDescription,
        new: &ShapeDescription,
    ) -> Result<(), Obstacle> {
        if let Some(id) = self.id_of_material(new.material) {
            let reference = self.document.build("ref", &[("id", &id)], Vec::new())?;
            self.replace_object(node, "subsurface", None);
            self.replace_object(node, "bsdf", Some(reference));
            return Ok(());
        }
        let nodes = &self.scene.nodes.materials;
        let before = &self.old.materials[old.material];
        let after = self.edited.materials.get(new.material).ok_or("a material is not there")?;
        let id = self.free_id(&after.name);
        self.placed.insert(new.material, id.replace('$', "\\$"));
        let source = nodes.get(old.material).copied().flatten();
        let source = source.filter(|n| self.document.element(*n).is_some_and(|e| e.name == "bsdf"));
        let first = self.document.elements_in(node).next().map(|(child, _)| child);
        let here = first.map_or_else(String::new, |child| self.document.indentation(node, child));
        let copy = match source {
            Some(source) => {
                let parent = self.document.parent(source).unwrap_or(source);
                let there = self.document.indentation(parent, source);
                self.document.copy(source, [&there, &here])?
            }
            None => materials::build(&mut self.document, after, &here)?,
        };
        if let Some(element) = self.document.element_mut(copy) {
            element.attributes.retain(|a| a.name != "name");
        }
        self.document.set_attribute(copy, "id", &id.replace('$', "\\$"));
        self.replace_object(node, "subsurface", None);
        self.replace_object(node, "bsdf", Some(copy));
        if source.is_some() { materials::change(&mut self.document, copy, before, after) } else { Ok(()) }
    }

    pub(super) fn free_id(&self, name: &str) -> String {
        let is_taken = |id: &str| {
            self.document.elements().any(|(_, e)| e.attribute("id").is_some_and(|a| a.value == id))
        };
        let mut id = name.to_owned();
        let mut number = 1;
        while is_taken(&id) {
            number += 1;
            id = format!("{name}-{number}");
        }
        id
    }
}

fn changed_geometry(old: &Geometry, new: &Geometry) -> bool {
    match (old, new) {
        (Geometry::Sphere { centre: c, radius: r }, Geometry::Sphere { centre, radius }) => {
            (c, r) != (centre, radius)
        }
        (Geometry::Cylinder { from: a, to: b, radius: r }, Geometry::Cylinder { from, to, radius }) => {
            (a, b, r) != (from, to, radius)
        }
        _ => false,
    }
}
