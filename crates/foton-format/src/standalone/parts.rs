//! An OBJ file as shapes: one for each material that its faces use, with what the files of materials say of it.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use foton_input::{quoted, shown_path};
use foton_math::Cancel;
use foton_math::glam::DAffine3;
use foton_scene::description::{Attribute, Mesh, SceneDescription};

use super::shapes::{Library, add_shape};
use crate::diagnostic::{Place, Report};
use crate::mesh::obj::Obj;
use crate::mesh::wanted::{Format, Wanted};
use crate::mesh::{mtl, normals};
use crate::mitsuba::read::reader::name_of;

/// So many different lines that name files of materials are heeded.
const MAX_LIBRARIES: usize = 100;
/// The longest of those lines: each word of it may be a name.
const MAX_LINE: usize = 4096;

/// Adds a shape for each material of an OBJ file, in the order in which they are first used.
pub(super) fn add_obj(
    obj: &Obj,
    library: &mut Library<'_>,
    report: &mut Report,
    scene: &mut SceneDescription,
    cancel: &Cancel,
) {
    let mut known: HashMap<String, mtl::Entry> = HashMap::new();
    let mut read: HashSet<&str> = HashSet::new();
    // Exporters name a file for each part; files of other kinds may name very many.
    let lines = obj.libraries.iter().filter(|(_, line)| read.insert(line)).take(MAX_LIBRARIES);
    for (place, line) in lines {
        if line.len() > MAX_LINE {
            report.warning(*place, "the names of files of materials are too long: their materials are grey");
            continue;
        }
        let (files, lost) = libraries(line, library);
        for filename in lost {
            report.warning(
                *place,
                format!("{} is not there: its materials are grey", shown_path(Path::new(&filename))),
            );
        }
        for (path, bytes) in files {
            let bytes = match bytes {
                Ok(bytes) => bytes,
                Err(message) => {
                    let path = shown_path(Path::new(&path));
                    report.warning(*place, format!("cannot read {path}: {message}; its materials are grey"));
                    continue;
                }
            };
            let (entries, problems) = mtl::parse(&bytes, cancel);
            if entries.is_empty() {
                report.warning(*place, format!("{} has no materials", shown_path(Path::new(&path))));
            }
            for (place, message) in problems {
                report.warning_in(&path, place, message);
            }
            for entry in entries {
                known.entry(entry.material.name.clone()).or_insert(entry);
            }
        }
    }
    let wanted = Wanted { format: Format::Obj, face_normals: false, flip_v: true };
    let mesh = normals::build(obj, wanted, &DAffine3::IDENTITY, cancel);
    let mut remap = vec![u32::MAX; mesh.positions.len()];
    for (name, triangles) in by_material(obj, &mesh) {
        let entry = find(name, &known);
        if entry.is_none() && !name.is_empty() && !obj.libraries.is_empty() {
            report.warning(Place::default(), format!("there is no material {}: it is grey", quoted(name)));
        }
        let number = scene.shapes.len() + 1;
        let name = if name.is_empty() { "mesh".to_owned() } else { name_of(name, number) };
        add_shape(&name, part(&mesh, &triangles, &mut remap), entry, scene);
    }
}

/// A material by the name that faces use: as it stands, or without quotes or a comment behind it.
fn find<'a>(name: &str, known: &'a HashMap<String, mtl::Entry>) -> Option<&'a mtl::Entry> {
    let shorter = || [mtl::unquoted(name), mtl::unquoted(without_comment(name))].into_iter();
    known.get(name).or_else(|| shorter().find_map(|name| known.get(name)))
}

fn without_comment(text: &str) -> &str {
    text.split_once(" #").map_or(text, |(before, _)| before.trim_end())
}

/// A file's path and contents, or why it cannot be read.
type LibraryFile = (String, Result<Vec<u8>, String>);

/// The files that a line `mtllib` names, and the names of which there is no file. The line is one name if there is such a
/// file; otherwise names end where quotes do or behind `.mtl`, and what is no file by then are words.
fn libraries(line: &str, library: &mut Library<'_>) -> (Vec<LibraryFile>, Vec<String>) {
    let (mut files, mut lost) = (Vec::new(), Vec::new());
    if let Some(file) = library(line).or_else(|| library(mtl::unquoted(line))) {
        return (vec![file], lost);
    }
    let mut look = |name: &str| match library(name) {
        Some(file) => {
            files.push(file);
            true
        }
        None => false,
    };
    // What stands between quotes is every second piece.
    for (i, piece) in
        without_comment(line).split('"').enumerate().filter(|(_, piece)| !piece.trim().is_empty())
    {
        if i % 2 == 1 {
            if !look(piece) {
                lost.push(piece.to_owned());
            }
            continue;
        }
        let mut name = String::new();
        let words: Vec<&str> = piece.split_whitespace().collect();
        for (i, word) in words.iter().enumerate() {
            name = if name.is_empty() { (*word).to_owned() } else { format!("{name} {word}") };
            let is_end = word.to_ascii_lowercase().ends_with(".mtl") || i + 1 == words.len();
            if is_end && !look(&name) {
                lost.extend(name.split(' ').filter(|word| !look(word)).map(str::to_owned));
            }
            if is_end {
                name.clear();
            }
        }
    }
    (files, lost)
}

/// The triangles of each material that has any.
fn by_material<'a>(obj: &'a Obj, mesh: &Mesh) -> Vec<(&'a str, Vec<[u32; 3]>)> {
    let mut parts: Vec<(&str, Vec<[u32; 3]>)> = Vec::new();
    let mut indices: HashMap<&str, usize> = HashMap::new();
    let mut runs = vec![(0, "")];
    runs.extend(obj.materials.iter().map(|(before, name)| (*before, name.as_str())));
    for (i, (from, name)) in runs.iter().enumerate() {
        let to = runs.get(i + 1).map_or(mesh.triangles.len(), |next| next.0);
        if to > *from {
            let index = *indices.entry(name).or_insert_with(|| {
                parts.push((name, Vec::new()));
                parts.len() - 1
            });
            parts[index].1.extend_from_slice(&mesh.triangles[*from..to]);
        }
    }
    parts
}

/// Some triangles of a mesh with the vertices that they need. `remap` is all `u32::MAX`, before and after.
fn part(mesh: &Mesh, triangles: &[[u32; 3]], remap: &mut [u32]) -> Mesh {
    let mut used: Vec<usize> = Vec::new();
    let triangles = triangles
        .iter()
        .map(|corners| {
            corners.map(|i| {
                let slot = &mut remap[i as usize];
                if *slot == u32::MAX {
                    *slot = used.len() as u32;
                    used.push(i as usize);
                }
                *slot
            })
        })
        .collect();
    used.iter().for_each(|&i| remap[i] = u32::MAX);
    let normals = if mesh.normals.is_empty() { Vec::new() } else { pick(&mesh.normals, &used) };
    let has_uv = !mesh.texture_coordinates.is_empty();
    let texture_coordinates = if has_uv { pick(&mesh.texture_coordinates, &used) } else { Vec::new() };
    let positions = pick(&mesh.positions, &used);
    // An OBJ file has attributes of vertices alone.
    let attribute = |a: &Attribute| {
        let values = used.iter().flat_map(|&i| &a.values[i * a.channels..(i + 1) * a.channels]);
        Attribute { values: values.copied().collect(), ..a.clone() }
    };
    let attributes = mesh.attributes.iter().map(attribute).collect();
    Mesh { positions, normals, texture_coordinates, triangles, attributes }
}

fn pick<T: Copy>(values: &[T], indices: &[usize]) -> Vec<T> {
    indices.iter().map(|&i| values[i]).collect()
}
