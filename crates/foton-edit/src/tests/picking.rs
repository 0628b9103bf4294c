//! The view, what is picked in it, and outlines.

use super::*;

#[test]
fn the_view_projects_as_the_scenes_camera_looks() {
    let mut description = scene();
    let plain = description.sensors[0].clone();
    let perspective = |fov_axis, near_clip| SensorDescription { fov_axis, near_clip, ..plain.clone() };
    let principal_point_offset = [0.1, -0.2];
    for sensor in [
        perspective(FovAxis::X, None),
        perspective(FovAxis::Diagonal, Some(0.5)),
        perspective(FovAxis::Smaller, None),
        SensorDescription { principal_point_offset, ..perspective(FovAxis::X, None) },
        orthographic(&plain),
        SensorDescription { principal_point_offset, ..orthographic(&plain) },
    ] {
        description.sensors[0] = sensor;
        let built = Scene::build(&description).unwrap();
        let view = View::new(&description.sensors[0]);
        for film in [DVec2::new(3.0, 7.0), DVec2::new(150.0, 100.0), DVec2::new(299.0, 150.5)] {
            let ray = built.sensors()[0].ray(film.as_vec2());
            let there = built.normalisation().world_point(ray.at(500.0));
            assert!(view.project(there).unwrap().distance(film) < 1e-2);
            let (eye, direction) = view.ray(film);
            assert!(direction.distance(ray.direction.as_dvec3()) < 1e-6);
            assert!(eye.distance(built.normalisation().world_point(ray.origin)) < 1e-5);
            assert!(view.eye_of(there).distance(eye) < 1e-3 && view.sight(there).distance(direction) < 1e-6);
        }
    }
}

#[test]
fn picking_meets_what_stands_there() {
    let mut description = scene();
    picks(&description);
    assert_eq!(pick(&Scene::build(&description).unwrap(), 0, [150.0, 0.0]), None);
    description.sensors[0] = orthographic(&description.sensors[0]);
    picks(&description);
}

fn picks(description: &SceneDescription) {
    let built = Scene::build(description).unwrap();
    let view = View::new(&description.sensors[0]);
    for (index, name, material) in [(1, "ball", "glass"), (2, "cube", "grey")] {
        let middle = geometry::centre(&description.shapes[index]);
        let picked = pick(&built, 0, view.project(middle).unwrap().to_array()).unwrap();
        assert_eq!((picked.target, picked.name.as_str()), (Target::Shape(index), name));
        assert_eq!(picked.material, material);
        let position = DVec3::from(picked.position);
        let eye = view.eye_of(position);
        assert!((picked.distance / position.distance(eye) - 1.0).abs() < 1e-5);
        assert!(DVec3::from(picked.normal).dot(eye - position) > 0.0);
    }
    let picked = pick(&built, 0, view.project(DVec3::new(0.0, 1.0, 0.0)).unwrap().to_array()).unwrap();
    assert!(close(DVec3::from(picked.position).distance(DVec3::Y), 1.0), "on the ball");
    assert_eq!(pick(&built, 7, [150.0, 100.0]), None);
}

#[test]
fn lights_without_surfaces_are_picked_by_their_markers() {
    let description = scene();
    let view = View::new(&description.sensors[0]);
    let bulb = view.project(DVec3::new(-2.0, 2.0, 0.0)).unwrap();
    let near = |d: f64| pick_light(&description, 0, (bulb + DVec2::new(d, 0.0)).to_array());
    assert_eq!(near(9.9).map(|p| p.target), Some(Target::Emitter(0)));
    assert_eq!(near(10.1), None);
    let built = Scene::build(&description).unwrap();
    let picked = pick_any(&built, &description, 0, bulb.to_array()).unwrap();
    assert_eq!((picked.name.as_str(), picked.position), ("bulb", [-2.0, 2.0, 0.0]));
    let shown: Vec<Target> = markers(&description, 0).iter().map(|(target, _)| *target).collect();
    assert_eq!(shown, [0, 1, 2].map(Target::Emitter), "the sky has no place");
    assert!(Outline::new(&description, Target::Emitter(3)).segments(&description, 0).is_empty());
}

#[test]
fn a_spheres_outline_is_where_lines_of_sight_touch_it() {
    let description = scene();
    touches(&description);
    let sensors = vec![orthographic(&description.sensors[0])];
    touches(&SceneDescription { sensors, ..description });
}

fn touches(description: &SceneDescription) {
    let built = Scene::build(description).unwrap();
    let outline = Outline::new(description, BALL).segments(description, 0);
    assert_eq!(outline.len(), 64);
    let middle = View::new(&description.sensors[0]).project(DVec3::Y).unwrap();
    for [a, _] in outline {
        let a = DVec2::new(f64::from(a[0]), f64::from(a[1]));
        let hits =
            |share: f64| pick(&built, 0, middle.lerp(a, share).to_array()).map(|p| p.target) == Some(BALL);
        assert!(hits(0.99) && !hits(1.01), "{a}");
    }
}

#[test]
fn a_meshs_outline_is_its_silhouette_and_its_rim() {
    let description = scene();
    let lines = |target| Outline::new(&description, target).segments(&description, 0).len();
    // Of a cube with three faces in sight six edges lie between seen and unseen ones; a diagonal never does.
    assert_eq!(lines(CUBE), 6);
    // The floor's fourth edge is behind the camera.
    assert_eq!(lines(Target::Shape(0)), 3);
    // Vertices split at creases, as files have them, are one.
    let mut split = scene();
    let cube = Mesh::cube();
    let positions = cube.triangles.iter().flatten().map(|i| cube.positions[*i as usize]).collect();
    let triangles = (0..12).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    split.shapes[2].geometry = Geometry::Mesh(Arc::new(Mesh { positions, triangles, ..Mesh::default() }));
    assert_eq!(Outline::new(&split, CUBE).segments(&split, 0).len(), 6);
}

#[test]
fn outlines_across_the_cameras_plane_are_cut_and_finite() {
    let mut description = scene();
    for step in 0..200 {
        let t = f64::from(step) * 0.1;
        description.sensors[0] = sensor(looking(
            DVec3::new(t.sin() * 3.0, 0.2 + 0.02 * t, t.cos()),
            DVec3::new(t, 0.0, -t),
            DVec3::Y,
        ));
        for i in 0..description.shapes.len() {
            for line in Outline::new(&description, Target::Shape(i)).segments(&description, 0) {
                for [x, y] in line {
                    assert!((-301.0..=601.0).contains(&x) && (-201.0..=401.0).contains(&y), "{line:?}");
                }
            }
        }
    }
    let floor = Outline::new(&description, Target::Shape(0));
    assert!(!floor.segments(&description, 0).is_empty());
}
