//! Motion blur: an image of what moves is the mean of images of what stands still, at all times while the shutter is open.

use std::num::NonZeroU32;
use std::sync::Arc;

use foton_integrator::{Cancel, Method, PpmSettings, Render, RenderSettings};
use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::Scene;
use foton_scene::description::{Keyframes, SceneDescription};
use foton_tests::{Sketch, glass, grey};

const SHUTTER: [f64; 2] = [0.25, 0.75];

/// A floor, a glass ball and a chalk ball over it, a lamp above. The balls fly past each other, and the camera sinks.
fn flight() -> SceneDescription {
    let mut scene = Sketch::default()
        .camera(DVec3::new(0.0, 3.0, 2.5), DVec3::ZERO, 40.0, 24)
        .rectangle(DVec3::ZERO, DVec3::new(0.0, 0.0, 2.0), DVec3::new(2.0, 0.0, 0.0), grey(0.7), None)
        .sphere(DVec3::new(0.0, 0.7, -0.4), 0.4, glass(1.5), None)
        .sphere(DVec3::new(0.0, 0.4, 0.5), 0.3, grey(0.6), None)
        .sphere(DVec3::new(0.0, 2.0, 0.0), 0.5, grey(0.0), Some(Rgb::splat(5.0)))
        .0;
    let shift = |by: DVec3| DAffine3::from_translation(by);
    let path =
        |from: DVec3, to: DVec3| Keyframes::new(vec![(0.0, shift(from)), (1.0, shift(to))]).expect("sound");
    for (shape, reach) in [(1, 1.0), (2, -1.2)] {
        let keyframes = path(DVec3::X * -reach, DVec3::X * reach);
        scene.shapes[shape].to_world = keyframes.all()[0].1;
        scene.motion.shapes.insert(shape, keyframes);
    }
    let stands = scene.sensors[0].to_world;
    let sunk = shift(DVec3::Y * -0.4) * stands;
    scene.motion.sensors.insert(0, Keyframes::new(vec![(0.0, stands), (1.0, sunk)]).expect("sound"));
    scene.motion.shutters.insert(0, SHUTTER);
    scene
}

fn render(scene: Scene, method: Method, seed: u64, passes: u32) -> Render {
    let photons = NonZeroU32::new(20_000).expect("above 0");
    let settings = RenderSettings {
        method,
        seed,
        samples_per_pixel: method.default_samples(),
        ppm: PpmSettings { photons_per_pass: photons, first_pass: photons, ..PpmSettings::default() },
        ..RenderSettings::default()
    };
    let cancel = Cancel::default();
    let mut render = Render::start(Arc::new(scene), settings, &mut |_| (), &cancel).expect("started");
    for _ in 0..passes {
        render.advance(&mut |_| (), &cancel).expect("a pass");
    }
    render
}

/// Luminance by blocks of 4 × 4 pixels.
fn blocks(render: &Render) -> Vec<f64> {
    let image = render.image();
    let across = image.width as usize / 4;
    let mut blocks = vec![0.0; across * across];
    for (pixel, light) in image.pixels.iter().enumerate() {
        let (x, y) = (pixel % image.width as usize, pixel / image.width as usize);
        blocks[y / 4 * across + x / 4] += f64::from(light.luminance()) / 16.0;
    }
    blocks
}

fn root_mean_square(of: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = of.fold((0.0, 0.0), |(sum, count), x| (sum + x * x, count + 1.0));
    f64::sqrt(sum / count)
}

#[test]
fn what_moves_is_the_mean_of_what_stands_still() {
    let moving = flight();
    for method in Method::ALL.into_iter().filter(|m| m.blurs_motion() && *m != Method::Whitted) {
        // Photons of a pass are worth more than samples.
        let few = if method.has_photons() { 8 } else { 64 };
        let blurred = blocks(&render(Scene::build(&moving).expect("sound"), method, 1, 32 * few));
        let times = 32u32;
        let mut mean = vec![0.0; blurred.len()];
        for i in 0..times {
            let share = (f64::from(i) + 0.5) / f64::from(times);
            let now = moving.at(SHUTTER[0] + share * (SHUTTER[1] - SHUTTER[0]));
            let still = blocks(&render(Scene::build(&now).expect("sound"), method, 100 + u64::from(i), few));
            mean.iter_mut().zip(still).for_each(|(sum, light)| *sum += light / f64::from(times));
        }
        let size = root_mean_square(mean.iter().copied());
        let apart = root_mean_square(blurred.iter().zip(&mean).map(|(a, b)| a - b)) / size;
        let frozen = blocks(&render(Scene::build(&moving.at(0.5)).expect("sound"), method, 1, 32 * few));
        let without = root_mean_square(frozen.iter().zip(&mean).map(|(a, b)| a - b)) / size;
        assert!(apart < 0.05 && without > 4.0 * apart, "{}: {apart} {without}", method.name());
    }
}

#[test]
fn threads_and_breaks_change_no_bit_of_what_moves() {
    for method in Method::ALL.into_iter().filter(|m| m.blurs_motion()) {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| render(Scene::build(&flight()).expect("sound"), method, 3, 4).save())
        };
        assert!(on(1) == on(3), "{}", method.name());
        let mut resumed = render(Scene::build(&flight()).expect("sound"), method, 3, 0);
        resumed
            .restore(&render(Scene::build(&flight()).expect("sound"), method, 3, 2).save())
            .expect("its own");
        for _ in 0..2 {
            resumed.advance(&mut |_| (), &Cancel::default()).expect("a pass");
        }
        assert!(resumed.save() == on(1), "{}", method.name());
    }
}

#[test]
fn what_stands_still_while_the_shutter_is_open_is_the_scene_as_it_is() {
    let mut still = flight();
    still.motion.shutters.insert(0, [0.5, 0.5]);
    let scene = Scene::build(&still).expect("sound");
    assert!(!scene.blurs(0));
    let bits = |scene| render(scene, Method::Path, 3, 2).save();
    assert!(bits(scene) != bits(Scene::build(&flight()).expect("sound")));
}
