//! Scenes that ask for more than the benchmark box does: four samples a pixel, textures and gloss, fifty lights, radii that vary a
//! hundredfold, a mesh of a million triangles. Each beside the plain box, in turns.

use foton_film::LayerData;
use foton_integrator::{LayerKind, PpmSettings, Render, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::{DAffine2, DAffine3, DVec2, DVec3};
use foton_scene::description::{
    Bsdf, Colour, Conductor, Diffuse, EmitterDescription, EmitterKind, MicrofacetDistribution, Microfacets,
    Plastic, SceneDescription, Texture, TextureKind,
};

use crate::rig::{self, PHOTONS, WARM_UP};
use crate::scaling::on_a_fine_floor;

const SIDE: u32 = 512;
const THREADS: usize = 2;
const PASSES: usize = 32;
const TURNS: usize = 3;

pub(crate) fn print() {
    let plain = || rig::box_spheres(SIDE, SIDE);
    let four = RenderSettings { samples_per_pixel: rig::number(4), ..rig::settings() };
    let mut million = on_a_fine_floor(707);
    million.sensors[0].resize(SIDE, SIDE);
    let rows: [(&str, SceneDescription, RenderSettings); 7] = [
        ("plain", plain(), rig::settings()),
        ("4 samples a pixel", plain(), four),
        ("textures on all walls", textured(plain()), rig::settings()),
        ("rough plastic and metal", rough(plain()), rig::settings()),
        ("50 lights", fifty_lights(plain()), rig::settings()),
        (
            "close to the caustic, radii of the footprint",
            close(plain()),
            RenderSettings { ppm: PpmSettings { radius: None, ..rig::settings().ppm }, ..rig::settings() },
        ),
        ("a floor of a million triangles", million, rig::settings()),
    ];
    let mut seconds = vec![Vec::new(); rows.len()];
    let mut held = vec![0.0; rows.len()];
    let mut radii = vec![1.0; rows.len()];
    for _ in 0..TURNS {
        for (i, (_, description, settings)) in rows.iter().enumerate() {
            let run = rig::run(description, settings, THREADS, PASSES);
            seconds[i].push(run.median(WARM_UP));
            held[i] = run.render.bytes() as f64 / f64::from(1 << 20);
            radii[i] = spread_of_radii(&run.render);
        }
    }
    println!(
        "| scene | ms a pass | M photons/s | over the plain one | largest over smallest radius | MiB |\n|---|---|---|---|---|---|"
    );
    let base = rig::median(seconds[0].iter().copied());
    for (i, (name, ..)) in rows.iter().enumerate() {
        let median = rig::median(seconds[i].iter().copied());
        let rate = f64::from(PHOTONS) / median / 1e6;
        println!(
            "| {name} | {:.1} | {rate:.3} | {:.2} | {:.0} | {:.0} |",
            1e3 * median,
            median / base,
            radii[i],
            held[i]
        );
    }
}

/// The largest over the smallest mean radius of a pixel.
fn spread_of_radii(render: &Render) -> f32 {
    let Some(LayerData::F32(plane)) = render.layer(LayerKind::Radius).map(|l| l.channels) else { return 1.0 };
    let radii = || plane.values.iter().copied().filter(|r| *r > 0.0);
    radii().fold(0.0, f32::max) / radii().fold(f32::MAX, f32::min)
}

/// A board on each wall, of the mean reflectance that the walls have: paths are as long as before.
fn textured(mut description: SceneDescription) -> SceneDescription {
    description.textures.push(Texture {
        name: "board".into(),
        to_uv: DAffine2::from_scale(DVec2::splat(16.0)),
        kind: TextureKind::Checkerboard { colours: [0.65, 0.85].map(|c| Rgb::splat(c).into()) },
    });
    for material in &mut description.materials {
        for bsdf in [Some(&mut material.front), material.back.as_mut()].into_iter().flatten() {
            if let Bsdf::Diffuse(Diffuse { reflectance }) = bsdf {
                *reflectance = Colour::Texture(0);
            }
        }
    }
    description
}

/// Walls of rough plastic, and a ball of rough metal where the chalk was.
fn rough(mut description: SceneDescription) -> SceneDescription {
    let microfacets = |alpha| Some(Microfacets::isotropic(MicrofacetDistribution::Ggx, alpha));
    for material in &mut description.materials {
        let is_chalk = material.name == "chalk";
        for bsdf in [Some(&mut material.front), material.back.as_mut()].into_iter().flatten() {
            if let Bsdf::Diffuse(Diffuse { reflectance }) = *bsdf {
                *bsdf = if is_chalk {
                    Bsdf::Conductor(Conductor {
                        eta: Rgb::splat(0.2),
                        k: Rgb::splat(3.9),
                        specular_reflectance: Rgb::WHITE.into(),
                        roughness: microfacets(0.3),
                    })
                } else {
                    Bsdf::Plastic(Plastic {
                        int_ior: 1.5,
                        ext_ior: 1.0,
                        diffuse_reflectance: reflectance,
                        specular_reflectance: Rgb::WHITE.into(),
                        nonlinear: false,
                        roughness: microfacets(0.2),
                    })
                };
            }
        }
    }
    description
}

/// Beside the lamp, points all over the ceiling.
fn fifty_lights(mut description: SceneDescription) -> SceneDescription {
    for i in 0..49 {
        let (column, row) = (i % 7, i / 7);
        description.emitters.push(EmitterDescription {
            name: format!("point {i}"),
            kind: EmitterKind::Point {
                position: DVec3::new(8.0 + 14.0 * f64::from(column), 78.0, 12.0 + 24.0 * f64::from(row)),
                intensity: Rgb::splat(400.0),
            },
        });
    }
    description
}

/// Looks at the bright spot from a hand's breadth above the floor, along it to the far wall.
fn close(mut description: SceneDescription) -> SceneDescription {
    let (eye, target) = (DVec3::new(73.0, 1.0, 101.0), DVec3::new(73.0, 0.4, 96.0));
    let forward = (target - eye).normalize();
    let left = DVec3::Y.cross(forward).normalize();
    let up = forward.cross(left);
    let mut to_world = DAffine3::from_translation(eye);
    to_world.matrix3 = foton_math::glam::DMat3::from_cols(left, up, forward);
    description.sensors[0].to_world = to_world;
    description.sensors[0].fov_degrees = 60.0;
    description
}
