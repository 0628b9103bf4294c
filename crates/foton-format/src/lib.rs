//! Scene files and meshes to scene descriptions; the only reader of scene files.
//!
//! The format is a subset of Mitsuba 3's XML, so that one file renders alike in both. All problems of a file are
//! found in one go, each with its place and the nearest known name. Nothing is rendered, downloaded or written here,
//! and textures, media and `<include>` are not read yet.
//!
//! ```
//! let xml = r#"<scene version="3.0.0">
//!     <default name="r" value="1"/>
//!     <sensor type="perspective"/>
//!     <shape type="sphere"><float name="radius" value="$r"/><emitter type="area"/></shape>
//! </scene>"#;
//! let no_files = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
//! let options = foton_format::Options { defines: vec![("r".into(), "2".into())] };
//! let opened = foton_format::read_str("ball.xml", xml, &no_files, &options).unwrap();
//! assert_eq!(opened.description.shapes.len(), 1);
//! ```

mod diagnostic;
mod document;
mod emitters;
mod hash;
mod ids;
mod materials;
mod meshes;
mod names;
mod obj;
mod properties;
mod reader;
mod sensor;
mod shapes;
mod substitute;
mod transform;
mod values;

use std::io;
use std::path::Path;

use foton_scene::description::SceneDescription;

pub use diagnostic::{Diagnostic, OpenError, Place, Severity};
pub use document::{Attribute, Document, Element, MAX_DEPTH, Node, NodeId};

use diagnostic::Report;
use hash::Fnv1a;
use reader::Reader;

/// Reads a file that a scene names.
pub type ReadFile<'a> = dyn Fn(&Path) -> io::Result<Vec<u8>> + 'a;

/// How to read a scene.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Parameters as name and value, stronger than the file's `<default>`s; of two with a name the last holds.
    pub defines: Vec<(String, String)>,
}

/// A scene as its file states it.
#[derive(Clone, Debug)]
pub struct Opened {
    /// What to render.
    pub description: SceneDescription,
    /// The file's tree as it was written, before parameters were replaced.
    pub document: Document,
    /// The element of each shape of the description, in its order.
    pub shape_nodes: Vec<NodeId>,
    /// What the file says without effect.
    pub warnings: Vec<Diagnostic>,
    /// Hash of the contents of the file and its meshes, and of the defines. The same on every platform.
    pub source_hash: u64,
}

/// Opens a scene file; the files that it names are found from its folder.
///
/// # Errors
/// Everything that is wrong with the file, unless it is not well-formed XML: then the first problem.
pub fn open(path: &Path, options: &Options) -> Result<Opened, OpenError> {
    let name = path.to_string_lossy();
    let report = Report::new(&name);
    let text = match std::fs::read(path).map(String::from_utf8) {
        Ok(Ok(text)) => text,
        Ok(Err(error)) => {
            let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            let line = valid.iter().filter(|&&b| b == b'\n').count() + 1;
            let place = Place { line: u32::try_from(line).unwrap_or(0), column: 0 };
            return Err(report.fail(place, "the text is not UTF-8"));
        }
        Err(error) => return Err(report.fail(Place::default(), format!("cannot be read: {error}"))),
    };
    let folder = path.parent().unwrap_or(Path::new(""));
    read(report, &text, folder, &|file| std::fs::read(file), options)
}

/// Reads a scene from memory. `name` stands in messages; `files` is asked for the meshes by the names in the scene.
///
/// # Errors
/// As [`open`].
pub fn read_str(name: &str, xml: &str, files: &ReadFile<'_>, options: &Options) -> Result<Opened, OpenError> {
    read(Report::new(name), xml, Path::new(""), files, options)
}

fn read(
    mut report: Report,
    xml: &str,
    folder: &Path,
    files: &ReadFile<'_>,
    options: &Options,
) -> Result<Opened, OpenError> {
    let document = match Document::parse(xml.strip_prefix('\u{feff}').unwrap_or(xml)) {
        Ok(document) => document,
        Err((place, message)) => return Err(report.fail(place, message)),
    };
    let resolved = substitute::substitute(&document, &options.defines, &mut report);
    let mut reader = Reader::new(&resolved, folder, files, report);
    reader.scene();
    let Reader { report, meshes, description, shape_nodes, .. } = reader;
    let warnings = report.finish()?;
    let source_hash = hash(xml, options, meshes.hash);
    Ok(Opened { description, document, shape_nodes, warnings, source_hash })
}

fn hash(xml: &str, options: &Options, meshes: Fnv1a) -> u64 {
    let mut hash = Fnv1a::default();
    hash.add(xml.as_bytes());
    for (name, value) in &options.defines {
        hash.add(name.as_bytes());
        hash.add(value.as_bytes());
    }
    hash.add(&meshes.finish().to_le_bytes());
    hash.finish()
}
