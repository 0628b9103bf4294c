//! Which side is outside: mirrors do not turn it around, `flip_normals` does, and emitters shine on it.

use foton_math::glam::{DAffine3, DMat3, DVec3, Vec2, Vec3};
use foton_math::{Ray, Rgb};
use foton_scene::description::{Geometry, Mesh, ShapeDescription};
use foton_scene::{Scene, Surface};

use crate::{ball, build, direction, geodesic, grazing, in_cube, mesh, shape, smooth_geodesic, stream, turn};

/// Turns and moves, each with an even scale, with mirrors and without.
fn placements() -> Vec<DAffine3> {
    let signs = [[1, 1, 1], [-1, 1, 1], [1, -1, 1], [1, 1, -1], [-1, -1, 1], [-1, -1, -1]];
    let place =
        DAffine3::from_scale_rotation_translation(DVec3::splat(3.0), turn(), DVec3::new(5.0, -2.0, 1.0));
    let mirrors = signs.map(|s| DAffine3::from_scale(DVec3::from_array(s.map(f64::from))));
    mirrors.into_iter().flat_map(|mirror| [mirror, place * mirror, mirror * place]).collect()
}

/// Both ways around, shining.
fn both(mut description: ShapeDescription) -> [ShapeDescription; 2] {
    description.radiance = Some(Rgb::WHITE.into());
    let mut flipped = description.clone();
    flipped.flip_normals = true;
    [description, flipped]
}

/// Fails unless the side that `to_eye` points to is the outside exactly where the shape is not flipped, and only the
/// outside shines.
fn assert_side(scene: &Scene, hit: &Surface, to_eye: Vec3, outside: bool) {
    assert_eq!(hit.normal.dot(to_eye) > 0.0, outside, "{hit:?}");
    assert!(hit.shading_normal.dot(hit.normal) > 0.0, "{hit:?}");
    let [towards, away] = [to_eye, -to_eye].map(|d| scene.emitted(hit, d));
    let (lit, dark) = if outside { (towards, away) } else { (away, towards) };
    assert_eq!((lit, dark), (Rgb::WHITE, Rgb::BLACK));
}

#[test]
fn mirrors_keep_the_outside_of_closed_shapes_and_flipping_turns_it() {
    let mut wound_inwards = smooth_geodesic(4);
    for triangle in &mut wound_inwards.triangles {
        triangle.swap(1, 2);
    }
    let sphere = Geometry::Sphere { centre: DVec3::new(0.1, 0.0, -0.2), radius: 0.8 };
    let stretched = DAffine3::from_scale(DVec3::new(1.0, 0.2, 3.0));
    for to_world in placements() {
        let shapes = [
            mesh(Mesh::cube(), to_world * stretched),
            mesh(geodesic(4), to_world * stretched),
            mesh(smooth_geodesic(4), to_world * stretched),
            mesh(wound_inwards.clone(), to_world),
            shape(sphere.clone(), to_world),
        ];
        for description in shapes.into_iter().flat_map(both) {
            let outside = !description.flip_normals;
            let scene = build(vec![description]);
            let mut stream = stream(40);
            for _ in 0..300 {
                let d = direction(&mut stream);
                let origin = scene.bounds().centre() - d * 5000.0;
                let hit = scene.nearest(Ray::new(origin, d)).expect("the shape surrounds its middle");
                assert_side(&scene, &hit, -d, outside);
                // What the emitter sends goes the same way: out, or across the inside.
                let [u, v] = [stream.next_2d(), stream.next_2d()];
                let photon = scene.emitters()[0].emit(stream.next_1d(), u, v);
                assert_ne!(scene.occluded(Ray::new(photon.origin, photon.direction)), outside);
            }
        }
    }
}

#[test]
fn mirrors_keep_the_outside_of_tubes_and_flipping_turns_it() {
    let (from, to) = (DVec3::new(-0.5, 0.2, 0.1), DVec3::new(0.5, 0.3, 0.0));
    for to_world in placements() {
        let tube = Geometry::Cylinder { from, to, radius: 0.25 };
        for description in both(shape(tube, to_world)) {
            let outside = !description.flip_normals;
            let scene = build(vec![description]);
            let ends = [from, to].map(|end| scene.normalisation().point(to_world.transform_point3(end)));
            let mut stream = stream(42);
            for _ in 0..300 {
                let across = (ends[1] - ends[0]).cross(direction(&mut stream)).normalize();
                let origin = ends[0].lerp(ends[1], stream.next_1d()) - across * 5000.0;
                let hit = scene.nearest(Ray::new(origin, across)).expect("the tube is around its axis");
                assert_side(&scene, &hit, -across, outside);
                let [u, v] = [stream.next_2d(), stream.next_2d()];
                let photon = scene.emitters()[0].emit(stream.next_1d(), u, v);
                let inside = scene.occluded(Ray::new(photon.origin, photon.direction));
                assert!(!(inside && outside), "light from outside meets the tube again");
            }
        }
    }
}

#[test]
fn mirrors_carry_the_normal_of_discs_and_rectangles_and_flipping_turns_it() {
    for to_world in placements() {
        let m: DMat3 = to_world.matrix3;
        let expected = (m.inverse().transpose() * DVec3::Z).normalize().as_vec3();
        for description in
            [shape(Geometry::Disc, to_world), mesh(Mesh::rectangle(), to_world)].into_iter().flat_map(both)
        {
            let side = if description.flip_normals { -1.0 } else { 1.0 };
            let scene = build(vec![description]);
            for from in [expected, -expected] {
                let origin = scene.bounds().centre() + from * 100.0;
                let hit = scene.nearest(Ray::new(origin, -from)).expect("both sides can be hit");
                assert!(hit.normal.dot(expected) * side > 0.999_999, "{hit:?}");
                assert_side(&scene, &hit, from, from.dot(expected) * side > 0.0);
            }
            let photon = scene.emitters()[0].emit(0.3, Vec2::splat(0.4), Vec2::splat(0.6));
            assert!(photon.direction.dot(expected) * side > 0.0);
        }
    }
}

#[test]
fn grazing_hits_are_finite_and_their_normals_unit_vectors_on_one_side() {
    let cosine = 89.999f64.to_radians().cos();
    let tilted = DAffine3::from_quat(turn());
    let shapes = [
        mesh(Mesh::rectangle(), tilted),
        mesh(geodesic(8), tilted),
        mesh(smooth_geodesic(8), tilted),
        shape(Geometry::Disc, tilted),
        ball(DVec3::ZERO, 1.0),
    ];
    for description in shapes {
        let scene = build(vec![description]);
        let mut stream = stream(41);
        let mut met = 0;
        for _ in 0..20_000 {
            let towards = scene.normalisation().point(in_cube(&mut stream) * 0.3);
            let d = direction(&mut stream);
            let Some(first) = scene.nearest(Ray::new(towards - d * 4000.0, d)) else { continue };
            let d = -grazing(first.normal, cosine, &mut stream);
            let Some(hit) = scene.nearest(Ray::new(first.position - d * 100.0, d)) else { continue };
            met += 1;
            for hit in [first, hit] {
                let origins = [hit.ray_origin(d), hit.ray_origin(-d)];
                let finite = [hit.position, hit.error, origins[0], origins[1]].iter().all(|v| v.is_finite());
                let unit = [hit.normal, hit.shading_normal].iter().all(|n| (n.length() - 1.0).abs() < 1e-6);
                assert!(finite && unit && hit.normal.dot(hit.shading_normal) > 0.0, "{hit:?}");
            }
        }
        assert!(met > 4000, "{met}");
    }
}
