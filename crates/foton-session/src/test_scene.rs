//! A scene for tests: discs before a camera.

use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::Scene;
use foton_scene::description::{
    Bsdf, Diffuse, Filter, FovAxis, Geometry, Material, SceneDescription, SensorDescription, ShapeDescription,
};

/// A small disc within a larger one, in front of the camera; behind them a lamp, which emits if asked to.
pub(crate) fn discs(radiance: Option<Rgb>) -> Scene {
    let disc = |name: &str, z: f64, radius: f64, radiance: Option<Rgb>| ShapeDescription {
        name: name.into(),
        geometry: Geometry::Disc,
        to_world: DAffine3::from_translation(DVec3::new(0.0, 0.0, z))
            * DAffine3::from_scale(DVec3::new(radius, radius, -1.0)),
        flip_normals: false,
        material: 0,
        radiance: radiance.map(Into::into),
    };
    let white = Bsdf::Diffuse(Diffuse { reflectance: Rgb::splat(0.5).into() });
    let description = SceneDescription {
        sensors: vec![SensorDescription {
            name: "camera".into(),
            to_world: DAffine3::IDENTITY,
            fov_degrees: 60.0,
            fov_axis: FovAxis::X,
            width: 8,
            height: 8,
            filter: Filter::Box { radius: 0.5 },
            ..SensorDescription::default()
        }],
        materials: vec![Material { name: "white".into(), front: white, back: None, ..Material::default() }],
        shapes: vec![
            disc("sign", 1.0, 1.0, None),
            disc("letter", 1.0, 0.5, None),
            disc("lamp", 3.0, 2.0, radiance),
        ],
        ..SceneDescription::default()
    };
    Scene::build(&description).expect("a scene")
}
