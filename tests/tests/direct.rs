//! Direct light by shadow rays: the same light as by photons, with as much noise as it says, in a share of a pass.

use std::f64::consts::PI;
use std::num::NonZeroU32;

use foton_integrator::{Cancel, DirectLight, PpmSettings, Render, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DQuat, DVec3};
use foton_scene::description::{EmitterDescription, EmitterKind};
use foton_tests::{Sketch, glass, grey};

fn number(n: u32) -> NonZeroU32 {
    NonZeroU32::new(n).expect("above 0")
}

fn settings(photons: u32, direct_light: DirectLight) -> RenderSettings {
    RenderSettings {
        samples_per_pixel: NonZeroU32::MIN,
        error: true,
        ppm: PpmSettings {
            photons_per_pass: number(photons),
            first_pass: number(photons),
            direct_light,
            ..PpmSettings::default()
        },
        ..RenderSettings::default()
    }
}

fn luminance(render: &Render) -> Vec<f64> {
    render.image().pixels.iter().map(|p| f64::from(p.luminance())).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// A floor, a ball on it, a rectangle and a ball that shine.
fn lamps() -> Sketch {
    Sketch::default()
        .camera(DVec3::new(0.0, 2.0, 1.5), DVec3::ZERO, 50.0, 24)
        .rectangle(DVec3::ZERO, DVec3::new(0.0, 0.0, 2.0), DVec3::new(2.0, 0.0, 0.0), grey(0.7), None)
        .sphere(DVec3::new(0.3, 0.3, 0.2), 0.3, grey(0.5), None)
        .rectangle(
            DVec3::new(-0.5, 1.2, 0.0),
            DVec3::X * 0.3,
            DVec3::Z * 0.2,
            grey(0.0),
            Some(Rgb::splat(8.0)),
        )
        .sphere(DVec3::new(0.8, 0.9, -0.4), 0.1, grey(0.0), Some(Rgb::new(20.0, 15.0, 10.0)))
}

/// Points, a spot and a sun.
fn deltas() -> Sketch {
    let mut sketch = lamps().point(DVec3::new(0.2, 1.0, 0.3), 5.0);
    sketch.0.shapes.truncate(2);
    let kind =
        EmitterKind::Directional { direction: DVec3::new(0.2, -1.0, 0.3), irradiance: Rgb::splat(0.8) };
    sketch.0.emitters.push(EmitterDescription { name: "sun".into(), kind });
    sketch
}

/// The same floor under a sky and many small lamps: more than four, so that a tree chooses among them.
fn many() -> Sketch {
    let mut sketch = lamps();
    for i in 0..12 {
        let (sin, cos) = (0.7 * f64::from(i)).sin_cos();
        let at = DVec3::new(cos, 0.3 + 0.05 * f64::from(i), sin);
        sketch = sketch.sphere(at, 0.04, grey(0.0), Some(Rgb::splat(30.0 * (1 + i % 3) as f32)));
    }
    let kind = EmitterKind::Constant { radiance: Rgb::new(0.1, 0.2, 0.4) };
    sketch.0.emitters.push(EmitterDescription { name: "sky".into(), kind });
    sketch
}

#[test]
fn points_spots_and_suns_have_no_noise() {
    let sketch = deltas().max_depth(2);
    let after = |passes| sketch.render(settings(1000, DirectLight::ShadowRays), passes);
    let (one, many) = (after(1), after(5));
    assert!(one.image() == many.image() && mean(&luminance(&one)) > 0.1);
    assert!(many.direct_light().expect("by rays").iter().all(|(_, variance)| *variance == 0.0));
    let error = many.error().expect("passes");
    assert_eq!((error.total, error.high, error.unknown_share), (0.0, 0.0, 0.0));
}

/// Means over pixels and seeds; photons' bias at shadows' edges is as small as their discs.
#[test]
fn photons_and_shadow_rays_bring_the_same_light_whichever_lights_there_are() {
    for sketch in [lamps(), deltas(), many(), lamps().room(grey(0.5), None)] {
        let of = |direct_light| -> (f64, f64) {
            let small = |seed| RenderSettings {
                seed,
                error: false,
                ppm: PpmSettings { radius: Some(0.02), ..settings(60_000, direct_light).ppm },
                ..settings(60_000, direct_light)
            };
            let means: Vec<f64> = (0..6).map(|s| mean(&luminance(&sketch.render(small(s), 4)))).collect();
            let m = mean(&means);
            let variance = means.iter().map(|x| (x - m).powi(2)).sum::<f64>() / 5.0;
            (m, (variance / 6.0).sqrt())
        };
        let (photons, a) = of(DirectLight::Photons);
        let (rays, b) = of(DirectLight::ShadowRays);
        assert!((photons - rays).abs() < 3.5 * a.hypot(b) + 0.01 * rays, "{photons} ± {a}, {rays} ± {b}");
    }
}

/// What is said of the noise of pixels, over how much they differ from seed to seed: at two visits a pixel, and at many, of which
/// each is stratified with those before it.
#[test]
fn the_noise_of_direct_light_is_what_it_says() {
    for sketch in [lamps().max_depth(2), many().max_depth(2)] {
        for (photons, passes) in [(4000, 2), (8000, 3), (8000, 12)] {
            let seeds = 24;
            let (mut said, mut sums, mut squares) = (0.0, vec![0.0; 24 * 24], vec![0.0; 24 * 24]);
            for seed in 0..seeds {
                let base = RenderSettings { seed, ..settings(photons, DirectLight::ShadowRays) };
                // The same eye samples for all.
                let scene = sketch.build().expect("sound");
                let eyes = RenderSettings { seed: 0, ..base };
                let started =
                    foton_integrator::Variants::start(&scene, &[eyes], seed, &mut |_| (), &Cancel::default());
                let mut runs = started.expect("not cancelled").expect("one");
                for _ in 0..passes {
                    runs.advance(&mut |_| (), &Cancel::default()).expect("not cancelled");
                }
                for (i, (light, variance)) in
                    runs.runs()[0].direct_light().expect("by rays").into_iter().enumerate()
                {
                    said += variance;
                    sums[i] += light;
                    squares[i] += light * light;
                }
            }
            let n = seeds as f64;
            let seen: f64 =
                sums.iter().zip(&squares).map(|(s, q): (&f64, &f64)| (q - s * s / n) / (n - 1.0)).sum();
            let ratio = said / n / seen;
            assert!((0.85..1.18).contains(&ratio), "{photons} photons, {passes} passes: {ratio}");
        }
    }
}

#[test]
fn the_floor_under_a_rectangle_has_the_irradiance_of_its_closed_form() {
    let sketch = Sketch::default()
        .camera(DVec3::new(0.0, 0.4, 0.0), DVec3::ZERO, 0.5, 8)
        .rectangle(DVec3::ZERO, DVec3::new(0.0, 0.0, 4.0), DVec3::new(4.0, 0.0, 0.0), grey(0.8), None)
        .rectangle(DVec3::Y, DVec3::X * 0.5, DVec3::Z * 0.5, grey(0.0), Some(Rgb::splat(3.0)))
        .max_depth(2);
    let render = sketch.render(settings(1000, DirectLight::ShadowRays), 6);
    // Four corners' parts: L/2 (a/√(1+a²) atan(b/√(1+a²)) + b/√(1+b²) atan(a/√(1+b²))), a = b = half the side over the height.
    let root = 1.25f64.sqrt();
    let irradiance = 4.0 * 3.0 / 2.0 * 2.0 * (0.5 / root) * (0.5 / root).atan();
    let found = mean(&luminance(&render)) / (irradiance * 0.8 / PI);
    assert!((found - 1.0).abs() < 2e-3, "{found}");
}

/// Ten thousand lamps in a net over a floor: the sum of all of them, whichever rays choose.
#[test]
fn ten_thousand_lamps_light_a_floor() {
    let (side, radius, height) = (100, 0.004, 0.25);
    let place = |i: i32| (f64::from(i) + 0.5) / f64::from(side) * 4.0 - 2.0;
    let mut sketch = Sketch::default()
        .camera(DVec3::new(0.1, 0.2, 0.05), DVec3::new(0.1, 0.0, 0.05), 20.0, 8)
        .rectangle(DVec3::ZERO, DVec3::new(0.0, 0.0, 4.0), DVec3::new(4.0, 0.0, 0.0), grey(0.8), None);
    let mut expected = 0.0;
    for (i, j) in (0..side).flat_map(|i| (0..side).map(move |j| (i, j))) {
        let at = DVec3::new(place(i), height, place(j));
        sketch = sketch.sphere(at, radius, grey(0.0), Some(Rgb::splat(100.0)));
        let d2 = (at - DVec3::new(0.1, 0.0, 0.05)).length_squared();
        expected += PI * 100.0 * radius * radius / d2 * height / d2.sqrt() * 0.8 / PI;
    }
    let render = sketch.max_depth(2).render(settings(20_000, DirectLight::ShadowRays), 8);
    let found = mean(&luminance(&render));
    assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
    // All lamps are alike: chosen by what they give, even single visits are not far off.
    let (light, variance): (Vec<f64>, Vec<f64>) = render.direct_light().expect("by rays").into_iter().unzip();
    assert!(mean(&variance).sqrt() < 0.3 * mean(&light), "{} {}", mean(&variance).sqrt(), mean(&light));
}

/// The first pass lights every pixel; those after it some, the more the more their photons cost.
#[test]
fn rays_are_a_share_of_a_pass() {
    let sketch = lamps().sphere(DVec3::new(-0.6, 0.2, 0.3), 0.2, glass(1.5), None);
    let rays = |photons, direct_light| {
        let scene = sketch.build().expect("sound");
        let base = settings(photons, direct_light);
        let mut render = Render::start(scene, base, &mut |_| (), &Cancel::default()).expect("starts");
        [(); 2].map(|()| render.advance(&mut |_| (), &Cancel::default()).expect("not cancelled").rays)
    };
    // Photons take the same rays either way.
    let shadow = |photons| {
        let [by_rays, by_photons] = [DirectLight::ShadowRays, DirectLight::Photons].map(|d| rays(photons, d));
        ([0, 1].map(|pass| by_rays[pass] - by_photons[pass]), by_photons[1])
    };
    let ([first, few], _) = shadow(1);
    let ([_, more], photons) = shadow(2000);
    assert!(first > 400 && few > 0 && few * 10 < first, "{first} {few}");
    assert!(more > 10 * few && more < photons, "{more} beside {photons}");
}

#[test]
fn beams_and_what_hardly_sees_an_emitter_get_direct_light_by_photons() {
    let by_rays = |sketch: &Sketch| sketch.render(settings(100, DirectLight::Auto), 0).has_shadow_rays();
    assert!(by_rays(&lamps()) && by_rays(&deltas()) && by_rays(&many()));
    // A spot, wide and as narrow as a beam.
    let spot = |degrees: f64| {
        let mut sketch = lamps();
        let to_world = DAffine3::from_rotation_translation(DQuat::from_rotation_x(PI / 2.0), DVec3::Y);
        let (cutoff_degrees, beam_degrees) = (degrees, degrees);
        let kind = EmitterKind::Spot {
            to_world,
            intensity: Rgb::WHITE,
            cutoff_degrees,
            beam_degrees,
            texture: None,
        };
        sketch.0.emitters.push(EmitterDescription { name: "spot".into(), kind });
        sketch
    };
    assert!(by_rays(&spot(20.0)) && !by_rays(&spot(0.1)));
    // A closed room under a sky.
    let mut room = Sketch::default().camera(DVec3::ZERO, -DVec3::Z, 60.0, 24).room(grey(0.5), None);
    let kind = EmitterKind::Constant { radiance: Rgb::WHITE };
    room.0.emitters.push(EmitterDescription { name: "sky".into(), kind });
    assert!(!by_rays(&room));
}
