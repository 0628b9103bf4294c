//! Walks a `<scene>` and fills a description; what each plugin means is in the file of its kind.

use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use foton_input::{printable, quoted, shown};
use foton_scene::description::SceneDescription;

use crate::diagnostic::Report;
use crate::files::Files;
use crate::image::Images;
use crate::mesh::files::Meshes;
use crate::mitsuba::document::{Document, Element, NodeId};
use crate::mitsuba::names::Plugins;
use crate::mitsuba::read::attributes::check_attributes;
use crate::mitsuba::read::ids::Ids;
use crate::mitsuba::read::include::major_version;
use crate::mitsuba::read::known::{Materials, Textures};
use crate::mitsuba::read::properties::{Object, Properties};
use crate::mitsuba::read::spectrum::Spectrum;
use crate::mitsuba::read::usage;
use crate::opened::SceneNodes;
use crate::spelling::did_you_mean;
use crate::suggested::Suggested;

/// What is known while a scene is read.
pub(crate) struct Reader<'a> {
    pub(crate) document: &'a Document,
    pub(crate) ids: Ids<'a>,
    pub(crate) report: Report,
    pub(crate) files: Files<'a>,
    pub(crate) meshes: Meshes,
    pub(crate) images: Images,
    pub(crate) textures: Textures,
    pub(crate) materials: Materials,
    /// Spectra of files; `None` for one that cannot be read, which was reported.
    pub(crate) spectra: HashMap<PathBuf, Option<Rc<Spectrum>>>,
    pub(crate) description: SceneDescription,
    pub(crate) suggested: Suggested,
    pub(crate) nodes: SceneNodes,
    /// Area emitters of the scene itself, and whether a shape refers to them.
    pub(crate) loose_areas: HashMap<NodeId, bool>,
    /// A film and a filter that stand in no sensor: those without take them.
    pub(crate) loose_film: Option<Object<'a>>,
    pub(crate) loose_filter: Option<Object<'a>>,
}

impl<'a> Reader<'a> {
    pub(crate) fn new(document: &'a Document, files: Files<'a>, mut report: Report) -> Self {
        let ids = Ids::collect(document, &mut report);
        report.parts(usage::parts(document, &ids));
        Self {
            document,
            ids,
            report,
            files,
            meshes: Meshes::default(),
            images: Images::default(),
            textures: Textures::default(),
            materials: Materials::default(),
            spectra: HashMap::new(),
            description: SceneDescription::default(),
            suggested: Suggested::default(),
            nodes: SceneNodes::default(),
            loose_areas: HashMap::new(),
            loose_film: None,
            loose_filter: None,
        }
    }

    /// Reads everything inside the root.
    pub(crate) fn scene(&mut self) {
        let root = self.document.root();
        if !self.check_root(root) {
            return;
        }
        self.refuse_references(root);
        let mut contents = Properties::of(self.document, &self.ids, root, "scene", &mut self.report);
        self.loose_film = self.only_one(contents.nested("film"), "film");
        self.loose_filter = self.only_one(contents.nested("rfilter"), "rfilter");
        let integrators = contents.nested("integrator");
        if let Some(second) = integrators.get(1) {
            self.report.error(second.place, "a scene has only one integrator");
        }
        for integrator in integrators {
            self.integrator(integrator.node);
        }
        for sensor in contents.nested("sensor") {
            self.sensor(sensor.node);
        }
        self.say_loose();
        // Samplers do not change what an image converges to.
        contents.nested("sampler");
        let textures = contents.nested("texture");
        for bsdf in contents.nested("bsdf") {
            self.material(bsdf.node);
        }
        let emitters = contents.nested("emitter");
        for emitter in &emitters {
            self.scene_emitter(emitter.node);
        }
        let shapes = contents.nested("shape");
        for (i, shape) in shapes.iter().enumerate() {
            self.files.begin_part(i, shapes.len());
            if self.files.cancel().is_requested() {
                return;
            }
            if self.report.is_full() {
                break;
            }
            self.shape(shape.node);
        }
        for texture in textures {
            self.unused_texture(texture);
        }
        for emitter in emitters.iter().filter(|e| self.loose_areas.get(&e.node) == Some(&false)) {
            self.report.warning(emitter.place, "this area emitter belongs to no shape and lights nothing");
        }
        contents.finish(&mut self.report);
        if self.description.sensors.is_empty() {
            let place = self.document.element(root).map_or_else(Default::default, |e| e.place);
            self.report.warning(place, "the scene has no sensor");
        }
    }

    /// References directly inside the scene would have it twice what they mean, unless that has an effect only where it is used.
    fn refuse_references(&mut self, root: NodeId) {
        let has_effect = |node| {
            let target = self.document.element(node).map_or("", |e| e.name.as_str());
            matches!(target, "shape" | "emitter" | "sensor" | "integrator")
        };
        for (_, reference) in self.document.elements_in(root).filter(|(_, e)| e.name == "ref") {
            if self.ids.target(reference).is_some_and(has_effect) {
                self.report.error(reference.place, "<ref> directly inside the scene is not supported yet");
            }
        }
    }

    /// The first of some plugins; an error where there are more.
    pub(crate) fn only_one(&mut self, found: Vec<Object<'a>>, what: &str) -> Option<Object<'a>> {
        if let Some(second) = found.get(1) {
            self.report.error(second.place, format!("a scene has only one {what}"));
        }
        found.into_iter().next()
    }

    /// Whether the scene is a file of a version before 2.
    pub(crate) fn is_of_version_0(&self) -> bool {
        let root = self.document.element(self.document.root());
        let major = root.and_then(|root| major_version(root, &mut Report::new("", Path::new(""))));
        major.is_some_and(|major| major < 2)
    }

    /// Whether the root is a scene of a version that is read.
    fn check_root(&mut self, root: NodeId) -> bool {
        let Some(element) = self.document.element(root) else { return false };
        if element.name != "scene" {
            let message = format!("the outermost element is <{}>, not <scene>", shown(&element.name));
            self.report.error(element.place, message);
            return false;
        }
        check_attributes(element, &["version"], &["id", "name", "type"], &mut self.report);
        major_version(element, &mut self.report).is_some()
    }

    /// The contents of a plugin's element.
    pub(crate) fn properties(&mut self, node: NodeId, subject: &'a str) -> Properties<'a> {
        Properties::of(self.document, &self.ids, node, subject, &mut self.report)
    }

    /// The plugin that an element names, if it is one that is read; otherwise an error.
    pub(crate) fn plugin(&mut self, element: &Element, plugins: &Plugins) -> Option<&'static str> {
        let attribute = element.attribute("type").filter(|t| !t.broken)?;
        let name = attribute.value.as_str();
        let kind = plugins.kind;
        let supported = (plugins.supported)();
        if let Some(known) = supported.iter().find(|s| **s == name) {
            return Some(known);
        }
        let message = if plugins.elsewhere.contains(&name) {
            format!("{kind} {} is not supported yet", quoted(name))
        } else {
            let hint = did_you_mean(name, supported.iter().chain(plugins.elsewhere).copied());
            format!("unknown {kind} {}{hint}", quoted(name))
        };
        self.report.error(attribute.value_place, message);
        let supported: BTreeSet<_> = supported.into_iter().collect();
        let names = supported.into_iter().collect::<Vec<_>>().join(", ");
        self.report.help(format!("the {kind} plugins that foton reads are {names}"));
        None
    }

    /// The plugin that an element names, or the one that stands for those that are not read, with a warning.
    pub(crate) fn replaceable(
        &mut self,
        element: &Element,
        plugins: &Plugins,
        instead: &'static str,
    ) -> &'static str {
        let Some(attribute) = element.attribute("type").filter(|t| !t.broken) else { return instead };
        let supported = (plugins.supported)();
        if let Some(known) = supported.iter().find(|s| **s == attribute.value) {
            return known;
        }
        let (kind, name) = (plugins.kind, quoted(&attribute.value));
        let message = format!("{kind} {name} is not supported, \"{instead}\" stands for it");
        self.report.warning(attribute.value_place, message);
        instead
    }

    /// The id of an element, or `kind` and the number in its list. What is not printable in an id is escaped, and a very long one
    /// is cut and ends in the number, so that names can be shown wherever a scene is.
    pub(crate) fn name(&self, element: &Element, kind: &str, number: usize) -> String {
        let id = element.attribute("id");
        id.map_or_else(|| format!("{kind}-{number}"), |id| name_of(&id.value, number))
    }
}

/// The most characters of a name in a scene.
const MAX_NAME: usize = 200;

/// A name of a file as it stands in the scene: printable and of bearable length. `number` tells it from others that are cut.
pub(crate) fn name_of(name: &str, number: usize) -> String {
    match name.char_indices().nth(MAX_NAME) {
        Some((end, _)) => format!("{}…{number}", printable(&name[..end])),
        None => printable(name).into_owned(),
    }
}
