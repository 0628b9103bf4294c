//! Drags, and moves of shapes and lights.

use super::*;

#[test]
fn a_drag_keeps_the_point_under_the_pointer_and_at_its_height() {
    let description = scene();
    let view = View::new(&description.sensors[0]);
    let picked = DVec3::new(0.3, 0.7, 1.0);
    let from = view.project(picked).unwrap();
    for to in [DVec2::new(20.0, 150.0), DVec2::new(250.0, 190.0), DVec2::new(150.0, 120.0)] {
        let drag = |mode| {
            let plane = DragPlane::new(&description.sensors[0], UpAxis::Y, picked.to_array(), mode);
            DVec3::from(plane.translation(from.to_array(), to.to_array()))
        };
        let by = drag(DragMode::Horizontal);
        assert!(by.y.abs() < 1e-12, "{by}");
        assert!(view.project(picked + by).unwrap().distance(to) < 1e-9);
        let by = drag(DragMode::Vertical);
        assert_eq!((by.x, by.z), (0.0, 0.0));
        assert!((view.project(picked + by).unwrap().y - to.y).abs() < 12.0, "follows up and down");
    }
}

#[test]
fn drags_are_bounded_wherever_the_pointer_and_the_camera_are() {
    let picked = DVec3::new(0.0, 0.5, 0.0);
    let height = [8.0, 0.51, 0.5, 0.0, -3.0];
    let places = height.map(|y| DVec3::new(0.0, y, 6.0)).into_iter().chain([DVec3::new(0.0, 9.0, 0.0)]);
    for from in places {
        let up = if from.z == 0.0 { DVec3::Z } else { DVec3::Y };
        let sensor = sensor(looking(from, picked, up));
        for mode in [DragMode::Horizontal, DragMode::Vertical] {
            let plane = DragPlane::new(&sensor, UpAxis::Y, picked.to_array(), mode);
            let mut furthest: f64 = 0.0;
            for to in
                [[150.0, 100.0], [150.0, -1e9], [-1e9, 99.9], [1e300, 1e300], [f64::NAN, 0.0], [150.0, 40.0]]
            {
                let by = DVec3::from(plane.translation([150.0, 100.0], to));
                assert!(by.is_finite(), "{from} {mode:?} {to:?}: {by}");
                if to[0].abs() < 1e6 && to[1].abs() < 1e6 {
                    assert!(by.length() < 62.0 * from.distance(picked), "{from} {mode:?} {to:?}: {by}");
                    furthest = furthest.max(by.length());
                }
            }
            assert!(furthest > 0.1, "{from} {mode:?}: nothing moves");
        }
    }
    let blind = DragPlane::new(&sensor(DAffine3::IDENTITY), UpAxis::Z, [0.0; 3], DragMode::Horizontal);
    assert_eq!(blind.translation([0.0, 0.0], [9.0, 9.0]), [0.0; 3]);
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
