//! A scene of pbrt and the same scene of Mitsuba, written by hand: they render alike.

use std::num::NonZeroU32;
use std::path::Path;
use std::sync::Arc;

use foton_film::Image;
use foton_format::{Options, open};
use foton_integrator::{Cancel, Method, PpmSettings, Render, RenderSettings};
use foton_scene::Scene;

fn rendered(file: &str, method: Method) -> Image {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/pbrt").join(file);
    let opened = open(&path, &Options::default()).expect("a sound file");
    assert_eq!(opened.warnings, [], "{file}");
    let scene = Arc::new(Scene::build(&opened.description).expect("a sound scene"));
    let number = |n| NonZeroU32::new(n).expect("above 0");
    let photons = number(1 << 17);
    let ppm = PpmSettings { photons_per_pass: photons, first_pass: photons, ..PpmSettings::default() };
    let samples = if method == Method::Path { 16 } else { 8 };
    let settings =
        RenderSettings { method, samples_per_pixel: number(samples), ppm, ..RenderSettings::default() };
    let cancel = Cancel::default();
    let mut render = Render::start(scene, settings, &mut |_| (), &cancel).expect("started");
    for _ in 0..8 {
        render.advance(&mut |_| (), &cancel).expect("a pass");
    }
    render.image()
}

/// Means of tiles of 16 by 16 pixels.
fn tiles(image: &Image) -> Vec<f64> {
    let across = image.width as usize / 16;
    let mut tiles = vec![0.0; across * (image.height as usize / 16)];
    for (i, pixel) in image.pixels.iter().enumerate() {
        let (x, y) = (i % image.width as usize / 16, i / image.width as usize / 16);
        tiles[y * across + x] += f64::from(pixel.luminance()) / 256.0;
    }
    tiles
}

#[test]
fn a_scene_of_pbrt_renders_as_its_twin() {
    for method in [Method::Ppm, Method::Path] {
        let [pbrt, twin] = ["twin.pbrt", "twin.xml"].map(|file| tiles(&rendered(file, method)));
        let [a, b] = [&pbrt, &twin].map(|tiles| tiles.iter().sum::<f64>());
        assert!((a / b - 1.0).abs() < 0.01, "{method:?}: {a} is not {b}");
        // Caustics of glass are noisy; a mirrored picture or a lamp at another place is off by far more.
        let mean = b / twin.len() as f64;
        for (i, (a, b)) in pbrt.iter().zip(&twin).enumerate() {
            assert!((a - b).abs() < 0.03 * (b + mean), "{method:?}, tile {i}: {a} is not {b}");
        }
    }
}
