//! What is read of OBJ files, and what is said of bad ones.

use foton_math::Cancel;
use foton_math::glam::{DVec2, DVec3};

use super::parser::MAX_PROBLEMS;
use super::*;

fn read(text: &str) -> Obj {
    Obj::parse(text.as_bytes(), &Cancel::default()).map_err(|p| format!("{p:?}")).unwrap()
}

fn problems(text: &str) -> Vec<String> {
    let problems = Obj::parse(text.as_bytes(), &Cancel::default()).err().unwrap_or_default();
    problems.iter().map(|(p, message)| format!("{}:{}: {message}", p.line, p.column)).collect()
}

fn positions(obj: &Obj) -> Vec<[u32; 3]> {
    obj.triangles.iter().map(|t| t.map(|c| c.position)).collect()
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn every_form_of_a_corner_is_read() {
    let obj = read(&format!(
        "{SQUARE}vt 0 0\nvn 0 0 2\nf 1 2 3\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 2/1/1 3/1/1\n"
    ));
    let firsts: Vec<_> = obj.triangles.iter().map(|t| (t[0].texture, t[0].normal)).collect();
    assert_eq!(firsts, [(0, 0), (1, 0), (0, 1), (1, 1)]);
    assert_eq!(obj.normals, [DVec3::new(0.0, 0.0, 2.0)]);
    assert_eq!(positions(&obj), [[0, 1, 2]; 4]);
}

#[test]
fn negative_numbers_count_back_from_the_face() {
    let obj = read("v 0 0 0\nv 1 0 0\nv 1 1 0\nvn 0 0 1\nf -3//-1 -2//-1 -1//-1\nv 5 5 5\nf -4 -3 -2\n");
    assert_eq!(positions(&obj), [[0, 1, 2], [0, 1, 2]]);
    assert_eq!(obj.triangles[0][0].normal, 1);
}

#[test]
fn a_polygon_becomes_a_fan() {
    assert_eq!(
        positions(&read(&format!("{SQUARE}v 2 2 2\nf 1 2 3 4 5\n"))),
        [[0, 1, 2], [0, 2, 3], [0, 3, 4]]
    );
}

#[test]
fn a_concave_polygon_becomes_ears_and_materials_keep_their_faces() {
    // An arrow with corners on its edges, one of them named twice, and a square of another material. The points come later.
    let text = format!(
        "f 5 6 7 7 8 9\nusemtl m\nf 1 2 3 4\n{SQUARE}v 0 0 0\nv 4 2 0\nv 0 4 0\nv 0.5 3 0\nv 1 2 0\n"
    );
    let obj = read(&text);
    let area = |t: &[Corner; 3]| {
        let [a, b, c] = t.map(|c| obj.positions[c.position as usize]);
        0.5 * (b - a).cross(c - a).z
    };
    let start = obj.materials[0].0;
    assert_eq!(positions(&obj)[start..], [[0, 1, 2], [0, 2, 3]]);
    assert!(obj.triangles[..start].iter().all(|t| area(t) > 0.0), "{:?}", positions(&obj));
    assert!((obj.triangles[..start].iter().map(area).sum::<f64>() - 6.0).abs() < 1e-12);
    assert_eq!(obj.warnings, []);
}

#[test]
fn what_exporters_get_wrong_is_mended_and_counted() {
    let text = format!(
        "{SQUARE}vn 0 0 1\nvn nan 0 0\nvn 0 0 0\nvn 0 0 0\nvn -nan(ind) 0 1\nvt 1 1\nvt 0.5 1.#QNAN\nf 1 2\nf\n\
         f 1/1/1 2/2/2 3/1/3\nf 1//5 3//1 4//1\nf 1 4 3 2 # and a face that crosses itself\nf 1 3 2 4\n"
    );
    let obj = read(&text);
    assert_eq!(obj.triangles.len(), 6);
    assert_eq!(obj.triangles[0].map(|c| c.normal), [1, 0, 0]);
    assert_eq!(obj.triangles[1].map(|c| c.normal), [0, 1, 1]);
    assert_eq!(obj.textures, [DVec2::ONE, DVec2::ZERO]);
    let said: Vec<_> = obj.warnings.iter().map(|(p, m)| format!("{}: {m}", p.line)).collect();
    assert_eq!(
        said,
        [
            format!("12: 2 faces have {LEFT_OUT}"),
            format!("6: 3 normals are {NORMALS_MENDED}"),
            format!("11: 1 texture coordinate is {TEXTURES_MENDED}"),
            "0: 1 face has edges that cross: what is filled may not be what was meant".to_owned(),
        ]
    );
}

#[test]
fn positive_numbers_may_point_forward() {
    assert_eq!(positions(&read("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 1 1 0")), [[0, 1, 2]]);
}

#[test]
fn white_space_comments_and_other_statements_are_skipped() {
    let text = "\u{feff}# a comment \\\r\nmtllib x.mtl\r\no it\r\n\r\n  v\t0 0 0 1.0  \r\nv 1 0 0 # trailing\r\nv 1 1 \\\r\n 0 0.5 0.5 0.5\r\n\
                g a \\\nv b\ns off\nusemtl m\nf 1 \\\n2 3  \r\n";
    let obj = read(text);
    assert_eq!(obj.positions, [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0)]);
    assert_eq!(positions(&obj), [[0, 1, 2]]);
}

#[test]
fn every_problem_has_its_line_and_column() {
    let text = "v 0 0 0\nv 1 x 0\nv 1 1\nv 1 nan 0\nvn 0 0 0\nf 1 2\nf\nf 1 2 9\nf 0 1 2\nf -9 1 2\nf 1/2/3/4 1 2\nf 1//7 1 2\nf 1 \\\n  2 z\nf 1/5 1 1";
    assert_eq!(
        problems(text),
        [
            "2:5: \"x\" is not a number",
            "3:1: \"v\" needs three numbers, not 2",
            "4:5: \"nan\" is not a finite number",
            "8:7: there is no vertex 9, the file has 4",
            "9:3: there is no vertex 0, the file has 4",
            "10:3: there is no vertex -9, the file has 4",
            "11:3: \"1/2/3/4\" is not a corner such as 1, 1/2 or 1/2/3",
            "12:3: there is no normal 7, the file has 1",
            "14:5: \"z\" is not the number of a vertex",
            "15:3: there is no texture coordinate 5, the file has 0",
        ]
    );
}

#[test]
fn a_hopeless_file_is_reported_briefly() {
    let found = problems(&"f 1 2 3\n".repeat(1000));
    assert_eq!(found.len(), MAX_PROBLEMS + 1);
    assert_eq!(found[MAX_PROBLEMS], "0:0: 980 more problems in this file");
    assert_eq!(problems(SQUARE), ["0:0: the file has no faces"]);
    assert_eq!(problems(""), ["0:0: the file has no faces"]);
}

#[test]
fn any_bytes_are_read_or_refused_without_panic() {
    let pieces: [&[u8]; 12] =
        [b"v", b" 1", b"\n", b"f ", b"/", b"\\\n", b"-1", b"#", b"\xff", b"vn 0 0 1\n", b"\r", b"v 1 2 3\n"];
    let mut state = 1_u64;
    for _ in 0..20_000 {
        let mut text = Vec::new();
        for _ in 0..12 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            text.extend_from_slice(pieces[(state >> 33) as usize % pieces.len()]);
        }
        let _ = Obj::parse(&text, &Cancel::default());
    }
}
