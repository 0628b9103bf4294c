//! Surfaces: where they are and of which shape.

use std::sync::Arc;

use foton_math::glam::{DAffine3, DVec2, DVec3};

use super::texture::Colour;

/// A surface with its material.
#[derive(Clone, Debug)]
pub struct ShapeDescription {
    /// The id in the file, or `shape-N` with its number in the file, from 1.
    pub name: String,
    /// The surface in object space.
    pub geometry: Geometry,
    /// Object to world.
    pub to_world: DAffine3,
    /// Turns all normals around: what was outside is inside.
    pub flip_normals: bool,
    /// Index into [`SceneDescription::materials`](super::SceneDescription::materials).
    pub material: usize,
    /// Emitted radiance on the side that the normal points to (W·m⁻²·sr⁻¹), where the surface is an area emitter.
    pub radiance: Option<Colour>,
}

/// A surface in object space.
#[derive(Clone, Debug)]
pub enum Geometry {
    /// Triangles.
    Mesh(Arc<Mesh>),
    /// A sphere, its normal outwards. A transform may turn, move and scale it evenly, nothing else.
    Sphere {
        /// The centre.
        centre: DVec3,
        /// The radius, above zero.
        radius: f64,
    },
    /// The unit disc in the xy plane, its normal +z. A transform must keep it circular.
    Disc,
    /// An open tube between two points, its normal away from the axis. A transform must keep it round.
    Cylinder {
        /// Middle of one end.
        from: DVec3,
        /// Middle of the other end.
        to: DVec3,
        /// The radius, above zero.
        radius: f64,
    },
}

/// Triangles over shared vertices.
///
/// Where there are vertex normals, they say which side of a triangle is outside; without them the winding does
/// (counter-clockwise seen from outside).
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Vertex positions.
    pub positions: Vec<DVec3>,
    /// Vertex normals, need not be of unit length: one a position, or none for flat faces.
    pub normals: Vec<DVec3>,
    /// Texture coordinates: one a position, or none.
    pub texture_coordinates: Vec<DVec2>,
    /// Vertex indices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// What else it states of its vertices or triangles, for textures.
    pub attributes: Vec<Attribute>,
}

/// Numbers that a mesh states of each of its vertices or triangles, colours for example.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribute {
    /// What textures call it. It begins with `vertex_`, or with `face_` where triangles have it.
    pub name: String,
    /// How many numbers each has: 1, or 3 for a linear colour.
    pub channels: usize,
    /// The numbers, one vertex or triangle after the other.
    pub values: Arc<[f32]>,
}

impl Attribute {
    /// Whether triangles have it, not vertices.
    #[must_use]
    pub fn is_of_faces(&self) -> bool {
        self.name.starts_with("face_")
    }
}

impl Mesh {
    /// Whether a triangle has an area that double precision can tell, its corners being there. Others are left out of scenes, and
    /// nothing goes by where their corners are.
    #[must_use]
    pub fn has_area(&self, triangle: [u32; 3]) -> bool {
        let [Some(&a), Some(&b), Some(&c)] = triangle.map(|i| self.positions.get(i as usize)) else {
            return false;
        };
        let (u, v, w) = (b - a, c - a, c - b);
        let longest = u.abs().max(v.abs()).max(w.abs()).max_element();
        longest > 0.0 && (u / longest).cross(v / longest).length_squared() > FLATTEST * FLATTEST
    }

    /// The square [−1, 1]² in the xy plane, its normal +z.
    #[must_use]
    pub fn rectangle() -> Self {
        let corner = |x, y| DVec3::new(x, y, 0.0);
        Self {
            positions: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
            normals: Vec::new(),
            texture_coordinates: [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Self::default()
        }
    }

    /// The cube [−1, 1]³ with flat faces, normals outwards; texture coordinates cover each face, turned as in Mitsuba 3.
    #[must_use]
    pub fn cube() -> Self {
        let corner = |i: i32| {
            let side = |bit: i32| if i & bit == 0 { -1.0 } else { 1.0 };
            DVec3::new(side(1), side(2), side(4))
        };
        const ALONG: [(f64, f64); 4] = [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)];
        // The corners of each face, and which of them has the first texture coordinates.
        let faces = [
            ([0, 4, 6, 2], 0),
            ([1, 3, 7, 5], 3),
            ([0, 1, 5, 4], 0),
            ([2, 6, 7, 3], 2),
            ([0, 2, 3, 1], 1),
            ([4, 5, 7, 6], 0),
        ];
        let mut cube = Self::default();
        for (corners, first) in faces {
            let start = cube.positions.len() as u32;
            cube.positions.extend(corners.map(corner));
            cube.texture_coordinates.extend((0..4).map(|i| DVec2::from(ALONG[(i + 4 - first) % 4])));
            cube.triangles.extend([[0, 1, 2], [0, 2, 3]].map(|t| t.map(|i: u32| start + i)));
        }
        cube
    }
}

/// The height of a triangle of no area, by its longest side: rounding.
const FLATTEST: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_of_the_cube_point_outwards() {
        let cube = Mesh::cube();
        for t in &cube.triangles {
            let [a, b, c] = t.map(|i| cube.positions[i as usize]);
            assert!((b - a).cross(c - a).dot(a + b + c) > 0.0, "{t:?}");
        }
        assert_eq!(cube.triangles.len(), 12);
    }

    #[test]
    fn texture_coordinates_of_the_cube_are_those_of_mitsuba() {
        // Printed by Mitsuba 3.9.1: a corner of each face, the face's normal, and the coordinates there.
        let printed = [
            ([1.0, -1.0, -1.0], [0.0, -1.0, 0.0], [0.0, 1.0]),
            ([-1.0, -1.0, 1.0], [0.0, -1.0, 0.0], [1.0, 0.0]),
            ([1.0, 1.0, -1.0], [0.0, 1.0, 0.0], [0.0, 1.0]),
            ([-1.0, 1.0, 1.0], [0.0, 1.0, 0.0], [1.0, 0.0]),
            ([1.0, -1.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0]),
            ([1.0, 1.0, 1.0], [1.0, 0.0, 0.0], [1.0, 0.0]),
            ([1.0, -1.0, 1.0], [0.0, 0.0, 1.0], [0.0, 1.0]),
            ([-1.0, 1.0, 1.0], [0.0, 0.0, 1.0], [1.0, 0.0]),
            ([-1.0, -1.0, 1.0], [-1.0, 0.0, 0.0], [0.0, 1.0]),
            ([-1.0, 1.0, -1.0], [-1.0, 0.0, 0.0], [1.0, 0.0]),
            ([1.0, 1.0, -1.0], [0.0, 0.0, -1.0], [0.0, 1.0]),
            ([-1.0, -1.0, -1.0], [0.0, 0.0, -1.0], [1.0, 0.0]),
        ];
        let cube = Mesh::cube();
        for (corner, normal, uv) in printed {
            let (corner, normal) = (DVec3::from(corner), DVec3::from(normal));
            let on_face = |f: &usize| cube.positions[4 * f..4 * f + 4].iter().all(|p| p.dot(normal) == 1.0);
            let face = (0..6).find(on_face).expect("a face of that normal");
            let i = (4 * face..4 * face + 4).find(|&i| cube.positions[i] == corner).expect("that corner");
            assert_eq!(cube.texture_coordinates[i], DVec2::from(uv), "{corner} of {normal}");
        }
    }
}
