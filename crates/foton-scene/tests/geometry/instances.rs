//! Shapes that share a mesh are met as if each had one of its own, to the bit, and contacts and patches are found on them, too.

use foton_math::Ray;
use foton_math::glam::{DAffine2, DVec2};
use foton_scene::description::{Attribute, Colour, Texture, TextureKind};
use foton_scene::{BuildOptions, Instancing, Surface};

use super::*;

fn built(description: &SceneDescription, instancing: Instancing) -> Scene {
    let options = BuildOptions { instancing, ..BuildOptions::default() };
    Scene::build_with(description, &options).expect("a sound description")
}

/// Numbers that single precision does not hold.
fn uneven(mut mesh: Mesh) -> Mesh {
    mesh.positions.iter_mut().for_each(|p| *p = *p * (1.0 / 3.0) + DVec3::new(0.1, 0.7, -0.3));
    mesh.texture_coordinates = mesh.positions.iter().map(|p| DVec2::new(p.x, p.y + p.z)).collect();
    mesh
}

/// Places of all kinds: turned, mirrored, stretched, small, large and far away.
fn places(stream: &mut Stream, count: u32) -> Vec<DAffine3> {
    let place = |_| {
        let axis = direction(stream).as_dvec3();
        let turn = DQuat::from_axis_angle(axis, 6.0 * f64::from(stream.next_1d()));
        let size = log_uniform([0.02, 2.0], stream);
        let mirror = if stream.next_1d() < 0.5 { -1.0 } else { 1.0 };
        let stretch = DVec3::new(mirror, log_uniform([0.3, 3.0], stream), 1.0) * size;
        DAffine3::from_scale_rotation_translation(stretch, turn, in_cube(stream) * 6.0)
    };
    (0..count).map(place).collect()
}

fn scattered(mesh: &Arc<Mesh>, stream: &mut Stream) -> Vec<ShapeDescription> {
    let of = |(i, place): (usize, DAffine3)| ShapeDescription {
        flip_normals: i % 3 == 0,
        ..shape(Geometry::Mesh(Arc::clone(mesh)), place)
    };
    places(stream, 30).into_iter().enumerate().map(of).collect()
}

/// All that is public of a point.
fn bits(s: &Surface) -> (Vec<u32>, u32, bool) {
    let vectors = [s.position, s.error, s.normal, s.shading_normal];
    (vectors.iter().flat_map(|v| v.to_array()).map(f32::to_bits).collect(), s.shape, s.curved)
}

fn any_ray(scene: &Scene, stream: &mut Stream) -> Ray {
    let (centre, radius) = (scene.bounds().centre(), scene.bounds().radius());
    let from = centre + direction(stream) * radius * stream.next_1d() * 1.5;
    let to = centre + direction(stream) * radius * stream.next_1d();
    Ray::new(from, (to - from).normalize())
}

#[test]
fn rays_meet_instances_where_they_meet_meshes_of_their_own() {
    let mut stream = stream(2201);
    for (name, one) in [("flat", geodesic(6)), ("smooth", smooth_geodesic(6)), ("ring", ring(1.0, 0.3))] {
        let shared = Arc::new(uneven(one));
        let floor = mesh(Mesh::rectangle(), DAffine3::from_scale(DVec3::splat(5.0)));
        let mut shapes = scattered(&shared, &mut stream);
        shapes.insert(7, floor);
        let description = describe(shapes);
        let [flat, two_level] = [Instancing::Never, Instancing::Always].map(|how| built(&description, how));
        assert_eq!((flat.census().instances, two_level.census().instances), (0, 30));
        assert_eq!(flat.census().triangles, two_level.census().triangles);
        assert_eq!(flat.bounds(), two_level.bounds());
        let (mut hits, mut others) = (0, 0);
        for _ in 0..cases(20_000) {
            let ray = any_ray(&flat, &mut stream);
            let [a, b] = [&flat, &two_level].map(|scene| scene.nearest(ray));
            assert_eq!(flat.occluded(ray), two_level.occluded(ray), "{name}");
            match (a, b) {
                (None, None) => {}
                (Some(a), Some(b)) if bits(&a) == bits(&b) => hits += 1,
                // Of triangles that a ray meets at one distance either counts.
                (Some(a), Some(b)) => {
                    others += 1;
                    let off = (a.position - b.position).length();
                    assert!(off <= a.error.length() + b.error.length(), "{name}: {a:?} {b:?}");
                }
                (a, b) => panic!("{name}: {a:?} {b:?}"),
            }
        }
        assert!(hits > 5000 && others <= 2, "{name}: {hits} {others}");
    }
}

/// A texture of colours at vertices, looked up through the material.
#[test]
fn attributes_of_instances_are_those_of_the_mesh() {
    let mut stream = stream(2202);
    for attribute in ["vertex_tint", "face_tint"] {
        let mut one = uneven(smooth_geodesic(4));
        let things = if attribute.starts_with("face") { one.triangles.len() } else { one.positions.len() };
        let values: Arc<[f32]> = (0..3 * things).map(|_| stream.next_1d()).collect();
        one.attributes.push(Attribute { name: attribute.into(), channels: 3, values });
        let mut description = describe(scattered(&Arc::new(one), &mut stream));
        description.textures.push(Texture {
            name: "tint".into(),
            to_uv: DAffine2::IDENTITY,
            kind: TextureKind::Attribute { name: attribute.into(), scale: 1.0, most: 1.0 },
        });
        description.materials[0].front = Bsdf::Diffuse(Diffuse { reflectance: Colour::Texture(0) });
        description.materials[0].back = Some(description.materials[0].front);
        let [flat, two_level] = [Instancing::Never, Instancing::Always].map(|how| built(&description, how));
        let mut compared = 0;
        for _ in 0..20_000 {
            let ray = any_ray(&flat, &mut stream);
            let [Some(a), Some(b)] = [&flat, &two_level].map(|scene| scene.nearest(ray)) else { continue };
            if bits(&a) != bits(&b) {
                continue;
            }
            let outward = ray.direction.dot(a.normal) < 0.0;
            let [a, b] = [(&flat, a), (&two_level, b)].map(|(s, p)| s.scattering(&p, outward));
            assert_eq!(format!("{a:?}"), format!("{b:?}"), "{attribute}");
            compared += 1;
        }
        assert!(compared > 200, "{compared}");
    }
}

#[test]
fn an_edit_that_moves_an_instance_keeps_the_trees() {
    let mut stream = stream(2203);
    let shared = Arc::new(smooth_geodesic(8));
    let mut description = describe(scattered(&shared, &mut stream));
    let options = BuildOptions { instancing: Instancing::Always, ..BuildOptions::default() };
    let before = built(&description, Instancing::Always);
    description.shapes[4].to_world =
        DAffine3::from_translation(DVec3::splat(0.1)) * description.shapes[4].to_world;
    let rebuilt = before.rebuild(&description, &options).expect("sound");
    let afresh = built(&description, Instancing::Always);
    assert_eq!(rebuilt.fingerprint(), afresh.fingerprint());
    for _ in 0..2000 {
        let ray = any_ray(&afresh, &mut stream);
        let [a, b] = [&rebuilt, &afresh].map(|scene| scene.nearest(ray).map(|s| bits(&s)));
        assert_eq!(a, b);
    }
}

/// Few instances are not worth a tree of their own; many are, and take a small share of the memory.
#[test]
fn many_copies_of_a_mesh_are_held_once() {
    let shared = Arc::new(smooth_geodesic(40));
    let copies = |count: u32| {
        let at = |i: u32| DAffine3::from_translation(DVec3::new(f64::from(i), 0.0, 0.0) * 3.0);
        describe((0..count).map(|i| shape(Geometry::Mesh(Arc::clone(&shared)), at(i))).collect())
    };
    let few = built(&copies(2), Instancing::default());
    assert_eq!(few.census().instances, 0);
    let many = built(&copies(40), Instancing::default());
    assert_eq!(many.census().instances, 40);
    let flat = built(&copies(40), Instancing::Never);
    assert!(many.bytes() * 10 < flat.bytes(), "{} {}", many.bytes(), flat.bytes());
    assert!(copies(40).build_bytes() < 3 * copies(1).build_bytes());
}

/// A block of glass, one of several, that stands on a floor: its lower face and the floor are one place.
#[test]
fn an_instance_that_lies_on_a_floor_is_settled_with_it() {
    let block = Arc::new(Mesh::cube());
    let at = |x: f64| {
        DAffine3::from_translation(DVec3::new(x, 1.0, 0.0)) * DAffine3::from_scale(DVec3::splat(1.0))
    };
    let floor = DAffine3::from_rotation_x(-0.5 * PI) * DAffine3::from_scale(DVec3::splat(9.0));
    let mut shapes = vec![mesh(Mesh::rectangle(), floor)];
    shapes.extend([-4.0, 0.0, 4.0].map(|x| shape(Geometry::Mesh(Arc::clone(&block)), at(x))));
    let mut description = describe(shapes);
    description.materials.push(Material {
        name: "glass".into(),
        front: Bsdf::Dielectric(foton_scene::description::Dielectric {
            int_ior: 1.5,
            ext_ior: 1.0,
            specular_reflectance: Rgb::WHITE.into(),
            specular_transmittance: Rgb::WHITE.into(),
            roughness: None,
        }),
        ..Material::default()
    });
    description.shapes[1..].iter_mut().for_each(|shape| shape.material = 1);
    let [flat, two_level] = [Instancing::Never, Instancing::Always].map(|how| built(&description, how));
    assert!(flat.has_coincident_surfaces() && two_level.has_coincident_surfaces());
    let mut stream = stream(2204);
    for _ in 0..500 {
        let inside = DVec3::new(0.9, 0.9, 0.9) * in_cube(&mut stream) + DVec3::Y;
        let from = flat.normalisation().point(inside);
        let down = direction_around(Vec3::NEG_Y, &mut stream);
        let ray = Ray::new(from, down);
        let [a, b] = [&flat, &two_level].map(|scene| scene.nearest(ray).expect("a closed block"));
        assert_eq!((a.shape, a.position), (b.shape, b.position));
        if (a.position.y - flat.normalisation().point(DVec3::ZERO).y).abs() < 1e-3 {
            assert_eq!(a.shape, 0, "the floor is opaque, the glass is clear");
        }
    }
}

/// Tiles that abut, one of them mirrored and one upside down, and a ball on them: the tiles are one surface, the ball is none of it.
#[test]
fn instances_that_continue_each_other_are_one_surface() {
    const SIDE: u32 = 6;
    let corner =
        |i: u32| DVec3::new(f64::from(i % (SIDE + 1)), 0.0, f64::from(i / (SIDE + 1))) / f64::from(SIDE);
    let square = |i: u32| {
        let first = i % SIDE + i / SIDE * (SIDE + 1);
        [[first, first + SIDE + 1, first + 1], [first + 1, first + SIDE + 1, first + SIDE + 2]]
    };
    let tile = Arc::new(Mesh {
        positions: (0..(SIDE + 1).pow(2)).map(corner).collect(),
        triangles: (0..SIDE * SIDE).flat_map(square).collect(),
        ..Mesh::default()
    });
    let at = |x: f64, z: f64| DAffine3::from_translation(DVec3::new(x, 0.0, z));
    let mirrored = at(2.0, 0.0) * DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let turned = at(0.0, 2.0) * DAffine3::from_rotation_x(PI);
    let places = [at(0.0, 0.0), mirrored, turned, at(1.0, 1.0), at(5.0, 5.0)];
    let mut shapes: Vec<_> =
        places.into_iter().map(|place| shape(Geometry::Mesh(Arc::clone(&tile)), place)).collect();
    shapes.push(ball(DVec3::new(0.5, 0.25, 0.5), 0.25));
    // One of its own beside them, too.
    shapes.push(mesh(Mesh::clone(&tile), at(2.0, 0.0)));
    let description = describe(shapes);
    for instancing in [Instancing::Never, Instancing::Always] {
        let scene = built(&description, instancing);
        let from_above = |x: f64, z: f64| {
            let [from, to] = [1.0, -1.0].map(|y| scene.normalisation().point(DVec3::new(x, y, z)));
            let surface = scene.nearest(Ray::new(from, (to - from).normalize())).expect("a surface there");
            surface.patch_towards(surface.normal.y > 0.0)
        };
        let first = from_above(0.1, 0.1);
        for (x, z) in [(0.9, 0.9), (1.3, 0.4), (0.3, 1.6), (1.2, 1.2), (2.6, 0.7)] {
            assert_eq!(from_above(x, z), first, "{instancing:?} {x} {z}");
        }
        assert_ne!(from_above(0.5, 0.5), first, "{instancing:?}: the ball");
        assert_ne!(from_above(5.5, 5.5), first, "{instancing:?}: the tile that stands alone");
    }
}
