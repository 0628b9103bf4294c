//! Shapes that share a mesh are written as instances of a group.

use super::*;

/// A triangle that many things share.
fn triangle() -> Geometry {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    Geometry::Mesh(Arc::new(Mesh { positions, triangles: vec![[0, 1, 2]], ..Mesh::default() }))
}

/// Leaves of two materials, one of each turned around, one that shines and one that stands for itself.
fn leaves() -> SceneDescription {
    let shared = triangle();
    let mirror = DAffine3::from_scale(DVec3::new(1.0, -2.0, 1.0));
    let leaf = |name: &str, material, geometry: &Geometry| ShapeDescription {
        name: name.to_owned(),
        geometry: geometry.clone(),
        to_world: odd_transform(),
        flip_normals: false,
        material,
        radiance: None,
    };
    let mut scene = SceneDescription {
        materials: vec![Material::default(), Material { back: None, ..Material::default() }],
        ..SceneDescription::default()
    };
    scene.sensors = sensors();
    scene.shapes = vec![
        leaf("a", 0, &shared),
        ShapeDescription { to_world: odd_transform() * mirror, ..leaf("b", 0, &shared) },
        leaf("c", 1, &shared),
        ShapeDescription { flip_normals: true, ..leaf("d", 1, &shared) },
        ShapeDescription { radiance: Some(colour(1.0, 2.0, 3.0)), ..leaf("lamp", 0, &shared) },
        leaf("alone", 0, &triangle()),
        leaf("e", 0, &shared),
        ShapeDescription { flip_normals: true, to_world: mirror, ..leaf("f", 1, &shared) },
        ShapeDescription { to_world: DAffine3::IDENTITY, ..leaf("a-group", 1, &shared) },
    ];
    scene.hidden.shapes.insert(1);
    scene
}

#[test]
fn shapes_that_share_a_mesh_are_instances_and_share_it_again() {
    let folder = Folder::new("instances");
    let scene = leaves();
    let again = written_and_read(&scene, &folder, "leaves.xml");
    assert_same(&scene, &again);
    let names = |scene: &SceneDescription| scene.shapes.iter().map(|s| s.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&again), names(&scene));
    let text = fs::read_to_string(folder.0.join("leaves.xml")).unwrap();
    let count = |what: &str| text.matches(what).count();
    assert_eq!((count("\"shapegroup\""), count("\"instance\""), count("\"ply\"")), (3, 7, 5), "{text}");
    assert_eq!(fs::read_dir(folder.0.join("meshes")).unwrap().count(), 2);
    let Geometry::Mesh(first) = &again.shapes[0].geometry else { panic!("a mesh") };
    let shares = |s: &ShapeDescription| matches!(&s.geometry, Geometry::Mesh(m) if Arc::ptr_eq(m, first));
    let of_a_group: Vec<bool> = again.shapes.iter().map(shares).collect();
    assert_eq!(of_a_group, [true, true, true, true, true, false, true, true, true]);
}

#[test]
fn a_thousand_instances_take_a_line_of_their_own_each_and_no_mesh() {
    let folder = Folder::new("thousand");
    let mut scene = leaves();
    scene.hidden.shapes.clear();
    scene.shapes = (0..1000)
        .map(|i| ShapeDescription { name: format!("leaf-{i}"), ..scene.shapes[0].clone() })
        .collect();
    let again = written_and_read(&scene, &folder, "leaves.xml");
    assert_same(&scene, &again);
    assert_eq!(fs::read_dir(folder.0.join("meshes")).unwrap().count(), 1);
}
