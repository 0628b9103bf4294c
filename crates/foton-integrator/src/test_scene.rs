//! A scene for tests of this crate alone.

use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::Scene;
use foton_scene::description::{
    Bsdf, Dielectric, Diffuse, EmitterDescription, EmitterKind, Filter, FovAxis, Geometry, Material, Mesh,
    SceneDescription, SensorDescription, ShapeDescription,
};

/// A box with a diffuse and a glass ball under a point light and a lamp.
pub(crate) fn scene() -> Arc<Scene> {
    Arc::new(Scene::build(&description()).expect("a sound scene"))
}

/// That of the scene.
pub(crate) fn description() -> SceneDescription {
    let diffuse = Bsdf::Diffuse(Diffuse { reflectance: Rgb::new(0.7, 0.5, 0.3).into() });
    let glass = Bsdf::Dielectric(Dielectric {
        int_ior: 1.5,
        ext_ior: 1.0,
        specular_reflectance: Rgb::WHITE.into(),
        specular_transmittance: Rgb::WHITE.into(),
        roughness: None,
    });
    let material =
        |name: &str, front, back| Material { name: name.into(), front, back, ..Material::default() };
    let shape = |geometry, material| ShapeDescription {
        name: "shape".into(),
        geometry,
        to_world: DAffine3::IDENTITY,
        flip_normals: false,
        material,
        radiance: None,
    };
    let ball = |x: f64| Geometry::Sphere { centre: DVec3::new(x, -0.5, -0.3), radius: 0.4 };
    let lamp = Geometry::Sphere { centre: DVec3::new(-0.3, 0.6, 0.3), radius: 0.1 };
    SceneDescription {
        sensors: vec![SensorDescription {
            name: "camera".into(),
            to_world: DAffine3::from_translation(DVec3::new(0.0, 0.0, -0.95)),
            fov_degrees: 70.0,
            fov_axis: FovAxis::X,
            width: 32,
            height: 32,
            filter: Filter::Box { radius: 0.5 },
            ..SensorDescription::default()
        }],
        materials: vec![material("chalk", diffuse, Some(diffuse)), material("glass", glass, None)],
        shapes: vec![
            shape(Geometry::Mesh(Arc::new(Mesh::cube())), 0),
            shape(ball(-0.45), 0),
            shape(ball(0.45), 1),
            ShapeDescription { radiance: Some(Rgb::splat(9.0).into()), ..shape(lamp, 0) },
        ],
        emitters: vec![EmitterDescription {
            name: "lamp".into(),
            kind: EmitterKind::Point { position: DVec3::new(0.2, 0.8, 0.1), intensity: Rgb::splat(3.0) },
        }],
        ..SceneDescription::default()
    }
}
