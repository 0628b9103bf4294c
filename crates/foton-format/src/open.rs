//! Opens scene files, and scenes from memory.

use std::borrow::Cow;
use std::cell::RefCell;
use std::collections::{BTreeMap, HashSet};
use std::io;
use std::path::Path;

use foton_input::{Named, of_other_case, shown_path};
use foton_scene::description::SceneDescription;

use crate::diagnostic::{Diagnostic, OpenError, Place, Report, Severity};
use crate::encoding::decoded;
use crate::files::Files;
use crate::hash::{self, Fnv1a};
use crate::limits::Budget;
use crate::mitsuba::read::reader::Reader;
use crate::opened::{MitsubaScene, Opened, Origin};
use crate::options::{Options, ReadFile};
use crate::refused::refused;
use crate::{gltf, mitsuba::read::include, pbrt, standalone};

/// Opens a scene file: of Mitsuba, pbrt, or glTF; the files that it names are found from its folder. An OBJ, PLY, STL or OFF file is a whole scene:
/// what it lacks is added, and a warning says so.
///
/// # Errors
/// Everything that is wrong with the file, unless it is not well-formed XML: then the first problem. Or that reading was cancelled.
pub fn open(path: &Path, options: &Options) -> Result<Opened, OpenError> {
    let files = RefCell::new((Vec::new(), HashSet::new()));
    let others = RefCell::new(BTreeMap::new());
    let read = |file: &Path| {
        // The file itself may be a pipe; what it names may not.
        let named = if file == path { Named::ByUser } else { Named::ByFile };
        let (file, bytes) = match options.read(file, named) {
            Ok(bytes) => (Cow::Borrowed(file), bytes),
            Err(error) if error.kind() == io::ErrorKind::NotFound && named == Named::ByFile => {
                let there = of_other_case(file).ok_or(error)?;
                let bytes = options.read(&there, named)?;
                others.borrow_mut().insert(file.to_owned(), there.clone());
                (Cow::Owned(there), bytes)
            }
            Err(error) => return Err(error),
        };
        let (in_order, known) = &mut *files.borrow_mut();
        if known.insert(file.to_path_buf()) {
            in_order.push(file.into_owned());
        }
        Ok(bytes)
    };
    let mut opened = open_from(path, &read, options)?;
    for (named, there) in others.into_inner() {
        let message = format!(
            "{} is not there and {} is taken, whose letters differ by their case alone",
            shown_path(&named),
            shown_path(&there)
        );
        let file = path.to_string_lossy().into_owned();
        opened.warnings.push(Diagnostic::new(Severity::Warning, file, Place::default(), message));
    }
    Ok(Opened { files: files.into_inner().0, ..opened })
}

/// Reads the shapes of an OBJ, PLY, STL, OFF or glTF file, with their materials and textures, to add them to another scene.
///
/// # Errors
/// As [`open`], and where the file is of another kind.
pub fn import(path: &Path, options: &Options) -> Result<SceneDescription, OpenError> {
    if standalone::Kind::of(path).is_none() && !gltf::is_named(path) && refused(path).is_none() {
        let report = Report::new(&path.to_string_lossy(), path.parent().unwrap_or(Path::new("")));
        return Err(report.fail(Place::default(), "only OBJ, PLY, STL, OFF and glTF files can be imported"));
    }
    Ok(standalone::shapes_alone(open(path, options)?.description))
}

/// Opens a scene as [`open`] does, from the files that `files` has.
///
/// # Errors
/// As [`open`].
pub fn open_from(path: &Path, files: &ReadFile<'_>, options: &Options) -> Result<Opened, OpenError> {
    if pbrt::is_named(path) {
        return pbrt::open(path, files, options);
    }
    if let Some((message, way_out)) = refused(path) {
        let mut report = Report::new(&path.to_string_lossy(), path.parent().unwrap_or(Path::new("")));
        report.error(Place::default(), message);
        report.help(way_out);
        report.finish()?;
    }
    if let Some(kind) = standalone::Kind::of(path) {
        return standalone::open(path, kind, files, options);
    }
    if gltf::is_named(path) {
        return gltf::open(path, files, options);
    }
    let name = path.to_string_lossy();
    let folder = path.parent().unwrap_or(Path::new(""));
    let report = Report::new(&name, folder);
    let text = match files(path).map(decoded) {
        Ok(Ok(text)) => text,
        Ok(Err(line)) => return Err(report.fail(Place { line, column: 0 }, "the text is not UTF-8")),
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

pub(crate) fn read(
    mut report: Report,
    xml: &str,
    files: &ReadFile<'_>,
    options: &Options,
) -> Result<Opened, OpenError> {
    let text = xml.strip_prefix('\u{feff}').unwrap_or(xml);
    report.main_text(text, include::begins_as_scene(text));
    let mut budget = Budget::new(options.memory);
    let document = match include::parse(text, &mut budget) {
        Ok(document) => document,
        Err((place, message)) => return Err(report.fail(place, message)),
    };
    let mut files = Files::new(files, options, budget);
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
    let origin = Origin::Mitsuba(MitsubaScene { document, nodes });
    Ok(Opened { description, origin, path, files, options, suggested, warnings, source_hash })
}

fn source_hash(xml: &str, options: &Options, files: Fnv1a) -> u64 {
    let defines = options.defines.iter().flat_map(|(name, value)| [name.as_bytes(), value.as_bytes()]);
    let files = files.finish().to_le_bytes();
    hash::of_parts(std::iter::once(xml.as_bytes()).chain(defines).chain([&files[..]]))
}
