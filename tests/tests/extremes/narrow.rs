//! Light that is narrower than the gaps between eye samples.

use foton_integrator::{DirectLight, PpmSettings, RadiusFloor, RadiusRule, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DQuat, DVec3};
use foton_scene::description::{EmitterDescription, EmitterKind};
use foton_tests::{Sketch, grey, mean_and_sigma};

use super::number;
use crate::settings;

/// A spot three metres above (x, z) of a floor; one of 0.1° makes a disc of two fifths of a pixel there.
fn spot(degrees: f64, x: f64, z: f64) -> Sketch {
    let mut sketch = Sketch::default()
        .camera(DVec3::new(0.0, 5.0, 0.0), DVec3::ZERO, 5.0, 16)
        .rectangle(DVec3::ZERO, DVec3::Z, DVec3::X, grey(0.5), None)
        .max_depth(2);
    let down = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
    let to_world = DAffine3::from_rotation_translation(down, DVec3::new(x, 3.0, z));
    let kind = EmitterKind::Spot {
        to_world,
        intensity: Rgb::WHITE,
        cutoff_degrees: degrees,
        beam_degrees: degrees,
        texture: None,
    };
    sketch.0.emitters.push(EmitterDescription { name: "spot".into(), kind });
    sketch
}

/// Side of the square on the floor that a pixel sees.
fn pixel() -> f64 {
    2.0 * 5.0 * 2.5f64.to_radians().tan() / 16.0
}

/// Reflected flux over what there is of it, after some passes, for spots all over a few pixels.
fn share_of_flux(degrees: f64, base: &RenderSettings, passes: &[u32], side: u32) -> Vec<(f64, f64)> {
    let solid_angle = 4.0 * std::f64::consts::PI * (0.5 * degrees.to_radians()).sin().powi(2);
    // The mean over the picture.
    let expected = solid_angle * 0.5 / std::f64::consts::PI / (16.0 * pixel()).powi(2);
    let mut shares = vec![Vec::new(); passes.len()];
    for i in 0..side * side {
        let place = |k: u32| pixel() * (3.7 * (f64::from(k) + 0.5) / f64::from(side) - 1.9);
        let mut render = spot(degrees, place(i % side), place(i / side)).render(base.clone(), 0);
        for (shares, passes) in shares.iter_mut().zip(passes) {
            let done = render.passes() as u32;
            super::advance(&mut render, passes - done);
            let image = render.image();
            let mean = image.pixels.iter().map(|p| f64::from(p.g)).sum::<f64>() / image.pixels.len() as f64;
            shares.push(mean / expected);
        }
    }
    shares.iter().map(|shares| mean_and_sigma(shares)).collect()
}

/// Over many places of a beam that falls between the eye samples none of its flux is lost, however long radii may have shrunk and
/// by whatever rule; without the smallest radius it hangs on single samples.
#[test]
fn a_beam_between_the_eye_samples_loses_no_flux() {
    for (radius_rule, side) in [(RadiusRule::Global, 8), (RadiusRule::Adaptive, 18)] {
        let base = RenderSettings {
            samples_per_pixel: number(4),
            ppm: PpmSettings { radius_rule, ..settings(40, 7).ppm },
            ..settings(40, 7)
        };
        for (share, sigma) in share_of_flux(0.1, &base, &[8, 128, 1024], side) {
            assert!((share - 1.0).abs() < 0.03 && sigma < 0.02, "{radius_rule:?}: {share} ± {sigma}");
        }
    }
    // Where radii shrink by what each disc finds, those at the rim of light stay wider than those within, and flux is gained
    // around anything about as wide as the radius: 5 to 16 % for the beam above. A narrower one tells of the smallest radius alone.
    let radius_rule = RadiusRule::Local;
    let base = RenderSettings {
        samples_per_pixel: number(4),
        ppm: PpmSettings { radius_rule, ..settings(40, 7).ppm },
        ..settings(40, 7)
    };
    for (share, sigma) in share_of_flux(0.001, &base, &[8, 128, 1024], 14) {
        assert!((share - 1.0).abs() < 0.03 && sigma < 0.02, "{radius_rule:?}: {share} ± {sigma}");
    }
    let base = RenderSettings {
        samples_per_pixel: number(4),
        ppm: PpmSettings { radius_floor: RadiusFloor::NONE, ..settings(40, 7).ppm },
        ..settings(40, 7)
    };
    let (_, bare) = share_of_flux(0.1, &base, &[256], 10)[0];
    assert!(bare > 0.03, "the test can tell: {bare}");
}

/// What the smallest radius smears is bias, and the claimed error covers it.
#[test]
fn the_error_of_a_beam_that_is_smeared_over_its_surroundings_is_claimed() {
    for radius_rule in RadiusRule::ALL {
        let base = RenderSettings {
            samples_per_pixel: number(4),
            error: true,
            ppm: PpmSettings { radius_rule, ..settings(2000, 3).ppm },
            ..settings(2000, 3)
        };
        let (mut truth2, mut high2) = (0.0, 0.0);
        for i in 0..36 {
            let place = |k: u32| pixel() * (f64::from(k) / 6.0 + 0.07);
            let sketch = spot(0.1, place(i % 6), place(i / 6));
            let render = sketch.render(base.clone(), 24);
            // By shadow rays the same eye samples see the beam as it is, or miss it.
            let exact = RenderSettings {
                ppm: PpmSettings { direct_light: DirectLight::ShadowRays, ..base.ppm },
                ..base.clone()
            };
            let exact = sketch.render(exact, 1).image();
            let image = render.image();
            let squares = image.pixels.iter().zip(&exact.pixels).map(|(a, b)| f64::from(a.g - b.g).powi(2));
            let error = render.error().expect("passes");
            truth2 += squares.sum::<f64>() / image.pixels.len() as f64 / error.mean_luminance.powi(2);
            high2 += error.high.powi(2);
            assert!(error.bias > error.noise, "it is bias: {error:?}");
        }
        assert!(truth2 < high2 && high2 < 16.0 * truth2, "{radius_rule:?}: {truth2} {high2}");
    }
}

/// A beam of a thirteenth of the spacing is met by hardly any sample: of what the error then is on average over places, a hundred times
/// what discs see, their photons tell.
#[test]
fn the_error_counts_on_beams_that_hardly_a_sample_meets() {
    let degrees = 0.02f64;
    for radius_rule in RadiusRule::ALL {
        let base = RenderSettings {
            samples_per_pixel: number(4),
            error: true,
            ppm: PpmSettings { radius_rule, ..settings(2000, 3).ppm },
            ..settings(2000, 3)
        };
        for i in 0..4u32 {
            let place = |k: u32| pixel() * (f64::from(k) / 2.0 + 0.13);
            let render = spot(degrees, place(i % 2), place(i / 2)).render(base.clone(), 24);
            let error = render.error().expect("passes");
            // In pixels; of four samples each that the beam meets makes its pixel a quarter as bright as the beam.
            let area = std::f64::consts::PI * (3.0 * degrees.to_radians().tan() / pixel()).powi(2);
            let beam = 0.5 / std::f64::consts::PI / 9.0;
            let truth2 = area * beam * beam / 4.0 / 256.0 / error.mean_luminance.powi(2);
            let share = error.high.powi(2) / truth2;
            assert!((0.8..20.0).contains(&share), "{radius_rule:?}, place {i}: {share}, {error:?}");
            assert!(error.is_of_narrow_light(), "{error:?}");
        }
    }
}
