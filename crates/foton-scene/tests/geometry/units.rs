//! The unit of length does not matter: powers of two change no bit, other factors next to nothing.

use foton_math::Ray;
use foton_math::glam::{DAffine3, DVec3, Vec3};
use foton_scene::description::{Geometry, Mesh, ShapeDescription};
use foton_scene::{Scene, Surface};

use crate::{ball, build, geodesic, in_cube, mesh, shape, smooth_geodesic, stream, turn};

/// A room with one of everything, in a unit of length that is `unit` of the original's.
fn room(unit: f64) -> Scene {
    let at = |p: [f64; 3], size: f64| {
        DAffine3::from_scale_rotation_translation(DVec3::splat(size), turn(), DVec3::from_array(p))
    };
    let mut flipped = ball(DVec3::new(0.1, -0.6, 0.5), 0.25);
    flipped.flip_normals = true;
    let shapes = vec![
        mesh(Mesh::cube(), DAffine3::from_scale(DVec3::new(1.3, 1.0, 0.9))),
        mesh(geodesic(4), at([-0.6, -0.5, 0.2], 0.3)),
        mesh(smooth_geodesic(4), at([0.7, 0.4, -0.3], 0.3)),
        mesh(Mesh::rectangle(), at([0.0, 0.3, 0.4], 0.2)),
        ball(DVec3::new(-0.3, 0.55, -0.3), 0.3),
        flipped,
        shape(Geometry::Disc, at([0.5, -0.4, 0.1], 0.3)),
    ];
    let scaled = |shape: ShapeDescription| {
        let to_world = DAffine3::from_scale(DVec3::splat(unit)) * shape.to_world;
        ShapeDescription { to_world, ..shape }
    };
    build(shapes.into_iter().map(scaled).collect())
}

/// The ray from one world point of the original room towards another.
fn ray(scene: &Scene, unit: f64, from: DVec3, to: DVec3) -> Ray {
    let origin = scene.normalisation().point(from * unit);
    Ray::new(origin, (scene.normalisation().point(to * unit) - origin).normalize())
}

/// Everything that a hit says.
fn bits(hit: &Surface) -> ([[u32; 3]; 4], bool, u32) {
    let vectors = [hit.position, hit.error, hit.normal, hit.shading_normal];
    (vectors.map(|v: Vec3| v.to_array().map(f32::to_bits)), hit.curved, hit.shape)
}

#[test]
fn a_scene_scaled_by_a_power_of_two_has_the_same_hits_bit_for_bit() {
    let original = room(1.0);
    for unit in [-40, -20, -1, 3, 20].map(|power| 2f64.powi(power)) {
        let scaled = room(unit);
        assert_eq!(scaled.bounds(), original.bounds());
        let mut stream = stream(30);
        let mut met = [0; 7];
        for _ in 0..50_000 {
            let (from, to) = (in_cube(&mut stream) * 0.89, in_cube(&mut stream) * 0.89);
            let hits = [(&original, 1.0), (&scaled, unit)]
                .map(|(scene, unit)| scene.nearest(ray(scene, unit, from, to)).expect("the room is closed"));
            assert_eq!(bits(&hits[0]), bits(&hits[1]), "unit {unit}: {hits:?}");
            met[hits[0].shape as usize] += 1;
        }
        assert!(met.iter().all(|&count| count > 100), "every shape is met: {met:?}");
    }
}

#[test]
fn a_scene_in_another_unit_has_the_same_hits_to_five_digits() {
    let original = room(1.0);
    for unit in [1e-4, 0.3, 1e6] {
        let scaled = room(unit);
        let mut stream = stream(31);
        let (mut apart, mut other) = (0, 0);
        for _ in 0..50_000 {
            let (from, to) = (in_cube(&mut stream) * 0.89, in_cube(&mut stream) * 0.89);
            let [(a, here), (b, there)] = [(&original, 1.0), (&scaled, unit)].map(|(scene, unit)| {
                let hit = scene.nearest(ray(scene, unit, from, to)).expect("the room is closed");
                (hit, scene.normalisation().world_point(hit.position) / unit)
            });
            other += u32::from(a.shape != b.shape);
            let near = here.distance(there) < 1e-5 && a.normal.distance(b.normal) < 1e-4;
            apart += u32::from(a.shape == b.shape && !near);
        }
        // Rays that graze a silhouette or cross an edge between two facets may differ.
        assert!(other <= 5 && apart <= 25, "unit {unit}: {other} other shapes, {apart} apart, of 50000");
    }
}
