//! Cameras as people move them.

use std::f64::consts::FRAC_PI_2;

use foton_math::glam::{DAffine3, DMat3, DVec3};
use foton_scene::description::{Filter, FovAxis, Projection, SensorDescription};

use crate::{Camera, UpAxis};

fn sensor(forward: DVec3, up: DVec3, mirrored: bool) -> SensorDescription {
    let forward = forward.normalize();
    let left = up.cross(forward).normalize();
    let side = if mirrored { -left } else { left };
    let m = DMat3::from_cols(side, forward.cross(left), forward);
    SensorDescription {
        name: "camera".into(),
        to_world: DAffine3::from_mat3_translation(m, DVec3::new(1.5, -2.0, 7.0)),
        fov_degrees: 37.0,
        fov_axis: FovAxis::Smaller,
        width: 400,
        height: 300,
        filter: Filter::Box { radius: 0.5 },
        ..SensorDescription::default()
    }
}

/// Level, tilted, rolled, upside down, straight up and down, mirrored.
fn sensors() -> Vec<SensorDescription> {
    let mut all = Vec::new();
    for mirrored in [false, true] {
        for (forward, up) in [
            (DVec3::new(0.2, -0.3, -1.0), DVec3::Y),
            (DVec3::new(1.0, 2.0, -0.5), DVec3::Z),
            (DVec3::new(0.2, -0.3, -1.0), DVec3::new(0.4, 1.0, 0.0)),
            (DVec3::new(0.2, -0.3, -1.0), DVec3::NEG_Y),
            (DVec3::NEG_Y, DVec3::new(0.3, 0.0, -1.0)),
            (DVec3::Y, DVec3::new(0.3, 0.0, 0.5)),
            (DVec3::NEG_Z, DVec3::new(0.3, 0.9, 0.0)),
        ] {
            all.push(sensor(forward, up, mirrored));
        }
    }
    all
}

#[test]
fn an_unmoved_camera_keeps_its_transform_and_its_angles_say_the_same() {
    for sensor in sensors() {
        let camera = Camera::new(&sensor, 4.0);
        assert_eq!(camera.to_world(), sensor.to_world);
        let mut touched = camera.clone();
        touched.orbit(0.0, 0.0);
        assert!(touched.is_moved());
        assert!(touched.to_world().abs_diff_eq(sensor.to_world, 1e-12), "{camera:?}");
    }
}

#[test]
fn orbiting_keeps_the_target_and_looking_keeps_the_place() {
    for sensor in sensors() {
        let mut camera = Camera::new(&sensor, 4.0);
        let target = DVec3::from(camera.target);
        camera.orbit(0.7, 0.2);
        let m = camera.to_world();
        assert!((m.translation + m.matrix3.z_axis * 4.0).distance(target) < 1e-12);
        camera.look(-0.3, 0.1);
        assert!(camera.to_world().translation.distance(m.translation) < 1e-12);
        camera.zoom(0.5);
        assert!((DVec3::from(camera.target).distance(camera.to_world().translation) - 2.0).abs() < 1e-12);
        let m = camera.to_world().matrix3;
        assert!((m * m.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-12));
        camera.set_fov(500.0);
        assert_eq!(camera.fov_degrees, 170.0);
        camera.reset(&sensor);
        assert_eq!((camera.to_world(), camera.fov_degrees), (sensor.to_world, 37.0));
        assert!(!camera.is_moved());
    }
}

#[test]
fn a_pan_of_pixels_moves_the_target_by_as_many() {
    for sensor in sensors() {
        let mut camera = Camera::new(&sensor, 4.0);
        let held = DVec3::from(camera.target);
        camera.pan(&sensor, 30.0, 12.0);
        let view = crate::view::View::new(&camera.applied_to(&sensor));
        let at = view.project(held).unwrap() - view.film * 0.5;
        assert!((at - foton_math::glam::DVec2::new(30.0, 12.0)).length() < 1e-9, "{at}");
    }
}

#[test]
fn a_pitch_stops_at_the_poles() {
    let mut camera = Camera::new(&sensors()[0], 4.0);
    camera.orbit(0.0, -9.0);
    assert_eq!(camera.pitch, -FRAC_PI_2);
    assert!(camera.to_world().matrix3.z_axis.distance(DVec3::NEG_Y) < 1e-12);
    camera.orbit(f64::NAN, 1.0);
    camera.zoom(0.0);
    camera.fly(f64::INFINITY, 0.0, 0.0);
    assert!(camera.to_world().is_finite());
}

#[test]
fn flying_goes_where_the_camera_looks() {
    for sensor in sensors() {
        let mut camera = Camera::new(&sensor, 4.0);
        camera.fly(2.0, 0.0, 0.0);
        let forward = sensor.to_world.matrix3.z_axis;
        assert!(camera.to_world().translation.distance(sensor.to_world.translation + forward * 2.0) < 1e-12);
        camera.fly(-2.0, 3.0, 0.0);
        let right = -sensor.to_world.matrix3.x_axis;
        assert!(camera.to_world().translation.distance(sensor.to_world.translation + right * 3.0) < 1e-12);
    }
}

#[test]
fn the_up_axis_is_that_of_a_level_camera() {
    let guess = |forward, up| UpAxis::guess(&sensor(forward, up, false));
    assert_eq!(guess(DVec3::new(0.3, -0.9, -1.0), DVec3::Y), UpAxis::Y);
    assert_eq!(guess(DVec3::new(0.3, 1.0, -0.9), DVec3::Z), UpAxis::Z);
    assert_eq!(guess(DVec3::new(0.0, 1.0, -0.2), DVec3::Z), UpAxis::Z);
}

#[test]
fn a_lens_is_focused_on_the_target_until_a_person_says_otherwise_and_goes_with_the_camera() {
    let sensor = &sensors()[0];
    let mut camera = Camera::new(sensor, 4.0);
    camera.set_focus(2.0);
    assert_eq!(camera.lens, None, "a pinhole has no focus");
    camera.set_aperture(0.25);
    let lens =
        |camera: &Camera| camera.applied_to(sensor).lens.map(|l| (l.aperture_radius, l.focus_distance));
    assert_eq!(lens(&camera), Some((0.25, 4.0)));
    camera.set_focus(2.5);
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        camera.set_focus(wrong);
    }
    camera.set_aperture(-1.0);
    camera.set_aperture(f64::NAN);
    camera.orbit(0.3, 0.1);
    assert_eq!(lens(&camera), Some((0.25, 2.5)));
    // As a file has it, and back to it.
    let with_lens = camera.applied_to(sensor);
    let mut camera = Camera::new(&with_lens, 4.0);
    camera.set_aperture(0.0);
    assert_eq!(lens(&camera), Some((0.0, 2.5)), "the focus is kept for when it is opened again");
    camera.reset(&with_lens);
    assert_eq!(lens(&camera), Some((0.25, 2.5)));
}

/// It turns and moves as another, but what it shows goes with its scale, and it sees no more from nearer.
#[test]
fn an_orthographic_camera_keeps_its_width_until_it_is_zoomed() {
    for sensor in sensors() {
        let scale = DAffine3::from_scale(DVec3::new(2.0, 3.0, 1.0));
        let projection = Projection::Orthographic;
        let sensor = SensorDescription { to_world: sensor.to_world * scale, projection, ..sensor };
        let mut camera = Camera::new(&sensor, 4.0);
        assert_eq!(camera.to_world(), sensor.to_world);
        assert!((camera.width() - 4.0).abs() < 1e-12);
        camera.orbit(0.0, 0.0);
        assert!(camera.to_world().abs_diff_eq(sensor.to_world, 1e-12), "{camera:?}");
        let held = DVec3::from(camera.target);
        camera.pan(&sensor, 30.0, 12.0);
        let seen = |camera: &Camera| {
            let view = crate::view::View::new(&camera.applied_to(&sensor));
            view.project(held).unwrap() - view.film * 0.5
        };
        assert!((seen(&camera) - foton_math::glam::DVec2::new(30.0, 12.0 / 1.5)).length() < 1e-9);
        camera.fly(0.5, 0.0, 0.0);
        camera.zoom(0.5);
        assert!((seen(&camera) - foton_math::glam::DVec2::new(60.0, 24.0 / 1.5)).length() < 1e-9);
        let m = camera.to_world().matrix3;
        let lengths = DVec3::new(m.x_axis.length(), m.y_axis.length(), m.z_axis.length());
        assert!(lengths.abs_diff_eq(DVec3::new(1.0, 1.5, 1.0), 1e-12));
        for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            camera.set_width(wrong);
            camera.zoom(wrong);
        }
        assert!((camera.width() - 2.0).abs() < 1e-12);
        camera.reset(&sensor);
        assert_eq!(camera.to_world(), sensor.to_world);
    }
}
