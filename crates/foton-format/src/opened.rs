//! A scene as its file states it.

use std::collections::HashMap;
use std::path::PathBuf;

use foton_scene::description::SceneDescription;

use crate::diagnostic::{Diagnostic, Place, Severity};
use crate::mitsuba::document::{Document, NodeId};
use crate::options::Options;
use crate::suggested::Suggested;

/// A scene as its file states it.
#[derive(Clone, Debug)]
pub struct Opened {
    /// What to render.
    pub description: SceneDescription,
    /// What it was opened from.
    pub origin: Origin,
    /// The scene file; `None` for a scene from memory.
    pub path: Option<PathBuf>,
    /// All files of the disk that were read for it, itself among them: what is written must be none of these.
    pub files: Vec<PathBuf>,
    /// How it was read.
    pub options: Options,
    /// Settings that the file asks for.
    pub suggested: Suggested,
    /// What the file says without effect.
    pub warnings: Vec<Diagnostic>,
    /// Hash of the contents of the file and of those it names, and of the defines. The same on every platform.
    pub source_hash: u64,
}

/// What a scene was opened from.
#[derive(Clone, Debug)]
pub enum Origin {
    /// A Mitsuba scene.
    Mitsuba(MitsubaScene),
    /// A file of another kind. It is never written: what is edited of it becomes a Mitsuba scene of its own.
    Foreign(ForeignScene),
}

/// A file of another kind than Mitsuba's.
#[derive(Clone, Debug)]
pub struct ForeignScene {
    /// What messages call it, with its article: "a mesh file".
    pub kind: &'static str,
    /// Where the parts of the scene stand, by their names, as far as that is known: the file and the place in it.
    pub places: HashMap<String, (String, Place)>,
}

impl ForeignScene {
    /// A file of which it is not known where parts stand.
    #[must_use]
    pub fn new(kind: &'static str) -> Self {
        Self { kind, places: HashMap::new() }
    }
}

/// The text of a Mitsuba scene.
#[derive(Clone, Debug)]
pub struct MitsubaScene {
    /// The file's tree as it was written, before parameters were replaced.
    pub document: Document,
    /// Where in the document things stand.
    pub nodes: SceneNodes,
}

impl Origin {
    /// The text of the scene, if that is a Mitsuba scene.
    #[must_use]
    pub const fn mitsuba(&self) -> Option<&MitsubaScene> {
        match self {
            Self::Mitsuba(scene) => Some(scene),
            Self::Foreign(_) => None,
        }
    }
}

impl Opened {
    /// A finding about the part of the scene of that name, or about the whole file, which is called `file`. Its place is that of the
    /// part's element, or of the `<include>` that brings it.
    #[must_use]
    pub fn finding(&self, severity: Severity, file: &str, part: Option<&str>, message: String) -> Diagnostic {
        if let (Origin::Foreign(scene), Some(part)) = (&self.origin, part)
            && let Some((file, place)) = scene.places.get(part)
        {
            return Diagnostic::new(severity, file.clone(), *place, message);
        }
        let place = part.and_then(|part| self.place_of(part)).unwrap_or_default();
        Diagnostic::new(severity, file.to_owned(), place, message)
    }

    /// Where the element of the sensor, shape, emitter or material of that name stands.
    fn place_of(&self, part: &str) -> Option<Place> {
        let MitsubaScene { document, nodes } = self.origin.mitsuba()?;
        let named = &self.description;
        let sensor = named.sensors.iter().position(|s| s.name == part);
        let shape = named.shapes.iter().position(|s| s.name == part);
        let emitter = named.emitters.iter().position(|e| e.name == part);
        let material = named.materials.iter().position(|m| m.name == part);
        let found = sensor.and_then(|i| nodes.sensors.get(i).copied());
        let found = found.or_else(|| nodes.shapes.get(shape?).copied());
        let found = found.or_else(|| nodes.emitters.get(emitter?).copied());
        let found = found.or_else(|| *nodes.materials.get(material?)?);
        Some(document.element(found?)?.place)
    }
}

/// The elements that stand for what is in a description, in its order; for those of another file its `<include>`.
#[derive(Clone, Debug, Default)]
pub struct SceneNodes {
    /// Of the sensors.
    pub sensors: Vec<NodeId>,
    /// Of the materials; `None` for those of shapes that name none.
    pub materials: Vec<Option<NodeId>>,
    /// Of the shapes.
    pub shapes: Vec<NodeId>,
    /// Of the emitters that are not surfaces.
    pub emitters: Vec<NodeId>,
}
