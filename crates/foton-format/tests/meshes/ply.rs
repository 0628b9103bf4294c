//! PLY files: text and both byte orders, and what is said of bad ones.

use foton_math::glam::{DVec2, DVec3};

use super::{points, problem, shape};

/// A quad and a triangle as a PLY file; lists and elements that are not asked for stand around them.
pub(crate) fn ply(format: &str, put: impl Fn(&mut Vec<u8>, &str, f64)) -> Vec<u8> {
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

pub(crate) fn little(bytes: &mut Vec<u8>, kind: &str, value: f64) {
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

pub(crate) fn all_ply() -> [(&'static str, Vec<u8>); 3] {
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

/// What a file of two faces, the first of four corners, states of its vertices and faces.
fn attributes(
    vertex: &str,
    of_vertex: &str,
    face: &str,
    of_faces: [&str; 2],
) -> Vec<(String, usize, Vec<f32>)> {
    let file = format!(
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n{vertex}\
         element face 2\nproperty list uchar int vertex_indices\n{face}end_header\n\
         0 0 0 {of_vertex}\n1 0 0 {of_vertex}\n1 1 0 {of_vertex}\n0 1 0 {of_vertex}\n2 2 0 {of_vertex}\n\
         4 0 1 2 3 {}\n3 1 4 2 {}\n",
        of_faces[0], of_faces[1]
    );
    let mesh = shape("ply", file.as_bytes(), "").unwrap();
    mesh.attributes.iter().map(|a| (a.name.clone(), a.channels, a.values.to_vec())).collect()
}

#[test]
fn colours_and_numbers_of_vertices_and_faces_are_attributes() {
    let bytes = "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n";
    let found = attributes(bytes, "255 128 0 7", "", ["", ""]);
    assert_eq!((found.len(), found[0].0.as_str(), found[0].1), (1, "vertex_color", 3));
    assert!((found[0].2[3] - 1.0).abs() < 1e-6 && (found[0].2[4] - 0.215_86).abs() < 1e-4, "sRGB: {found:?}");
    let floats = "property float w_0\nproperty float foo_r\nproperty float foo_g\nproperty float foo_b\nproperty float q\n";
    let found = attributes(floats, "0.5 1 2 3 9", "", ["", ""]);
    let names: Vec<_> = found.iter().map(|(name, channels, _)| (name.as_str(), *channels)).collect();
    assert_eq!(names, [("vertex_w", 1), ("vertex_foo_color", 3)]);
    assert_eq!((found[0].2[4], &found[1].2[..3]), (0.5, &[1.0, 2.0, 3.0][..]));
    let found = attributes("", "", "property float id_0\n", ["7", "8"]);
    assert_eq!(
        found,
        [("face_id".to_owned(), 1, vec![7.0, 7.0, 8.0])],
        "each triangle has what its face has"
    );
}
