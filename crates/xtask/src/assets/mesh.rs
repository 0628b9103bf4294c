//! Polygons with normals, and their text as Wavefront OBJ.
//!
//! Not a modeller's mesh: nothing is edited, and there are no texture coordinates.

use std::fmt::Write as _;

/// Flat convex polygons, counter-clockwise seen from outside.
#[derive(Default)]
pub(super) struct Mesh {
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) normals: Vec<[f64; 3]>,
    /// The (position, normal) indices of each corner.
    pub(super) faces: Vec<Vec<[usize; 2]>>,
}

impl Mesh {
    /// Adds a face with its own normal, sharing positions with the faces that are there.
    pub(super) fn flat_face(&mut self, corners: &[[f64; 3]]) {
        let normal = cross(sub(corners[1], corners[0]), sub(corners[2], corners[0]));
        let length = dot(normal, normal).sqrt();
        self.normals.push(normal.map(|x| x / length));
        let mut face = Vec::new();
        for &corner in corners {
            let near = |&p: &[f64; 3]| dot(sub(p, corner), sub(p, corner)) < 1e-18;
            let position = self.positions.iter().position(near).unwrap_or_else(|| {
                self.positions.push(corner);
                self.positions.len() - 1
            });
            face.push([position, self.normals.len() - 1]);
        }
        self.faces.push(face);
    }

    /// Wavefront OBJ text, five decimals for positions and four for normals.
    pub(super) fn to_obj(&self) -> String {
        let mut text = String::from("# Made by `cargo xtask assets`.\n");
        let mut list = |tag, vectors: &[[f64; 3]], scale: f64| {
            for v in vectors {
                // Adding zero turns -0 into 0.
                let [x, y, z] = v.map(|c| (c * scale).round() / scale + 0.0);
                writeln!(text, "{tag} {x} {y} {z}").expect("a String takes all text");
            }
        };
        list("v", &self.positions, 1e5);
        list("vn", &self.normals, 1e4);
        for face in &self.faces {
            text.push('f');
            for [position, normal] in face {
                write!(text, " {}//{}", position + 1, normal + 1).expect("a String takes all text");
            }
            text.push('\n');
        }
        text
    }
}

pub(super) fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
