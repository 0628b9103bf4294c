//! Shapes, their sides, and what their surfaces are called in textures.

use foton_math::glam::{DVec2, DVec3};
use foton_scene::description::{Geometry, Mesh, TextureKind};

use super::{read, read_with, whole};

fn mesh(text: &str) -> Mesh {
    let scene = read(&whole(text));
    match &scene.shapes[0].geometry {
        Geometry::Mesh(mesh) => Mesh::clone(mesh),
        other => panic!("{text}: {other:?}"),
    }
}

#[test]
fn round_shapes_are_primitives_where_they_can_be() {
    let scene = read(&whole(
        "Shape \"sphere\" \"float radius\" 2\nShape \"disk\" \"float height\" 3 \"float radius\" 2\n\
         Shape \"cylinder\" \"float radius\" 2 \"float zmin\" 0 \"float zmax\" 4",
    ));
    assert!(matches!(scene.shapes[0].geometry, Geometry::Sphere { radius: 2.0, .. }));
    assert!(matches!(scene.shapes[1].geometry, Geometry::Disc));
    let rim = scene.shapes[1].to_world.transform_point3(DVec3::X);
    assert!((rim - DVec3::new(2.0, 0.0, 3.0)).length() < 1e-9, "{rim}");
    assert!(matches!(
        scene.shapes[2].geometry,
        Geometry::Cylinder { radius: 2.0, to: DVec3 { z: 4.0, .. }, .. }
    ));
}

#[test]
fn what_is_cut_or_stretched_becomes_triangles_once() {
    let (scene, warnings) = read_with(&whole(
        "Shape \"sphere\" \"float phimax\" 180\nTranslate 1 0 0 Shape \"sphere\" \"float phimax\" 180\n\
         Scale 1 2 1 Shape \"sphere\"",
    ));
    let shapes: Vec<&std::sync::Arc<Mesh>> = scene
        .shapes
        .iter()
        .map(|s| if let Geometry::Mesh(mesh) = &s.geometry { mesh } else { panic!("{:?}", s.geometry) })
        .collect();
    assert!(std::sync::Arc::ptr_eq(shapes[0], shapes[1]));
    assert_eq!(warnings, ["s.pbrt:2:8: a sphere that is stretched or cut becomes triangles"]);
    let highest = shapes[2].positions.iter().map(|p| p.y).fold(0.0, f64::max);
    assert!((highest - 1.0).abs() < 1e-3 && scene.shapes[2].to_world.matrix3.y_axis.y == 2.0);
}

#[test]
fn patches_are_turned_as_their_parameters() {
    let patch = mesh("Shape \"bilinearmesh\" \"point3 P\" [0 0 0  2 0 0  0 3 0  2 3 0]");
    assert_eq!(patch.triangles.len(), 2);
    assert!(patch.normals.iter().all(|n| *n == DVec3::Z));
    assert_eq!(patch.texture_coordinates, [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE]);
    let bent = mesh("Shape \"bilinearmesh\" \"point3 P\" [0 0 0  2 0 0  0 3 0  2 3 1]");
    assert_eq!(bent.triangles.len(), 128);
    let middle = bent.positions.iter().find(|p| p.x == 1.0 && p.y == 1.5).expect("the middle of the patch");
    assert_eq!(middle.z, 0.25);
}

#[test]
fn subdivision_and_heights_make_meshes() {
    let smooth = mesh(
        "Shape \"loopsubdiv\" \"integer levels\" 1 \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [0 0 0 1 0 0 1 1 0 0 1 0]",
    );
    assert_eq!((smooth.triangles.len(), smooth.normals.len()), (8, 9));
    let field = mesh("Shape \"heightfield\" \"integer nu\" 2 \"integer nv\" 3 \"float Pz\" [0 1 2 3 4 5]");
    assert_eq!((field.triangles.len(), field.positions[5]), (4, DVec3::new(1.0, 1.0, 5.0)));
}

#[test]
fn sides_follow_reverse_orientation_and_mirrored_quadrics_are_inside_out() {
    let scene = read(&whole(
        "Shape \"sphere\" ReverseOrientation Shape \"sphere\" Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] ReverseOrientation\n\
         Scale -1 1 1 Shape \"sphere\" Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n\
         AreaLightSource \"diffuse\" Shape \"sphere\"",
    ));
    let flipped: Vec<bool> = scene.shapes.iter().map(|s| s.flip_normals).collect();
    assert_eq!(flipped, [false, true, true, true, false, false]);
}

#[test]
fn a_mesh_without_texture_coordinates_has_those_of_each_triangle_where_a_texture_asks() {
    let triangle =
        "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [0 0 0 1 0 0 1 1 0 0 1 0]";
    assert_eq!(mesh(triangle).texture_coordinates.len(), 0);
    let textured = mesh(&format!(
        "Texture \"t\" \"spectrum\" \"checkerboard\" Material \"diffuse\" \"texture reflectance\" \"t\" {triangle}"
    ));
    assert_eq!(textured.positions.len(), 6);
    assert_eq!(textured.texture_coordinates[3..], [DVec2::ZERO, DVec2::X, DVec2::ONE]);
}

#[test]
fn textures_of_spheres_and_disks_begin_where_pbrt_has_them() {
    let texture = "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"two.hdr\" \"float uscale\" 2\n\
                   Material \"diffuse\" \"texture reflectance\" \"t\"";
    let scene = read_with(&whole(&format!("{texture} Shape \"sphere\" Shape \"disk\" Shape \"sphere\""))).0;
    assert_eq!(scene.textures.len(), 2);
    let at = |i: usize, u: f64, v: f64| scene.textures[i].to_uv.transform_point2(DVec2::new(u, v));
    // The upper pole is v = 0 for foton and 1 for pbrt.
    assert_eq!(at(0, 0.25, 0.0), DVec2::new(0.5, 1.0));
    // On a disk foton has the radius and the angle, pbrt the angle and what is left to the middle.
    assert_eq!(at(1, 0.75, 0.25), DVec2::new(0.5, 0.25));
    assert!(matches!(scene.textures[0].kind, TextureKind::Bitmap { .. }));
}

#[test]
fn shapes_of_objects_do_not_shine() {
    let (scene, warnings) = read_with(&whole(
        "ObjectBegin \"o\" AreaLightSource \"diffuse\" Shape \"sphere\" ObjectEnd ObjectInstance \"o\"",
    ));
    assert!(
        scene.shapes[0].radiance.is_none() && warnings[0].contains("shapes of objects do not shine"),
        "{warnings:?}"
    );
}
