//! Rays of cameras, what their pixels cover, and where points are seen.

use super::*;
use crate::description::Lens;
use foton_math::glam::DAffine3;

fn sensor(axis: FovAxis) -> Sensor {
    new(&description(axis))
}

fn new(description: &SensorDescription) -> Sensor {
    Sensor::new(description, &Normalisation::IDENTITY)
}

fn shifted() -> SensorDescription {
    SensorDescription { principal_point_offset: [0.1, 0.2], ..description(FovAxis::X) }
}

/// Shows 4 × 3 units.
fn orthographic() -> SensorDescription {
    let scale = DAffine3::from_scale(DVec3::new(2.0, 3.0, 5.0));
    let to_world = description(FovAxis::X).to_world * scale;
    SensorDescription { projection: Projection::Orthographic, to_world, ..description(FovAxis::X) }
}

fn telecentric() -> SensorDescription {
    let lens = Some(Lens { aperture_radius: 0.25, focus_distance: 4.0 });
    SensorDescription { lens, ..orthographic() }
}

fn description(axis: FovAxis) -> SensorDescription {
    // Looks along world −z from (0, 0, 5): camera x to world −x, camera z to world −z.
    let to_world = DAffine3::from_cols(-DVec3::X, DVec3::Y, -DVec3::Z, DVec3::new(0.0, 0.0, 5.0));
    SensorDescription {
        to_world,
        fov_degrees: 90.0,
        fov_axis: axis,
        width: 200,
        height: 100,
        ..SensorDescription::default()
    }
}

#[test]
fn all_rays_of_a_film_position_meet_in_focus_and_spread_over_the_circle_of_confusion() {
    let lens = Lens { aperture_radius: 0.25, focus_distance: 4.0 };
    let description = SensorDescription { lens: Some(lens), ..description(FovAxis::X) };
    let films = [Vec2::new(100.0, 50.0), Vec2::new(12.0, 90.0)];
    let s = new(&description);
    let lenses = [&s, &new(&telecentric())].map(|s| films.map(|film| (s.clone(), film)));
    for (s, film) in lenses.into_iter().flatten() {
        let middle = s.ray(film);
        let at = |ray: &Ray, depth: f32| ray.at(depth / ray.direction.dot(-Vec3::Z));
        let mut widest = [0f32; 2];
        for i in 0..256 {
            let u = Vec2::new((i % 16) as f32 / 15.0, (i / 16) as f32 / 15.0);
            let ray = s.eye_ray(film, u);
            assert!(at(&ray, 4.0).distance(at(&middle, 4.0)) < 1e-5, "{film} {u}");
            assert!((ray.origin.z - 5.0).abs() < 1e-6, "from the plane of the lens");
            // r |z/f − 1|, nearer and farther than the focus.
            for (widest, depth) in widest.iter_mut().zip([1.0, 12.0]) {
                *widest = widest.max(
                    (ray.origin + ray.direction * (depth / -ray.direction.z)).distance(at(&middle, depth)),
                );
            }
        }
        for (widest, (depth, expected)) in widest.into_iter().zip([(1.0, 0.1875), (12.0, 0.5)]) {
            assert!((widest / expected - 1.0).abs() < 1e-4, "{widest} {expected}");
            let distance = depth / middle.direction.dot(-Vec3::Z);
            let area = s.confusion(middle.direction, distance);
            assert!((area / (PI * expected * expected) - 1.0).abs() < 1e-4, "{area}");
        }
    }
    assert_eq!(s.lens(), Some([0.25, 4.0]));
    let closed = SensorDescription { lens: Some(Lens { aperture_radius: 0.0, ..lens }), ..description };
    let pinhole = Sensor::new(&closed, &Normalisation::IDENTITY);
    assert_eq!(pinhole.lens(), None);
    assert_eq!(pinhole.eye_ray(Vec2::ONE, Vec2::ZERO).origin, pinhole.ray(Vec2::ONE).origin);
}

#[test]
fn rays_change_as_those_of_neighbouring_pixels_do() {
    for s in [sensor(FovAxis::X), new(&shifted()), new(&orthographic()), new(&telecentric())] {
        for film in [Vec2::new(100.0, 50.0), Vec2::new(12.0, 90.0)] {
            let [origins, directions] = s.change_of_ray(s.ray(film).direction);
            for (i, step) in [Vec2::X, Vec2::Y].into_iter().enumerate() {
                let [a, b] = [0.5, -0.5].map(|half| s.ray(film + half * step));
                let between = [a.origin - b.origin, a.direction - b.direction];
                for (change, between) in [origins[i], directions[i]].into_iter().zip(between) {
                    assert!(change.distance(between) <= 1e-3 * between.length(), "{change} {between}");
                }
            }
        }
    }
}

#[test]
fn a_crop_sees_what_its_window_of_the_whole_image_sees() {
    let whole = sensor(FovAxis::X);
    let crop = Some(Crop { x: 30, y: 20, width: 64, height: 50 });
    let part = Sensor::new(&SensorDescription { crop, ..description(FovAxis::X) }, &Normalisation::IDENTITY);
    assert_eq!((part.width, part.height), (64, 50));
    let (a, b) = (part.ray(Vec2::new(3.5, 7.25)), whole.ray(Vec2::new(33.5, 27.25)));
    assert_eq!(a.direction, b.direction);
    assert_eq!(part.pixel_area(a.direction, 3.0), whole.pixel_area(b.direction, 3.0));
}

#[test]
fn a_crop_keeps_its_place_and_stays_inside_at_another_size() {
    let crop = Some(Crop { x: 30, y: 20, width: 170, height: 50 });
    for (size, expected) in
        [((400, 200), (60, 40, 340, 100)), ((20, 10), (3, 2, 17, 5)), ((3, 1), (0, 0, 3, 1))]
    {
        let mut resized = SensorDescription { crop, ..description(FovAxis::X) };
        resized.resize(size.0, size.1);
        let c = resized.crop.expect("still a crop");
        assert_eq!((c.x, c.y, c.width, c.height), expected, "{size:?}");
    }
}

#[test]
fn a_point_on_a_ray_is_seen_where_the_ray_leaves_the_film() {
    let cropped = SensorDescription { crop: Some(Crop { x: 3, y: 2, width: 180, height: 70 }), ..shifted() };
    for description in [description(FovAxis::X), shifted(), cropped, orthographic()] {
        let sensor = new(&description);
        for film in [Vec2::new(3.0, 7.0), Vec2::new(150.5, 99.0), Vec2::new(100.0, 50.0)] {
            let ray = sensor.ray(film);
            let (seen, depth) = sensor.project(ray.at(12.0)).expect("in front");
            assert!(seen.distance(film) < 1e-3 && depth > 0.0 && depth < 12.001, "{film} {seen} {depth}");
            assert!(sensor.eye_of(ray.at(12.0)).distance(ray.origin) < 1e-5, "{film}");
            assert_eq!(sensor.project(ray.at(-12.0)), None);
        }
        assert_eq!(sensor.project(sensor.origin()), None);
    }
}

/// Mitsuba 3.9 has these rays for a film of 20 × 10 pixels, the camera at the origin; here it looks the other way from z = 5.
#[test]
fn rays_are_those_of_mitsuba() {
    let film = |x: f32, y: f32| Vec2::new(200.0 * x, 100.0 * y);
    let close = |a: Vec3, b: [f32; 3]| assert!(a.distance(Vec3::from(b)) < 1e-5, "{a} {b:?}");
    let s = new(&shifted());
    close(s.ray(film(0.5, 0.5)).direction, [0.192_450_03, -0.192_450_03, -0.962_250_5]);
    close(s.ray(film(0.0, 0.0)).direction, [-0.608_228_8, 0.228_085_82, -0.760_285_85]);
    close(s.ray(film(1.0, 1.0)).direction, [0.701_047_4, -0.408_944_34, -0.584_206_2]);
    let s = new(&SensorDescription { near_clip: Some(5.0), far_clip: Some(13.0), ..orthographic() });
    for (at, [x, y]) in [((0.0, 0.0), [-2.0, 1.5]), ((1.0, 1.0), [2.0, -1.5]), ((1.0, 0.0), [2.0, 1.5])] {
        let ray = s.ray(film(at.0, at.1));
        close(ray.origin, [x, y, 5.0]);
        close(ray.direction, [0.0, 0.0, -1.0]);
        assert_eq!([ray.t_min, ray.t_max], [5.0, 13.0]);
    }
}

#[test]
fn the_right_edge_of_the_image_looks_right_at_half_the_field_of_view() {
    let ray = sensor(FovAxis::X).ray(Vec2::new(200.0, 50.0));
    assert!(ray.direction.distance(Vec3::new(1.0, 0.0, -1.0).normalize()) < 1e-6);
    assert_eq!(ray.origin, Vec3::new(0.0, 0.0, 5.0));
    let up = sensor(FovAxis::Y).ray(Vec2::new(100.0, 0.0));
    assert!(up.direction.distance(Vec3::new(0.0, 1.0, -1.0).normalize()) < 1e-6);
    assert_eq!(
        sensor(FovAxis::Larger).ray(Vec2::ZERO).direction,
        sensor(FovAxis::X).ray(Vec2::ZERO).direction
    );
    assert_eq!(
        sensor(FovAxis::Smaller).ray(Vec2::ZERO).direction,
        sensor(FovAxis::Y).ray(Vec2::ZERO).direction
    );
    let corner = sensor(FovAxis::Diagonal).ray(Vec2::new(200.0, 0.0)).direction;
    assert!((corner.dot(-Vec3::Z) - 45f32.to_radians().cos()).abs() < 1e-6);
}

#[test]
fn pixels_cover_the_solid_angle_of_the_image() {
    // The pyramid of half angles whose tangents are 1 and 1/2.
    let (a, b) = (1f64, 0.5f64);
    let expected = 4.0 * (a * b / (1.0 + a * a + b * b).sqrt()).atan();
    let s = sensor(FovAxis::X);
    let mut sum = 0.0;
    for y in 0..100 {
        for x in 0..200 {
            let ray = s.ray(Vec2::new(x as f32 + 0.5, y as f32 + 0.5));
            sum += f64::from(s.pixel_area(ray.direction, 1.0));
        }
    }
    assert!((sum / expected - 1.0).abs() < 1e-4, "{sum} {expected}");
}

#[test]
fn pixels_of_parallel_rays_cover_the_same_at_any_distance() {
    let s = new(&orthographic());
    let ray = s.ray(Vec2::new(12.0, 90.0));
    for distance in [0.5, 80.0] {
        let all = s.pixel_area(ray.direction, distance) * 200.0 * 100.0;
        assert!((all / 12.0 - 1.0).abs() < 1e-5, "{all}");
    }
    // A scale of the scene scales what is shown.
    let mut large = orthographic();
    large.to_world = DAffine3::from_scale(DVec3::splat(8.0)) * large.to_world;
    let area = new(&large).pixel_area(ray.direction, 1.0);
    assert!((area / s.pixel_area(ray.direction, 1.0) / 64.0 - 1.0).abs() < 1e-5);
}
