//! `.serialized` files: every mesh by its number, and what is said of bad ones.

use std::io::Write;

use foton_math::glam::{DVec2, DVec3};

use super::{POINTS, points, shape};

/// Meshes of a file in turn: whether they are double, have normals, texture coordinates, colours.
const KINDS: [(bool, bool, bool, bool); 3] =
    [(false, false, false, true), (true, true, true, false), (false, true, false, true)];

/// A `.serialized` file as Mitsuba writes them.
pub(crate) fn serialized(version: u16) -> Vec<u8> {
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

pub(crate) fn index(i: i32) -> String {
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
