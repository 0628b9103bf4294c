//! Guided emission: the same light as without, and less noise where most photons would land unseen.

use std::num::NonZeroU32;
use std::path::Path;
use std::sync::Arc;

use foton_format::{Options, open};
use foton_integrator::{Cancel, DirectLight, PpmSettings, Render, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::DVec3;
use foton_scene::Scene;

const ASSETS: [&str; 7] =
    ["box-spheres", "cornell-diffuse", "cornell-spheres", "furnace", "glass-and-ring", "pool", "ring"];

fn asset(name: &str) -> Arc<Scene> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../assets/{name}/scene.xml"));
    let mut scene = open(&path, &Options::default()).expect("a sound file").description;
    let sensor = &mut scene.sensors[0];
    (sensor.width, sensor.height) = (30, 20);
    Arc::new(Scene::build(&scene).expect("a sound scene"))
}

/// Luminance by pixel, under several photon seeds over the same eye samples.
fn luminances(scene: &Arc<Scene>, guided: bool, passes: u32, seeds: u64) -> Vec<Vec<f64>> {
    let photons = NonZeroU32::new(20_000).expect("above 0");
    let ppm = PpmSettings {
        photons_per_pass: photons,
        first_pass: photons,
        guided,
        direct_light: DirectLight::Photons,
        ..PpmSettings::default()
    };
    let of = |seed| {
        let settings = RenderSettings { photon_seed: Some(seed), ppm, ..RenderSettings::default() };
        let cancel = Cancel::default();
        let mut render =
            Render::start(Arc::clone(scene), settings, &mut |_| (), &cancel).expect("not cancelled");
        for _ in 0..passes {
            render.advance(&mut |_| (), &cancel).expect("a pass");
        }
        render.image().pixels.iter().map(|p| f64::from(p.luminance())).collect()
    };
    (1..=seeds).map(of).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The variance between seeds, the mean over pixels.
fn noise(images: &[Vec<f64>]) -> f64 {
    let pixels = images[0].len();
    let of_pixel = |pixel: usize| {
        let values: Vec<f64> = images.iter().map(|image| image[pixel]).collect();
        foton_tests::mean_and_sigma(&values).1.powi(2)
    };
    (0..pixels).map(of_pixel).sum::<f64>() / pixels as f64
}

#[test]
fn means_are_the_same_with_and_without() {
    for name in ASSETS {
        let scene = asset(name);
        let of = |guided| {
            let means: Vec<f64> = luminances(&scene, guided, 3, 8).iter().map(|image| mean(image)).collect();
            foton_tests::mean_and_sigma(&means)
        };
        let ((with, sigma), (without, other)) = (of(true), of(false));
        // Radii follow the photons that are found, and bias the radii: a little of the mean besides.
        let allowed = 3.0 * sigma.hypot(other) + 0.004 * without;
        assert!((with - without).abs() < allowed, "{name}: {with} ± {sigma}, {without} ± {other}");
    }
}

#[test]
fn noise_falls_where_most_photons_are_not_seen() {
    let scene = asset("ring");
    let [with, without] = [true, false].map(|guided| noise(&luminances(&scene, guided, 5, 6)));
    assert!(with < 0.5 * without, "{with} for {without}");
}

/// In a furnace that emits 1 and reflects half of what arrives, radiance is 2 everywhere.
#[test]
fn the_error_is_known_with_guidance_too() {
    let photons = NonZeroU32::new(10_000).expect("above 0");
    let settings = |seed| RenderSettings {
        seed,
        error: true,
        ppm: PpmSettings { photons_per_pass: photons, radius: Some(0.1), ..PpmSettings::default() },
        ..RenderSettings::default()
    };
    let walls = foton_tests::grey(0.5);
    let sketch = foton_tests::Sketch::default()
        .camera(DVec3::ZERO, -DVec3::Z, 60.0, 32)
        .room(walls, Some(Rgb::splat(1.0)))
        .sphere(DVec3::new(0.5, 0.5, -0.2), 0.2, foton_tests::glass(1.5), None);
    for seed in 0..3 {
        let render = sketch.render(settings(seed), 24);
        let error = render.error().expect("passes");
        let image = render.image();
        let squares = image.pixels.iter().map(|p| (f64::from(p.luminance()) - 2.0).powi(2));
        // Relative to what is reflected.
        let truth = (squares.sum::<f64>() / 1024.0).sqrt();
        assert!(error.low < truth && truth < error.high, "{error:?}, true {truth}");
        assert!((error.total / truth - 1.0).abs() < 0.3, "{error:?}, true {truth}");
    }
}

#[test]
fn noise_stays_where_guidance_has_nothing_to_gain() {
    let scene = asset("furnace");
    let [with, without] = [true, false].map(|guided| noise(&luminances(&scene, guided, 5, 6)));
    assert!(with < 1.2 * without, "{with} for {without}");
}
