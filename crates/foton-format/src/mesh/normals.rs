//! Normals of meshes, as Mitsuba computes them, and what is mended of those that a file states.

use foton_math::Cancel;
use foton_math::glam::{DAffine3, DVec2, DVec3};
use foton_scene::description::{Attribute, Mesh};

use crate::mesh::obj::{Corner, NORMALS_MENDED, Obj, TEXTURES_MENDED};
use crate::mesh::tally::Tally;
use crate::mesh::vertices::Vertices;
use crate::mesh::wanted::Wanted;
use crate::mesh::words::Problem;

/// A mesh as a shape wants it.
pub(crate) fn finished(mesh: &Mesh, wanted: Wanted, to_world: &DAffine3, cancel: &Cancel) -> Mesh {
    let mut mesh = mesh.clone();
    if wanted.face_normals {
        mesh.normals = Vec::new();
    } else if mesh.normals.is_empty() {
        mesh.normals = smooth_normals(&mesh.positions, &mesh.triangles, to_world, cancel);
    }
    if wanted.flip_v {
        mesh.texture_coordinates.iter_mut().for_each(|uv| uv.y = 1.0 - uv.y);
    }
    mesh
}

/// Computes normals that a file states as zero or not as numbers, and takes texture coordinates that are none as zero. What
/// is said of those; normals of vertices without triangles are often zero, and nothing is said of them.
pub(crate) fn mend(mesh: &mut Mesh, cancel: &Cancel) -> Vec<Problem> {
    let (mut normals, mut textures) = (Tally::default(), Tally::default());
    let is_bad = |n: &DVec3| n.try_normalize().is_none();
    if mesh.normals.iter().any(is_bad) {
        let mut is_used = vec![false; mesh.positions.len()];
        mesh.triangles.iter().flatten().for_each(|&i| is_used[i as usize] = true);
        let smooth = smooth_normals(&mesh.positions, &mesh.triangles, &DAffine3::IDENTITY, cancel);
        for ((normal, smooth), is_used) in mesh.normals.iter_mut().zip(smooth).zip(is_used) {
            if is_bad(normal) {
                *normal = smooth;
                normals.add_many(usize::from(is_used), Problem::default);
            }
        }
    }
    for uv in mesh.texture_coordinates.iter_mut().filter(|uv| !uv.is_finite()) {
        *uv = DVec2::ZERO;
        textures.add(Problem::default);
    }
    let normals = normals.warning("normal is", "normals are", NORMALS_MENDED);
    let textures = textures.warning("texture coordinate is", "texture coordinates are", TEXTURES_MENDED);
    normals.into_iter().chain(textures).collect()
}

/// The mesh of an OBJ file as a shape wants it, its triangles in the order of the file.
pub(crate) fn build(obj: &Obj, wanted: Wanted, to_world: &DAffine3, cancel: &Cancel) -> Mesh {
    let mut vertices = Vertices::new(obj.positions.len());
    let key = |c: Corner| if wanted.face_normals { Corner { normal: 0, ..c } } else { c };
    let triangles: Vec<[u32; 3]> =
        obj.triangles.iter().map(|corners| corners.map(|c| vertices.index(c.position, key(c)))).collect();
    let positions: Vec<DVec3> = vertices.keys.iter().map(|k| obj.positions[k.position as usize]).collect();
    let mut normals = Vec::new();
    if !wanted.face_normals {
        normals = vertices.keys.iter().map(|k| stated_normal(obj, *k)).collect();
        if vertices.keys.iter().any(|k| k.normal == 0) {
            let smooth = smooth_normals(&positions, &triangles, to_world, cancel);
            for (normal, (key, smooth)) in normals.iter_mut().zip(vertices.keys.iter().zip(smooth)) {
                if key.normal == 0 {
                    *normal = smooth;
                }
            }
        }
    }
    let mut texture_coordinates = Vec::new();
    if vertices.keys.iter().any(|k| k.texture != 0) {
        texture_coordinates = vertices.keys.iter().map(|k| texture(obj, *k, wanted.flip_v)).collect();
    }
    let colours = |k: &Corner| obj.colours.get(k.position as usize).copied().unwrap_or_default();
    let attributes = if obj.colours.is_empty() {
        Vec::new()
    } else {
        let values = vertices.keys.iter().flat_map(colours).collect();
        vec![Attribute { name: VERTEX_COLOUR.to_owned(), channels: 3, values }]
    };
    Mesh { positions, normals, texture_coordinates, triangles, attributes }
}

/// What textures call the colours of vertices.
const VERTEX_COLOUR: &str = "vertex_color";

/// The texture coordinate of a corner; the origin if it has none.
fn texture(obj: &Obj, key: Corner, flip_v: bool) -> DVec2 {
    let Some(index) = (key.texture as usize).checked_sub(1) else { return DVec2::ZERO };
    let uv = obj.textures[index];
    if flip_v { DVec2::new(uv.x, 1.0 - uv.y) } else { uv }
}

fn stated_normal(obj: &Obj, key: Corner) -> DVec3 {
    let index = (key.normal as usize).checked_sub(1);
    index.map_or(DVec3::ZERO, |i| obj.normals[i])
}

/// Angle-weighted normals of the mesh as it stands in the world, brought back to object space so that the inverse
/// transpose of `to_world` yields them. Once cancelled they are whatever they are by then.
pub(crate) fn smooth_normals(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    to_world: &DAffine3,
    cancel: &Cancel,
) -> Vec<DVec3> {
    let m = to_world.matrix3;
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for (i, triangle) in triangles.iter().enumerate() {
        if cancel.check_at(i).is_err() {
            break;
        }
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
    use crate::mesh::wanted::Format;

    const DIAGONAL: f64 = std::f64::consts::FRAC_1_SQRT_2;

    fn mesh(text: &str, face_normals: bool, to_world: DAffine3) -> Mesh {
        let obj = Obj::parse(text.as_bytes(), &Cancel::default()).map_err(|p| format!("{p:?}")).unwrap();
        build(&obj, Wanted { format: Format::Obj, face_normals, flip_v: true }, &to_world, &Cancel::default())
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
        assert_eq!((stated.positions.len(), stated.normals[0], stated.normals[5]), (6, DVec3::Z, DVec3::Z));
        let flat = mesh(&format!("{seam}f 1/1/1 2/1/1 3/1/1\nf 1/2 4/2 2/2\n"), true, DAffine3::IDENTITY);
        assert_eq!((flat.positions.len(), flat.normals.len()), (6, 0));
    }

    #[test]
    fn texture_coordinates_are_those_of_mitsuba() {
        // Printed by Mitsuba 3.9.1.
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0.25\nvt 0 1\nvt 0.5\nvn 0 0 1\n\
                    f 1/1/1 2/2/1 3/3/1\nf 1/4/1 3/3/1 2/2/1\n";
        let found = mesh(text, false, DAffine3::IDENTITY);
        let uvs = [[0.0, 1.0], [1.0, 0.75], [0.0, 0.0], [0.5, 1.0]];
        assert_eq!(found.texture_coordinates, uvs.map(DVec2::from_array));
        assert_eq!(found.triangles, [[0, 1, 2], [3, 2, 1]]);
        assert!(mesh(CORNER, false, DAffine3::IDENTITY).texture_coordinates.is_empty());
        let partly = mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 1 1\nf 1/1 2 3\n", true, DAffine3::IDENTITY);
        assert_eq!(partly.texture_coordinates, [DVec2::X, DVec2::ZERO, DVec2::ZERO]);
    }

    #[test]
    fn colours_of_vertices_are_an_attribute() {
        let text = "v 0 0 0 0 0.5 1\nv 1 0 0\nv 1 1 0 1 1 1\nv 0 1 0 1\nvt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/2 3/1 4/1\n";
        let found = mesh(text, true, DAffine3::IDENTITY);
        let linear = crate::mitsuba::read::values::srgb_to_linear(0.5) as f32;
        let (first, white) = ([0.0, linear, 1.0], [1.0; 3]);
        assert_eq!(found.attributes[0].name, "vertex_color");
        assert_eq!(*found.attributes[0].values, [first, white, white, first, white].concat());
        // Some write them as bytes.
        let bytes = text.replace("0 0.5 1\n", "0 127.5 255\n").replace("1 1 1\n", "255 255 255\n");
        assert_eq!(mesh(&bytes, true, DAffine3::IDENTITY).attributes, found.attributes);
        assert!(mesh(CORNER, true, DAffine3::IDENTITY).attributes.is_empty());
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
