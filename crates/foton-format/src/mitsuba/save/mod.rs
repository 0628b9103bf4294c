//! An edited scene into its own file: what changed is changed there, and everything else stays as a person wrote it.
//!
//! Comments, parameters, integrators and what is not understood are kept. The new text is read before it is written: if
//! it is not the edited scene, or where a change has no place in the file, the whole scene is written anew and the
//! answer says why. Files that the scene names are left where they are: in another folder the scene begins with a
//! `<path>` to them, relative if the two folders have more in common than the root of the disk.

mod additions;
mod changes;
mod lists;
mod materials;
mod pairs;
mod same;
mod tree;

use std::io::Write;
use std::path::{Component, Path, PathBuf};

use foton_film::{WriteError, atomic_write, is_same_file};
use foton_input::{Named, shown_path};
use foton_scene::description::SceneDescription;

use crate::diagnostic::Report;
use crate::mitsuba::document::{Document, Element};
use crate::mitsuba::write::write_scene;
use crate::open::read;
use crate::opened::{Opened, Origin};
use crate::options::Options;
use changes::Changes;
use tree::Obstacle;

/// How an edited scene was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Saved {
    /// The scene's own file, with what changed.
    Changed,
    /// A new file of the whole scene, with its meshes and images beside it. What the program did not understand, comments
    /// and parameters are not in it.
    Anew {
        /// Why.
        why: String,
    },
}

/// Writes an edited scene, as the file that was opened with what changed if that is possible, or else anew as
/// [`write_scene`] does. Defines that it was opened with become the defaults of its parameters.
///
/// # Errors
/// As [`write_scene`], if the folder is not there, and if the path leads to another file that the scene is made of.
///
/// # Panics
/// As [`write_scene`].
pub fn save_edited(opened: &Opened, edited: &SceneDescription, path: &Path) -> Result<Saved, WriteError> {
    if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty() && !f.is_dir()) {
        return Err(WriteError::NoFolder { path: path.to_owned(), folder: folder.to_owned() });
    }
    // A Mitsuba scene may be saved over itself, nothing else over what it was read from.
    let own = opened.path.as_ref().filter(|_| opened.origin.mitsuba().is_some());
    let mut of_others = opened.files.iter().filter(|file| Some(*file) != own);
    if of_others.any(|file| is_same_file(file, path)) {
        return Err(WriteError::Special { path: path.to_owned(), what: "a file that the scene reads" });
    }
    match changed_text(opened, edited, path) {
        Ok(text) => {
            atomic_write(path, |file| file.write_all(text.as_bytes()))?;
            Ok(Saved::Changed)
        }
        Err(why) => {
            write_scene(edited, path, &opened.files)?;
            Ok(Saved::Anew { why })
        }
    }
}

/// The text of the opened file with what changed, proven by reading it.
fn changed_text(opened: &Opened, edited: &SceneDescription, path: &Path) -> Result<String, Obstacle> {
    let scene = match &opened.origin {
        Origin::Mitsuba(scene) => scene,
        Origin::Foreign(scene) => return Err(format!("it was opened from {}", scene.kind)),
    };
    let Some(from) = opened.path.as_deref() else {
        return Err("the scene was not opened from a file".to_owned());
    };
    if is_old(&scene.document) {
        return Err("the file is of an old version, with other names".to_owned());
    }
    let mut changes = Changes::new(scene, &opened.description, edited);
    changes.make()?;
    let mut document = changes.document;
    let (from, to) = (folder(from)?, folder(path)?);
    if from != to {
        find_files(&mut document, &way(&to, &from))?;
    }
    set_defaults(&mut document, &opened.options)?;
    let text = document.text();
    let mut report = Report::new(&path.to_string_lossy(), path.parent().unwrap_or(Path::new("")));
    report.main_text(&text, false);
    // Defaults say what parameters did; the memory is that of opening it.
    let options = Options { defines: Vec::new(), ..opened.options.clone() };
    let again = read(report, &text, &|file| options.read(file, Named::ByFile), &options);
    let again = again.map_err(|error| format!("what was changed does not read back: {error}"))?;
    match same::difference(edited, &again.description) {
        None => Ok(text),
        Some(what) => Err(format!("a change of {what} has no place in the file")),
    }
}

fn is_old(document: &Document) -> bool {
    let version = document.element(document.root()).and_then(|e| e.attribute("version"));
    version.is_none_or(|v| crate::mitsuba::read::values::major_version(&v.value).is_ok_and(|major| major < 2))
}

/// The folder that a file is in, with nothing to resolve any more.
fn folder(file: &Path) -> Result<PathBuf, Obstacle> {
    let folder = file.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    folder.canonicalize().map_err(|error| format!("{}: {error}", shown_path(folder)))
}

/// The way from one folder to another, both absolute; absolute where they have only the root in common.
fn way(from: &Path, to: &Path) -> PathBuf {
    let shared = from.components().zip(to.components()).take_while(|(a, b)| a == b).count();
    let named = |c: &Component<'_>| matches!(c, Component::Normal(_));
    if !to.components().take(shared).any(|c| named(&c)) {
        return to.to_owned();
    }
    let up = from.components().skip(shared).map(|_| Component::ParentDir);
    let way: PathBuf = up.chain(to.components().skip(shared)).collect();
    if way.as_os_str().is_empty() { PathBuf::from(".") } else { way }
}

/// Lets the files that a scene names be found from another folder.
fn find_files(document: &mut Document, way: &Path) -> Result<(), Obstacle> {
    let root = document.root();
    let text = |path: &Path| path.to_string_lossy().replace('\\', "/").replace('$', "\\$");
    let paths: Vec<_> = document
        .elements_in(root)
        .filter(|(_, e)| e.name == "path")
        .filter_map(|(node, e)| Some((node, e.attribute("value")?.value.clone())))
        .collect();
    for (node, value) in paths.iter().filter(|(_, value)| Path::new(value).is_relative()) {
        document.set_attribute(*node, "value", &format!("{}/{value}", text(way)));
    }
    let is_file = |e: &Element| {
        e.attribute("filename").is_some() || e.attribute("name").is_some_and(|a| a.value == "filename")
    };
    if document.elements().any(|(_, e)| is_file(e)) {
        put_first(document, "path", &[("value", &text(way))])?;
    }
    Ok(())
}

/// Makes defines the defaults of the file.
fn set_defaults(document: &mut Document, options: &Options) -> Result<(), Obstacle> {
    let mut seen: Vec<&str> = Vec::new();
    // Of two defines with a name the last holds.
    for (name, value) in options.defines.iter().rev() {
        if seen.contains(&name.as_str()) {
            continue;
        }
        seen.push(name);
        let value = value.replace('$', "\\$");
        let is_it =
            |e: &Element| e.name == "default" && e.attribute("name").is_some_and(|a| a.value == *name);
        let default = document.elements().find(|(_, e)| is_it(e)).map(|(node, _)| node);
        match default {
            Some(default) => document.set_attribute(default, "value", &value),
            None => put_first(document, "default", &[("name", name), ("value", &value)])?,
        }
    }
    Ok(())
}

/// A new element before all others of the scene.
fn put_first(document: &mut Document, tag: &str, attributes: &[(&str, &str)]) -> Result<(), Obstacle> {
    let new = document.build(tag, attributes, Vec::new())?;
    let root = document.root();
    let space = document.element(root).and_then(|e| e.children.first().copied());
    let space = space.filter(|s| document.is_space(*s));
    if let Some(element) = document.element_mut(root) {
        element.children.splice(0..0, space.into_iter().chain([new]));
    }
    Ok(())
}
