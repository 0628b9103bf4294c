//! No instruction set changes a bit: what is compiled for wide vectors against what every machine runs.

use std::num::NonZeroU32;
use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::Scene;
use foton_scene::description::{
    Bsdf, EmitterDescription, EmitterKind, Filter, FovAxis, Geometry, Material, Mesh, SceneDescription,
    SensorDescription, ShapeDescription,
};
use pulp::Arch;

use super::Ppm;
use crate::cancel::Cancel;
use crate::settings::Settings;

/// A box with a diffuse and a glass ball under a point light.
fn scene() -> Arc<Scene> {
    let diffuse = Bsdf::Diffuse { reflectance: Rgb::new(0.7, 0.5, 0.3).into() };
    let glass = Bsdf::Dielectric {
        int_ior: 1.5,
        ext_ior: 1.0,
        specular_reflectance: Rgb::WHITE.into(),
        specular_transmittance: Rgb::WHITE.into(),
        roughness: None,
    };
    let material = |name: &str, front, back| Material { name: name.into(), front, back, opacity: None };
    let shape = |geometry, material| ShapeDescription {
        name: "shape".into(),
        geometry,
        to_world: DAffine3::IDENTITY,
        flip_normals: false,
        material,
        radiance: None,
    };
    let ball = |x: f64| Geometry::Sphere { centre: DVec3::new(x, -0.5, -0.3), radius: 0.4 };
    Arc::new(
        Scene::build(&SceneDescription {
            sensors: vec![SensorDescription {
                name: "camera".into(),
                to_world: DAffine3::from_translation(DVec3::new(0.0, 0.0, -0.95)),
                fov_degrees: 70.0,
                fov_axis: FovAxis::X,
                width: 32,
                height: 32,
                crop: None,
                filter: Filter::Box { radius: 0.5 },
                near_clip: None,
                far_clip: None,
            }],
            materials: vec![material("chalk", diffuse, Some(diffuse)), material("glass", glass, None)],
            shapes: vec![
                shape(Geometry::Mesh(Arc::new(Mesh::cube())), 0),
                shape(ball(-0.45), 0),
                shape(ball(0.45), 1),
            ],
            emitters: vec![EmitterDescription {
                name: "lamp".into(),
                kind: EmitterKind::Point { position: DVec3::new(0.2, 0.8, 0.1), intensity: Rgb::splat(3.0) },
            }],
            ..SceneDescription::default()
        })
        .expect("a sound scene"),
    )
}

/// Bits of the image after three passes, and photons found.
fn render(scene: &Arc<Scene>, arch: Arch) -> (Vec<[u32; 3]>, u64) {
    let settings =
        Settings { photons_per_pass: NonZeroU32::new(20_000).expect("above 0"), ..Settings::default() };
    let cancel = Cancel::default();
    let mut ppm = Ppm::start(scene.clone(), settings, &mut |_| (), &cancel).expect("not cancelled");
    ppm.arch = arch;
    let accepted = (0..3).map(|_| ppm.advance(&mut |_| (), &cancel).expect("not cancelled").accepted).sum();
    let image = ppm.image();
    (image.pixels.iter().map(|p| p.to_array().map(f32::to_bits)).collect(), accepted)
}

#[test]
fn the_widest_instruction_set_and_the_plainest_give_the_same_bits() {
    let scene = scene();
    let (plain, found) = render(&scene, Arch::Scalar);
    assert!(found > 10_000, "{found}");
    let (wide, found_wide) = render(&scene, Arch::new());
    assert!(plain == wide && found == found_wide, "{:?} differs", Arch::new());
    #[cfg(target_arch = "x86_64")]
    if let Some(v3) = pulp::x86::V3::try_new() {
        assert!(plain == render(&scene, Arch::V3(v3)).0, "AVX2 differs");
    }
}
