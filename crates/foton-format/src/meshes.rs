//! Mesh files of a scene: each is read once, and becomes vertices that triangles share.
//!
//! Mitsuba 3.9 was asked what it makes of an OBJ file, and this follows it:
//! - Corners with the same position and normal share a vertex. Normals of the file are kept.
//! - Without normals, smooth ones are computed: the mean of the adjoining faces' unit normals, weighted by the angle
//!   at the vertex, *after* `to_world`; so they follow the winding in the world. Corners that differ in their texture
//!   coordinate do not share a vertex then, so a texture seam is a crease. Where the mean vanishes it is the x axis.
//! - `face_normals` drops all normals.
//!
//! In a file with normals for some corners only, Mitsuba leaves the others undefined; here they are computed.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::Mesh;

use crate::ReadFile;
use crate::diagnostic::{Place, Report};
use crate::hash::Fnv1a;
use crate::obj::{Corner, Obj};

/// The files that a scene names.
pub(crate) struct Meshes<'a> {
    folder: &'a Path,
    files: &'a ReadFile<'a>,
    /// What each file holds; `None` if it could not be read, which was reported.
    read: HashMap<PathBuf, Option<Rc<Obj>>>,
    /// Meshes that do not depend on a transform, by file and `face_normals`.
    built: HashMap<(PathBuf, bool), Arc<Mesh>>,
    /// The contents of all files, in the order in which they were first named.
    pub(crate) hash: Fnv1a,
}

impl<'a> Meshes<'a> {
    pub(crate) fn new(folder: &'a Path, files: &'a ReadFile<'a>) -> Self {
        Self { folder, files, read: HashMap::new(), built: HashMap::new(), hash: Fnv1a::default() }
    }

    /// The mesh of an OBJ file named at `place`.
    pub(crate) fn obj(
        &mut self,
        filename: &str,
        place: Place,
        face_normals: bool,
        to_world: &DAffine3,
        report: &mut Report,
    ) -> Option<Arc<Mesh>> {
        let path = self.folder.join(filename);
        let key = (path, face_normals);
        if let Some(mesh) = self.built.get(&key) {
            return Some(Arc::clone(mesh));
        }
        if !self.read.contains_key(&key.0) {
            let obj = self.read_obj(&key.0, place, report).map(Rc::new);
            self.read.insert(key.0.clone(), obj);
        }
        let obj = Rc::clone(self.read.get(&key.0)?.as_ref()?);
        let mesh = Arc::new(build(&obj, face_normals, to_world));
        let depends_on_transform = !face_normals && obj.triangles.iter().flatten().any(|c| c.normal == 0);
        if !depends_on_transform {
            self.built.insert(key, Arc::clone(&mesh));
        }
        Some(mesh)
    }

    fn read_obj(&mut self, path: &Path, place: Place, report: &mut Report) -> Option<Obj> {
        let file = path.to_string_lossy();
        let bytes = match (self.files)(path) {
            Ok(bytes) => bytes,
            Err(error) => {
                report.error(place, format!("cannot read {file}: {error}"));
                return None;
            }
        };
        self.hash.add(&bytes);
        let problems = match Obj::parse(&bytes) {
            Ok(obj) => return Some(obj),
            Err(problems) => problems,
        };
        for (place, message) in problems {
            report.error_in(&file, place, message);
        }
        None
    }
}

/// Vertices that corners share, found by chains of those with the same position.
struct Vertices {
    first: Vec<u32>,
    next: Vec<u32>,
    keys: Vec<Corner>,
}

const NONE: u32 = u32::MAX;

impl Vertices {
    fn new(positions: usize) -> Self {
        Self { first: vec![NONE; positions], next: Vec::new(), keys: Vec::with_capacity(positions) }
    }

    fn index(&mut self, key: Corner) -> u32 {
        let slot = &mut self.first[key.position as usize];
        let mut at = *slot;
        while at != NONE {
            if self.keys[at as usize] == key {
                return at;
            }
            at = self.next[at as usize];
        }
        let new = u32::try_from(self.keys.len()).unwrap_or(NONE);
        self.next.push(*slot);
        self.keys.push(key);
        *slot = new;
        new
    }
}

fn build(obj: &Obj, face_normals: bool, to_world: &DAffine3) -> Mesh {
    let mut vertices = Vertices::new(obj.positions.len());
    let key = |c: Corner| match c {
        Corner { position, .. } if face_normals => Corner { position, ..Corner::default() },
        Corner { normal: 0, .. } => c,
        _ => Corner { texture: 0, ..c },
    };
    let triangles: Vec<[u32; 3]> =
        obj.triangles.iter().map(|corners| corners.map(|c| vertices.index(key(c)))).collect();
    let positions: Vec<DVec3> = vertices.keys.iter().map(|k| obj.positions[k.position as usize]).collect();
    let mut normals = Vec::new();
    if !face_normals {
        normals = vertices.keys.iter().map(|k| stated_normal(obj, *k)).collect();
        if vertices.keys.iter().any(|k| k.normal == 0) {
            let smooth = smooth_normals(&positions, &triangles, to_world);
            for (normal, (key, smooth)) in normals.iter_mut().zip(vertices.keys.iter().zip(smooth)) {
                if key.normal == 0 {
                    *normal = smooth;
                }
            }
        }
    }
    Mesh { positions, normals, triangles }
}

fn stated_normal(obj: &Obj, key: Corner) -> DVec3 {
    let index = (key.normal as usize).checked_sub(1);
    index.map_or(DVec3::ZERO, |i| obj.normals[i])
}

/// Angle-weighted normals of the mesh as it stands in the world, brought back to object space so that the inverse
/// transpose of `to_world` yields them.
fn smooth_normals(positions: &[DVec3], triangles: &[[u32; 3]], to_world: &DAffine3) -> Vec<DVec3> {
    let m = to_world.matrix3;
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for triangle in triangles {
        let corners = triangle.map(|i| m * positions[i as usize]);
        let Some(normal) = (corners[1] - corners[0]).cross(corners[2] - corners[0]).try_normalize() else {
            continue;
        };
        for i in 0..3 {
            let to_next = (corners[(i + 1) % 3] - corners[i]).normalize_or_zero();
            let to_last = (corners[(i + 2) % 3] - corners[i]).normalize_or_zero();
            sums[triangle[i] as usize] += normal * to_next.dot(to_last).clamp(-1.0, 1.0).acos();
        }
    }
    let back = m.transpose();
    sums.into_iter()
        .map(|sum| (back * sum.try_normalize().unwrap_or(DVec3::X)).normalize_or(DVec3::X))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const DIAGONAL: f64 = std::f64::consts::FRAC_1_SQRT_2;

    fn mesh(text: &str, face_normals: bool, to_world: DAffine3) -> Mesh {
        build(&Obj::parse(text.as_bytes()).map_err(|p| format!("{p:?}")).unwrap(), face_normals, &to_world)
    }

    fn world_normals(mesh: &Mesh, to_world: DAffine3) -> Vec<DVec3> {
        let m = to_world.matrix3.inverse().transpose();
        mesh.normals.iter().map(|n| (m * *n).normalize()).collect()
    }

    fn assert_close(found: &[DVec3], wanted: &[[f64; 3]]) {
        assert_eq!(found.len(), wanted.len());
        for (a, b) in found.iter().zip(wanted) {
            assert!((*a - DVec3::from_array(*b)).length() < 1e-6, "{found:?} is not {wanted:?}");
        }
    }

    /// A square in the xy plane with a triangle in the xz plane at one edge.
    const CORNER: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nf 1 2 3 4\nf 1 5 2\n";

    #[test]
    fn smooth_normals_are_those_of_mitsuba() {
        // Printed by Mitsuba 3.9.1, for this transform and those below.
        let found = mesh(CORNER, false, DAffine3::IDENTITY);
        assert_eq!(found.triangles, [[0, 1, 2], [0, 2, 3], [0, 4, 1]]);
        let wanted =
            [[0., DIAGONAL, DIAGONAL], [0., 0.447214, 0.894427], [0., 0., 1.], [0., 0., 1.], [0., 1., 0.]];
        assert_close(&found.normals, &wanted);
    }

    #[test]
    fn smooth_normals_are_weighted_by_angles_in_the_world() {
        let to_world = DAffine3::from_scale(DVec3::new(2.0, 1.0, 3.0));
        let wanted =
            [[0., DIAGONAL, DIAGONAL], [0., 0.530405, 0.847744], [0., 0., 1.], [0., 0., 1.], [0., 1., 0.]];
        assert_close(&world_normals(&mesh(CORNER, false, to_world), to_world), &wanted);
    }

    #[test]
    fn smooth_normals_follow_the_winding_of_a_mirrored_mesh() {
        let to_world = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        let wanted = [
            [0., -DIAGONAL, -DIAGONAL],
            [0., -0.447214, -0.894427],
            [0., 0., -1.],
            [0., 0., -1.],
            [0., -1., 0.],
        ];
        assert_close(&world_normals(&mesh(CORNER, false, to_world), to_world), &wanted);
    }

    #[test]
    fn a_texture_seam_is_a_crease_only_where_normals_are_computed() {
        let seam = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 1\nvt 0 0\nvt 1 1\nvn 0 0 1\n";
        let computed = mesh(&format!("{seam}f 1/1 2/1 3/1\nf 1/2 4/2 2/2\n"), false, DAffine3::IDENTITY);
        let (z, y) = ([0., 0., 1.], [0., 1., 0.]);
        assert_close(&computed.normals, &[z, z, z, y, y, y]);
        let stated =
            mesh(&format!("{seam}f 1/1/1 2/1/1 3/1/1\nf 1/2/1 4/2/1 2/2/1\n"), false, DAffine3::IDENTITY);
        assert_eq!(stated.positions.len(), 4);
        let flat = mesh(&format!("{seam}f 1/1/1 2/1/1 3/1/1\nf 1/2 4/2 2/2\n"), true, DAffine3::IDENTITY);
        assert_eq!((flat.positions.len(), flat.normals.len()), (4, 0));
    }

    #[test]
    fn a_position_with_two_normals_is_two_vertices() {
        let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nvn 0 0 1\nvn 0 0 -1\nf 1//1 2//1 3//1\nf 3//2 2//2 1//1\n";
        let found = mesh(text, false, DAffine3::IDENTITY);
        assert_eq!(found.triangles, [[0, 1, 2], [3, 4, 0]]);
        let (up, down) = ([0., 0., 1.], [0., 0., -1.]);
        assert_close(&found.normals, &[up, up, up, down, down]);
    }

    #[test]
    fn corners_without_a_normal_get_a_computed_one() {
        let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 1 1\nf 1//1 2//1 3//1\nf 1 3 4\n";
        let (stated, computed) = ([0., 1., 1.], [0., 0., 1.]);
        assert_close(
            &mesh(text, false, DAffine3::IDENTITY).normals,
            &[stated, stated, stated, computed, computed, computed],
        );
    }

    #[test]
    fn a_vertex_of_nothing_but_degenerate_faces_has_some_normal() {
        let found = mesh("v 0 0 0\nv 1 0 0\nf 1 1 2\n", false, DAffine3::IDENTITY);
        assert_eq!(found.normals, [DVec3::X; 2]);
    }
}
