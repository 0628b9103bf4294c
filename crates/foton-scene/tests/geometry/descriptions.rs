//! Descriptions that make no scene, and triangles that make no surface.
//!
//! Not here: `BuildError::TooLarge`, which takes 2^31 primitives to reach.

use foton_math::glam::{DAffine3, DMat3, DVec3};
use foton_math::{Ray, Rgb};
use foton_scene::description::{
    Bsdf, Colour, Diffuse, EmitterDescription, EmitterKind, Geometry, Mesh, SceneDescription,
    ShapeDescription,
};
use foton_scene::{BuildError, Scene};

use crate::{ball, build, describe, mesh, shape, smooth_geodesic};

/// Two sound triangles and seven without area.
fn torn() -> Mesh {
    let mut mesh = Mesh { texture_coordinates: Vec::new(), ..Mesh::rectangle() };
    let first = mesh.positions.len() as u32;
    // 4 and 5 are in one place, 6 is between 0 and 2.
    mesh.positions.extend([DVec3::ONE, DVec3::ONE, DVec3::ZERO]);
    let [a, b, middle] = [first, first + 1, first + 2];
    let collapsed = [[0, 0, 1], [1, 0, 0], [0, 1, 0], [2, 2, 2], [a, b, 0], [b, 1, a], [0, middle, 2]];
    mesh.triangles.extend(collapsed);
    mesh
}

#[test]
fn triangles_without_area_are_dropped_and_counted() {
    let scene = build(vec![mesh(torn(), DAffine3::IDENTITY)]);
    let census = scene.census();
    assert_eq!((census.triangles, census.degenerate_triangles), (2, 7));
    assert!(
        scene
            .nearest(Ray::new(scene.normalisation().point(DVec3::new(0.5, 0.25, 1.0)), -DVec3::Z.as_vec3()))
            .is_some()
    );
}

#[test]
fn what_is_left_out_of_a_mesh_says_nothing_of_the_size_of_the_scene() {
    let sound = Mesh::rectangle();
    let far = DVec3::new(1e8, -3e7, 2e8);
    // A stray vertex; triangles with a corner named twice, with two in one place, and with three on a line, which rounding
    // bends a little.
    for faces in [&[][..], &[[0, 4, 4]], &[[4, 0, 4]], &[[0, 4, 5]], &[[6, 4, 0]], &[[4, 7, 0]]] {
        let mut torn = Mesh { texture_coordinates: Vec::new(), ..sound.clone() };
        let between = [0.5, 1.0 / 3.0].map(|t| sound.positions[0].lerp(far, t));
        torn.positions.extend([far, far].into_iter().chain(between));
        torn.triangles.extend(faces);
        for to_world in [DAffine3::IDENTITY, DAffine3::from_scale(DVec3::new(3.0, 0.3, 1.0))] {
            let (whole, found) =
                (build(vec![mesh(sound.clone(), to_world)]), build(vec![mesh(torn.clone(), to_world)]));
            assert_eq!(found.normalisation(), whole.normalisation(), "{faces:?}");
            assert_eq!((found.bounds(), found.census().triangles), (whole.bounds(), 2), "{faces:?}");
        }
    }
}

#[test]
fn the_cone_of_a_spot_stays_round() {
    let spot = |m: DMat3| {
        let kind = EmitterKind::Spot {
            to_world: DAffine3::from_mat3(m),
            intensity: Rgb::WHITE,
            cutoff_degrees: 30.0,
            beam_degrees: 20.0,
            texture: None,
        };
        let mut description = describe(vec![ball(DVec3::ZERO, 1.0)]);
        description.emitters.push(EmitterDescription { name: "bad".into(), kind });
        Scene::build(&description).err()
    };
    for scale in [DVec3::new(-2.0, 1.0, 0.3), DVec3::new(1.0, 1.0, 1.01), DVec3::new(2.0, 1.0, 1.0)] {
        assert_eq!(spot(DMat3::from_diagonal(scale)), Some(BuildError::NotRound(bad())), "{scale}");
    }
    let sheared = DMat3::from_cols(DVec3::X, DVec3::new(0.1, 1.0, 0.0), DVec3::Z);
    assert_eq!(spot(sheared), Some(BuildError::NotRound(bad())));
    for scale in [DVec3::splat(3.0), DVec3::new(-1.0, 1.0, 1.0), DVec3::new(1.0, 1.0005, 1.0)] {
        assert_eq!(spot(DMat3::from_diagonal(scale)), None, "{scale}");
    }
}

#[test]
fn a_shining_shape_without_area_is_no_emitter() {
    let mut flat = mesh(Mesh { triangles: torn().triangles[2..].to_vec(), ..torn() }, DAffine3::IDENTITY);
    flat.radiance = Some(Rgb::WHITE.into());
    let scene = build(vec![flat]);
    let census = scene.census();
    assert_eq!((census.triangles, census.degenerate_triangles, census.emitters), (0, 7, 0));
    assert!(scene.choose_emitter(0.5).is_none());
    assert!(scene.nearest(Ray::new(DVec3::Z.as_vec3(), -DVec3::Z.as_vec3())).is_none());
}

/// The error of a description with one thing wrong.
fn error(spoil: impl FnOnce(&mut SceneDescription)) -> BuildError {
    let mut description = describe(vec![ball(DVec3::ZERO, 1.0)]);
    spoil(&mut description);
    Scene::build(&description).err().expect("the description is spoilt")
}

fn error_of(shape: ShapeDescription) -> BuildError {
    error(|description| description.shapes.push(ShapeDescription { name: "bad".into(), ..shape }))
}

fn bad() -> String {
    "bad".into()
}

#[test]
fn a_scene_needs_a_sensor_that_makes_an_image() {
    assert_eq!(error(|d| d.sensors.clear()), BuildError::NoSensor);
    let camera = |spoil: fn(&mut foton_scene::description::SensorDescription)| {
        assert_eq!(error(|d| spoil(&mut d.sensors[0])), BuildError::BadSensor("camera".into()));
    };
    camera(|s| s.fov_degrees = 0.0);
    camera(|s| s.fov_degrees = 180.0);
    camera(|s| s.fov_degrees = f64::NAN);
    camera(|s| s.width = 0);
    camera(|s| s.height = 0);
    camera(|s| s.to_world.matrix3.z_axis = DVec3::ZERO);
    camera(|s| s.to_world.matrix3.x_axis.y = f64::NAN);
    camera(|s| s.to_world.translation.x = f64::INFINITY);
}

#[test]
fn coordinates_are_finite() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut hole = Mesh::cube();
        hole.positions[3].y = value;
        let mut torn = Mesh::rectangle();
        torn.texture_coordinates[2].x = value;
        let moved = DAffine3::from_translation(DVec3::X * value);
        for shape in [
            mesh(hole, DAffine3::IDENTITY),
            mesh(torn, DAffine3::IDENTITY),
            mesh(Mesh::cube(), moved),
            shape(Geometry::Disc, moved),
            ball(DVec3::Z * value, 1.0),
            ball(DVec3::ZERO, value),
        ] {
            assert_eq!(error_of(shape), BuildError::NotFinite(bad()));
        }
        // A normal that is no direction is none: the face's own stands in for it.
        let mut bald = smooth_geodesic(1);
        bald.normals[0].x = value;
        let scene = build(vec![mesh(bald, DAffine3::IDENTITY)]);
        let mut stream = crate::stream(90);
        for _ in 0..1000 {
            let ray = Ray::new(DVec3::ZERO.as_vec3(), crate::direction(&mut stream));
            let hit = scene.nearest(ray).expect("it is closed");
            assert!(hit.shading_normal.is_normalized() && hit.normal.is_normalized(), "{hit:?}");
            // One of the eight faces has that corner.
            assert_eq!(hit.shading_normal != hit.normal, ray.direction.min_element() < 0.0, "{hit:?}");
        }
        // Where none is a direction there is nothing to interpolate, nor to correct photons for.
        let mut barren = smooth_geodesic(1);
        barren.normals.iter_mut().for_each(|n| n.x = value);
        assert!(!build(vec![mesh(barren, DAffine3::IDENTITY)]).census().bsdfs[0].interpolated_normals);
        assert!(
            build(vec![mesh(smooth_geodesic(1), DAffine3::IDENTITY)]).census().bsdfs[0].interpolated_normals
        );
    }
}

#[test]
fn transforms_keep_round_things_round_and_normals_upright() {
    let flattened = DAffine3::from_mat3(DMat3::from_diagonal(DVec3::new(1.0, 1.0, 0.0)));
    assert_eq!(error_of(mesh(smooth_geodesic(1), flattened)), BuildError::Singular(bad()));
    let sheared = DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::new(0.1, 1.0, 0.0), DVec3::Z));
    let stretched = DAffine3::from_scale(DVec3::new(1.0, 1.001, 1.0));
    let nothing = DAffine3::from_scale(DVec3::ZERO);
    for to_world in [sheared, stretched, nothing] {
        for geometry in [Geometry::Disc, Geometry::Sphere { centre: DVec3::ZERO, radius: 1.0 }] {
            assert_eq!(error_of(shape(geometry, to_world)), BuildError::NotRound(bad()));
        }
    }
    // A disc has no thickness to stretch.
    let thick = DAffine3::from_scale(DVec3::new(2.0, 2.0, 7.0));
    assert_eq!(build(vec![shape(Geometry::Disc, thick)]).census().discs, 1);
}

#[test]
fn meshes_fit_their_vertices_and_shapes_their_materials() {
    let mut beyond = Mesh::cube();
    beyond.triangles[5][1] = 24;
    let mut bald = smooth_geodesic(1);
    bald.normals.pop();
    for broken in [beyond, bald] {
        assert_eq!(error_of(mesh(broken, DAffine3::IDENTITY)), BuildError::BadMesh(bad()));
    }
    let unpainted = ShapeDescription { material: 1, ..ball(DVec3::ZERO, 1.0) };
    assert_eq!(error_of(unpainted), BuildError::NoMaterial(bad()));
}

#[test]
fn an_empty_scene_is_a_scene() {
    let scene = build(Vec::new());
    assert!(scene.nearest(Ray::new(DVec3::ZERO.as_vec3(), DVec3::X.as_vec3())).is_none());
    assert!(!scene.occluded(Ray::new(DVec3::ZERO.as_vec3(), DVec3::X.as_vec3())));
}

#[test]
fn textures_are_there_and_their_coordinates_fit() {
    let mut uneven = Mesh::rectangle();
    uneven.texture_coordinates.pop();
    let description = describe(vec![mesh(uneven, DAffine3::IDENTITY)]);
    assert_eq!(Scene::build(&description).err(), Some(BuildError::BadMesh("shape".into())));
    let mut absent = describe(vec![mesh(Mesh::rectangle(), DAffine3::IDENTITY)]);
    absent.materials[0].front = Bsdf::Diffuse(Diffuse { reflectance: Colour::Texture(3) });
    assert_eq!(Scene::build(&absent).err(), Some(BuildError::NoTexture("white".into())));
}

#[test]
fn what_emitters_emit_is_finite() {
    for bad in [f32::NAN, f32::INFINITY] {
        let mut shining = describe(vec![mesh(Mesh::rectangle(), DAffine3::IDENTITY)]);
        shining.shapes[0].radiance = Some(Rgb::new(1.0, bad, 1.0).into());
        assert_eq!(Scene::build(&shining).err(), Some(BuildError::NotFinite("shape".into())));
        let kind = EmitterKind::Point { position: DVec3::splat(f64::from(bad)), intensity: Rgb::WHITE };
        let mut lit = describe(vec![mesh(Mesh::rectangle(), DAffine3::IDENTITY)]);
        lit.emitters.push(EmitterDescription { name: "lamp".into(), kind });
        assert_eq!(Scene::build(&lit).err(), Some(BuildError::NotFinite("lamp".into())));
    }
}
