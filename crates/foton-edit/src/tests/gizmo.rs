//! Handles and what dragging them does.

use super::*;

const REACH: f64 = 60.0;

/// The gizmo of the ball, which stands in the middle, from a camera at a place.
fn of_ball(from: DVec3) -> (SceneDescription, Gizmo) {
    let mut description = scene();
    description.sensors[0] = sensor(looking(from, DVec3::new(0.0, 1.0, 0.0), DVec3::Y));
    let gizmo = Gizmo::new(&description, BALL, 0, None).expect("in the image");
    (description, gizmo)
}

fn moved(edit: &Edit) -> DVec3 {
    let Edit::Move { by, .. } = edit else { panic!("{edit:?}") };
    DVec3::from(*by)
}

#[test]
fn dragging_an_arrow_moves_along_its_axis_and_keeps_up_with_the_pointer() {
    let (mut description, gizmo) = of_ball(DVec3::new(2.0, 3.0, 8.0));
    drags_along_axes(&description, &gizmo);
    description.sensors[0] = orthographic(&description.sensors[0]);
    drags_along_axes(&description, &Gizmo::new(&description, BALL, 0, None).expect("in the image"));
}

fn drags_along_axes(description: &SceneDescription, gizmo: &Gizmo) {
    let view = View::new(&description.sensors[0]);
    for axis in 0..3 {
        let on_axis = |t: f64| view.project(DVec3::Y + DVec3::AXES[axis] * t).unwrap().to_array();
        let pull = Pull::new(*gizmo, Handle::MoveAxis(axis as u8), on_axis(0.5), REACH);
        let by = moved(&pull.edit(BALL, on_axis(0.8), false));
        assert!(by.distance(DVec3::AXES[axis] * 0.3) < 1e-9, "{axis}: {by}");
        // Beside the axis it is the same.
        let [x, y] = on_axis(0.8);
        let by = moved(&pull.edit(BALL, [x + 3.0, y + 3.0], false));
        assert!((0..3).all(|i| (i == axis) == (by[i] != 0.0)), "{by}");
    }
}

#[test]
fn ten_pixels_move_a_thing_by_ten_pixels_of_what_is_seen_wherever_the_camera_is() {
    // From above, level with the ball, and almost along the floor.
    for height in [6.0, 1.0, 1.001, 1.2, -0.5] {
        let (description, gizmo) = of_ball(DVec3::new(0.3, height, 8.0));
        let view = View::new(&description.sensors[0]);
        let pixel = view.pixel_at(DVec3::Y.distance(view.origin));
        let from = DVec2::from(gizmo.film());
        for to in [DVec2::new(10.0, 0.0), DVec2::new(0.0, -10.0), DVec2::new(-6.0, 8.0)] {
            let drag = |handle| {
                let pull = Pull::new(gizmo, handle, from.to_array(), REACH);
                moved(&pull.edit(BALL, (from + to).to_array(), false))
            };
            let by = drag(Handle::MoveView);
            let seen = view.project(DVec3::Y + by).unwrap() - from;
            assert!(seen.distance(to) < 0.01, "{height}: {seen}, not {to}");
            for axis in 0..3 {
                for handle in [Handle::MoveAxis(axis), Handle::MovePlane(axis)] {
                    let by = drag(handle);
                    assert!(by.length() <= 4.2 * 10.0 * pixel, "{height} {handle:?}: {by}");
                }
            }
        }
    }
}

#[test]
fn no_drag_is_other_than_finite() {
    let (description, gizmo) = of_ball(DVec3::new(0.0, 1.0, 8.0));
    let handles = (0..3)
        .flat_map(|i| [Handle::MoveAxis(i), Handle::MovePlane(i), Handle::Turn(i), Handle::ScaleAxis(i)]);
    for handle in handles.chain([Handle::MoveView, Handle::ScaleAll]) {
        for to in [[150.0, -1e9], [1e300, 1e300], [f64::NAN, 0.0], [-1e9, 99.9], [150.0, 100.0]] {
            let target = if matches!(handle, Handle::ScaleAxis(_)) { CUBE } else { BALL };
            let pull = Pull::new(gizmo, handle, [150.0, 100.0], REACH);
            for snap in [false, true] {
                let next = pull.edit(target, to, snap).apply(&description).unwrap();
                assert!(anchor(&next, target).unwrap().is_finite(), "{handle:?} {to:?}");
            }
        }
    }
}

#[test]
fn a_ring_turns_by_the_angle_that_the_pointer_goes_around() {
    let (mut description, _) = of_ball(DVec3::new(0.0, 1.0, 8.0));
    description.sensors[0] = sensor(looking(DVec3::new(3.0, 1.0, 8.0), DVec3::new(3.0, 1.0, 0.0), DVec3::Y));
    let gizmo = Gizmo::new(&description, CUBE, 0, None).unwrap();
    let middle = DVec2::from(gizmo.film());
    let pull = Pull::new(gizmo, Handle::Turn(2), (middle + DVec2::X * 50.0).to_array(), REACH);
    // Towards the top of the image: counter-clockwise about the axis at the camera.
    let to = (middle - DVec2::Y * 50.0).to_array();
    let Edit::Turn { radians, axis, .. } = pull.edit(CUBE, to, false) else { panic!("a turn") };
    assert!((radians.to_degrees() - 90.0).abs() < 1e-6 && axis == [0.0, 0.0, 1.0], "{radians}");
    let to = (middle + DVec2::new(50.0, -14.0)).to_array();
    let Edit::Turn { radians, .. } = pull.edit(CUBE, to, true) else { panic!("a turn") };
    assert!((radians.to_degrees() - 15.0).abs() < 1e-9, "{radians}");
    let before = anchor(&description, CUBE).unwrap();
    let turned = pull.edit(CUBE, to, true).apply(&description).unwrap();
    assert!(anchor(&turned, CUBE).unwrap().distance(before) < 1e-12, "about its middle");
    // A ring that is seen edge-on is pulled along by its near side.
    let edge_on = Pull::new(gizmo, Handle::Turn(1), middle.to_array(), REACH);
    let Edit::Turn { radians, .. } = edge_on.edit(CUBE, (middle + DVec2::X * 60.0).to_array(), false) else {
        panic!("a turn")
    };
    assert!((radians - 1.0).abs() < 1e-9, "{radians}");
}

#[test]
fn scaling_goes_by_the_distance_and_keeps_the_middle_and_the_power() {
    let (description, _) = of_ball(DVec3::new(0.0, 1.0, 8.0));
    let gizmo = Gizmo::new(&description, LAMP, 0, None).unwrap();
    let middle = DVec2::from(gizmo.film());
    let pull = Pull::new(gizmo, Handle::ScaleAll, middle.to_array(), REACH);
    let to = (middle + DVec2::X * REACH).to_array();
    let Edit::Scale { factors, .. } = pull.edit(LAMP, to, false) else { panic!("a scale") };
    assert_eq!(factors, [2.0; 3]);
    let scaled = pull.edit(LAMP, to, false).apply(&description).unwrap();
    let power = |d: &SceneDescription| number(d, LAMP, FieldId::Power);
    assert!(close(power(&scaled), power(&description)));
    let stretch = Edit::Scale { target: CUBE, factors: [2.0, 1.0, 0.5] };
    let stretched = stretch.apply(&description).unwrap();
    let extent = |axis| number(&stretched, CUBE, FieldId::Extent(axis));
    assert!(close(extent(0), 4.0) && close(extent(1), 2.0) && close(extent(2), 1.0));
    assert!(anchor(&stretched, CUBE).unwrap().distance(anchor(&description, CUBE).unwrap()) < 1e-12);
    let refused = Edit::Scale { target: BALL, factors: [2.0, 1.0, 1.0] }.apply(&description);
    assert_eq!(refused.err(), Some(EditError::CannotScale("ball".into())));
}

#[test]
fn moves_snap_to_round_places() {
    let (mut description, _) = of_ball(DVec3::new(0.0, 1.0, 8.0));
    description = Edit::Move { target: BALL, by: [0.0137, 0.0, 0.0] }.apply(&description).unwrap();
    let gizmo = Gizmo::new(&description, BALL, 0, None).unwrap();
    let from = DVec2::from(gizmo.film());
    let pull = Pull::new(gizmo, Handle::MoveAxis(0), from.to_array(), REACH);
    let next = pull.edit(BALL, (from + DVec2::X * 40.0).to_array(), true).apply(&description).unwrap();
    let x = number(&next, BALL, FieldId::Position(0));
    let steps = x / 0.1;
    assert!(x > 0.5 && (steps - steps.round()).abs() < 1e-9, "{x}");
}

#[test]
fn handles_are_where_they_are_drawn_and_none_points_at_the_camera() {
    let (_, gizmo) = of_ball(DVec3::new(3.0, 4.0, 8.0));
    let handles = gizmo.handles(Tool::Move, REACH);
    assert_eq!(handles.len(), 7, "three arrows, three planes, the middle");
    for shape in &handles {
        let Some(&[_, end]) = shape.lines.first() else { continue };
        if matches!(shape.handle, Handle::MoveAxis(_)) {
            assert_eq!(nearest(&handles, end.map(f64::from), 5.0), Some(shape.handle));
        }
    }
    assert_eq!(nearest(&handles, gizmo.film(), 5.0), Some(Handle::MoveView));
    assert_eq!(nearest(&handles, [3.0, 3.0], 5.0), None);
    let (_, gizmo) = of_ball(DVec3::new(0.0, 1.0, 8.0));
    let level = gizmo.handles(Tool::Move, REACH);
    assert!(!level.iter().any(|h| h.handle == Handle::MoveAxis(2)), "it points at the camera");
    assert!(!level.iter().any(|h| h.handle == Handle::MovePlane(1)), "the floor is seen edge-on");
    assert!(
        gizmo.handles(Tool::Scale, REACH).iter().all(|h| h.handle == Handle::ScaleAll),
        "a ball stays one"
    );
}

#[test]
fn lights_turn_and_are_aimed() {
    let description = scene();
    let spot = Target::Emitter(1);
    let at = [-3.0, 0.0, 1.0];
    let aimed = Edit::Aim { target: spot, at }.apply(&description).unwrap();
    let EmitterKind::Spot { to_world, .. } = &aimed.emitters[1].kind else { panic!("a spot") };
    let way = (DVec3::from(at) - to_world.translation).normalize();
    assert!(to_world.matrix3.z_axis.normalize().distance(way) < 1e-9);
    let aimed = Edit::Aim { target: LAMP, at }.apply(&description).unwrap();
    let lamp = &aimed.shapes[3];
    let way = (DVec3::from(at) - lamp.to_world.translation).normalize();
    assert!(lamp.to_world.matrix3.z_axis.normalize().distance(way) < 1e-9);
    assert!(inspect(&description, LAMP).unwrap().can_aim && !inspect(&description, BALL).unwrap().can_aim);
    let sun = Edit::Turn { target: Target::Emitter(2), axis: [0.0, 1.0, 0.0], radians: 0.5 };
    let turned = sun.apply(&description).unwrap();
    let EmitterKind::Directional { direction, .. } = turned.emitters[2].kind else { panic!("a sun") };
    assert!((direction.y - 0.1).abs() < 1e-12 && direction.x > 0.5);
    let sky = Edit::Turn { target: Target::Emitter(3), axis: [0.0, 1.0, 0.0], radians: 0.5 };
    assert_eq!(sky.apply(&description).err(), Some(EditError::CannotTurn("sky".into())));
}

#[test]
fn typed_angles_and_lengths_are_what_they_say() {
    let mut description = scene();
    for (axis, degrees) in [(1u8, 30.0), (0, -20.0), (2, 75.0)] {
        description = set(&description, CUBE, FieldId::Rotation(axis), Value::Number(degrees));
        let now = number(&description, CUBE, FieldId::Rotation(axis));
        assert!((now - degrees).abs() < 1e-6, "{axis}: {now}");
    }
    assert!((number(&description, CUBE, FieldId::Rotation(1)) - 30.0).abs() < 1e-6, "the others stay");
    description = set(&description, CUBE, FieldId::Extent(1), Value::Number(5.0));
    assert!(close(number(&description, CUBE, FieldId::Extent(1)), 5.0));
    assert!(close(number(&description, CUBE, FieldId::Extent(0)), 2.0));
}
