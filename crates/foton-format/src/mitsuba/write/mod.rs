//! A scene description as a Mitsuba 3 scene: one XML file, with its meshes and images in folders beside it.
//!
//! What is written reads back as an equal description, and Mitsuba renders the same picture from it. Numbers are the
//! shortest that read back to the same bits. What the description does not hold (samplers, integrators by name) is
//! written as parameters with defaults, so that the file serves both programs. Shapes that share a mesh are instances of
//! one group, so that both hold the mesh once. Nothing is validated here; [`beyond`] says what Mitsuba 3 does not have.

pub(crate) mod beyond;
mod emitters;
mod files;
mod groups;
pub(crate) mod mesh;
mod names;
mod shapes;
pub(crate) mod surfaces;
pub(crate) mod xml;

use std::collections::{HashMap, HashSet};
use std::io::Write;
use std::path::{Path, PathBuf};

use foton_film::{WriteError, atomic_write};
use foton_scene::description::{
    Bitmap, EmitterDescription, EmitterKind, Filter, Geometry, Material, Mesh, Projection, SceneDescription,
    SensorDescription, ShapeDescription,
};
use foton_scene::plugins::sensors;

use groups::Groups;
use names::{file_name, mark};
use xml::{Xml, number};

/// Writes a description as the scene file `path`, its meshes as `meshes/NAME-….ply` and its images as
/// `textures/NAME-….exr` beside it, where `NAME` is that of the file. The scene file comes last.
///
/// Meshes and images get other names where theirs is that of a file in `kept`, by whatever link: those that a scene is made of;
/// and where it is that of a file which this did not write for the same scene file.
///
/// A box filter of another radius than half a pixel, which Mitsuba does not have, becomes one of half a pixel.
///
/// # Errors
/// [`WriteError`] with the path. Files of an earlier conversion are replaced one by one, each by a whole one.
///
/// # Panics
/// If an index in the description refers to nothing.
pub fn write_scene(description: &SceneDescription, path: &Path, kept: &[PathBuf]) -> Result<(), WriteError> {
    let stem = path.file_stem().map_or_else(|| "scene".to_owned(), |s| file_name(&s.to_string_lossy()));
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let mut writer = Writer::new(description, folder, stem, kept);
    writer.mark = mark(path);
    writer.scene()?;
    let text = writer.xml.finish();
    atomic_write(path, |file| file.write_all(text.as_bytes()))
}

/// A material without textures as its `<bsdf>` element.
pub(crate) fn material_xml(material: &Material) -> String {
    let description = SceneDescription::default();
    let mut writer = Writer::new(&description, PathBuf::new(), String::new(), &[]);
    writer.material(material);
    writer.xml.finish()
}

/// A shape without its material as its `<shape>` element; `None` for a mesh that is in a file.
pub(crate) fn shape_xml(shape: &ShapeDescription) -> Option<String> {
    let described = match &shape.geometry {
        Geometry::Mesh(mesh) => mesh::same(mesh, &Mesh::rectangle()) || mesh::same(mesh, &Mesh::cube()),
        _ => true,
    };
    let description = SceneDescription::default();
    let mut writer = Writer::new(&description, PathBuf::new(), String::new(), &[]);
    let written = described && writer.shape(shape, &shape.name, (false, None)).is_ok();
    written.then(|| writer.xml.finish())
}

/// An emitter as its `<emitter>` element; `None` for one that has a picture in a file.
pub(crate) fn emitter_xml(emitter: &EmitterDescription) -> Option<String> {
    let description = SceneDescription::default();
    let mut writer = Writer::new(&description, PathBuf::new(), String::new(), &[]);
    let is_picture =
        matches!(emitter.kind, EmitterKind::Environment { .. } | EmitterKind::Goniometric { .. });
    let described = !is_picture && emitter.kind.texture().is_none();
    let written = described && writer.emitter(emitter, false).is_ok();
    written.then(|| writer.xml.finish())
}

struct Writer<'a> {
    description: &'a SceneDescription,
    folder: PathBuf,
    /// What the names of all other files begin with.
    stem: String,
    /// Files that are not written to.
    kept: &'a [PathBuf],
    /// What stands in meshes and images that are written for this scene file.
    mark: String,
    xml: Xml,
    /// Ids that are taken.
    ids: HashSet<String>,
    /// Names of files that are taken, in lower case.
    files: HashSet<String>,
    /// Files of meshes and bitmaps that several things share, by address.
    meshes: HashMap<*const Mesh, String>,
    bitmaps: HashMap<*const Bitmap, String>,
    texture_ids: Vec<String>,
    material_ids: Vec<String>,
}

impl<'a> Writer<'a> {
    fn new(description: &'a SceneDescription, folder: PathBuf, stem: String, kept: &'a [PathBuf]) -> Self {
        Self {
            description,
            folder,
            stem,
            kept,
            mark: String::new(),
            xml: Xml::new(),
            ids: HashSet::new(),
            files: HashSet::new(),
            meshes: HashMap::new(),
            bitmaps: HashMap::new(),
            texture_ids: Vec::new(),
            material_ids: Vec::new(),
        }
    }

    fn scene(&mut self) -> Result<(), WriteError> {
        self.xml.open("scene", &[("version", "3.0.0")]);
        self.xml.leaf("default", &[("name", "integrator"), ("value", "path")]);
        self.xml.leaf("default", &[("name", "spp"), ("value", "64")]);
        self.xml.open("integrator", &[("type", "$integrator")]);
        let depth = self.description.max_depth.map_or(-1, i64::from);
        self.xml.value("integer", "max_depth", &depth.to_string());
        self.xml.close("integrator");
        // Shapes come first where names collide: theirs stand in every output.
        let shape_ids: Vec<String> = self.description.shapes.iter().map(|s| self.id(&s.name)).collect();
        for (i, sensor) in self.description.sensors.iter().enumerate() {
            self.sensor(i, sensor);
        }
        for texture in &self.description.textures {
            let id = self.texture(texture)?;
            self.texture_ids.push(id);
        }
        for (i, material) in self.description.materials.iter().enumerate() {
            // What is only blended with others stands inside of those.
            let is_inside = self.description.is_component(i);
            let id = if is_inside { String::new() } else { self.material(material) };
            self.material_ids.push(id);
        }
        for (i, emitter) in self.description.emitters.iter().enumerate() {
            self.emitter(emitter, self.description.hidden.emitters.contains(&i))?;
        }
        let mut groups = Groups::of_scene(self.description);
        for (i, (shape, id)) in self.description.shapes.iter().zip(&shape_ids).enumerate() {
            let hidden = self.description.hidden.shapes.contains(&i);
            match groups.of(shape, i) {
                Some(group) => self.instance(shape, (id, hidden), group)?,
                None => self.shape(shape, id, (hidden, self.description.motion.shapes.get(&i)))?,
            }
        }
        self.xml.close("scene");
        Ok(())
    }

    /// An id that is like a name and not taken.
    fn id(&mut self, name: &str) -> String {
        let name = if name.is_empty() { "unnamed" } else { name };
        let mut id = name.to_owned();
        let mut number = 1;
        while !self.ids.insert(id.clone()) {
            number += 1;
            id = format!("{name}-{number}");
        }
        id
    }

    fn sensor(&mut self, index: usize, sensor: &SensorDescription) {
        let (id, motion) = (self.id(&sensor.name), &self.description.motion);
        let xml = &mut self.xml;
        xml.open("sensor", &[("type", sensors::of(sensor).name), ("id", &id)]);
        if let Some(lens) = sensor.lens {
            xml.value("float", sensors::APERTURE_RADIUS.name, &number(lens.aperture_radius));
            xml.value("float", sensors::FOCUS_DISTANCE.name, &number(lens.focus_distance));
        }
        if sensor.projection == Projection::Perspective {
            xml.value("float", sensors::FOV.name, &number(sensor.fov_degrees));
            xml.value("string", sensors::FOV_AXIS.name, sensor.fov_axis.name());
        }
        for (name, clip) in sensors::clips(sensor) {
            xml.value("float", name, &number(clip));
        }
        for (parameter, offset) in sensors::OFFSETS.iter().zip(sensor.principal_point_offset) {
            if offset != 0.0 {
                xml.value("float", parameter.name, &number(offset));
            }
        }
        xml.placement("to_world", &sensor.to_world, motion.sensors.get(&index));
        if let Some([open, close]) = motion.shutters.get(&index) {
            xml.value("float", sensors::SHUTTER_OPEN.name, &number(*open));
            xml.value("float", sensors::SHUTTER_CLOSE.name, &number(*close));
        }
        xml.open("sampler", &[("type", "independent")]);
        xml.value("integer", "sample_count", "$spp");
        xml.close("sampler");
        xml.open("film", &[("type", "hdrfilm")]);
        xml.value("integer", "width", &sensor.width.to_string());
        xml.value("integer", "height", &sensor.height.to_string());
        if let Some(crop) = sensor.crop {
            xml.value("integer", "crop_offset_x", &crop.x.to_string());
            xml.value("integer", "crop_offset_y", &crop.y.to_string());
            xml.value("integer", "crop_width", &crop.width.to_string());
            xml.value("integer", "crop_height", &crop.height.to_string());
        }
        match sensor.filter {
            Filter::Box { .. } => xml.leaf("rfilter", &[("type", "box")]),
            Filter::Tent { radius } => xml.plugin("rfilter", "tent", &[("float", "radius", &number(radius))]),
            Filter::Gaussian { stddev } => {
                xml.plugin("rfilter", "gaussian", &[("float", "stddev", &number(stddev))]);
            }
        }
        xml.close("film");
        xml.close("sensor");
    }
}
