//! Surfaces that lie exactly in one another: the one that counts is met from all sides, at every place, turn and size, and rays
//! that leave it meet none of the others there.

use std::f64::consts::PI;

use foton_math::Ray;
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::{
    Bsdf, Colour, Dielectric, Geometry, Material, Mesh, Mirror, Null, ShapeDescription,
};
use foton_scene::{Scene, Surface};

use crate::{describe, direction, direction_around, in_cube, mesh, shape, stream, turn};

const WHITE: Colour = Colour::Constant(Rgb::WHITE);

/// Materials by index: opaque on both sides, in front only, glass, water, a mask, nothing, a mirror.
const BOTH: usize = 0;
const FRONT: usize = 1;
const GLASS: usize = 2;
const WATER: usize = 3;
const MASK: usize = 4;
const NULL: usize = 5;
const MIRROR: usize = 6;

fn dielectric(int_ior: f32) -> Bsdf {
    Bsdf::Dielectric(Dielectric {
        int_ior,
        ext_ior: 1.0,
        specular_reflectance: WHITE,
        specular_transmittance: WHITE,
        roughness: None,
    })
}

fn scene(shapes: Vec<ShapeDescription>) -> Scene {
    let mut description = describe(shapes);
    let grey = description.materials[0].front;
    let half = Some(Colour::Constant(Rgb::splat(0.5)));
    let material = |front, back, opacity| Material {
        name: "material".into(),
        front,
        back,
        opacity,
        ..Material::default()
    };
    description.materials.extend([
        material(grey, None, None),
        material(dielectric(1.5), None, None),
        material(dielectric(1.25), None, None),
        material(grey, None, half),
        material(Bsdf::Null(Null), None, None),
        material(
            Bsdf::Mirror(Mirror { reflectance: WHITE }),
            Some(Bsdf::Mirror(Mirror { reflectance: WHITE })),
            None,
        ),
    ]);
    Scene::build(&description).expect("a sound description")
}

fn of(material: usize, shape: ShapeDescription) -> ShapeDescription {
    ShapeDescription { material, ..shape }
}

/// Object to world: as it is, moved, turned, small and far, large.
fn places() -> [DAffine3; 6] {
    let turned = DAffine3::from_quat(turn());
    [
        DAffine3::IDENTITY,
        DAffine3::from_translation(DVec3::new(0.3, 1.7, -0.9)),
        turned,
        DAffine3::from_translation(DVec3::new(3.1, -0.7, 2.3)) * turned,
        DAffine3::from_translation(DVec3::new(0.3, 0.1, 0.2))
            * turned
            * DAffine3::from_scale(DVec3::splat(1e-2)),
        DAffine3::from_scale(DVec3::splat(123.4)) * DAffine3::from_rotation_z(0.2),
    ]
}

/// In the plane y = `height`, looking up or down.
fn lying(half: f64, height: f64, up: bool) -> DAffine3 {
    let angle = if up { -PI / 2.0 } else { PI / 2.0 };
    DAffine3::from_translation(DVec3::Y * height)
        * DAffine3::from_rotation_x(angle)
        * DAffine3::from_scale(DVec3::splat(half))
}

fn floor(place: DAffine3) -> ShapeDescription {
    mesh(Mesh::rectangle(), place * lying(5.0, 0.0, true))
}

/// The cube of side 2 that stands on that floor.
fn block(place: DAffine3) -> ShapeDescription {
    mesh(Mesh::cube(), place * DAffine3::from_translation(DVec3::Y))
}

/// What rays from near the point (x, 0, z) meet there, from above or below: with the scene, rays come from inside the block.
fn met(scene: &Scene, place: DAffine3, above: bool, mut check: impl FnMut(&Ray, &Surface)) {
    let mut stream = stream(31);
    let units = scene.normalisation();
    for _ in 0..2000 {
        let side = if above { 1.0 } else { -1.0 };
        let target = in_cube(&mut stream) * DVec3::new(0.98, 0.0, 0.98);
        let from = in_cube(&mut stream) * DVec3::new(0.9, 0.0, 0.9)
            + DVec3::Y * (side * (0.05 + f64::from(stream.next_1d())));
        let [from, target] = [from, target].map(|p| units.point(place.transform_point3(p)));
        let ray = Ray::new(from, (target - from).normalize());
        let Some(hit) = scene.nearest(ray) else { panic!("nothing met from {from}") };
        assert!(hit.position.distance(target) < 1e-3 * from.distance(target), "{hit:?} for {target}");
        check(&ray, &hit);
    }
}

#[test]
fn what_is_opaque_counts_before_what_is_clear_and_rays_leave_both() {
    for place in places() {
        for clear in [GLASS, MASK, NULL] {
            for floor_first in [true, false] {
                let mut shapes = vec![of(BOTH, floor(place)), of(clear, block(place))];
                let opaque = u32::from(!floor_first);
                if !floor_first {
                    shapes.reverse();
                }
                let scene = scene(shapes);
                let mut stream = stream(32);
                for above in [true, false] {
                    met(&scene, place, above, |ray, hit| {
                        assert_eq!(hit.shape, opaque, "{clear} {place}");
                        let d = direction_around(hit.normal, &mut stream);
                        let d = if ray.direction.dot(hit.normal) < 0.0 { d } else { -d };
                        let next = scene.nearest(Ray::new(hit.ray_origin(d), d));
                        match next {
                            Some(next) if above => {
                                assert!(next.shape != opaque && d.dot(next.normal) > 0.0, "{next:?}");
                            }
                            next => assert!(!above && next.is_none(), "{next:?}"),
                        }
                    });
                }
            }
        }
    }
}

#[test]
fn of_two_opaque_surfaces_the_first_counts_where_it_is_described() {
    let disc = |place: DAffine3| shape(Geometry::Disc, place * lying(1.5, 0.0, true));
    let decal = |place: DAffine3, up| mesh(Mesh::rectangle(), place * lying(1.2, 0.0, up));
    for place in places() {
        // A decal, a mirror, a disc, a block, on or under the floor; in both orders.
        for thing in [of(BOTH, decal(place, true)), of(MIRROR, decal(place, false)), of(BOTH, disc(place))] {
            for shapes in [[of(BOTH, floor(place)), thing.clone()], [thing.clone(), of(BOTH, floor(place))]] {
                let scene = scene(shapes.to_vec());
                // What faces the other way may be the bottom of something that stands there.
                let named = usize::from(thing.material != MIRROR);
                assert_eq!(scene.hidden_shapes().collect::<Vec<_>>(), [[0, 1]][..named]);
                for above in [true, false] {
                    met(&scene, place, above, |_, hit| assert_eq!(hit.shape, 0, "{place}"));
                }
            }
        }
        // Rooms above and below, each with its own side of one wall.
        for order in [[true, false], [false, true]] {
            let scene = scene(order.map(|up| of(FRONT, decal(place, up))).to_vec());
            assert_eq!(scene.hidden_shapes().count(), 0);
            for above in [true, false] {
                met(&scene, place, above, |ray, hit| {
                    assert!(ray.direction.dot(hit.normal) < 0.0, "a back");
                });
            }
        }
        // A lamp let into a ceiling, whichever comes first.
        for lamp in [0, 1] {
            let mut shapes = vec![of(BOTH, floor(place)), of(BOTH, floor(place))];
            shapes[lamp] = of(BOTH, decal(place, true));
            shapes[lamp].radiance = Some(Rgb::WHITE.into());
            let scene = scene(shapes);
            met(&scene, place, true, |_, hit| assert_eq!(hit.shape as usize, lamp));
            met(&scene, place, false, |_, hit| assert_eq!(hit.shape, 0));
            for i in 0..1000u16 {
                let u = [f32::from(i) / 1000.0, f32::from(i * 7 % 1000) / 1000.0, 0.3, 0.6];
                let start = scene.emitters()[0].emit(u[0], [u[0], u[1]].into(), [u[2], u[3]].into());
                assert!(scene.nearest(Ray::new(start.origin, start.direction)).is_none(), "light is caught");
            }
        }
    }
}

/// Indices on the side that a ray comes from and on the other, as a surface's BSDF has them.
fn indices(scene: &Scene, ray: &Ray, hit: &Surface) -> [f32; 2] {
    let outward = ray.direction.dot(hit.normal) < 0.0;
    let scattering = scene.scattering(hit, outward).expect("it transmits");
    let Bsdf::Dielectric(Dielectric { int_ior, ext_ior, .. }) = scattering.bsdf else {
        panic!("no dielectric")
    };
    if outward { [ext_ior, int_ior] } else { [int_ior, ext_ior] }
}

#[test]
fn a_face_that_two_dielectrics_state_is_one_boundary_between_them() {
    for place in places() {
        let under = |half: f64| {
            let to_world =
                DAffine3::from_translation(-DVec3::Y * half) * DAffine3::from_scale(DVec3::splat(half));
            mesh(Mesh::cube(), place * to_world)
        };
        let outer = mesh(
            Mesh::cube(),
            place * DAffine3::from_translation(DVec3::Y * 3.0) * DAffine3::from_scale(DVec3::splat(3.0)),
        );
        // Water on glass; glass on glass; water inside a larger block of glass, whose bottom is its own.
        let cases = [
            (of(WATER, block(place)), of(GLASS, under(2.0)), [1.25, 1.5]),
            (of(GLASS, block(place)), of(GLASS, under(1.0)), [1.5, 1.5]),
        ];
        for (a, b, expected) in cases {
            for shapes in [vec![a.clone(), b.clone()], vec![b, a]] {
                let scene = scene(shapes);
                let mut stream = stream(33);
                for above in [true, false] {
                    met(&scene, place, above, |ray, hit| {
                        let [here, there] = indices(&scene, ray, hit);
                        let expected = if above { expected } else { [expected[1], expected[0]] };
                        assert_eq!([here, there], expected, "{place}");
                        // On to the other side: nothing of the two faces is met again.
                        let d = direction(&mut stream);
                        let next = scene.nearest(Ray::new(hit.ray_origin(d), d)).expect("both are closed");
                        assert!(next.position.distance(hit.position) > 20.0 * hit.error.length(), "{next:?}");
                    });
                }
            }
        }
        let mut description = describe(vec![of(1, outer), of(2, block(place))]);
        let material = |front| Material { name: "clear".into(), front, back: None, ..Material::default() };
        let inner = Bsdf::Dielectric(Dielectric {
            int_ior: 1.25,
            ext_ior: 1.5,
            specular_reflectance: WHITE,
            specular_transmittance: WHITE,
            roughness: None,
        });
        description.materials.extend([material(dielectric(1.5)), material(inner)]);
        for _ in 0..2 {
            let scene = Scene::build(&description).expect("a sound description");
            met(&scene, place, false, |ray, hit| {
                assert_eq!(indices(&scene, ray, hit), [1.0, 1.25], "{place}");
            });
            description.shapes.reverse();
        }
    }
}

#[test]
fn balls_and_tubes_that_state_one_surface_twice_are_one_too() {
    for place in places() {
        let ball = |material, flip_normals| ShapeDescription {
            flip_normals,
            ..of(material, shape(Geometry::Sphere { centre: DVec3::ZERO, radius: 1.0 }, place))
        };
        let tube = |material, flip_normals, [from, to]: [f64; 2]| ShapeDescription {
            flip_normals,
            ..of(
                material,
                shape(Geometry::Cylinder { from: DVec3::Z * from, to: DVec3::Z * to, radius: 1.0 }, place),
            )
        };
        // Water in a hollow in glass, whose inner face looks at what is in it.
        let pairs = [
            [ball(GLASS, true), ball(WATER, false)],
            [tube(GLASS, true, [-9.0, 9.0]), tube(WATER, false, [5.0, -5.0])],
        ];
        for [a, b] in pairs {
            for shapes in [vec![a.clone(), b.clone()], vec![b, a]] {
                let scene = scene(shapes);
                let units = scene.normalisation();
                let mut stream = stream(34);
                for _ in 0..2000 {
                    let from = units.point(place.transform_point3(in_cube(&mut stream) * 0.5));
                    let across = in_cube(&mut stream) * DVec3::new(1.0, 1.0, 0.3);
                    let towards = units.point(place.transform_point3(across * 4.0));
                    let ray = Ray::new(from, (towards - from).normalize());
                    let hit = scene.nearest(ray).expect("it is around");
                    if units.world_length(f64::from(hit.position.distance(from)))
                        > 4.0 * place.matrix3.x_axis.length()
                    {
                        // Beyond the water's ends.
                        continue;
                    }
                    assert_eq!(indices(&scene, &ray, &hit), [1.25, 1.5], "{place}");
                    let next = scene.nearest(Ray::new(hit.ray_origin(ray.direction), ray.direction));
                    assert!(next.is_none(), "{next:?}");
                }
            }
        }
    }
}

#[test]
fn faces_that_only_touch_are_left_alone() {
    // A plane of many triangles, a closed cube, cubes side by side that share an edge, and a floor below a gap.
    let grid = (0..10).flat_map(|i| (0..10).map(move |j| [i, j].map(f64::from))).map(|[x, z]| {
        mesh(
            Mesh::rectangle(),
            DAffine3::from_translation(DVec3::new(2.0 * x, 0.0, 2.0 * z)) * lying(1.0, 0.0, true),
        )
    });
    for place in places() {
        let on = |x: f64, y: f64| {
            of(GLASS, mesh(Mesh::cube(), place * DAffine3::from_translation(DVec3::new(x, y, 0.0))))
        };
        let mut shapes: Vec<_> =
            grid.clone().map(|s| ShapeDescription { to_world: place * s.to_world, ..s }).collect();
        shapes.extend([on(-5.0, 1.0), on(-7.0, 3.0), on(-20.0, 1.001)]);
        shapes.push(mesh(
            Mesh::rectangle(),
            place * DAffine3::from_translation(DVec3::X * -20.0) * lying(3.0, 0.0, true),
        ));
        assert!(!scene(shapes).has_coincident_surfaces(), "{place}");
    }
}
