//! Reading that is cancelled, whatever is read, and wherever that comes.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use foton_film::{Image, Metadata, ToneMap, write_exr, write_png};
use foton_format::{OpenError, Opened, Options, Progress, open};
use foton_math::{Cancel, Rgb};

/// A folder that goes with the test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("foton-cancelling-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("a folder");
        Self(folder)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        fs::write(&path, bytes).expect("room");
        path
    }

    /// A scene of one plugin.
    fn scene(&self, body: &str) -> PathBuf {
        let xml = format!("<scene version='3.0.0'><sensor type='perspective'/>{body}</scene>");
        self.write("scene.xml", xml)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Opens a file with a request that comes after 0, 1, 2 … questions, until it is opened: each time before that must end in the
/// request and in nothing else. The number of questions by then.
fn questions(path: &Path) -> (u64, Opened) {
    for questions in 0.. {
        let options = Options { cancel: Cancel::after(questions), ..Options::default() };
        match open(path, &options) {
            Ok(opened) => return (questions, opened),
            Err(OpenError::Cancelled(_)) => {}
            Err(other) => panic!("{}, after {questions} questions: {other}", path.display()),
        }
    }
    unreachable!("some number is enough");
}

/// Squares along a line, as corners and as triangles.
const SQUARES: u32 = 9000;

fn corners() -> impl Iterator<Item = [f32; 3]> {
    (0..=SQUARES).flat_map(|i| [0.0, 1.0].map(|y| [i as f32, y, (i % 7) as f32]))
}

fn triangles() -> impl Iterator<Item = [u32; 3]> {
    (0..SQUARES).flat_map(|i| [[2 * i, 2 * i + 2, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 1]])
}

fn obj() -> String {
    let mut text = String::new();
    corners().for_each(|[x, y, z]| writeln!(text, "v {x} {y} {z}").expect("a string"));
    triangles().for_each(|t| {
        let [a, b, c] = t.map(|i| i + 1);
        writeln!(text, "f {a} {b} {c}").expect("a string");
    });
    text
}

fn ply(format: &str) -> Vec<u8> {
    let (vertices, faces) = (2 * (SQUARES + 1), 2 * SQUARES);
    let mut bytes = format!(
        "ply\nformat {format} 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    .into_bytes();
    if format == "ascii" {
        corners().for_each(|[x, y, z]| bytes.extend(format!("{x} {y} {z}\n").bytes()));
        triangles().for_each(|[a, b, c]| bytes.extend(format!("3 {a} {b} {c}\n").bytes()));
    } else {
        bytes.extend(corners().flatten().flat_map(f32::to_le_bytes));
        triangles().for_each(|t| {
            bytes.push(3);
            bytes.extend(t.into_iter().flat_map(u32::to_le_bytes));
        });
    }
    bytes
}

fn stl(is_text: bool) -> Vec<u8> {
    let points: Vec<[f32; 3]> = corners().collect();
    let of = |t: [u32; 3]| t.map(|i| points[i as usize]);
    if is_text {
        let mut text = "solid\n".to_owned();
        for t in triangles() {
            text.push_str("facet\nouter loop\n");
            of(t).iter().for_each(|[x, y, z]| writeln!(text, "vertex {x} {y} {z}").expect("a string"));
            text.push_str("endloop\nendfacet\n");
        }
        return text.into_bytes();
    }
    let mut bytes = vec![0; 80];
    bytes.extend((2 * SQUARES).to_le_bytes());
    for t in triangles() {
        bytes.extend([0; 12]);
        bytes.extend(of(t).into_iter().flatten().flat_map(f32::to_le_bytes));
        bytes.extend([0; 2]);
    }
    bytes
}

fn serialized() -> Vec<u8> {
    let mut plain = 0x1000_u32.to_le_bytes().to_vec();
    plain.push(0);
    plain.extend(u64::from(2 * (SQUARES + 1)).to_le_bytes());
    plain.extend(u64::from(2 * SQUARES).to_le_bytes());
    plain.extend(corners().flatten().flat_map(f32::to_le_bytes));
    plain.extend(triangles().flatten().flat_map(u32::to_le_bytes));
    let mut packed = flate2::write::ZlibEncoder::new(vec![0x1c, 0x04, 4, 0], flate2::Compression::fast());
    std::io::Write::write_all(&mut packed, &plain).expect("memory");
    packed.finish().expect("memory")
}

#[test]
fn meshes_of_every_format_are_given_up_wherever_that_is_asked_for() {
    let folder = Folder::new("meshes");
    let files = [
        ("obj", obj().into_bytes()),
        ("ply", ply("ascii")),
        ("ply", ply("binary_little_endian")),
        ("stl", stl(true)),
        ("stl", stl(false)),
        ("serialized", serialized()),
    ];
    for (plugin, bytes) in files {
        let name = format!("mesh.{plugin}");
        folder.write(&name, &bytes);
        let scene =
            folder.scene(&format!("<shape type='{plugin}'><string name='filename' value='{name}'/></shape>"));
        let (needed, opened) = questions(&scene);
        // What every file takes, and what is asked while this one is gone through.
        assert!(needed > 12, "{plugin}, {} bytes: {needed}", bytes.len());
        assert!(!opened.options.cancel.is_requested(), "reading is over");
        if plugin != "serialized" {
            assert!(questions(&folder.0.join(&name)).0 > 5, "{plugin} by itself");
        }
    }
}

#[test]
fn pictures_are_given_up_wherever_that_is_asked_for() {
    let folder = Folder::new("pictures");
    let mut noise = 1_u32;
    let mut image = Image::black(400, 400);
    for pixel in &mut image.pixels {
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        *pixel = Rgb::splat((noise >> 8) as f32 / (1 << 24) as f32);
    }
    write_exr(&folder.0.join("sky.exr"), &image, &[], &Metadata::default()).expect("room");
    write_png(&folder.0.join("card.png"), &image, ToneMap::default(), 0.0, &Metadata::default())
        .expect("room");
    for (file, body) in [
        ("sky.exr", "<emitter type='envmap'><string name='filename' value='sky.exr'/></emitter>"),
        (
            "card.png",
            "<shape type='rectangle'><bsdf type='diffuse'><texture type='bitmap' name='reflectance'>\
             <string name='filename' value='card.png'/></texture></bsdf></shape>",
        ),
    ] {
        let (needed, _) = questions(&folder.scene(body));
        // Without decoders that ask it would be a dozen.
        assert!(needed > 40, "{file}: {needed}");
    }
}

#[test]
fn a_scene_of_many_parts_and_files_is_given_up_wherever_that_is_asked_for() {
    let folder = Folder::new("parts");
    let part = "<scene version='3.0.0'><shape type='sphere'/><shape type='disk'/></scene>";
    folder.write("part.xml", part);
    let scene = folder.scene(&"<include filename='part.xml'/>".repeat(20));
    let (needed, opened) = questions(&scene);
    assert!(needed > 60, "{needed}");
    assert_eq!(opened.description.shapes.len(), 40);
}

#[test]
fn a_request_says_nothing_of_a_file_that_is_wrong() {
    let folder = Folder::new("wrong");
    let scene = folder.scene("<shape type='sphre'/>");
    let options = Options::default();
    options.cancel.request();
    let error = open(&scene, &options).expect_err("cancelled");
    assert!(matches!(error, OpenError::Cancelled(_)) && error.diagnostics().is_empty(), "{error}");
    options.cancel.rearm();
    let error = open(&scene, &options).expect_err("wrong");
    assert!(matches!(&error, OpenError::Faults(found) if found.len() == 1), "{error}");
}

#[test]
fn reading_tells_how_far_it_is() {
    let folder = Folder::new("progress");
    let mut text = String::new();
    corners().for_each(|[x, y, z]| writeln!(text, "v {x} {y} {z}").expect("text"));
    (0..SQUARES).map(|i| 2 * i + 1).for_each(|i| writeln!(text, "f {i} {} {}", i + 1, i + 2).expect("text"));
    let obj = folder.write("line.obj", &text);
    let shape = "<shape type='obj'><string name='filename' value='line.obj'/></shape>";
    let two = folder.scene(&format!("{shape}<shape type='sphere'/>"));
    for (path, most) in [(obj, 1.0), (two, 0.5)] {
        let told = Arc::new(Mutex::new(Vec::new()));
        let teller = Arc::clone(&told);
        let progress = Progress::new(move |share| teller.lock().expect("whole").push(share));
        open(&path, &Options { progress, ..Options::default() }).expect("a scene");
        let told = told.lock().expect("whole");
        assert!(told.len() > 10 && told.is_sorted(), "{told:?}");
        assert!(told[0] == 0.0 && told.iter().any(|share| (0.8 * most..=most).contains(share)), "{told:?}");
    }
}

#[test]
fn a_scene_of_pbrt_ends_in_the_middle_of_its_lists() {
    let folder = Folder::new("pbrt");
    let mut text =
        "Film \"rgb\" Camera \"perspective\" WorldBegin Shape \"trianglemesh\" \"point3 P\" [".to_owned();
    corners().for_each(|[x, y, z]| write!(text, " {x} {y} {z}").expect("a string"));
    text.push_str("] \"integer indices\" [");
    triangles().for_each(|[a, b, c]| write!(text, " {a} {b} {c}").expect("a string"));
    text.push_str("]\nShape \"loopsubdiv\" \"integer levels\" 3 \"point3 P\" [0 0 0 1 0 0 0 1 0]\n");
    text.push_str(&"Shape \"sphere\" ".repeat(10));
    let (asked, opened) = questions(&folder.write("scene.pbrt", text));
    // Lists of 54,004 and 54,000 numbers are asked about every 4096, which version the file is of included.
    assert!(asked > 40, "{asked}");
    assert_eq!((opened.description.shapes.len(), opened.warnings.len()), (12, 0));
}
