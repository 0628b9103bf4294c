//! Generated meshes are closed and face outwards.

use std::collections::HashMap;

use super::mesh::{cross, dot, sub};
use super::*;

fn edges(face: &[[usize; 2]]) -> impl Iterator<Item = (usize, usize)> + '_ {
    (0..face.len()).map(|i| (face[i][0], face[(i + 1) % face.len()][0]))
}

#[test]
fn every_edge_of_a_solid_joins_two_faces_that_agree_on_its_outside() {
    for (name, solid) in solids() {
        let mut uses = HashMap::new();
        for edge in solid.faces.iter().flat_map(|face| edges(face)) {
            *uses.entry(edge).or_insert(0) += 1;
        }
        for (&(a, b), &count) in &uses {
            assert_eq!((count, uses.get(&(b, a))), (1, Some(&1)), "{name}: edge {a}-{b}");
        }
    }
}

#[test]
fn the_outside_of_a_solid_is_outside() {
    for (name, solid) in solids() {
        let mut volume = 0.0;
        for face in &solid.faces {
            for pair in face[1..].windows(2) {
                let [a, b, c] = [face[0][0], pair[0][0], pair[1][0]].map(|i| solid.positions[i]);
                volume += dot(a, cross(b, c)) / 6.0;
            }
        }
        assert!(volume > 0.1, "{name}: volume {volume}");
    }
}

#[test]
fn normals_agree_with_their_faces() {
    for (name, mesh) in solids().into_iter().chain(sheets()) {
        for face in &mesh.faces {
            let [a, b, c] = [0, 1, 2].map(|i| mesh.positions[face[i][0]]);
            let flat = cross(sub(b, a), sub(c, a));
            let length = dot(flat, flat).sqrt();
            for &[_, normal] in face {
                let cos = dot(flat, mesh.normals[normal]) / length;
                assert!(cos > 0.9, "{name}: face {face:?} is {cos} off its normal");
            }
        }
    }
}

#[test]
fn faces_are_flat_and_convex() {
    for (name, mesh) in solids().into_iter().chain(sheets()) {
        for face in &mesh.faces {
            let normal = mesh.normals[face[0][1]];
            let at = |i: usize| mesh.positions[face[i % face.len()][0]];
            let [first, second, third] = [at(0), at(1), at(2)];
            let flat = cross(sub(second, first), sub(third, first));
            for i in 0..face.len() {
                assert!(dot(flat, sub(at(i), first)).abs() < 1e-9, "{name}: {face:?} is bent");
                let turn = cross(sub(at(i + 1), at(i)), sub(at(i + 2), at(i + 1)));
                assert!(dot(turn, normal) > 0.0, "{name}: {face:?} is not convex");
            }
        }
    }
}

#[test]
fn the_files_in_the_tree_are_what_is_written() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets");
    for (name, mesh) in solids().into_iter().chain(sheets()) {
        let text = fs::read_to_string(folder.join(name)).expect("every mesh is committed");
        assert!(text == mesh.to_obj(), "{name} differs: run `cargo xtask assets`");
    }
}
