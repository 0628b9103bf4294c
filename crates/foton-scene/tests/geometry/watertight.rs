//! Closed surfaces hold every ray, wherever it starts and however it is aimed.

use foton_math::glam::{DAffine3, DVec3, Vec3};
use foton_math::{Ray, Stream};
use foton_scene::Scene;
use foton_scene::description::Mesh;

use crate::{ball, build, cases, direction, direction_around, geodesic, in_cube, mesh, stream, turn};

/// A closed surface around the world's origin.
struct Room {
    name: &'static str,
    scene: Scene,
    /// The cube of this half-size around the world's origin is inside.
    inside: f64,
    /// Corners of each triangle in scene units.
    faces: Vec<[Vec3; 3]>,
}

impl Room {
    fn of_mesh(name: &'static str, shape: &Mesh, to_world: DAffine3, inside: f64) -> Self {
        let scene = build(vec![mesh(shape.clone(), to_world)]);
        let place = |i: u32| to_world.transform_point3(shape.positions[i as usize]);
        let corner = |i: u32| scene.normalisation().point(place(i));
        let faces = shape.triangles.iter().map(|t| t.map(corner)).collect();
        Self { name, scene, inside, faces }
    }

    /// A point inside.
    fn point(&self, stream: &mut Stream) -> Vec3 {
        self.scene.normalisation().point(in_cube(stream) * self.inside)
    }

    fn holds(&self, ray: Ray) -> bool {
        self.scene.nearest(ray).is_some() && self.scene.occluded(ray)
    }

    fn assert_holds(&self, ray: Ray) {
        assert!(self.holds(ray), "the {} loses {ray:?}", self.name);
    }
}

fn boxes() -> [Room; 3] {
    let turned = DAffine3::from_scale_rotation_translation(DVec3::new(3.0, 1.0, 0.2), turn(), DVec3::ZERO);
    let shifted = DAffine3::from_translation(DVec3::new(0.5, -0.25, 0.125));
    [
        Room::of_mesh("box along the axes", &Mesh::cube(), DAffine3::IDENTITY, 0.99),
        Room::of_mesh("box off the centre", &Mesh::cube(), shifted, 0.49),
        Room::of_mesh("turned box", &Mesh::cube(), turned, 0.11),
    ]
}

/// A box whose faces are cut at the same three places of each axis, of which two lie a millionth of the side apart: slivers of
/// 10⁶ : 1 between large triangles.
fn box_of_slivers() -> Room {
    let cuts = [-1.0, -0.3, -0.3 + 2e-6, 1.0];
    let mut shape = Mesh::default();
    for (face, axis) in (0..6).map(|face| (face, face % 3)) {
        let side = if face < 3 { -1.0 } else { 1.0 };
        for (i, j) in (0..9).map(|n| (n / 3, n % 3)) {
            let corner = |di: usize, dj: usize| {
                let mut p = DVec3::splat(side);
                (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (cuts[i + di], cuts[j + dj]);
                p
            };
            let first = shape.positions.len() as u32;
            shape.positions.extend([corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]);
            let [a, b, c, d] = [0, 1, 2, 3].map(|n| first + n);
            let faces = [[a, b, c], [a, c, d]];
            shape.triangles.extend(if side > 0.0 { faces } else { faces.map(|[a, b, c]| [a, c, b]) });
        }
    }
    let room = Room::of_mesh("box of slivers", &shape, DAffine3::from_quat(turn()), 0.5);
    assert_eq!((room.scene.census().triangles, room.scene.census().degenerate_triangles), (108, 0));
    room
}

fn rooms() -> impl Iterator<Item = Room> {
    let sphere = build(vec![ball(DVec3::new(0.1, 0.2, -0.1), 1.0)]);
    let sphere = Room { name: "sphere", scene: sphere, inside: 0.43, faces: Vec::new() };
    let globe = Room::of_mesh("globe", &geodesic(8), DAffine3::from_quat(turn()), 0.56);
    boxes().into_iter().chain([box_of_slivers(), globe, sphere])
}

#[test]
fn no_ray_leaves_a_closed_surface() {
    for room in rooms() {
        let mut stream = stream(1);
        for _ in 0..cases(200_000) {
            room.assert_holds(Ray::new(room.point(&mut stream), direction(&mut stream)));
        }
    }
}

#[test]
fn no_ray_leaves_at_a_vertex_an_edge_or_a_diagonal() {
    for room in rooms().filter(|room| !room.faces.is_empty()) {
        let mut stream = stream(2);
        for [a, b, c] in room.faces.iter().cycle().take(15_000.max(room.faces.len())) {
            let s = stream.next_1d();
            for target in [*a, (a + b) * 0.5, a + (b - a) * s, b + (c - b) * s, c + (a - c) * s] {
                let origin = room.point(&mut stream);
                room.assert_holds(Ray::new(origin, (target - origin).normalize()));
            }
        }
    }
}

/// Faces' diagonals, edges and vertices of a cube are met without any rounding, and zeros have both signs.
#[test]
fn rays_along_axes_and_diagonals_meet_a_box_where_they_should() {
    let [room, ..] = boxes();
    let half = room.scene.bounds().max.x;
    assert_eq!(half, 2048.0);
    for i in (0..27).filter(|&i| i != 13) {
        let signs = Vec3::new((i % 3 - 1) as f32, (i / 3 % 3 - 1) as f32, (i / 9 - 1) as f32);
        for zero in [0.0, -0.0] {
            for shift in [0.0, 0.25, -0.5] {
                let d = signs.normalize().map(|x| if x == 0.0 { zero } else { x });
                // Off the centre in the coordinates that the ray does not change.
                let origin = signs.map(|s| if s == 0.0 { half * shift } else { 0.0 });
                let hit = room.scene.nearest(Ray::new(origin, d));
                let hit = hit.unwrap_or_else(|| panic!("{origin} {d} is lost"));
                assert!(hit.position.distance(origin + signs * half) < 4e-3, "{origin} {d}: {hit:?}");
            }
        }
    }
}

#[test]
fn directions_with_tiny_or_signed_zero_components_hit() {
    for room in rooms() {
        let mut stream = stream(3);
        for tiny in [0.0f32, 1e-40, 1e-30, 1e-20, 1e-9, 1e-7] {
            for (sign, axis) in [(1.0, 0), (-1.0, 0), (1.0, 1), (-1.0, 1), (1.0, 2), (-1.0, 2)] {
                for _ in 0..300 {
                    let mut d = direction(&mut stream);
                    d[axis] = 0.0;
                    d = d.normalize();
                    d[axis] = tiny * sign;
                    room.assert_holds(Ray::new(room.point(&mut stream), d));
                }
            }
        }
    }
}

#[test]
fn a_path_of_random_bounces_stays_inside() {
    for room in rooms() {
        let mut stream = stream(4);
        let mut ray = Ray::new(room.point(&mut stream), direction(&mut stream));
        for bounce in 0..cases(200_000) {
            let hit = room.scene.nearest(ray);
            let hit = hit.unwrap_or_else(|| panic!("the {} loses {ray:?} at bounce {bounce}", room.name));
            let d = direction_around(-hit.normal, &mut stream);
            ray = Ray::new(hit.ray_origin(d), d);
        }
    }
}

/// Only where the two faces of an edge round differently can a ray that starts in it slip through: about one in a million.
#[test]
fn rays_that_start_in_the_edges_of_a_box_stay_inside() {
    for room in rooms().filter(|room| !room.faces.is_empty()) {
        let mut stream = stream(5);
        let (mut started, mut lost) = (0, 0);
        for [a, b, _] in room.faces.iter().cycle().take(50_000) {
            let target = a + (b - a) * stream.next_1d();
            let origin = room.point(&mut stream);
            let hit = room.scene.nearest(Ray::new(origin, (target - origin).normalize()));
            let Some(hit) = hit.filter(|hit| hit.position.distance(target) < 0.01) else { continue };
            let d = direction_around(-hit.normal, &mut stream);
            started += 1;
            lost += u32::from(!room.holds(Ray::new(hit.ray_origin(d), d)));
        }
        assert!(started > 40_000 && lost <= 2, "the {} loses {lost} of {started}", room.name);
    }
}
