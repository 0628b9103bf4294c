//! Which surfaces continue each other: by where they lie, not by how files divide them.

use std::f64::consts::PI;

use foton_math::Ray;
use foton_math::glam::{DAffine3, DQuat, DVec3, Vec3};
use foton_scene::description::{Geometry, Mesh, ShapeDescription};
use foton_scene::{Scene, Surface};

use super::{ball, build, geodesic, mesh, smooth_geodesic, turn};

/// What a ray from one point to another meets first.
fn met(scene: &Scene, from: DVec3, to: DVec3) -> Surface {
    let [from, to] = [from, to].map(|p| scene.normalisation().point(p));
    scene.nearest(Ray::new(from, (to - from).normalize())).expect("a surface there")
}

/// The patch that light from `from` finds at `to`.
fn patch(scene: &Scene, from: DVec3, to: DVec3) -> u8 {
    let surface = met(scene, from, to);
    let [from, to] = [from, to].map(|p| scene.normalisation().point(p));
    surface.patch_towards((from - to).dot(surface.normal) > 0.0)
}

/// The patch seen from above at (x, z).
fn from_above(scene: &Scene, x: f64, z: f64) -> u8 {
    patch(scene, DVec3::new(x, 50.0, z), DVec3::new(x, -50.0, z))
}

/// The patch seen from below at (x, z).
fn from_below(scene: &Scene, x: f64, z: f64) -> u8 {
    patch(scene, DVec3::new(x, -50.0, z), DVec3::new(x, 50.0, z))
}

/// Corners of a quadrilateral, as triangles that share no vertex with any other.
fn quad(mesh: &mut Mesh, [a, b, c, d]: [DVec3; 4]) {
    for corners in [[a, b, c], [a, c, d]] {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(corners);
        mesh.triangles.push([first, first + 1, first + 2]);
    }
}

/// A level rectangle from (x0, z0) to (x1, z1), seen from above counter-clockwise.
fn level(y: f64, [x0, z0, x1, z1]: [f64; 4]) -> [DVec3; 4] {
    let corner = |x, z| DVec3::new(x, y, z);
    [corner(x0, z0), corner(x0, z1), corner(x1, z1), corner(x1, z0)]
}

fn level_shape(y: f64, corners: [f64; 4]) -> ShapeDescription {
    let mut one = Mesh::default();
    quad(&mut one, level(y, corners));
    mesh(one, DAffine3::IDENTITY)
}

/// A rectangle of its own transform, as scene files make floors of them.
fn tile(x: f64, z: f64, half: f64) -> ShapeDescription {
    let lie = DAffine3::from_rotation_x(-0.5 * PI);
    let to_world =
        DAffine3::from_translation(DVec3::new(x, 0.1, z)) * lie * DAffine3::from_scale(DVec3::splat(half));
    mesh(Mesh::rectangle(), to_world)
}

#[test]
fn a_card_above_a_floor_is_another_surface_in_one_mesh_and_in_two() {
    for gap in [1e-3, 1e-4, -1e-3] {
        let mut one = Mesh::default();
        quad(&mut one, level(0.0, [-5.0, -5.0, 5.0, 5.0]));
        quad(&mut one, level(gap, [-1.0, -1.0, 1.0, 1.0]));
        let together = build(vec![mesh(one, DAffine3::IDENTITY)]);
        let apart =
            build(vec![level_shape(0.0, [-5.0, -5.0, 5.0, 5.0]), level_shape(gap, [-1.0, -1.0, 1.0, 1.0])]);
        for scene in [together, apart] {
            let above = patch(&scene, DVec3::new(0.3, 1.0, 0.2), DVec3::new(0.3, 0.0, 0.2));
            let below = patch(&scene, DVec3::new(0.3, -1.0, 0.2), DVec3::new(0.3, 0.0, 0.2));
            let between = patch(&scene, DVec3::new(0.3, gap / 2.0, 0.2), DVec3::new(0.3, -1.0, 0.2));
            assert_ne!(above | 1, below | 1, "{gap}: the card and the floor");
            assert_ne!(above, between, "{gap}");
            let (right, left) = (from_above(&scene, 3.0, 0.0), from_above(&scene, -3.0, 1.0));
            assert_eq!(right, left, "{gap}: the floor beside the card");
        }
    }
}

#[test]
fn rectangles_that_abut_continue_each_other_with_and_without_equal_corners() {
    // Sixteen of one size; two large ones against rows of smaller ones; bricks that lie half a brick off.
    let even = (0..16).map(|i| tile(f64::from(i % 4) * 0.6, f64::from(i / 4) * 0.6, 0.3)).collect();
    let mut uneven = vec![level_shape(0.0, [0.0, 0.0, 3.0, 1.0]), level_shape(0.0, [0.0, 1.3, 3.0, 2.3])];
    let row = (0..7).map(|i| f64::from(i) * 3.0 / 7.0);
    uneven.extend(row.map(|x| level_shape(0.0, [x, 1.0, x + 3.0 / 7.0, 1.3])));
    let brick = |i: i32| {
        let (row, column) = (f64::from(i / 4), f64::from(i % 4));
        let x = 0.7 * column + 0.31 * (row % 2.0);
        level_shape(0.0, [x, 0.3 * row, x + 0.7, 0.3 * row + 0.3])
    };
    let bricks = (0..16).map(brick).collect();
    for (shapes, name) in [(even, "even"), (uneven, "uneven"), (bricks, "bricks")] {
        let scene = build(shapes);
        let bounds = scene.bounds();
        let (mut seen, mut count) = (Vec::new(), 0);
        for (i, j) in (0..40).flat_map(|i| (0..40).map(move |j| (i, j))) {
            let share = (Vec3::new(i as f32, 0.0, j as f32) + 0.5) / 40.0;
            let at = bounds.min + bounds.size() * share;
            let ray = Ray::new(at.with_y(500.0), Vec3::NEG_Y);
            if let Some(surface) = scene.nearest(ray) {
                count += 1;
                let patch = surface.patch_towards(surface.normal.y > 0.0);
                if !seen.contains(&patch) {
                    seen.push(patch);
                }
            }
        }
        assert!(count > 1200 && seen.len() == 1, "{name}: {seen:?} of {count}");
    }
}

#[test]
fn planks_that_are_boxes_have_one_top() {
    let plank = |i: i32| {
        let at = DVec3::new(f64::from(i) * 0.4, 0.0, 0.0);
        mesh(
            Mesh::cube(),
            DAffine3::from_scale_rotation_translation(DVec3::new(0.2, 0.05, 2.0), DQuat::IDENTITY, at),
        )
    };
    let scene = build((0..5).map(plank).collect());
    let tops: Vec<u8> = (0..5).map(|i| from_above(&scene, f64::from(i) * 0.4, 0.3)).collect();
    assert!(tops.iter().all(|&t| t == tops[0]), "{tops:?}");
    assert_ne!(tops[0], from_below(&scene, 0.0, 0.3));
}

/// A leaf of two halves that meet in the line x = z = 0… at an angle, each of `n` strips; vertices are shared or not.
fn folded(angle: f64, n: u32, shared: bool) -> Mesh {
    let mut leaf = Mesh::default();
    let half =
        |side: f64| move |s: f64| DVec3::new(s * (0.5 * angle).cos(), side * s * (0.5 * angle).sin(), 0.0);
    for strip in 0..2 * n {
        let at = |k: u32| {
            let s = f64::from(k) / f64::from(n) - 1.0;
            if s < 0.0 { half(1.0)(-s) } else { half(-1.0)(s) }
        };
        let (a, b) = (at(strip), at(strip + 1));
        quad(&mut leaf, [a - DVec3::Z, b - DVec3::Z, b + DVec3::Z, a + DVec3::Z]);
    }
    if shared {
        let mut known: Vec<DVec3> = Vec::new();
        for triangle in &mut leaf.triangles {
            for index in triangle {
                let p = leaf.positions[*index as usize];
                let place = known.iter().position(|&k| k == p).unwrap_or_else(|| {
                    known.push(p);
                    known.len() - 1
                });
                *index = place as u32;
            }
        }
        leaf.positions = known;
    }
    leaf
}

#[test]
fn the_halves_of_a_folded_leaf_are_two_surfaces_and_those_of_an_open_one_are_one() {
    for shared in [false, true] {
        for n in [1, 6] {
            let at = |angle: f64| {
                build(vec![mesh(folded(angle, n, shared), DAffine3::from_quat(DQuat::IDENTITY))])
            };
            for angle in [0.1, 0.5, 1.2] {
                let scene = at(angle);
                // The outside of the upper half, and the inside of the lower half: both face up.
                let inside = DVec3::new(0.6, 0.0, 0.1);
                let lower = patch(&scene, inside, inside - DVec3::Y * 9.0);
                assert_ne!(from_above(&scene, 0.6, 0.1), lower, "{angle} {n} {shared}");
            }
            let open = at(2.8);
            let upper = patch(&open, DVec3::new(9.0, 0.5, 0.1), DVec3::new(-9.0, 0.5, 0.1));
            let lower = patch(&open, DVec3::new(9.0, -0.5, 0.1), DVec3::new(-9.0, -0.5, 0.1));
            assert_eq!(upper, lower, "{n} {shared}");
        }
    }
}

#[test]
fn a_sheet_bent_back_over_itself_differs_between_its_layers() {
    // A U of 24 strips: one patch, whose sides tell the layers apart.
    let mut bent = Mesh::default();
    let at = |k: u32| {
        let s = f64::from(k);
        match k {
            0..=10 => DVec3::new(1.0 - 0.1 * s, 0.05, 0.0),
            11..=13 => {
                let turn = PI * (s - 10.0) / 4.0;
                DVec3::new(-0.05 * turn.sin(), 0.05 * turn.cos(), 0.0)
            }
            _ => DVec3::new(0.1 * (s - 14.0), -0.05, 0.0),
        }
    };
    for k in 0..24 {
        quad(&mut bent, [at(k) - DVec3::Z, at(k + 1) - DVec3::Z, at(k + 1) + DVec3::Z, at(k) + DVec3::Z]);
    }
    let scene = build(vec![mesh(bent, DAffine3::IDENTITY)]);
    let inside = DVec3::new(0.5, 0.0, 0.1);
    let lower = patch(&scene, inside, inside - DVec3::Y * 9.0);
    let upper = from_above(&scene, 0.5, 0.1);
    assert_eq!(upper ^ lower, 1, "one patch, other sides");
}

#[test]
fn a_leaf_that_touches_a_floor_does_not_continue_it() {
    for angle in [0.1f64, 0.5, 1.0] {
        let mut leaf = Mesh::default();
        let up = DVec3::new(angle.cos(), angle.sin(), 0.0) * 0.4;
        let edge = [DVec3::new(0.1, 0.0, -0.3), DVec3::new(0.1, 0.0, 0.3)];
        quad(&mut leaf, [edge[0], edge[1], edge[1] + up, edge[0] + up]);
        let scene = build(vec![level_shape(0.0, [-1.0, -1.0, 1.0, 1.0]), mesh(leaf, DAffine3::IDENTITY)]);
        let x = 0.1 + 0.5 * up.x;
        assert_ne!(from_above(&scene, x, 0.0) | 1, from_above(&scene, -0.5, 0.0) | 1, "{angle}");
    }
}

#[test]
fn a_sphere_and_one_of_triangles_are_one_curved_patch_each_wherever_they_stand() {
    let place = DAffine3::from_rotation_translation(turn(), DVec3::new(0.3, -0.2, 0.9));
    let shapes =
        [ball(DVec3::new(0.3, -0.2, 0.9), 1.0), mesh(geodesic(12), place), mesh(smooth_geodesic(12), place)];
    for (i, ball) in shapes.into_iter().enumerate() {
        let scene = build(vec![ball]);
        let centre = DVec3::new(0.3, -0.2, 0.9);
        let mut stream = super::stream(77);
        let patches: Vec<(u8, bool)> = (0..300)
            .map(|_| {
                let towards = super::direction(&mut stream).as_dvec3();
                let surface = met(&scene, centre + towards * 3.0, centre);
                (patch(&scene, centre + towards * 3.0, centre), surface.curved)
            })
            .collect();
        assert!(patches.iter().all(|p| *p == (patches[0].0, true)), "{i}");
        let inside = patch(&scene, centre, centre + DVec3::X * 3.0);
        assert_eq!(inside ^ patches[0].0, 1, "{i}");
    }
}

#[test]
fn tubes_end_to_end_continue_each_other_and_a_lid_does_not() {
    let tube = |from: f64, to: f64| {
        let [from, to] = [from, to].map(|y| DVec3::new(0.2, y, -0.1));
        super::shape(Geometry::Cylinder { from, to, radius: 0.3 }, DAffine3::IDENTITY)
    };
    let lie = DAffine3::from_rotation_x(-0.5 * PI) * DAffine3::from_scale(DVec3::splat(0.3));
    let lid = super::shape(Geometry::Disc, DAffine3::from_translation(DVec3::new(0.2, 1.0, -0.1)) * lie);
    let scene = build(vec![tube(-1.0, 0.1), tube(0.1, 1.0), lid]);
    let side = |y: f64| patch(&scene, DVec3::new(9.0, y, -0.1), DVec3::new(-9.0, y, -0.1));
    assert_eq!(side(-0.5), side(0.5));
    assert_ne!(side(0.5) | 1, from_above(&scene, 0.2, -0.1) | 1);
}

#[test]
fn many_patches_share_numbers_but_neighbours_do_not() {
    // 1,600 cards in stacks of four over a floor.
    let mut cards = Mesh::default();
    let cell = |i: u32| (f64::from(i % 20) * 0.1, f64::from(i / 20) * 0.1);
    for i in 0..400 {
        let (x, z) = cell(i);
        for layer in 1..=4 {
            quad(&mut cards, level(0.01 * f64::from(layer), [x, z, x + 0.08, z + 0.08]));
        }
    }
    let floor = level_shape(0.0, [-1.0, -1.0, 3.0, 3.0]);
    let scene = build(vec![mesh(cards, DAffine3::IDENTITY), floor]);
    let ground = from_above(&scene, -0.5, -0.5);
    for i in 0..400 {
        let (x, z) = cell(i);
        let layers: Vec<u8> = (0..5)
            .map(|layer| {
                let y = 0.01 * f64::from(layer);
                patch(
                    &scene,
                    DVec3::new(x + 0.04, y + 0.005, z + 0.04),
                    DVec3::new(x + 0.04, y - 1.0, z + 0.04),
                )
            })
            .collect();
        assert_eq!(layers[0], ground);
        let differ = (0..5).all(|a| (0..a).all(|b| layers[a] != layers[b]));
        assert!(differ, "{i}: {layers:?}");
    }
}
