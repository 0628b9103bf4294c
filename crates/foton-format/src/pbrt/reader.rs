//! What is known while a pbrt file is read; what each directive means is in the file of its kind.

use std::collections::HashMap;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;

use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::{Filter, Mesh, SceneDescription};

use super::made::{MadeMaterials, MadeTextures};
use super::names::Names;
use super::parameters::Parameters;
use super::state::{Definition, Open, Opened, State, Transforms};
use super::texture::Picture;
use super::version::Version;
use super::waiting::Shape;
use crate::diagnostic::{Place, Report};
use crate::files::Files;
use crate::image::Images;
use crate::mitsuba::read::spectrum::Spectrum;
use crate::suggested::Suggested;

/// What a camera's directive says, until the film is known.
pub(crate) struct Camera {
    pub(crate) parameters: Parameters,
    /// World to camera.
    pub(crate) transforms: Transforms,
}

/// An object that `ObjectInstance` places.
pub(crate) struct Object {
    pub(crate) name: String,
    pub(crate) shapes: Vec<Shape>,
    /// How often it stands somewhere.
    pub(crate) instances: usize,
}

/// The reader.
pub(crate) struct Reader<'a> {
    pub(crate) version: Version,
    pub(crate) report: Report,
    pub(crate) files: Files<'a>,
    pub(crate) images: Images,
    pub(crate) description: SceneDescription,
    pub(crate) suggested: Suggested,
    pub(crate) state: State,
    /// What is open, outermost first.
    pub(crate) open: Vec<Opened>,
    /// Files being read, outermost first.
    pub(crate) including: Vec<PathBuf>,
    pub(crate) files_included: usize,
    pub(crate) coordinate_systems: HashMap<String, Transforms>,
    pub(crate) materials: Names<Rc<Definition>>,
    /// Textures of numbers, and of colours.
    pub(crate) textures: [Names<Rc<Picture>>; 2],
    pub(crate) media: Names<()>,
    pub(crate) objects: HashMap<String, Rc<Object>>,
    /// The object that is being defined.
    pub(crate) object: Option<Object>,
    pub(crate) camera: Option<Camera>,
    pub(crate) film: Option<Parameters>,
    pub(crate) filter: Option<Filter>,
    /// Start and end of motion.
    pub(crate) times: [f64; 2],
    pub(crate) definitions: usize,
    pub(crate) made_textures: MadeTextures,
    pub(crate) made_materials: MadeMaterials,
    /// Meshes of files, and those that stand for other shapes, by what these are.
    pub(crate) meshes: HashMap<PathBuf, Option<Arc<Mesh>>>,
    pub(crate) round: HashMap<Vec<u64>, Arc<Mesh>>,
    /// Meshes with texture coordinates of their own, by those without.
    pub(crate) unfolded: HashMap<*const Mesh, (Arc<Mesh>, Arc<Mesh>)>,
    pub(crate) spectra: HashMap<PathBuf, Option<Rc<Spectrum>>>,
    /// Where parts of the description stand, by their names: of the first of them.
    pub(crate) places: HashMap<String, (String, Place)>,
}

impl<'a> Reader<'a> {
    pub(crate) fn new(version: Version, files: Files<'a>, report: Report) -> Self {
        let plugin = if version == Version::Three { "matte" } else { "diffuse" };
        let parameters = Parameters::new(plugin.to_owned(), Place::default(), Vec::new());
        let material =
            Definition { number: 0, name: "default".to_owned(), parameters, parts: Vec::new(), size: 1 };
        Self {
            version,
            report,
            files,
            images: Images::default(),
            description: SceneDescription::default(),
            suggested: Suggested::default(),
            state: State::new(Rc::new(material)),
            open: Vec::new(),
            including: Vec::new(),
            files_included: 0,
            coordinate_systems: HashMap::new(),
            materials: Names::default(),
            textures: [Names::default(), Names::default()],
            media: Names::default(),
            objects: HashMap::new(),
            object: None,
            camera: None,
            film: None,
            filter: None,
            times: [0.0, 1.0],
            definitions: 1,
            made_textures: MadeTextures::default(),
            made_materials: MadeMaterials::default(),
            meshes: HashMap::new(),
            round: HashMap::new(),
            unfolded: HashMap::new(),
            spectra: HashMap::new(),
            places: HashMap::new(),
        }
    }

    /// Whether the file is of version 3.
    pub(crate) fn is_old(&self) -> bool {
        self.version == Version::Three
    }

    /// The transform of what comes next, as the shutter opens.
    pub(crate) const fn place(&self) -> DAffine3 {
        self.state.transforms.first()
    }

    /// Takes memory for something that one statement may ask for many times; an error where there is none left.
    pub(crate) fn take(&mut self, bytes: u64, place: Place) -> bool {
        let taken = self.files.budget.take(bytes);
        taken.map_err(|message| self.report.error(place, message)).is_ok()
    }

    /// Remembers where a part of the description stands.
    pub(crate) fn remember(&mut self, name: &str, place: Place) {
        const MOST: usize = 10_000;
        if self.places.len() < MOST {
            self.places.insert(name.to_owned(), self.report.in_file(place));
        }
    }

    /// Opens something that an end closes later.
    pub(crate) fn open(&mut self, what: Open, place: Place) {
        const DEEPEST: usize = 1000;
        if self.open.len() == DEEPEST {
            self.report.error(place, format!("more than {DEEPEST} blocks stand inside one another"));
        }
        if self.open.len() < DEEPEST {
            self.open.push(Opened { what, place });
            if self.is_old() {
                self.begin_scope();
            }
        }
    }

    /// Begins a stretch of the file whose names hide those before.
    fn begin_scope(&mut self) {
        self.materials.begin();
        self.media.begin();
        self.textures.iter_mut().for_each(Names::begin);
    }

    /// Ends a stretch.
    pub(crate) fn end_scope(&mut self) {
        if self.is_old() {
            self.materials.end();
            self.media.end();
            self.textures.iter_mut().for_each(Names::end);
        }
    }

    /// A point of the space that comes next in the world.
    pub(crate) fn in_world(&self, point: DVec3) -> DVec3 {
        self.place().transform_point3(point)
    }
}
