//! Materials beside Lambert's: light by photons against light by eye paths and shadow rays, two independent ways.

use std::f64::consts::PI;
use std::num::NonZeroU32;
use std::sync::Arc;

use foton_integrator::{DirectLight, PpmSettings, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::{
    Bitmap, Bsdf, Colour, Conductor, EmitterDescription, EmitterKind, Geometry, Mesh, MicrofacetDistribution,
    Microfacets, Mirror, Plastic,
};
use foton_tests::{Sketch, grey, seeds};

const WHITE: Colour = Colour::Constant(Rgb::WHITE);

fn metal(alpha: f32) -> Bsdf {
    Bsdf::Conductor(Conductor {
        eta: Rgb::new(0.2, 0.9, 1.1),
        k: Rgb::new(3.9, 2.5, 2.1),
        specular_reflectance: WHITE,
        roughness: Some(Microfacets::isotropic(MicrofacetDistribution::Ggx, alpha)),
    })
}

fn plastic(roughness: Option<f32>) -> Bsdf {
    Bsdf::Plastic(Plastic {
        int_ior: 1.5,
        ext_ior: 1.0,
        diffuse_reflectance: Colour::Constant(Rgb::splat(0.5)),
        specular_reflectance: WHITE,
        nonlinear: true,
        roughness: roughness.map(|a| Microfacets::isotropic(MicrofacetDistribution::Beckmann, a)),
    })
}

fn settings(photons: u32) -> RenderSettings {
    RenderSettings {
        samples_per_pixel: NonZeroU32::new(4).expect("above 0"),
        ppm: PpmSettings {
            photons_per_pass: NonZeroU32::new(photons).expect("above 0"),
            first_pass: NonZeroU32::new(photons).expect("above 0"),
            ..PpmSettings::default()
        },
        ..RenderSettings::default()
    }
}

/// A small wall of the material seen from the front, lit by an area emitter in an otherwise dark space.
fn wall(material: Bsdf) -> Sketch {
    Sketch::default()
        .camera(DVec3::new(0.6, 0.3, 2.0), DVec3::new(0.05, 0.0, 0.0), 12.0, 12)
        .rectangle(DVec3::ZERO, DVec3::X, DVec3::Y, material, None)
        .rectangle(
            DVec3::new(-0.8, 0.2, 2.0),
            DVec3::X * 0.4,
            -DVec3::Y * 0.4,
            grey(0.0),
            Some(Rgb::splat(20.0)),
        )
        .max_depth(3)
}

/// One material, two ways for direct light to reach it: the BSDF weighs photons in the gather, or it weighs shadow rays.
#[test]
fn glossy_hit_points_weigh_photons_as_they_weigh_shadow_rays() {
    for material in [metal(0.25), metal(0.6), plastic(None), plastic(Some(0.3)), grey(0.5)] {
        let base = RenderSettings {
            ppm: PpmSettings { radius: Some(0.04), ..settings(200_000).ppm },
            ..settings(200_000)
        };
        let sketch = wall(material);
        let (photons, a) = seeds(&sketch, &base, 3, 4);
        let by_rays =
            RenderSettings { ppm: PpmSettings { direct_light: DirectLight::ShadowRays, ..base.ppm }, ..base };
        let (rays, b) = seeds(&sketch, &by_rays, 3, 4);
        // Bias over r = 0.04 where the highlight curves: under a percent at these roughnesses.
        let bound = 4.0 * a.hypot(b) + 0.01 * rays;
        assert!((photons - rays).abs() < bound, "{material:?}: {photons} ± {a}, {rays} ± {b}");
    }
}

/// A lobe just narrow enough to be specular and one just wide enough to be gathered reflect the same light.
#[test]
fn a_specular_lobe_and_a_gathered_one_give_the_same_light() {
    let base = RenderSettings {
        samples_per_pixel: NonZeroU32::new(64).expect("above 0"),
        ppm: PpmSettings {
            radius: Some(0.03),
            hit_points_per_sample: NonZeroU32::MIN,
            ..settings(300_000).ppm
        },
        ..settings(300_000)
    };
    let (specular, a) = seeds(&wall(metal(0.0999)), &base, 1, 4);
    let few = RenderSettings { samples_per_pixel: NonZeroU32::new(4).expect("above 0"), ..base };
    let (gathered, b) = seeds(&wall(metal(0.1001)), &few, 4, 4);
    let bound = 4.0 * a.hypot(b) / gathered + 0.02;
    assert!((specular / gathered - 1.0).abs() < bound, "{specular} ± {a}, {gathered} ± {b}");
}

/// An area emitter that eye paths rarely meet by sampling the BSDF is found by sampling the emitter, and counts once.
#[test]
fn a_small_area_emitter_shows_in_narrow_gloss_without_waiting_for_chance() {
    // Half a degree wide, where the lobe is three.
    let lit = |material, size: f64| {
        let at = DVec3::new(-0.6, -0.3, 2.0);
        let radiance = Some(Rgb::splat((20.0 / (size * size)) as f32));
        Sketch::default()
            .camera(DVec3::new(0.6, 0.3, 2.0), DVec3::new(0.05, 0.0, 0.0), 4.0, 12)
            .rectangle(DVec3::ZERO, DVec3::X, DVec3::Y, material, None)
            .rectangle(at, DVec3::X * size, -DVec3::Y * size, grey(0.0), radiance)
            .max_depth(3)
    };
    for material in [metal(0.05), plastic(Some(0.05))] {
        let base = settings(20_000);
        let (small, noise) = seeds(&lit(material, 0.01), &base, 1, 6);
        assert!(noise < 0.02 * small, "{material:?}: {small} ± {noise}");
        // The same power from an emitter that is still small compared with the lobe: the same light.
        let (wider, other) = seeds(&lit(material, 0.03), &base, 1, 6);
        assert!(
            (small - wider).abs() < 4.0 * noise.hypot(other) + 0.02 * wider,
            "{small} and {wider} ± {other}"
        );
        // An emitter as wide as the lobe: both ways of sampling are equally good.
        let (wide, noise) = seeds(&lit(material, 0.3), &base, 1, 6);
        assert!(noise < 0.03 * wide, "{wide} ± {noise}");
    }
}

/// No eye path meets a delta emitter: it is sampled, and a specular lobe reflects it as a gathered one does.
#[test]
fn delta_emitters_show_in_narrow_gloss() {
    let camera = |material| {
        Sketch::default()
            .camera(DVec3::new(0.0, 0.0, 2.0), DVec3::ZERO, 20.0, 12)
            .rectangle(DVec3::ZERO, DVec3::X, DVec3::Y, material, None)
            .max_depth(3)
    };
    let light = |mut sketch: Sketch, kind| {
        sketch.0.emitters.push(EmitterDescription { name: "light".into(), kind });
        sketch
    };
    let bright = Rgb::new(3.0, 2.0, 1.0);
    let position = DVec3::new(0.1, 0.2, 2.5);
    let kinds = [
        EmitterKind::Point { position, intensity: bright },
        EmitterKind::Directional { direction: DVec3::new(-0.1, 0.05, -2.0), irradiance: bright },
    ];
    let rays = RenderSettings {
        ppm: PpmSettings { direct_light: DirectLight::ShadowRays, ..settings(1000).ppm },
        ..settings(1000)
    };
    for kind in &kinds {
        // Nothing is random in either: the values of the lobes, which differ by their roughness alone.
        for (specular, gathered) in [(metal(0.1), metal(0.1001)), (plastic(Some(0.1)), plastic(Some(0.1001)))]
        {
            let [a, b] = [specular, gathered].map(|material| {
                let image = light(camera(material), kind.clone()).render(rays.clone(), 1).image();
                (image.pixels.iter().map(|p| f64::from(p.mean())).sum::<f64>(), image)
            });
            assert!(a.0 > 1.0 && (a.0 / b.0 - 1.0).abs() < 2e-3, "{} and {}", a.0, b.0);
            let max = b.1.pixels.iter().map(|p| p.mean()).fold(0.0, f32::max);
            for (a, b) in a.1.pixels.iter().zip(&b.1.pixels) {
                assert!((a.mean() - b.mean()).abs() < 0.01 * max, "{a:?} and {b:?}");
            }
        }
    }
    // What stands in between casts a shadow; what lies behind the emitter does not.
    let [point, _] = kinds;
    let shade =
        |z: f64| camera(metal(0.05)).rectangle(DVec3::new(0.1, 0.2, z), DVec3::X, DVec3::Y, grey(0.0), None);
    let [shadowed, lit] = [2.2, 2.7]
        .map(|z| foton_tests::mean(&light(shade(z), point.clone()).render(rays.clone(), 1).image()));
    assert!(shadowed == 0.0 && lit > 0.1, "{shadowed}, {lit}");
}

fn lit_from_infinity(kind: EmitterKind, casters: bool) -> Sketch {
    let mut sketch = Sketch::default()
        .camera(DVec3::new(0.0, 1.5, 0.0), DVec3::ZERO, 20.0, 8)
        .rectangle(DVec3::ZERO, DVec3::Z, DVec3::X, grey(0.6), None)
        .max_depth(2);
    if casters {
        // Off to the side, under the plane: it changes how light is aimed, not what arrives.
        sketch = sketch.sphere(DVec3::new(0.0, -0.4, 0.0), 0.2, foton_tests::glass(1.5), None);
    }
    sketch.0.emitters.push(EmitterDescription { name: "sky".into(), kind });
    sketch
}

/// A plane under a uniform sky of radiance L has E = πL, under a sun of irradiance E⊥ it has E⊥ cos θ.
#[test]
fn light_from_infinity_has_its_closed_form_with_and_without_casters() {
    let uniform = Bitmap::new(16, 8, vec![Rgb::splat(0.5); 128]);
    let kinds = [
        (EmitterKind::Constant { radiance: Rgb::splat(0.5) }, 0.5 * PI),
        (
            EmitterKind::Environment { to_world: DAffine3::IDENTITY, bitmap: Arc::new(uniform), scale: 1.0 },
            0.5 * PI,
        ),
        (
            EmitterKind::Directional { direction: DVec3::new(0.0, -3.0, -4.0), irradiance: Rgb::splat(2.0) },
            2.0 * 0.6,
        ),
    ];
    for (kind, irradiance) in kinds {
        for casters in [false, true] {
            for direct_light in [DirectLight::Photons, DirectLight::ShadowRays] {
                let base = RenderSettings {
                    ppm: PpmSettings { radius: Some(0.1), direct_light, ..settings(100_000).ppm },
                    ..settings(100_000)
                };
                let sketch = lit_from_infinity(kind.clone(), casters);
                let (got, sigma) = seeds(&sketch, &base, 2, 4);
                let expected = 0.6 / PI * irradiance;
                assert!(
                    (got - expected).abs() < 4.0 * sigma + 2e-3 * expected,
                    "{kind:?} casters {casters} {direct_light:?}: {got} ± {sigma}, expected {expected}"
                );
            }
        }
    }
}

/// A surface of opacity ½ before a black background halves its light; one of opacity 0 is not there.
#[test]
fn opacity_scales_what_is_seen() {
    let at = |opacity: Option<f32>| {
        let mut sketch = wall(grey(0.5));
        sketch.0.materials[0].opacity = opacity.map(|o| Colour::Constant(Rgb::splat(o)));
        seeds(
            &sketch,
            &RenderSettings {
                ppm: PpmSettings { radius: Some(0.05), ..settings(50_000).ppm },
                ..settings(50_000)
            },
            2,
            4,
        )
    };
    let (full, a) = at(None);
    let (half, b) = at(Some(0.5));
    // A photon is stored before it is decided whether it passes, so both see the same photons.
    assert!((half / full - 0.5).abs() < 4.0 * a.hypot(b) / full + 1e-3, "{half} {full}");
    assert!(at(Some(0.0)).0.abs() < 1e-9);
}

/// A perfect mirror seen 20° above its plane, with normals that lean 15° away, mirrors to 10° below its plane. What the eye
/// sees there is the sky all the same, and what photons carry there escapes to it, with the adjoint's sin 10°/sin 20° of its
/// power.
#[test]
fn a_mirror_whose_normals_lean_too_far_swallows_no_light() {
    let (height, lean) = (20f64.to_radians(), 15f64.to_radians());
    let from = DVec3::new(-height.cos(), height.sin(), 0.0) * 4.0;
    let plane = Mesh {
        positions: vec![
            DVec3::new(-1.0, 0.0, -1.0),
            DVec3::new(-1.0, 0.0, 1.0),
            DVec3::new(1.0, 0.0, 1.0),
            DVec3::new(1.0, 0.0, -1.0),
        ],
        normals: vec![DVec3::new(lean.sin(), lean.cos(), 0.0); 4],
        texture_coordinates: Vec::new(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    // What goes on below the mirror meets black.
    let mirror = Sketch::default()
        .camera(from, DVec3::ZERO, 4.0, 8)
        .rectangle(-0.2 * DVec3::Y, DVec3::Z * 9.0, DVec3::X * 9.0, grey(0.0), None)
        .shape(
            Geometry::Mesh(Arc::new(plane)),
            DAffine3::IDENTITY,
            Bsdf::Mirror(Mirror { reflectance: WHITE }),
            None,
        );
    let lit_by = |kind: EmitterKind| {
        let mut sketch = mirror.clone();
        sketch.0.emitters.push(EmitterDescription { name: "light".into(), kind });
        sketch.render(settings(40_000), 1)
    };
    let sky = lit_by(EmitterKind::Constant { radiance: Rgb::WHITE });
    assert!(sky.image().pixels.iter().all(|p| (p.g - 1.0).abs() < 1e-4), "{:?}", sky.image().pixels);
    let forward = -from.normalize();
    let beam = lit_by(EmitterKind::Spot {
        to_world: DAffine3::from_cols(DVec3::Z, forward.cross(DVec3::Z), forward, from),
        intensity: Rgb::WHITE,
        cutoff_degrees: 1.0,
        beam_degrees: 0.5,
        texture: None,
    });
    let escaped = beam.ledger().escaped / beam.ledger().emitted;
    let expected = 10f64.to_radians().sin() / height.sin();
    assert!((escaped / expected - 1.0).abs() < 0.02, "{escaped}, expected {expected}");
}
