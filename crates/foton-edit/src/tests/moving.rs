//! Steps of keys, and moves of shapes and lights.

use super::*;

#[test]
fn a_step_of_a_key_is_as_long_as_its_pixels_wherever_the_camera_is() {
    let at = DVec3::new(0.0, 0.5, 0.0);
    // From above, at a slant, along the floor, from below, and straight down.
    let places = [8.0, 1.5, 0.51, 0.5, -3.0].map(|y| DVec3::new(0.0, y, 6.0));
    for from in places.into_iter().chain([DVec3::new(0.0, 9.0, 1e-9)]) {
        let sensor = sensor(looking(from, at, DVec3::Y));
        let pixel = View::new(&sensor).pixel_at(from.distance(at));
        let by = |pixels, mode| DVec3::from(nudge(&sensor, UpAxis::Y, at.to_array(), pixels, mode)) / pixel;
        let horizontal = |x, y| by([x, y], DragMode::Horizontal);
        assert!(horizontal(4.0, 0.0).distance(DVec3::X * 4.0) < 1e-3, "{from}: {}", horizontal(4.0, 0.0));
        assert!(horizontal(0.0, 4.0).distance(DVec3::Z * 4.0) < 1e-3, "{from}: {}", horizontal(0.0, 4.0));
        assert!(by([0.0, -4.0], DragMode::Vertical).distance(DVec3::Y * 4.0) < 1e-3, "{from}");
        assert_eq!(by([f64::NAN, 1.0], DragMode::Horizontal), DVec3::ZERO);
    }
    let blind = sensor(DAffine3::IDENTITY);
    assert_eq!(nudge(&blind, UpAxis::Z, [0.0; 3], [9.0, 9.0], DragMode::Horizontal), [0.0; 3]);
}

#[test]
fn moves_change_one_place_and_leave_the_rest_shared() {
    let before = scene();
    for target in [BALL, CUBE, Target::Emitter(0), Target::Emitter(1)] {
        let old = anchor(&before, target).unwrap();
        let after = Edit::Move { target, by: [0.5, -0.25, 2.0] }.apply(&before).unwrap();
        let new = anchor(&after, target).unwrap();
        assert!(new.distance(old + DVec3::new(0.5, -0.25, 2.0)) < 1e-12);
        let same = set(&before, target, FieldId::Position(2), Value::Number(old.z + 2.0));
        assert!(close(anchor(&same, target).unwrap().z, new.z));
        let meshes = [&before, &after].map(|d| match &d.shapes[2].geometry {
            Geometry::Mesh(mesh) => Arc::as_ptr(mesh),
            _ => panic!("a mesh"),
        });
        assert_eq!(meshes[0], meshes[1]);
    }
    let fails = |target, by| Edit::Move { target, by }.apply(&before).err();
    assert_eq!(fails(Target::Emitter(3), [1.0; 3]), Some(EditError::CannotMove("sky".into())));
    assert_eq!(fails(Target::Shape(9), [1.0; 3]), Some(EditError::NoTarget));
    assert_eq!(fails(BALL, [f64::NAN, 0.0, 0.0]), Some(EditError::NotFinite));
    assert_eq!(Edit::Move { target: BALL, by: [0.0; 3] }.name(&before), "move ball");
}
