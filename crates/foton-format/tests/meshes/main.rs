//! Mesh files: every format against the same few triangles, and what a person reads when a file is wrong.

mod bare;
mod exporters;
mod ply;
mod serialized;
mod stl;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use foton_format::{Opened, Options, Origin, Severity, open, read_str};
use foton_math::Rgb;
use foton_math::glam::{DVec2, DVec3};
use foton_scene::description::{Bsdf, Dielectric, Diffuse, EmitterKind, Geometry, Mesh, Mirror, Plastic};

use ply::{all_ply, little, ply};
use serialized::{index, serialized};
use stl::{STL, binary_stl};

/// What a scene makes of a mesh file, or the messages about it.
fn shape(plugin: &str, bytes: &[u8], more: &str) -> Result<Mesh, Vec<String>> {
    let files = |path: &Path| match path.to_str() {
        Some("m") => Ok(bytes.to_vec()),
        _ => Err(io::ErrorKind::NotFound.into()),
    };
    let xml = format!(
        "<scene version='3.0.0'><sensor type='perspective'/>\
         <shape type='{plugin}'><string name='filename' value='m'/>{more}</shape></scene>"
    );
    match read_str("s.xml", &xml, &files, &Options::default()) {
        Ok(opened) => Ok(mesh(&opened, 0).clone()),
        Err(error) => Err(error.diagnostics().iter().map(ToString::to_string).collect()),
    }
}

fn mesh(opened: &Opened, shape: usize) -> &Mesh {
    match &opened.description.shapes[shape].geometry {
        Geometry::Mesh(mesh) => mesh,
        other => panic!("not a mesh: {other:?}"),
    }
}

fn problem(plugin: &str, bytes: &[u8]) -> String {
    let problems = shape(plugin, bytes, "").expect_err("the file is wrong");
    assert_eq!(problems.len(), 1, "{problems:?}");
    problems[0].clone()
}

/// Four corners of a square and the point below the first.
const POINTS: [[f32; 3]; 5] =
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.25, 0.5, -1.0]];

fn points() -> Vec<DVec3> {
    POINTS.iter().map(|p| DVec3::from_array(p.map(f64::from))).collect()
}

/// A folder of a test's own, removed when the test is over.
struct Folder(PathBuf);

impl Folder {
    fn new(test: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("foton-meshes-{}-{test}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    /// The path of a new file in it.
    fn file(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.join(name);
        fs::write(&path, bytes).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn warnings(opened: &Opened) -> Vec<String> {
    let name = |file: &str| Path::new(file).file_name().unwrap().to_string_lossy().into_owned();
    let at = |line: u32| if line == 0 { String::new() } else { format!(":{line}") };
    opened.warnings.iter().map(|w| format!("{}{}: {}", name(&w.file), at(w.line), w.message)).collect()
}

#[test]
fn damaged_files_are_read_or_refused_without_panic() {
    let mut files = all_ply().map(|(_, bytes)| ("ply", bytes)).to_vec();
    files.push(("serialized", serialized(3)));
    files.push(("serialized", serialized(4)));
    files.push(("stl", STL.as_bytes().to_vec()));
    files.push(("stl", binary_stl(b"", 0)));
    let mut state = 1_u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 33) as usize % below
    };
    for round in 0..4000 {
        let (plugin, whole) = &files[round % files.len()];
        let mut bytes = whole.clone();
        for _ in 0..=random(4) {
            let at = random(bytes.len());
            match random(4) {
                0 => bytes.truncate(at + 1),
                1 => bytes[at] = random(256) as u8,
                2 => bytes[at] = b"09-. \nx\xff"[random(8)],
                _ => {
                    bytes.remove(at.min(bytes.len() - 1));
                    bytes.push(b'0');
                }
            }
        }
        let more = if *plugin == "serialized" { index(random(3) as i32) } else { String::new() };
        let _ = shape(plugin, &bytes, &more);
    }
}
