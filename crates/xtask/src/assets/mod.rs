//! The meshes of the scenes in `assets/`, made from a few numbers: what lies there is what [`write_all`] writes.
//!
//! Not a modeller: bodies of revolution, one cut gem, a curved backdrop, a basin of wavy water.

mod gem;
mod lathe;
mod mesh;
mod pool;
mod still_life;

use std::path::Path;
use std::{fs, io};

use mesh::Mesh;

/// Writes every generated file below `dir`, the folder `assets/`, and makes the folders that are missing.
///
/// # Errors
/// What the file system says.
pub(crate) fn write_all(dir: &Path) -> io::Result<()> {
    for (name, mesh) in solids().into_iter().chain(sheets()) {
        let path = dir.join(name);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        fs::write(path, mesh.to_obj())?;
    }
    Ok(())
}

/// The closed meshes, each with its file's path. All but the gem stand on y = 0; the outside is air.
fn solids() -> Vec<(&'static str, Mesh)> {
    vec![
        ("glass-and-ring/meshes/goblet.obj", still_life::goblet().revolve(96)),
        ("glass-and-ring/meshes/ring.obj", still_life::ring().revolve(160)),
        ("glass-and-ring/meshes/gem.obj", gem::gem()),
        ("ring/meshes/band.obj", still_life::band().revolve(160)),
    ]
}

/// The open ones.
fn sheets() -> Vec<(&'static str, Mesh)> {
    let [light, middle, dark] = pool::tiles();
    vec![
        ("glass-and-ring/meshes/backdrop.obj", still_life::backdrop()),
        ("pool/meshes/water.obj", pool::water()),
        ("pool/meshes/joints.obj", pool::joints()),
        ("pool/meshes/tiles-light.obj", light),
        ("pool/meshes/tiles-middle.obj", middle),
        ("pool/meshes/tiles-dark.obj", dark),
    ]
}

#[cfg(test)]
mod tests {
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
}
