//! Surfaces that light passes, that lie in one another, or that are smooth by their normals alone.

mod narrow_gloss;

use std::f64::consts::PI;
use std::num::NonZeroU32;
use std::sync::Arc;

use foton_integrator::{DirectLight, PpmSettings, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::{
    Bsdf, Colour, Conductor, Dielectric, EmitterDescription, EmitterKind, Geometry, Mesh,
    MicrofacetDistribution, Microfacets, Mirror, Null, Plastic, ThinDielectric,
};
use foton_tests::{Sketch, glass, grey, mean, seeds};

const WHITE: Colour = Colour::Constant(Rgb::WHITE);

fn settings(photons: u32, samples: u32) -> RenderSettings {
    RenderSettings {
        samples_per_pixel: NonZeroU32::new(samples).expect("above 0"),
        ppm: PpmSettings {
            photons_per_pass: NonZeroU32::new(photons).expect("above 0"),
            first_pass: NonZeroU32::new(photons).expect("above 0"),
            ..PpmSettings::default()
        },
        ..RenderSettings::default()
    }
}

/// A metal that reflects all light, in lobes of this roughness.
fn white_metal(alpha: f32) -> Bsdf {
    Bsdf::Conductor(Conductor {
        eta: Rgb::BLACK,
        k: Rgb::WHITE,
        specular_reflectance: WHITE,
        roughness: Some(Microfacets::isotropic(MicrofacetDistribution::Ggx, alpha)),
    })
}

const MIRROR: Bsdf = Bsdf::Mirror(Mirror { reflectance: WHITE });

fn pane() -> Bsdf {
    Bsdf::ThinDielectric(ThinDielectric {
        int_ior: 1.5,
        ext_ior: 1.0,
        specular_reflectance: WHITE,
        specular_transmittance: WHITE,
    })
}

/// Makes a mask of the last material.
fn masked(mut sketch: Sketch, opacity: f32, both_sides: bool) -> Sketch {
    let material = sketch.0.materials.last_mut().expect("a material");
    material.opacity = Some(Colour::Constant(Rgb::splat(opacity)));
    material.back = both_sides.then_some(material.front);
    sketch
}

fn area_emitter(sketch: Sketch, centre: DVec3, half: f64) -> Sketch {
    let radiance = Some(Rgb::splat((1.0 / (half * half)) as f32));
    sketch.rectangle(centre, DVec3::X * half, DVec3::Z * half, grey(0.0), radiance)
}

fn near(what: &str, a: (f64, f64), b: (f64, f64), bias: f64) {
    let bound = 4.0 * a.1.hypot(b.1) + bias * b.0;
    assert!((a.0 - b.0).abs() <= bound, "{what}: {} ± {} and {} ± {}", a.0, a.1, b.0, b.1);
}

/// A wall behind a one-sided card whose back is turned to the eye.
#[test]
fn a_mask_lets_light_through_from_behind_too() {
    let wall = || {
        let room = Sketch::default().camera(DVec3::new(0.0, 0.0, 4.0), DVec3::ZERO, 20.0, 8).rectangle(
            DVec3::NEG_Z,
            DVec3::X * 2.0,
            DVec3::Y * 2.0,
            grey(0.7),
            None,
        );
        area_emitter(room, DVec3::new(0.0, 1.9, 1.0), 0.3).max_depth(6)
    };
    let card = |opacity| {
        let backwards = wall().rectangle(DVec3::Z * 0.5, DVec3::X, -DVec3::Y, grey(0.5), None);
        masked(backwards, opacity, false)
    };
    let ball = |opacity| {
        // The eye is inside.
        masked(wall().sphere(DVec3::new(0.0, 0.0, 4.0), 0.2, grey(0.5), None), opacity, false)
    };
    for direct_light in [DirectLight::Photons, DirectLight::ShadowRays] {
        let base = RenderSettings {
            ppm: PpmSettings { direct_light, ..settings(50_000, 1).ppm },
            ..settings(50_000, 1)
        };
        let open = seeds(&wall(), &base, 2, 4);
        for (opacity, share) in [(0.0, 1.0), (0.5, 0.5), (1.0, 0.0)] {
            let (seen, sigma) = seeds(&ball(opacity), &base, 2, 4);
            near("ball", (seen, sigma), (share * open.0, share * open.1), 0.01);
            let (seen, sigma) = seeds(&card(opacity), &base, 2, 4);
            if opacity == 0.0 {
                near("card", (seen, sigma), open, 0.01);
            } else {
                // The card hides its share of the wall, and casts light of the emitter on it.
                assert!(
                    seen >= 0.0 && seen < 0.9 * open.0 && (seen > 0.0) == (share > 0.0),
                    "{opacity}: {seen}"
                );
            }
        }
    }
}

/// A block of glass whose bottom lies in the floor is one without a bottom: floor and glass touch.
#[test]
fn glass_that_stands_in_the_plane_of_a_floor_is_one_with_it() {
    let place = DAffine3::from_rotation_y(0.4) * DAffine3::from_translation(DVec3::new(0.2, 0.0, 0.1));
    let scene = |block: &dyn Fn(Sketch) -> Sketch, floor_first: bool| {
        let floor = |s: Sketch| s.rectangle(DVec3::ZERO, DVec3::X * 4.0, DVec3::NEG_Z * 4.0, grey(0.5), None);
        let s = Sketch::default().camera(DVec3::new(2.0, 4.0, 5.0), DVec3::Y * 0.4, 26.0, 12);
        let s = if floor_first { block(floor(s)) } else { floor(block(s)) };
        area_emitter(s, DVec3::Y * 5.0, 1.0).max_depth(12)
    };
    let cube = place * DAffine3::from_translation(DVec3::Y);
    let whole = |s: Sketch| s.shape(Geometry::Mesh(Arc::new(Mesh::cube())), cube, glass(1.5), None);
    let open = |s: Sketch| {
        let mut five = Mesh::cube();
        five.triangles.retain(|t| t.iter().any(|&i| five.positions[i as usize].y > 0.0));
        s.shape(Geometry::Mesh(Arc::new(five)), cube, glass(1.5), None)
    };
    let base = settings(60_000, 4);
    let expected = seeds(&scene(&open, true), &base, 3, 4);
    for floor_first in [true, false] {
        let got = seeds(&scene(&whole, floor_first), &base, 3, 4);
        near("the block", got, expected, 0.002);
    }
}

/// Water on glass: the face between them stated once, by its two indices, or twice, each in air.
#[test]
fn a_face_between_water_and_glass_may_be_stated_once_or_twice() {
    let between = |int_ior, ext_ior| {
        Bsdf::Dielectric(Dielectric {
            int_ior,
            ext_ior,
            specular_reflectance: WHITE,
            specular_transmittance: WHITE,
            roughness: None,
        })
    };
    let layer = |s: Sketch, height: f64, up: bool, bsdf| {
        let y = if up { DVec3::NEG_Z } else { DVec3::Z };
        s.rectangle(DVec3::Y * height, DVec3::X * 9.0, y * 9.0, bsdf, None)
    };
    let scene = |faces: &[(bool, Bsdf)]| {
        let s = Sketch::default().camera(DVec3::new(0.3, 4.0, 0.2), DVec3::ZERO, 20.0, 6).rectangle(
            DVec3::NEG_Y,
            DVec3::X * 4.0,
            DVec3::NEG_Z * 4.0,
            grey(0.5),
            None,
        );
        let s = layer(s, 1.0, true, between(1.333, 1.0));
        let s = faces.iter().fold(s, |s, &(up, bsdf)| layer(s, 0.5, up, bsdf));
        layer(s, 0.0, false, between(1.5, 1.0)).point(DVec3::Y * 3.0, 50.0).max_depth(16)
    };
    let base = settings(100_000, 1);
    let image = |faces: &[(bool, Bsdf)]| mean(&scene(faces).render(base.clone(), 2).image());
    let (water, plate) = ((false, between(1.333, 1.0)), (true, between(1.5, 1.0)));
    let once = image(&[(true, between(1.5, 1.333))]);
    for twice in [[water, plate], [plate, water]] {
        let twice = image(&twice);
        assert!(once > 0.0 && (twice / once - 1.0).abs() < 0.01, "{twice} and {once}");
    }
}

/// A ball of a few faces with the normals of a sphere.
fn coarse_ball() -> Geometry {
    const AROUND: u32 = 12;
    const DOWN: u32 = 6;
    let mut mesh = Mesh::default();
    for i in 0..=DOWN {
        for j in 0..AROUND {
            let (a, b) = (PI * f64::from(i) / f64::from(DOWN), 2.0 * PI * f64::from(j) / f64::from(AROUND));
            mesh.positions.push(DVec3::new(a.sin() * b.cos(), a.cos(), a.sin() * b.sin()));
        }
    }
    for i in 0..DOWN {
        for j in 0..AROUND {
            let at = |i: u32, j: u32| i * AROUND + j % AROUND;
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            mesh.triangles.extend((i > 0).then_some([a, b, c]));
            mesh.triangles.extend((i + 1 < DOWN).then_some([a, c, d]));
        }
    }
    mesh.normals.clone_from(&mesh.positions);
    Geometry::Mesh(Arc::new(mesh))
}

/// Nothing reflects more light than arrives: under a sky of radiance 1 nothing is brighter than 1, by three standard errors.
#[test]
fn interpolated_normals_reflect_no_more_than_arrives() {
    let coat = Bsdf::Plastic(Plastic {
        int_ior: 1.5,
        ext_ior: 1.0,
        diffuse_reflectance: WHITE,
        specular_reflectance: WHITE,
        nonlinear: true,
        roughness: Some(Microfacets::isotropic(MicrofacetDistribution::Beckmann, 0.2)),
    });
    for material in [grey(1.0), white_metal(0.11), white_metal(0.3), coat] {
        let mut sketch = Sketch::default().camera(DVec3::new(0.0, 0.3, 4.0), DVec3::ZERO, 13.0, 10).shape(
            coarse_ball(),
            DAffine3::IDENTITY,
            material,
            None,
        );
        sketch.0.emitters.push(EmitterDescription {
            name: "sky".into(),
            kind: EmitterKind::Constant { radiance: Rgb::WHITE },
        });
        let (seen, sigma) = seeds(&sketch, &settings(40_000, 4), 10, 6);
        assert!(sigma < 0.01 && seen < 1.0 + 3.0 * sigma, "{material:?}: {seen} ± {sigma}");
    }
}

/// Light that passes straight through surfaces is direct light: photons bring it, or shadow rays do.
#[test]
fn shadow_rays_see_through_what_photons_pass_straight() {
    let scene = |between: &dyn Fn(Sketch) -> Sketch, ground: Bsdf, by_point: bool| {
        let s = Sketch::default().camera(DVec3::new(1.5, 3.0, 2.0), DVec3::ZERO, 14.0, 8).rectangle(
            DVec3::ZERO,
            DVec3::X * 2.0,
            DVec3::NEG_Z * 2.0,
            ground,
            None,
        );
        let s = between(s).max_depth(8);
        let above = DVec3::new(-0.5, 2.0, 0.3);
        if by_point { s.point(above, 60.0) } else { area_emitter(s, above, 0.3) }
    };
    let sheet = |s: Sketch, height: f64, bsdf| {
        s.rectangle(DVec3::Y * height, DVec3::X * 0.8, DVec3::NEG_Z * 0.8, bsdf, None)
    };
    let nothing = |s: Sketch| sheet(s, 1.0, Bsdf::Null(Null));
    let half = |s: Sketch| masked(sheet(s, 1.0, grey(0.5)), 0.5, true);
    let one_sided = |s: Sketch| masked(sheet(s, 1.0, grey(0.0)), 0.25, false);
    let glazed = |s: Sketch| sheet(sheet(s, 1.0, pane()), 1.2, pane());
    let mirrored = |s: Sketch| masked(sheet(s, 1.0, MIRROR), 0.5, true);
    let all = |s: Sketch| sheet(half(sheet(s, 1.1, pane())), 0.9, Bsdf::Null(Null));
    let betweens: [&dyn Fn(Sketch) -> Sketch; 6] = [&nothing, &half, &one_sided, &glazed, &mirrored, &all];
    for (i, between) in betweens.into_iter().enumerate() {
        for (ground, by_point) in [(grey(0.5), false), (white_metal(0.3), false), (grey(0.5), true)] {
            let sketch = scene(between, ground, by_point);
            let base = RenderSettings {
                ppm: PpmSettings { radius: Some(0.05), ..settings(100_000, 1).ppm },
                ..settings(100_000, 1)
            };
            let photons = seeds(&sketch, &base, 2, 4);
            let by_rays = RenderSettings {
                ppm: PpmSettings { direct_light: DirectLight::ShadowRays, ..base.ppm },
                ..base
            };
            let rays = seeds(&sketch, &by_rays, 6, 4);
            near(&format!("sheet {i}, {ground:?}"), photons, rays, 0.015);
        }
    }
}
