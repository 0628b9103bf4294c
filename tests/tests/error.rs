//! The live error against the true one, where that is known: estimates that a person stops by must be right.

use std::num::NonZeroU32;

use foton_film::Image;
use foton_integrator::{Alpha, DirectLight, PpmSettings, RadiusFloor, RadiusRule, Render, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::DVec3;
use foton_tests::{Sketch, grey, slopes};

fn settings(photons: u32, seed: u64) -> RenderSettings {
    let photons_per_pass = NonZeroU32::new(photons).expect("above 0");
    RenderSettings {
        samples_per_pixel: NonZeroU32::MIN,
        error: true,
        seed,
        ppm: PpmSettings {
            photons_per_pass,
            first_pass: NonZeroU32::new(photons / 8).expect("above 0"),
            // Theory is of photons, and of radii that shrink for ever.
            direct_light: DirectLight::Photons,
            radius_floor: RadiusFloor::NONE,
            // Nor is it of photons that differ in power.
            guided: false,
            ..PpmSettings::default()
        },
        ..RenderSettings::default()
    }
}

/// RMSE of luminance over the mean of the truth, where `emission` is seen beside the reflected light.
fn true_error(image: &Image, truth: &[f64], emission: f64) -> f64 {
    let squares = image.pixels.iter().zip(truth).map(|(p, t)| (f64::from(p.luminance()) - t).powi(2));
    let n = truth.len() as f64;
    (squares.sum::<f64>() / n).sqrt() / (truth.iter().sum::<f64>() / n - emission)
}

/// A floor that a point lights, and nothing else. Shadow rays to a point are exact, so at the same eye samples they are the
/// truth.
fn lit_floor(height: f64) -> Sketch {
    Sketch::default()
        .camera(DVec3::new(0.3, 2.0, 0.1), DVec3::new(0.3, 0.0, 0.0), 50.0, 32)
        .rectangle(DVec3::ZERO, DVec3::new(0.0, 0.0, 4.0), DVec3::new(4.0, 0.0, 0.0), grey(0.8), None)
        .point(DVec3::new(0.0, height, 0.0), 3.0)
        .max_depth(2)
}

fn by_shadow_rays(sketch: &Sketch, base: &RenderSettings) -> Vec<f64> {
    let exact = RenderSettings {
        error: false,
        ppm: PpmSettings { direct_light: DirectLight::ShadowRays, ..base.ppm },
        ..base.clone()
    };
    sketch.render(exact, 1).image().pixels.iter().map(|p| f64::from(p.luminance())).collect()
}

/// In a closed furnace every pixel is Le/(1−ρ) = 2 and nothing is blurred: all of the error is noise.
#[test]
fn the_error_of_a_furnace_is_its_noise_at_16_and_64_passes() {
    let sketch =
        Sketch::default().camera(DVec3::ZERO, -DVec3::Z, 60.0, 32).room(grey(0.5), Some(Rgb::splat(1.0)));
    for passes in [16, 64] {
        let render = sketch.render(
            RenderSettings {
                ppm: PpmSettings { radius: Some(0.1), ..settings(10_000, 3).ppm },
                ..settings(10_000, 3)
            },
            passes,
        );
        let truth = vec![2.0; 32 * 32];
        let (error, truth) = (render.error().expect("passes"), true_error(&render.image(), &truth, 1.0));
        let quotient = error.total / truth;
        assert!((quotient - 1.0).abs() < 0.2, "pass {passes}: {error:?}, true {truth}");
        assert!(error.low < truth && truth < error.high, "pass {passes}: {error:?}, true {truth}");
        assert!(error.bias < 0.5 * error.noise, "{error:?}");
        assert!((error.mean_luminance - 1.0).abs() < 0.02 && error.unknown_share == 0.0, "{error:?}");
    }
}

/// Radii too large for the light's gradient, then radii that shrink: bias that dominates, and bias beside noise.
#[test]
fn blur_is_part_of_the_error_at_16_and_64_passes() {
    for (radius, alpha) in [(0.5, 1.0), (0.5, 2.0 / 3.0), (0.2, 2.0 / 3.0)] {
        let sketch = lit_floor(0.8);
        let base = RenderSettings {
            ppm: PpmSettings {
                radius: Some(radius),
                alpha: Alpha::new(alpha).expect("in range"),
                ..settings(20_000, 4).ppm
            },
            ..settings(20_000, 4)
        };
        let truth = by_shadow_rays(&sketch, &base);
        for passes in [16, 64] {
            let render = sketch.render(base.clone(), passes);
            let (error, truth) = (render.error().expect("passes"), true_error(&render.image(), &truth, 0.0));
            let quotient = error.total / truth;
            assert!((quotient - 1.0).abs() < 0.25, "{radius} {alpha} {passes}: {error:?}, true {truth}");
        }
    }
}

/// Of tiles where all is smooth, about nine in ten are within a bound meant for nine in ten, at each of several seeds.
#[test]
fn bounds_of_tiles_hold_about_as_often_as_they_say() {
    let (mut within, mut all) = (0.0, 0.0);
    for seed in 0..6 {
        let base = RenderSettings {
            ppm: PpmSettings { radius: Some(0.3), ..settings(20_000, seed).ppm },
            ..settings(20_000, seed)
        };
        let truth = tile_means(&by_shadow_rays(&lit_floor(0.8), &base), 32);
        let render = lit_floor(0.8).render(base, 32);
        for (tile, truth) in render.error_tiles().iter().zip(&truth) {
            within += f64::from(u8::from((tile.mean - truth).abs() <= tile.bound(1.645)));
            all += 1.0;
        }
    }
    let share = within / all;
    assert!((0.83..=0.98).contains(&share), "{share}");
}

fn tile_means(pixels: &[f64], width: usize) -> Vec<f64> {
    let tiles = width / 8;
    (0..tiles * tiles)
        .map(|t| {
            let (x, y) = (t % tiles * 8, t / tiles * 8);
            let rows = (y..y + 8).map(|y| pixels[y * width + x..][..8].iter().sum::<f64>());
            rows.sum::<f64>() / 64.0
        })
        .collect()
}

/// An emitter that a pinhole hides: for a long time almost nothing is found, which must not look like a dark, finished image.
#[test]
fn light_that_is_hardly_found_keeps_the_error_large() {
    let sketch = Sketch::default()
        .camera(DVec3::new(0.0, 1.0, 0.5), DVec3::new(0.0, 0.0, 0.0), 60.0, 16)
        .rectangle(DVec3::ZERO, DVec3::new(0.0, 0.0, 4.0), DVec3::new(4.0, 0.0, 0.0), grey(0.8), None)
        .point(DVec3::new(0.0, 3000.0, 0.0), 3e8)
        .max_depth(2);
    let render = sketch.render(
        RenderSettings {
            ppm: PpmSettings { radius: Some(0.05), ..settings(20_000, 1).ppm },
            ..settings(20_000, 1)
        },
        12,
    );
    let unknown = render.unknown_share().iter().sum::<f32>() / 256.0;
    assert!(unknown > 0.2, "hardly anything is found: {unknown}");
    if let Some(error) = render.error() {
        assert!(error.total > 0.5 && error.unknown_share > 0.2, "{error:?}");
    }
}

/// Whether the error is asked for changes no bit of the image, and threads change no bit of the error.
#[test]
fn the_error_costs_no_bit_and_depends_on_no_thread() {
    let sketch = lit_floor(1.0);
    let base = settings(5_000, 9);
    let with = sketch.render(base.clone(), 5);
    let without = sketch.render(RenderSettings { error: false, ..settings(5_000, 9) }, 5);
    assert_eq!(with.image().pixels, without.image().pixels);
    assert!(without.error().is_none() && without.error_tiles().is_empty());
    let threads = |n| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads");
        pool.install(|| Render::error(&sketch.render(base.clone(), 5)))
    };
    assert_eq!(threads(1), threads(3));
    assert_eq!(threads(1), with.error());
}

/// Light of one class has all of the error, and the parts' squares add up.
#[test]
fn the_error_of_one_class_is_all_of_the_error() {
    for layers in [false, true] {
        let base = RenderSettings {
            layers,
            ppm: PpmSettings { radius: Some(0.5), ..settings(20_000, 2).ppm },
            ..settings(20_000, 2)
        };
        let error = lit_floor(0.8).render(base, 24).error().expect("passes");
        let [direct, caustic, indirect] = error.classes.expect("each was asked for");
        assert!((direct.noise / error.noise - 1.0).abs() < 1e-9, "{error:?}");
        assert!((direct.bias / error.bias - 1.0).abs() < 1e-9, "{error:?}");
        assert_eq!((caustic.total(), indirect.total()), (0.0, 0.0));
    }
}

/// In a furnace of reflectance ρ all photons have the same power, and 1 − ρ of the light is direct: so is that share of the variance.
#[test]
fn classes_have_the_noise_of_their_photons() {
    let sketch =
        Sketch::default().camera(DVec3::ZERO, -DVec3::Z, 60.0, 32).room(grey(0.75), Some(Rgb::splat(1.0)));
    let base = RenderSettings {
        samples_per_pixel: NonZeroU32::new(3).expect("above 0"),
        ppm: PpmSettings { radius: Some(0.1), ..settings(10_000, 3).ppm },
        ..settings(10_000, 3)
    };
    let error = sketch.render(base, 24).error().expect("passes");
    let classes = error.classes.expect("each was asked for");
    let share = (classes[0].noise / error.noise).powi(2);
    assert!((share - 0.25).abs() < 0.03, "{share} {error:?}");
    let squares: f64 = classes.iter().map(|c| c.total().powi(2)).sum();
    assert!((squares.sqrt() / error.total - 1.0).abs() < 1e-9, "{error:?}");
}

/// Over two decades of passes noise, bias of smooth light, and both fall with n^(−1/3) at α = 2/3, bias across an edge with n^(−1/12)
/// alone `[KD13]`.
#[test]
fn noise_and_blur_fall_with_the_slopes_of_theory() {
    let checkpoints: Vec<u64> = (2..10).map(|power| 1 << power).collect();
    let parts = slopes::measure(2.0 / 3.0, 8000, 3, &checkpoints);
    let slope = |part: fn(&slopes::Parts) -> f64| slopes::slope_of(&parts, part);
    let smooth = [slope(|p| p.noise), slope(|p| p.bias), slope(|p| p.smooth)];
    assert!(smooth.iter().all(|s| (s + 1.0 / 3.0).abs() < 0.04), "noise, blur, both: {smooth:?}, {parts:?}");
    let edge = [slope(|p| p.edge_bias), slope(|p| p.edge)];
    assert!(
        edge.iter().all(|s| (s + 1.0 / 12.0).abs() < 0.02),
        "blur, both at the edge: {edge:?}, {parts:?}"
    );
}

/// Where nothing is blurred radii stay, so that there is less noise; below an emitter they shrink, and more so at a shadow's edge. The
/// error is below that of every fixed rule that starts with the same radius.
#[test]
fn radii_that_adapt_leave_less_error_than_any_fixed_rule() {
    let furnace =
        Sketch::default().camera(DVec3::ZERO, -DVec3::Z, 60.0, 16).room(grey(0.5), Some(Rgb::splat(1.0)));
    let adaptive = |base: RenderSettings| RenderSettings {
        error: false,
        ppm: PpmSettings { radius_rule: RadiusRule::Adaptive, ..base.ppm },
        ..base
    };
    let local = |settings: RenderSettings| RenderSettings {
        error: false,
        ppm: PpmSettings { radius_rule: RadiusRule::Local, ..settings.ppm },
        ..settings
    };
    let base = local(RenderSettings {
        ppm: PpmSettings { radius: Some(0.1), ..settings(10_000, 3).ppm },
        ..settings(10_000, 3)
    });
    let [adapted, fixed] = [adaptive(base.clone()), base].map(|s| furnace.render(s, 32).radii().median);
    assert!(adapted > 1.3 * fixed && fixed < 0.06, "{adapted} {fixed}");

    let base = local(RenderSettings {
        ppm: PpmSettings { radius: Some(0.4), ..settings(20_000, 3).ppm },
        ..settings(20_000, 3)
    });
    let truth = by_shadow_rays(&slopes::scene(), &base);
    let after =
        |settings: RenderSettings| true_error(&slopes::scene().render(settings, 32).image(), &truth, 0.0);
    let error = after(adaptive(base.clone()));
    for alpha in [0.4, 0.5, 0.6, 2.0 / 3.0, 0.8, 1.0] {
        let alpha = Alpha::new(alpha).expect("in range");
        let fixed = after(RenderSettings { ppm: PpmSettings { alpha, ..base.ppm }, ..base.clone() });
        assert!(error < 0.9 * fixed, "{error} against {fixed} at {alpha}");
    }
}
