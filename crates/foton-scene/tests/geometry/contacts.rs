//! Small things on large floors: offsets of ray origins neither swallow the object nor dive under the floor.

use std::f64::consts::{PI, TAU};

use foton_math::Ray;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::{Mesh, ShapeDescription};

use crate::{ball, build, direction_around, log_uniform, mesh, ring, stream, turn};

/// A square floor in the plane y = 0 that looks up, of this half-size.
fn floor(half: f64, to_world: DAffine3) -> ShapeDescription {
    let lie = DAffine3::from_rotation_x(-PI / 2.0) * DAffine3::from_scale(DVec3::splat(half));
    mesh(Mesh::rectangle(), to_world * lie)
}

#[test]
fn a_ring_of_millimetres_is_seen_from_the_floor_of_kilometres_that_it_lies_on() {
    let (major, minor) = (9e-3, 1.5e-3);
    let mut stream = stream(20);
    for half in [1e3, 1e4] {
        for tilt in [DAffine3::IDENTITY, DAffine3::from_rotation_x(0.4), DAffine3::from_quat(turn())] {
            let scene = build(vec![floor(half, tilt), mesh(ring(major, minor), tilt)]);
            let units = scene.normalisation();
            for _ in 0..2000 {
                let angle = TAU * f64::from(stream.next_1d());
                let outwards = DVec3::new(angle.cos(), 0.0, angle.sin());
                // From a micrometre to a centimetre beside the line on which the ring touches the floor.
                let beside = log_uniform([1e-6, 1e-2], &mut stream);
                let ground = tilt.transform_point3(outwards * (major + beside));
                let above = tilt.transform_point3(outwards * (major + beside + minor) + DVec3::Y * 1e-5);
                let above = units.point(above);
                let down = (units.point(ground) - above).normalize();
                let Some(hit) = scene.nearest(Ray::new(above, down)) else { panic!("no floor") };
                if hit.shape != 0 {
                    continue;
                }
                let tube = units.point(tilt.transform_point3(outwards * major + DVec3::Y * minor));
                let d = (tube - hit.position).normalize();
                let origin = hit.ray_origin(d);
                let seen = scene.nearest(Ray::new(origin, d)).map(|next| next.shape);
                assert_eq!(seen, Some(1), "half-size {half}, {beside} m beside");
                let offset = units.world_length(f64::from(origin.distance(hit.position)));
                assert!(offset < 1e-3 * minor, "an offset of {offset} m");
            }
        }
    }
}

/// Rays leave the ball downwards, beside its contact; the floor is there wherever the gap is wider than their offset.
#[test]
fn no_ray_dives_under_the_floor_that_a_ball_rests_on() {
    let mut stream = stream(21);
    for (half, radius) in [(5.0, 1.0), (50.0, 1.0), (1000.0, 1.0), (5.0, 3.0)] {
        let scene = build(vec![floor(half, DAffine3::IDENTITY), ball(DVec3::Y * radius, radius)]);
        let units = scene.normalisation();
        let middle = units.point(DVec3::Y * radius);
        let ground = units.point(DVec3::ZERO).y;
        let mut asked = 0;
        for _ in 0..100_000 {
            let angle = TAU * f64::from(stream.next_1d());
            let beside = radius * log_uniform([1e-3, 0.5], &mut stream);
            let height = radius - (radius * radius - beside * beside).sqrt();
            let target = units.point(DVec3::new(beside * angle.cos(), height, beside * angle.sin()));
            let hit =
                scene.nearest(Ray::new(middle, (target - middle).normalize())).expect("the ball is around");
            let d = direction_around(hit.normal, &mut stream);
            let ray = Ray::new(hit.ray_origin(d), d);
            let gap = hit.position.y - ground;
            let offset = ray.origin.distance(hit.position);
            let reach = gap / -d.y * d.x.hypot(d.z);
            if hit.shape != 1 || d.y >= 0.0 || gap < 2.0 * offset || reach > 0.5 * units.length(half) {
                continue;
            }
            asked += 1;
            let next = scene.nearest(ray).map(|next| next.shape);
            assert_eq!(next, Some(0), "half-size {half}, {beside} beside the contact: {ray:?}");
        }
        assert!(asked > 50_000, "{asked}");
    }
}

#[test]
fn no_ray_from_the_floor_around_a_contact_goes_down() {
    let mut stream = stream(22);
    let scene = build(vec![floor(5.0, DAffine3::IDENTITY), ball(DVec3::Y, 1.0)]);
    let units = scene.normalisation();
    for _ in 0..100_000 {
        let angle = TAU * f64::from(stream.next_1d());
        let beside = DVec3::new(angle.cos(), 0.0, angle.sin()) * log_uniform([1e-2, 1.0], &mut stream);
        let below = units.point(beside - DVec3::Y * 0.1);
        let up = (units.point(beside) - below).normalize();
        let hit = scene.nearest(Ray::new(below, up)).expect("the floor is above");
        assert_eq!(hit.shape, 0);
        let d = direction_around(hit.normal, &mut stream);
        let ray = Ray::new(hit.ray_origin(d), d);
        // It meets the ball from outside, or nothing.
        let next = scene.nearest(ray);
        assert!(next.is_none_or(|next| next.shape == 1 && d.dot(next.normal) < 0.0), "{ray:?}: {next:?}");
    }
}
