//! STL files: text and bytes, and what is said of bad ones.

use foton_format::{Options, open};
use foton_math::glam::DVec3;

use super::{Folder, mesh};

pub(crate) const STL: &str = "solid wedge\n facet normal 0 0 0\n  outer loop\n   vertex 0 0 0\n   vertex 1e0 0 0\n   vertex 0 1 0\n  endloop\n\
                   endfacet\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 1\nVERTEX 1 0 1\nVERTEX 0 1 1\nENDLOOP\nENDFACET\nendsolid wedge\n";

pub(crate) fn binary_stl(header: &[u8], trailing: usize) -> Vec<u8> {
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
