//! Mesh files: every format against the same few triangles, and what a person reads when a file is wrong.

mod bare;
mod exporters;

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use foton_format::{Opened, Options, Severity, open, read_str};
use foton_math::Rgb;
use foton_math::glam::{DVec2, DVec3};
use foton_scene::description::{Bsdf, EmitterKind, Geometry, Mesh};

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

/// A quad and a triangle as a PLY file; lists and elements that are not asked for stand around them.
fn ply(format: &str, put: impl Fn(&mut Vec<u8>, &str, f64)) -> Vec<u8> {
    let mut bytes = format!(
        "ply\r\nformat {format} 1.0\ncomment made by hand\nobj_info none\nelement camera 1\nproperty list uchar short pose\n\
         property double f\nelement vertex 5\nproperty float x\nproperty uchar red\nproperty double y\nproperty float32 z\n\
         property float s\nproperty float t\nproperty list uint8 int8 tags\nelement face 2\nproperty uchar flags\n\
         property list uchar ushort vertex_index\nproperty list ushort float weights\nend_header\n"
    )
    .into_bytes();
    let mut line = |values: &[(&str, f64)]| {
        values.iter().for_each(|(kind, value)| put(&mut bytes, kind, *value));
        put(&mut bytes, "end", 0.0);
    };
    line(&[("u8", 2.0), ("i16", -7.0), ("i16", 300.0), ("f64", 0.1)]);
    for (i, [x, y, z]) in points().iter().map(DVec3::to_array).enumerate() {
        let uv = [("f32", i as f64), ("f32", 0.25)];
        line(&[("f32", x), ("u8", 9.0), ("f64", y), ("f32", z), uv[0], uv[1], ("u8", 1.0), ("i8", -1.0)]);
    }
    let corners = |list: &[u16]| list.iter().map(|&i| ("u16", f64::from(i))).collect::<Vec<_>>();
    let tail = [("u16", 1.0), ("f32", 0.5)];
    line(&[&[("u8", 1.0), ("u8", 4.0)][..], &corners(&[0, 1, 2, 3]), &tail].concat());
    line(&[&[("u8", 0.0), ("u8", 3.0)][..], &corners(&[0, 4, 1]), &[("u16", 0.0)]].concat());
    bytes
}

fn text(bytes: &mut Vec<u8>, kind: &str, value: f64) {
    let end = if kind == "end" { " and more\r\n".to_owned() } else { format!(" {value}") };
    bytes.extend(end.into_bytes());
}

fn little(bytes: &mut Vec<u8>, kind: &str, value: f64) {
    match kind {
        "u8" => bytes.push(value as u8),
        "i8" => bytes.push(value as i8 as u8),
        "i16" => bytes.extend((value as i16).to_le_bytes()),
        "u16" => bytes.extend((value as u16).to_le_bytes()),
        "f32" => bytes.extend((value as f32).to_le_bytes()),
        "f64" => bytes.extend(value.to_le_bytes()),
        _ => {}
    }
}

fn big(bytes: &mut Vec<u8>, kind: &str, value: f64) {
    let mut number = Vec::new();
    little(&mut number, kind, value);
    number.reverse();
    bytes.extend(number);
}

fn all_ply() -> [(&'static str, Vec<u8>); 3] {
    [
        ("ascii", ply("ascii", text)),
        ("little", ply("binary_little_endian", little)),
        ("big", ply("binary_big_endian", big)),
    ]
}

#[test]
fn a_ply_file_is_the_same_in_text_and_in_both_byte_orders() {
    for (name, bytes) in all_ply() {
        let mesh = shape("ply", &bytes, "").unwrap_or_else(|e| panic!("{name}: {e:?}"));
        assert_eq!(mesh.positions, points(), "{name}");
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 4, 1]], "{name}");
        let uv: Vec<_> = (0..5).map(|i| DVec2::new(f64::from(i), 0.25)).collect();
        assert_eq!(mesh.texture_coordinates, uv, "{name}");
        assert_eq!(mesh.normals.len(), 5, "{name}: smooth ones are computed");
        assert!((mesh.normals[2] - DVec3::Z).length() < 1e-12, "{name}: {:?}", mesh.normals);
        let flat = shape("ply", &bytes, "<boolean name='face_normals' value='true'/>").unwrap();
        assert_eq!((flat.normals.len(), flat.triangles.len()), (0, 3), "{name}");
    }
}

#[test]
fn a_ply_file_that_ends_early_anywhere_is_an_error() {
    for (name, bytes) in all_ply() {
        assert!(shape("ply", &bytes, "").is_ok(), "{name}");
        // The text goes on with a list of no length and words that are ignored.
        let needed = if name == "ascii" { bytes.len() - b" 0 and more\r\n".len() } else { bytes.len() - 1 };
        for length in 0..=needed {
            let result = shape("ply", &bytes[..length], "");
            assert!(result.is_err(), "{name}: {length} of {} bytes are enough", bytes.len());
        }
    }
}

#[test]
fn normals_of_a_ply_file_are_kept_and_bad_ones_computed() {
    let file = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                property float nx\nproperty float ny\nproperty float nz\nelement face 1\n\
                property list uchar int vertex_indices\nend_header\n\
                0 0 0 0 1 1\n1 0 0 0 0 0\n0 1 0 nan 0 1\n3 0 1 2\n";
    let mesh = shape("ply", file.as_bytes(), "").unwrap();
    assert_eq!(mesh.normals, [DVec3::new(0.0, 1.0, 1.0), DVec3::Z, DVec3::Z]);
}

/// The header of a text file up to its faces, and three vertices.
const TRIANGLE: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                        element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n";

#[test]
fn what_is_wrong_with_a_ply_file_is_said_with_its_line() {
    let with = |from: &str, to: &str| format!("{TRIANGLE}3 0 1 2\n").replacen(from, to, 1);
    for (file, wanted) in [
        (String::new(), "m:1: the file does not begin with \"ply\""),
        ("solid\n".to_owned(), "m:1: the file does not begin with \"ply\""),
        (with("end_header", "end_head"), "m:9: \"end_head\" is not understood in a header"),
        (with("format ascii 1.0\n", ""), "m:8: the header has no \"format\" line"),
        (with("ascii", "asci"), "m:2: \"format asci 1.0\" is not understood in a header"),
        (with("float y", "flaot y"), "m:5: unknown type \"flaot\""),
        (with("float y", "float q"), "m:9: a vertex needs x, y and z"),
        (with("list uchar", "list float"), "m:8: the length of a list must be a whole number"),
        (with("vertex_indices", "corners"), "m:9: a face needs one list \"vertex_indices\""),
        (with("face 1", "face 0"), "m:9: the file has no faces"),
        (with("vertex 3", "vertex 0"), "m:9: the file has no vertices"),
        (with("element face", "element vertex"), "m:7: element \"vertex\" is declared twice"),
        (with("\n1 0 0\n", "\n1 0\n"), "m:11: the line ends where a number is needed"),
        (with("\n1 0 0\n", "\n1 x 0\n"), "m:11: \"x\" is not a number"),
        (with("\n1 0 0\n", "\n1 inf 0\n"), "m:11: the position 1 inf 0 is not finite"),
        (with("3 0 1 2", "3 0 1 3"), "m:13: there is no vertex 3, the file has 3"),
        (with("3 0 1 2", "3 0 1 -1"), "m:13: there is no vertex -1, the file has 3"),
        (with("3 0 1 2", "3 0 1 0.5"), "m:13: there is no vertex 0.5, the file has 3"),
        (with("3 0 1 2", "2 0 1"), "m: the file has no faces"),
        (with("3 0 1 2", "-1"), "m:13: -1 is not the length of a list"),
        (with("3 0 1 2", "4 0 1 2"), "m:13: the line ends where a number is needed"),
        (with("\n3 0 1 2\n", ""), "m:12: the file is too short for 1 × face"),
        // The face is taken for the last vertex.
        (with("vertex 3", "vertex 4"), "m:14: the file is too short for 1 × face"),
    ] {
        assert_eq!(problem("ply", file.as_bytes()), wanted, "of {file}");
    }
}

#[test]
fn what_is_wrong_with_a_binary_ply_file_is_said_with_its_byte() {
    let header = TRIANGLE.split_inclusive("end_header\n").next().unwrap();
    let header = header.replace("ascii", "binary_little_endian");
    let file = |last: i32| {
        let mut bytes = header.clone().into_bytes();
        let floats = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0_f32];
        floats.iter().for_each(|f| bytes.extend(f.to_le_bytes()));
        bytes.push(3);
        [0, 1, last].iter().for_each(|i| bytes.extend(i.to_le_bytes()));
        bytes
    };
    assert!(shape("ply", &file(2), "").is_ok());
    let end = header.len() + 36 + 13;
    assert_eq!(problem("ply", &file(3)), format!("m: byte {end}: there is no vertex 3, the file has 3"));
    let cut = problem("ply", &file(2)[..end - 1]);
    assert_eq!(cut, format!("m: byte {}: the file ends where a number is needed", end - 4));
    let mut not_finite = file(2);
    not_finite[header.len() + 4..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    let at = header.len() + 12;
    assert_eq!(problem("ply", &not_finite), format!("m: byte {at}: the position 0 NaN 0 is not finite"));
}

#[test]
fn a_count_that_lies_is_refused_before_anything_is_allocated() {
    for count in [1 << 20, u64::from(u32::MAX), u64::MAX] {
        for format in ["ascii", "binary_little_endian"] {
            let lie = |element: &str| {
                let (from, to) = (format!("{element} 3"), format!("{element} {count}"));
                let file =
                    TRIANGLE.replace("face 1", "face 3").replace("ascii", format).replacen(&from, &to, 1);
                problem("ply", file.as_bytes())
            };
            let found = lie("vertex");
            assert!(found.contains("too short for") || found.contains("more vertices"), "{found}");
            assert!(lie("face").contains("too short for"), "{}", lie("face"));
        }
    }
    // A list that claims to be long.
    let long = format!("{TRIANGLE}4294967295 0 1 2\n").replace("uchar int", "uint int");
    assert_eq!(problem("ply", long.as_bytes()), "m:13: the line ends where a number is needed");
}

const STL: &str = "solid wedge\n facet normal 0 0 0\n  outer loop\n   vertex 0 0 0\n   vertex 1e0 0 0\n   vertex 0 1 0\n  endloop\n\
                   endfacet\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 1\nVERTEX 1 0 1\nVERTEX 0 1 1\nENDLOOP\nENDFACET\nendsolid wedge\n";

fn binary_stl(header: &[u8], trailing: usize) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend(2_u32.to_le_bytes());
    for z in [0.0, 1.0_f32] {
        let floats = [0.0, 0.0, 0.0, 0.0, 0.0, z, 1.0, 0.0, z, 0.0, 1.0, z];
        floats.iter().for_each(|f| bytes.extend(f.to_le_bytes()));
        bytes.extend([0, 0]);
    }
    bytes.resize(bytes.len() + trailing, 0);
    bytes
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
fn an_stl_file_is_the_same_in_text_and_in_bytes() {
    let folder = Folder::new("stl");
    let triangles = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(DVec3::from_array);
    let above = triangles.map(|p| p + DVec3::Z);
    let wanted = [triangles, above].concat();
    for (i, bytes) in [
        STL.as_bytes().to_vec(),
        binary_stl(b"made by a program", 0),
        binary_stl(b"solid made by a program that did not know", 0),
        binary_stl(b"made by a program", 7),
    ]
    .iter()
    .enumerate()
    {
        let path = folder.file(&format!("{i}.STL"), bytes);
        let opened = open(&path, &Options::default()).unwrap_or_else(|e| panic!("{i}: {e}"));
        let mesh = mesh(&opened, 0);
        assert_eq!(mesh.positions, wanted, "{i}");
        assert_eq!((&mesh.triangles[..], mesh.normals.len()), (&[[0, 1, 2], [3, 4, 5]][..], 0), "{i}");
    }
}

#[test]
fn what_is_wrong_with_an_stl_file_is_said() {
    let folder = Folder::new("bad-stl");
    let with = |from: &str, to: &str| STL.replacen(from, to, 1).into_bytes();
    let nan = {
        let mut bytes = binary_stl(b"", 0);
        bytes[84 + 50 + 12..][..4].copy_from_slice(&f32::INFINITY.to_le_bytes());
        bytes
    };
    for (i, (bytes, wanted)) in [
        (b"".to_vec(), "the file is too short for the triangles that it states, or no STL file"),
        (b"solid nothing\nendsolid\n".to_vec(), "the file has no triangles"),
        (with("vertex 1e0 0 0", "vertex 1 0"), ":5:4: \"vertex\" needs three numbers, not 2"),
        (with("vertex 1e0", "vertex nan"), ":5:11: \"nan\" is not a finite number"),
        (with("   vertex 1e0 0 0\n", ""), ":6:3: a facet has three corners, not 2"),
        (with("ENDLOOP", "ENDLOP"), ":14:1: \"endlop\" is not understood"),
        (
            binary_stl(b"", 0)[..183].to_vec(),
            "the file is too short for the triangles that it states, or no STL file",
        ),
        (nan, "byte 134: a triangle's corner is not finite"),
    ]
    .into_iter()
    .enumerate()
    {
        let path = folder.file(&format!("{i}.stl"), &bytes);
        let error = open(&path, &Options::default()).unwrap_err().to_string();
        assert!(error.ends_with(wanted), "{i}: {error}");
    }
}

/// Meshes of a file in turn: whether they are double, have normals, texture coordinates, colours.
const KINDS: [(bool, bool, bool, bool); 3] =
    [(false, false, false, true), (true, true, true, false), (false, true, false, true)];

/// A `.serialized` file as Mitsuba writes them.
fn serialized(version: u16) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut offsets = Vec::new();
    for (number, (double, normals, uv, colours)) in KINDS.into_iter().enumerate() {
        offsets.push(bytes.len() as u64);
        bytes.extend([0x1c, 0x04]);
        bytes.extend(version.to_le_bytes());
        let mut stream = flate2::write::ZlibEncoder::new(&mut bytes, flate2::Compression::default());
        let mut put = |part: &[u8]| stream.write_all(part).unwrap();
        let flags =
            u32::from(normals) | u32::from(uv) << 1 | u32::from(colours) << 3 | 0x1000 << u32::from(double);
        put(&flags.to_le_bytes());
        if version == 4 {
            put(format!("mesh {number}\0").as_bytes());
        }
        put(&5_u64.to_le_bytes());
        put(&2_u64.to_le_bytes());
        let mut numbers = |values: &[f32]| {
            for value in values {
                if double { put(&f64::from(*value).to_le_bytes()) } else { put(&value.to_le_bytes()) }
            }
        };
        let shifted: Vec<f32> = POINTS.concat().iter().map(|x| x + number as f32).collect();
        numbers(&shifted);
        numbers(&[0.0, 0.0, 1.0].repeat(if normals { 5 } else { 0 }));
        numbers(&[0.25, 0.75].repeat(if uv { 5 } else { 0 }));
        numbers(&[9.0, 9.0, 9.0].repeat(if colours { 5 } else { 0 }));
        [0_u32, 1, 2, 0, 4, 1].iter().for_each(|i| put(&i.to_le_bytes()));
        stream.finish().unwrap();
    }
    for offset in offsets {
        if version == 3 {
            bytes.extend(u32::try_from(offset).unwrap().to_le_bytes());
        } else {
            bytes.extend(offset.to_le_bytes());
        }
    }
    bytes.extend(3_u32.to_le_bytes());
    bytes
}

fn index(i: i32) -> String {
    format!("<integer name='shape_index' value='{i}'/>")
}

#[test]
fn every_mesh_of_a_serialized_file_is_found_by_its_number() {
    for version in [3, 4] {
        let bytes = serialized(version);
        for (number, (_, normals, uv, _)) in KINDS.into_iter().enumerate() {
            let mesh = shape("serialized", &bytes, &index(number as i32)).unwrap();
            let shift = DVec3::splat(number as f64);
            assert_eq!(mesh.positions, points().iter().map(|p| *p + shift).collect::<Vec<_>>());
            assert_eq!(mesh.triangles, [[0, 1, 2], [0, 4, 1]]);
            assert_eq!(mesh.normals == [DVec3::Z; 5], normals, "computed where they are missing");
            assert_eq!(mesh.texture_coordinates == [DVec2::new(0.25, 0.75); 5], uv);
        }
        assert_eq!(shape("serialized", &bytes, "").unwrap().positions, points());
    }
}

#[test]
fn what_is_wrong_with_a_serialized_file_is_said() {
    let bytes = serialized(4);
    let found = |bytes: &[u8], i: i32| shape("serialized", bytes, &index(i)).unwrap_err().remove(0);
    assert_eq!(found(&bytes, 3), "m: there is no mesh 3, the file has 3, counted from 0");
    assert!(found(&bytes, -1).ends_with("\"shape_index\" must not be negative"));
    assert_eq!(found(b"PK", 0), "m: this is not a serialized mesh");
    assert_eq!(found(&[0x1c, 4, 5, 0], 0), "m: version 5 is not read, only 3 and 4");
    assert!(found(&bytes[..40], 0).starts_with("m: the compressed data is broken"));
    // The last mesh claims to begin beyond the end.
    let mut beyond = bytes;
    let at = beyond.len() - 12;
    beyond[at..at + 8].fill(0xff);
    assert_eq!(found(&beyond, 2), "m: mesh 2: this is not a serialized mesh");
    let claim = |vertices: u64| {
        let mut file = vec![0x1c, 4, 4, 0];
        let mut stream = flate2::write::ZlibEncoder::new(&mut file, flate2::Compression::default());
        stream.write_all(&[0, 0x10, 0, 0, 0]).unwrap();
        stream.write_all(&[vertices.to_le_bytes(), vertices.to_le_bytes()].concat()).unwrap();
        stream.finish().unwrap();
        found(&file, 0)
    };
    assert_eq!(claim(0), "m: the mesh is empty");
    assert_eq!(claim(1 << 31), "m: the file is too short for what it claims to hold");
    assert_eq!(claim(u64::MAX), "m: the mesh has more vertices than can be numbered");
    assert_eq!(claim(100), "m: the mesh ends too early");
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
