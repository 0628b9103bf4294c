//! Scene files and meshes to scene descriptions; the only reader of scene files.
//!
//! The format is a subset of Mitsuba 3's XML, so that one file renders alike in both; files of its predecessor (version
//! 0.6) are read, too. All problems of a file are found in one go, each with its place and the nearest known name.
//! Nothing is rendered or downloaded here, and media are not read.
//!
//! ```
//! let xml = r#"<scene version="3.0.0">
//!     <default name="r" value="1"/>
//!     <sensor type="perspective"/>
//!     <shape type="sphere"><float name="radius" value="$r"/><emitter type="area"/></shape>
//! </scene>"#;
//! let no_files = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
//! let options = foton_format::Options { defines: vec![("r".into(), "2".into())], ..Default::default() };
//! let opened = foton_format::read_str("ball.xml", xml, &no_files, &options).unwrap();
//! assert_eq!(opened.description.shapes.len(), 1);
//! ```

mod bare;
mod bsdfs;
mod colours;
mod diagnostic;
mod document;
mod emitters;
mod files;
mod hash;
mod ids;
mod images;
mod include;
mod integrator;
mod limits;
mod materials;
mod meshes;
mod metals;
mod mtl;
mod names;
mod obj;
mod ply;
mod polygons;
mod properties;
mod reader;
mod save;
mod sensor;
mod serialized;
mod shapes;
mod spectrum;
mod stl;
mod substitute;
mod tally;
mod textures;
mod transform;
mod upgrade;
mod values;
mod words;
mod write;

use std::cell::RefCell;
use std::io;
use std::path::{Path, PathBuf};

use foton_input::{Limit, Named};
use foton_math::Cancel;
use foton_scene::description::SceneDescription;

pub use diagnostic::{Diagnostic, OpenError, Place, Severity};
pub use document::{Attribute, Document, Element, MAX_DEPTH, Node, NodeId};
pub use integrator::Suggested;
pub use save::{Saved, save_edited};
pub use write::write_scene;

use diagnostic::Report;
use files::Files;
use hash::Fnv1a;
use limits::Budget;
use reader::Reader;

/// Reads a file that a scene names.
pub type ReadFile<'a> = dyn Fn(&Path) -> io::Result<Vec<u8>> + 'a;

/// How to read a scene.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Parameters as name and value, stronger than the file's `<default>`s; of two with a name the last holds.
    pub defines: Vec<(String, String)>,
    /// Bytes that reading may take; `None`: as many as there are. What [`open`] could not read within that is refused unread.
    pub memory: Option<u64>,
    /// Ends reading within a fraction of a second: then the outcome is [`OpenError::Cancelled`].
    pub cancel: Cancel,
}

impl Options {
    /// The same, once reading is over.
    fn without_cancel(&self) -> Self {
        Self { cancel: Cancel::default(), ..self.clone() }
    }

    /// Reads a file of the disk, or refuses it by its kind or size; an error of some kind once cancelled.
    fn read(&self, path: &Path, named: Named) -> io::Result<Vec<u8>> {
        foton_input::read_file(path, named, Limit::new(self.memory, BYTES_PER_BYTE), &|| {
            self.cancel.is_requested()
        })
    }
}

/// The most bytes that reading takes for each of a file, its own included; fuzzing holds all readers of meshes to that.
const BYTES_PER_BYTE: u64 = 4;

/// A scene as its file states it.
#[derive(Clone, Debug)]
pub struct Opened {
    /// What to render.
    pub description: SceneDescription,
    /// The file's tree as it was written, before parameters were replaced.
    pub document: Document,
    /// Where in the document things stand.
    pub nodes: SceneNodes,
    /// The scene file; `None` for a scene from memory and for a mesh file.
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

impl Opened {
    /// A finding about the part of the scene of that name, or about the whole file, which is called `file`. Its place is that of the
    /// part's element, or of the `<include>` that brings it.
    #[must_use]
    pub fn finding(&self, severity: Severity, file: &str, part: Option<&str>, message: String) -> Diagnostic {
        let place = part.and_then(|part| self.node_of(part)).and_then(|node| self.document.element(node));
        let Place { line, column } = place.map_or_else(Place::default, |element| element.place);
        Diagnostic { severity, file: file.to_owned(), line, column, message }
    }

    /// The element of the sensor, shape, emitter or material of that name.
    fn node_of(&self, part: &str) -> Option<NodeId> {
        let (named, nodes) = (&self.description, &self.nodes);
        let sensor = named.sensors.iter().position(|s| s.name == part);
        let shape = named.shapes.iter().position(|s| s.name == part);
        let emitter = named.emitters.iter().position(|e| e.name == part);
        let material = named.materials.iter().position(|m| m.name == part);
        let found = sensor.and_then(|i| nodes.sensors.get(i).copied());
        let found = found.or_else(|| nodes.shapes.get(shape?).copied());
        let found = found.or_else(|| nodes.emitters.get(emitter?).copied());
        let found = found.or_else(|| *nodes.materials.get(material?)?);
        // In place of a mesh file there is an empty document, and its root stands for all shapes.
        found.filter(|node| *node != self.document.root())
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

/// Opens a scene file; the files that it names are found from its folder. An OBJ, PLY or STL file is a whole scene: what
/// it lacks is added, and a warning says so.
///
/// # Errors
/// Everything that is wrong with the file, unless it is not well-formed XML: then the first problem. Or that reading was cancelled.
pub fn open(path: &Path, options: &Options) -> Result<Opened, OpenError> {
    let files = RefCell::new(Vec::new());
    let opened = open_with(path, options, &|file| {
        // The file itself may be a pipe; what it names may not.
        let named = if file == path { Named::ByUser } else { Named::ByFile };
        let bytes = options.read(file, named)?;
        files.borrow_mut().push(file.to_owned());
        Ok(bytes)
    })?;
    Ok(Opened { files: files.into_inner(), ..opened })
}

fn open_with(path: &Path, options: &Options, files: &ReadFile<'_>) -> Result<Opened, OpenError> {
    if let Some(kind) = bare::Kind::of(path) {
        return bare::open(path, kind, files, options);
    }
    let name = path.to_string_lossy();
    let folder = path.parent().unwrap_or(Path::new(""));
    let report = Report::new(&name, folder);
    let text = match files(path).map(String::from_utf8) {
        Ok(Ok(text)) => text,
        Ok(Err(error)) => {
            let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            let line = valid.iter().filter(|&&b| b == b'\n').count() + 1;
            let place = Place { line: u32::try_from(line).unwrap_or(0), column: 0 };
            return Err(report.fail(place, "the text is not UTF-8"));
        }
        Err(error) => {
            options.cancel.check()?;
            return Err(report.fail(Place::default(), format!("cannot be read: {error}")));
        }
    };
    let opened = read(report, &text, files, options)?;
    Ok(Opened { path: Some(path.to_owned()), ..opened })
}

/// Reads a scene from memory. `name` stands in messages; `files` is asked for other files by the names in the
/// scene.
///
/// # Errors
/// As [`open`].
pub fn read_str(name: &str, xml: &str, files: &ReadFile<'_>, options: &Options) -> Result<Opened, OpenError> {
    read(Report::new(name, Path::new("")), xml, files, options)
}

fn read(mut report: Report, xml: &str, files: &ReadFile<'_>, options: &Options) -> Result<Opened, OpenError> {
    let text = xml.strip_prefix('\u{feff}').unwrap_or(xml);
    report.main_text(text);
    let mut budget = Budget::new(options.memory);
    let document = match include::parse(text, &mut budget) {
        Ok(document) => document,
        Err((place, message)) => return Err(report.fail(place, message)),
    };
    let mut files = Files::new(files, &options.cancel, budget);
    let expanded = include::expand(&document, &options.defines, &mut files, &mut report);
    let mut reader = Reader::new(&expanded.document, files, report);
    reader.scene();
    options.cancel.check()?;
    let Reader { report, files, description, mut nodes, suggested, .. } = reader;
    let warnings = report.finish()?;
    let source_hash = source_hash(xml, options, files.hash);
    let required = [&mut nodes.sensors, &mut nodes.shapes, &mut nodes.emitters].into_iter().flatten();
    for node in required.chain(nodes.materials.iter_mut().flatten()) {
        *node = expanded.origin(*node);
    }
    let options = options.without_cancel();
    let (path, files) = (None, Vec::new());
    Ok(Opened { description, document, nodes, path, files, options, suggested, warnings, source_hash })
}

fn source_hash(xml: &str, options: &Options, files: Fnv1a) -> u64 {
    let defines = options.defines.iter().flat_map(|(name, value)| [name.as_bytes(), value.as_bytes()]);
    let files = files.finish().to_le_bytes();
    hash::of_parts(std::iter::once(xml.as_bytes()).chain(defines).chain([&files[..]]))
}
