//! Picking, outlines, drags, fields and cameras on a small scene.

use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{DAffine3, DMat3, DVec2, DVec3};
use foton_scene::Scene;
use foton_scene::description::{
    Bsdf, Dielectric, Diffuse, EmitterDescription, EmitterKind, Filter, FovAxis, Geometry, Material, Mesh,
    Projection, SceneDescription, SensorDescription, ShapeDescription,
};

use crate::view::View;
use crate::*;

mod camera;
mod fields;
mod gizmo;
mod history;
mod moving;
mod picking;
mod things;

fn looking(from: DVec3, to: DVec3, up: DVec3) -> DAffine3 {
    let forward = (to - from).normalize();
    let left = up.cross(forward).normalize();
    DAffine3::from_cols(left, forward.cross(left), forward, from)
}

fn sensor(to_world: DAffine3) -> SensorDescription {
    SensorDescription {
        name: "camera".into(),
        to_world,
        fov_degrees: 50.0,
        fov_axis: FovAxis::X,
        width: 300,
        height: 200,
        filter: Filter::Box { radius: 0.5 },
        ..SensorDescription::default()
    }
}

/// The camera without perspective that shows 8 units along its width from the same place.
fn orthographic(sensor: &SensorDescription) -> SensorDescription {
    let to_world = sensor.to_world * DAffine3::from_scale(DVec3::splat(4.0));
    SensorDescription { to_world, projection: Projection::Orthographic, ..sensor.clone() }
}

fn shape(name: &str, geometry: Geometry, to_world: DAffine3, material: usize) -> ShapeDescription {
    ShapeDescription { name: name.into(), geometry, to_world, flip_normals: false, material, radiance: None }
}

/// A floor, a ball, a cube and a small lamp of one grey and one glass; four lights without surfaces.
fn scene() -> SceneDescription {
    let grey = Bsdf::Diffuse(Diffuse { reflectance: Rgb::splat(0.5).into() });
    let white = Rgb::WHITE.into();
    let glass = Bsdf::Dielectric(Dielectric {
        int_ior: 1.5,
        ext_ior: 1.0,
        specular_reflectance: white,
        specular_transmittance: white,
        roughness: None,
    });
    let material =
        |name: &str, front| Material { name: name.into(), front, back: None, ..Material::default() };
    let flat = DMat3::from_cols(DVec3::X * 20.0, DVec3::NEG_Z * 20.0, DVec3::Y);
    let floor = DAffine3::from_mat3(flat);
    let ball = Geometry::Sphere { centre: DVec3::new(0.0, 1.0, 0.0), radius: 1.0 };
    let mut lamp = shape("lamp", Geometry::Disc, DAffine3::from_translation(DVec3::new(-2.0, 3.0, -2.0)), 0);
    lamp.radiance = Some(Rgb::new(2.0, 1.0, 0.5).into());
    let light = |name: &str, kind| EmitterDescription { name: name.into(), kind };
    SceneDescription {
        sensors: vec![sensor(looking(DVec3::new(1.0, 3.0, 8.0), DVec3::new(0.0, 0.5, 0.0), DVec3::Y))],
        materials: vec![material("grey", grey), material("glass", glass)],
        shapes: vec![
            shape("floor", Geometry::Mesh(Arc::new(Mesh::rectangle())), floor, 0),
            shape("ball", ball, DAffine3::IDENTITY, 1),
            shape(
                "cube",
                Geometry::Mesh(Arc::new(Mesh::cube())),
                DAffine3::from_translation(DVec3::new(3.0, 1.0, 0.0)) * DAffine3::from_rotation_y(0.3),
                0,
            ),
            lamp,
        ],
        emitters: vec![
            light(
                "bulb",
                EmitterKind::Point { position: DVec3::new(-2.0, 2.0, 0.0), intensity: Rgb::splat(3.0) },
            ),
            light(
                "key",
                EmitterKind::Spot {
                    to_world: looking(DVec3::new(2.0, 2.5, 2.0), DVec3::ZERO, DVec3::Y),
                    intensity: Rgb::new(4.0, 3.0, 2.0),
                    cutoff_degrees: 25.0,
                    beam_degrees: 15.0,
                    texture: None,
                },
            ),
            light(
                "sun",
                EmitterKind::Directional {
                    direction: DVec3::new(0.1, 0.1, 1.0),
                    irradiance: Rgb::splat(1.0),
                },
            ),
            light("sky", EmitterKind::Constant { radiance: Rgb::splat(0.1) }),
        ],
        ..SceneDescription::default()
    }
}

const BALL: Target = Target::Shape(1);
const CUBE: Target = Target::Shape(2);
const LAMP: Target = Target::Shape(3);

fn number(description: &SceneDescription, target: Target, id: FieldId) -> f64 {
    let fields = inspect(description, target).unwrap().fields;
    match fields.iter().find(|f| f.id == id).map(|f| f.value) {
        Some(Value::Number(x)) => x,
        other => panic!("{id:?} is {other:?}"),
    }
}

fn set(description: &SceneDescription, target: Target, field: FieldId, value: Value) -> SceneDescription {
    Edit::SetField { target, field, value }.apply(description).unwrap()
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-5 * a.abs().max(b.abs())
}
