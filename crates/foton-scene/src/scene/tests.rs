//! The short way past Lambertian surfaces against the way that all surfaces have.

use std::sync::Arc;

use foton_math::glam::{DAffine2, DAffine3, DVec3, Vec3};
use foton_math::{Ray, Rgb};

use super::Scene;
use crate::bsdf::Scattering;
use crate::description::{
    Bsdf, Colour, Diffuse, Filter, FovAxis, Geometry, Material, Mesh, Mirror, SceneDescription,
    SensorDescription, ShapeDescription, Texture, TextureKind, ThinDielectric,
};

fn diffuse(reflectance: Colour) -> Bsdf {
    Bsdf::Diffuse(Diffuse { reflectance })
}

/// Unit squares that face +z beside each other along x, one of each material.
fn squares(materials: Vec<Material>) -> Scene {
    let shape = |i: usize| ShapeDescription {
        name: format!("square {i}"),
        geometry: Geometry::Mesh(Arc::new(Mesh::rectangle())),
        to_world: DAffine3::from_translation(DVec3::X * 3.0 * i as f64),
        flip_normals: false,
        material: i,
        radiance: None,
    };
    let sensor = SensorDescription {
        name: "camera".into(),
        to_world: DAffine3::IDENTITY,
        fov_degrees: 60.0,
        fov_axis: FovAxis::X,
        width: 1,
        height: 1,
        crop: None,
        filter: Filter::Box { radius: 0.5 },
        near_clip: None,
        far_clip: None,
        lens: None,
    };
    let board = TextureKind::Checkerboard { colours: [Rgb::splat(0.2), Rgb::splat(0.7)] };
    let description = SceneDescription {
        sensors: vec![sensor],
        shapes: (0..materials.len()).map(shape).collect(),
        materials,
        textures: vec![Texture { name: "board".into(), to_uv: DAffine2::IDENTITY, kind: board }],
        ..SceneDescription::default()
    };
    Scene::build(&description).expect("a sound scene")
}

#[test]
fn a_lambertian_side_is_what_its_scattering_says_and_no_other_is_one() {
    let (red, blue) = (Colour::Constant(Rgb::new(0.8, 0.1, 0.1)), Colour::Constant(Rgb::new(0.1, 0.1, 0.8)));
    let glass = Bsdf::ThinDielectric(ThinDielectric {
        int_ior: 1.5,
        ext_ior: 1.0,
        specular_reflectance: Rgb::WHITE.into(),
        specular_transmittance: Rgb::WHITE.into(),
    });
    let of = |front, back, opacity| Material {
        name: "material".into(),
        front,
        back,
        opacity,
        ..Material::default()
    };
    let scene = squares(vec![
        of(diffuse(red), Some(diffuse(blue)), None),
        of(diffuse(red), None, None),
        of(diffuse(Colour::Texture(0)), Some(diffuse(red)), None),
        of(diffuse(red), Some(diffuse(red)), Some(Colour::Constant(Rgb::splat(0.5)))),
        of(Bsdf::Mirror(Mirror { reflectance: red }), Some(diffuse(blue)), None),
        of(glass, Some(diffuse(blue)), None),
    ]);
    let to_scene = |p: DVec3| scene.normalisation().point(p);
    let mut found = 0;
    for i in 0..6 {
        for place in [DVec3::new(0.3, 0.2, 1.0), DVec3::new(-0.4, 0.6, 1.0)] {
            let origin = to_scene(DVec3::X * 3.0 * f64::from(i) + place);
            let surface = scene.nearest(Ray::new(origin, -Vec3::Z)).expect("a square");
            for outward in [true, false] {
                let wanted = match scene.scattering(&surface, outward) {
                    Some(Scattering {
                        bsdf: Bsdf::Diffuse(Diffuse { reflectance }), opacity: 1.0, ..
                    }) => Some(reflectance),
                    _ => None,
                };
                assert_eq!(scene.lambertian(&surface, outward), wanted, "square {i}, outward: {outward}");
                found += u32::from(wanted.is_some());
            }
        }
    }
    assert_eq!(found, 2 * (2 + 1 + 2 + 1), "sides that are Lambertian");
}
