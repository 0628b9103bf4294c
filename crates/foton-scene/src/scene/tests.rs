//! The short way past Lambertian surfaces against the way that all surfaces have; numbers from textures.

use std::sync::Arc;

use foton_math::glam::{DAffine2, DAffine3, DVec3, Vec3};
use foton_math::{Ray, Rgb};

use super::Scene;
use crate::bsdf::{LobeFlags, Scattering};
use crate::description::{
    Bsdf, Colour, Conductor, Diffuse, Filter, FovAxis, Geometry, Material, Mesh, MicrofacetDistribution,
    Microfacets, Mirror, Number, Plastic, Principled, PrincipledThin, SceneDescription, SensorDescription,
    ShapeDescription, Texture, TextureKind, ThinDielectric,
};

fn diffuse(reflectance: Colour) -> Bsdf {
    Bsdf::Diffuse(Diffuse { reflectance })
}

/// Unit squares that face +z beside each other along x, one of each material.
pub(super) fn described(materials: Vec<Material>) -> SceneDescription {
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
        filter: Filter::Box { radius: 0.5 },
        ..SensorDescription::default()
    };
    let board = TextureKind::Checkerboard { colours: [0.2, 0.7].map(|c| Rgb::splat(c).into()) };
    SceneDescription {
        sensors: vec![sensor],
        shapes: (0..materials.len()).map(shape).collect(),
        materials,
        textures: vec![Texture { name: "board".into(), to_uv: DAffine2::IDENTITY, kind: board }],
        ..SceneDescription::default()
    }
}

fn squares(materials: Vec<Material>) -> Scene {
    Scene::build(&described(materials)).expect("a sound scene")
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

/// A metal and a plastic whose roughness is the board's, 0.2 and 0.7, the metal's along v alone.
fn rough_by_texture() -> [Material; 2] {
    let (board, white) = (Number::Texture(0), Colour::Constant(Rgb::WHITE));
    let distribution = MicrofacetDistribution::Ggx;
    let metal = Bsdf::Conductor(Conductor {
        eta: Rgb::BLACK,
        k: Rgb::WHITE,
        specular_reflectance: white,
        roughness: Some(Microfacets { distribution, alpha_u: 0.3.into(), alpha_v: board }),
    });
    let plastic = Bsdf::Plastic(Plastic {
        int_ior: 1.5,
        ext_ior: 1.0,
        diffuse_reflectance: white,
        specular_reflectance: white,
        nonlinear: false,
        roughness: Some(Microfacets { distribution, alpha_u: board, alpha_v: board }),
    });
    [metal, plastic].map(|front| Material { name: "rough".into(), front, back: None, ..Material::default() })
}

/// The scattering of a square at a place on it.
fn at(scene: &Scene, square: f64, place: [f64; 2]) -> Scattering {
    let above = DVec3::new(3.0 * square + place[0], place[1], 1.0);
    let surface = scene.nearest(Ray::new(scene.normalisation().point(above), -Vec3::Z)).expect("a square");
    scene.scattering(&surface, true).expect("its front")
}

#[test]
fn a_texture_gives_the_roughness_of_a_point_and_of_what_gets_through_its_coat() {
    let scene = squares(rough_by_texture().to_vec());
    // Texture coordinates run from 0 to 1 over the square, which is two units wide: the first field is at its lower left.
    for (place, alpha) in [([-0.5, -0.5], 0.2f32), ([0.5, -0.5], 0.7), ([0.5, 0.5], 0.2)] {
        let metal = at(&scene, 0.0, place);
        let roughness = metal.bsdf.roughness().expect("rough");
        assert_eq!((roughness.alpha_u, roughness.alpha_v), (0.3, alpha));
        assert_eq!(metal.bsdf.gloss(), Some(alpha.max(0.3)));
        // The same as a plastic that is so rough everywhere.
        let [_, mut same] = rough_by_texture();
        let Bsdf::Plastic(Plastic { roughness: Some(r), .. }) = &mut same.front else { panic!("plastic") };
        (r.alpha_u, r.alpha_v) = (alpha.into(), alpha.into());
        let same = at(&squares(vec![same]), 0.0, place);
        let (wo, wi) = (Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.3, 0.4, 0.6).normalize());
        let values = [at(&scene, 1.0, place), same].map(|s| s.eval(wo, wi, LobeFlags::ALL).g);
        assert!((values[0] - values[1]).abs() < 2e-3 * values[1], "{place:?}: {values:?}");
    }
}

#[test]
fn the_census_counts_the_least_and_the_greatest_roughness_of_a_texture() {
    let scene = squares(rough_by_texture().to_vec());
    let census = scene.census();
    let roughness: Vec<_> = census.bsdfs.iter().map(|kind| kind.roughness).collect();
    assert_eq!(roughness, [0.3, 0.7, 0.2, 0.7].map(Some));
    assert!(census.textures && census.anisotropy && census.rough_coats);
}

#[test]
fn a_number_from_a_texture_that_is_not_there_is_refused_by_the_materials_name() {
    let [mut metal, _] = rough_by_texture();
    let Bsdf::Conductor(Conductor { roughness: Some(r), .. }) = &mut metal.front else { panic!("metal") };
    r.alpha_u = Number::Texture(7);
    let description = described(vec![metal]);
    assert!(matches!(Scene::build(&description), Err(crate::BuildError::NoTexture(name)) if name == "rough"));
}

#[test]
fn behind_a_surface_that_is_clear_in_places_the_others_are_black_and_a_sheet_is_lit_from_both_sides() {
    let material = |front| Material { name: "m".into(), front, back: None, ..Material::default() };
    let of = |plugin| Bsdf::of_plugin(plugin).expect("is modelled");
    let Bsdf::Principled(plain) = of("principled") else { panic!("a body") };
    let Bsdf::PrincipledThin(sheet) = of("principledthin") else { panic!("a sheet") };
    let patched = Principled { spec_trans: Number::Texture(0), ..plain };
    let mut description = described(vec![
        material(Bsdf::Principled(patched)),
        material(Bsdf::Principled(plain)),
        material(Bsdf::PrincipledThin(PrincipledThin { base_color: Rgb::WHITE.into(), ..sheet })),
    ]);
    let fields = [0.0, 0.7].map(|c| Rgb::splat(c).into());
    description.textures[0].kind = TextureKind::Checkerboard { colours: fields };
    let scene = Scene::build(&description).expect("a sound scene");
    let behind = |square: f64, place: [f64; 2]| {
        let above = DVec3::new(3.0 * square + place[0], place[1], 1.0);
        let surface =
            scene.nearest(Ray::new(scene.normalisation().point(above), -Vec3::Z)).expect("a square");
        scene.scattering(&surface, false)
    };
    let reflects = |s: Option<Scattering>| {
        let (wo, wi) = (Vec3::new(0.6, 0.0, -0.8), Vec3::new(0.0, 0.6, -0.8));
        s.map(|s| s.eval(wo, wi, LobeFlags::ALL).g)
    };
    let (opaque, clear) = ([-0.5, -0.5], [0.5, -0.5]);
    assert!(reflects(behind(0.0, opaque)).is_none_or(|g| g == 0.0));
    assert!(behind(0.0, clear).is_some_and(|s| s.bsdf.transmits()));
    assert!(behind(1.0, opaque).is_none(), "a body without transmission is black behind");
    assert!(reflects(behind(2.0, opaque)).is_some_and(|g| g > 0.3), "a sheet is the same behind");
}
