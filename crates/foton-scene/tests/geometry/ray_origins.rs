//! A ray that leaves a surface does not meet it again: off triangles of all shapes, discs and spheres.

use foton_math::glam::{DAffine3, DQuat, DVec3, Vec3};
use foton_math::{Ray, Stream, warp};
use foton_scene::description::{Geometry, Mesh};
use foton_scene::{Scene, Surface};

use crate::{
    ball, cases, direction, grazing, in_cube, in_unit_cube, log_uniform, mesh, shape, stream, triangle, turn,
};

/// Cosines down to where single precision no longer says on which side of a plane a direction is.
const GRAZING: [f64; 2] = [1e-6, 1e-2];

/// Where a ray from a random side to a point of shape 0 meets it; `None` where rounding makes it pass by.
fn arrive(scene: &Scene, point: Vec3, stream: &mut Stream) -> Option<Surface> {
    let from = direction(stream);
    let distance = log_uniform([1e-2, 1e3], stream) as f32;
    scene.nearest(Ray::new(point + from * distance, -from)).filter(|hit| hit.shape == 0)
}

/// Half of the directions anywhere, half nearly along the surface, on either side.
fn leave(normal: Vec3, stream: &mut Stream) -> Vec3 {
    match (stream.next_1d() * 4.0) as u32 {
        0 => grazing(normal, log_uniform(GRAZING, stream), stream),
        1 => grazing(normal, -log_uniform(GRAZING, stream), stream),
        _ => direction(stream),
    }
}

/// Counts rays off a flat shape 0, whose points `sample` gives in world units, and fails at the first that meets it again.
fn rays_off(scene: &Scene, count: u32, stream: &mut Stream, sample: impl Fn(&mut Stream) -> DVec3) -> u32 {
    let mut left = 0;
    for _ in 0..count {
        let point = scene.normalisation().point(sample(stream));
        let Some(hit) = arrive(scene, point, stream) else { continue };
        let d = leave(hit.normal, stream);
        let ray = Ray::new(hit.ray_origin(d), d);
        let again = scene.nearest(ray).filter(|next| next.shape == 0);
        assert!(again.is_none(), "{ray:?} off {hit:?} meets {again:?}");
        left += 1;
    }
    left
}

/// A triangle in the middle third of the unit cube.
fn random_triangle(length: f64, width: f64, stream: &mut Stream) -> [DVec3; 3] {
    let a = in_cube(stream) * 0.3;
    let along = in_cube(stream).normalize();
    let across = along.cross(in_cube(stream)).normalize();
    [a, a + along * length, a + along * (0.4 * length) + across * width]
}

#[test]
fn rays_off_triangles_do_not_meet_them() {
    let mut stream = stream(10);
    let (large, small, tiny) = ([0.1, 0.7], [1e-3, 0.1], [1e-5, 1e-3]);
    for (name, length, slenderness) in [
        ("large", large, [0.1, 1.0]),
        ("small", small, [0.1, 1.0]),
        ("tiny", tiny, [0.1, 1.0]),
        ("slender", large, [1e-5, 1e-2]),
        ("sliver", [0.7, 0.7], [1e-6, 1e-6]),
    ] {
        let (mut asked, mut left) = (0, 0);
        for _ in 0..100 {
            let length = log_uniform(length, &mut stream);
            let width = length * log_uniform(slenderness, &mut stream);
            let [a, b, c] = random_triangle(length, width, &mut stream);
            let scene = in_unit_cube(triangle([a, b, c]));
            assert_eq!(scene.census().triangles, 3);
            asked += cases(2000);
            left += rays_off(&scene, cases(2000), &mut stream, |stream| {
                let weights = warp::square_to_triangle(stream.next_2d()).as_dvec2();
                a + (b - a) * weights.x + (c - a) * weights.y
            });
        }
        // A sliver's corners are rounded by a tenth of its width.
        assert!(left * 10 > asked * 7, "{name}: only {left} of {asked} arrived");
    }
}

/// Where a plane's own coordinate is near zero its points have next to no error, and depths taken from far corners have.
#[test]
fn rays_off_a_plane_through_the_middle_of_the_scene_do_not_meet_it() {
    let mut stream = stream(11);
    for height in [0.0, 1e-6, -1e-4, 1e-3, -0.01, 0.1, 0.5] {
        for tilt in [DAffine3::IDENTITY, DAffine3::from_rotation_x(0.3), DAffine3::from_quat(turn())] {
            let lie = DAffine3::from_translation(DVec3::Z * height) * DAffine3::from_scale(DVec3::splat(0.6));
            let scene = in_unit_cube(mesh(Mesh::rectangle(), tilt * lie));
            let left = rays_off(&scene, 5000, &mut stream, |stream| {
                (tilt * lie).transform_point3(in_cube(stream) * DVec3::new(1.0, 1.0, 0.0))
            });
            assert!(left > 4900, "{left}");
        }
    }
}

#[test]
fn rays_off_discs_do_not_meet_them() {
    let mut stream = stream(12);
    for _ in 0..100 {
        let radius = log_uniform([1e-4, 0.5], &mut stream);
        let turned = DQuat::from_rotation_arc(DVec3::Z, in_cube(&mut stream).normalize());
        let middle = in_cube(&mut stream) * 0.4;
        let to_world = DAffine3::from_scale_rotation_translation(DVec3::splat(radius), turned, middle);
        let scene = in_unit_cube(shape(Geometry::Disc, to_world));
        let left = rays_off(&scene, cases(1000), &mut stream, |stream| {
            let p = warp::square_to_disc(stream.next_2d()).as_dvec2() * 0.999;
            to_world.transform_point3(p.extend(0.0))
        });
        assert!(left > cases(800), "{left}");
    }
}

/// A ball anywhere in the cube, however small: its centre and radius in scene units come with it.
fn random_ball(radius: f64, stream: &mut Stream) -> (Scene, Vec3, f32) {
    let centre = in_cube(stream) * (1.0 - radius);
    let scene = in_unit_cube(ball(centre, radius));
    let units = *scene.normalisation();
    (scene, units.point(centre), units.length(radius))
}

#[test]
fn rays_off_a_ball_miss_it_outside_and_cross_it_inside() {
    let mut stream = stream(13);
    for radii in [[1e-4, 1e-3], [1e-3, 1e-2], [1e-2, 0.1], [0.1, 0.99]] {
        for _ in 0..60 {
            let (scene, centre, radius) = random_ball(log_uniform(radii, &mut stream), &mut stream);
            for _ in 0..cases(2000) {
                let point = centre + direction(&mut stream) * radius * 0.9;
                let hit = arrive(&scene, point, &mut stream).expect("the ray passes through the ball");
                let d = leave(hit.normal, &mut stream);
                let ray = Ray::new(hit.ray_origin(d), d);
                let next = scene.nearest(ray).filter(|next| next.shape == 0);
                let cosine = d.dot(hit.normal);
                if cosine == 0.0 {
                    // Neither in nor out, in single precision.
                    continue;
                }
                if cosine > 0.0 {
                    assert!(next.is_none(), "{ray:?} off {hit:?} meets {next:?}");
                } else {
                    let next =
                        next.unwrap_or_else(|| panic!("{ray:?} leaves the ball from inside, off {hit:?}"));
                    let (crossed, chord) = (next.position.distance(ray.origin), -2.0 * radius * cosine);
                    assert!(crossed > 0.5 * chord, "{ray:?} off {hit:?} goes {crossed} of {chord}");
                }
            }
        }
    }
}

/// One side of the triangle is a multiple of the direction, bit for bit, so that the ray never meets the plane.
#[test]
fn rays_parallel_to_a_triangle_do_not_meet_it() {
    let mut stream = stream(14);
    // The half-size in scene units of a cube whose half-size is 1.
    let half = 2048.0;
    for _ in 0..20_000 {
        let angle = std::f32::consts::TAU * stream.next_1d();
        let d = Vec3::new(angle.cos(), angle.sin(), 0.0);
        let side = d.as_dvec3() * 1024.0;
        let wall = [-side, side, DVec3::Z * 512.0].map(|corner| corner / half);
        let scene = in_unit_cube(triangle(wall));
        let beside = Vec3::new(-d.y, d.x, 0.0) * log_uniform([1e-6, 1.0], &mut stream) as f32;
        let ray = Ray::new(d * -1500.0 * stream.next_1d() + Vec3::Z * 100.0 + beside, d);
        let hit = scene.nearest(ray).filter(|hit| hit.shape == 0);
        assert!(hit.is_none(), "{ray:?} meets {hit:?}");
    }
}
