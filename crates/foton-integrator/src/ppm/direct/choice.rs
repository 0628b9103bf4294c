//! Whether shadow rays bring direct light: they do where most of them are not in vain, and where no light is a narrow beam.
//!
//! Photons find openings by themselves, and each serves all discs around it; a ray serves one hit point, and behind a small opening
//! most rays are blocked. So a pilot lights some hit points twice: the squared difference is what one visit's noise is.

use std::num::NonZeroU32;

use foton_math::{Cancel, Purpose, Rgb, Stream};
use foton_scene::{Emitter, Scene};
use foton_transport::camera_paths::HitPoint;
use foton_transport::direct_light::{Lights, Receiver, SCRAMBLES, Scramble};

use crate::ppm::eye_samples::eye_pass;
use crate::ppm::settings::DirectLight;
use crate::settings::RenderSettings;

/// Pixels of the pilot, spread evenly.
const PIXELS: u64 = 1024;

/// The variance of a hit point's light in one visit, over its squared mean, up to which shadow rays bring it.
const NOISIEST: f64 = 8.0;

/// A spot of a smaller half angle is a beam, in radians.
const BEAM: f32 = 0.0175;

/// Whether shadow rays bring direct light. It depends on scene and settings alone.
pub(crate) fn by_shadow_rays(scene: &Scene, settings: &RenderSettings) -> bool {
    match settings.ppm.direct_light {
        DirectLight::Photons => false,
        DirectLight::ShadowRays => true,
        DirectLight::Auto => {
            !scene.emitters().iter().any(is_beam) && noise(scene, &Lights::new(scene), settings) <= NOISIEST
        }
    }
}

/// Whether an emitter's light is so narrow that it may fall between eye samples, which stand still: discs around them find it.
fn is_beam(emitter: &Emitter) -> bool {
    emitter.is_delta() && emitter.extent().is_some_and(|extent| extent.normals + extent.reach < BEAM)
}

/// The variance of a visit over the squared mean, both over hit points.
pub(super) fn noise(scene: &Scene, lights: &Lights, settings: &RenderSettings) -> f64 {
    let sensor = &scene.sensors()[settings.sensor];
    let pixels = u64::from(sensor.width) * u64::from(sensor.height);
    // The same for all seeds.
    let one_sample = RenderSettings { samples_per_pixel: NonZeroU32::MIN, seed: 0, ..settings.clone() };
    let pass = eye_pass(scene, &one_sample, settings.max_depth_in(scene), Purpose::Pilot);
    let n = pixels.min(PIXELS);
    let found = pass.follow((0..n).map(|i| (i * pixels / n) as u32), &Cancel::default());
    let (mut square, mut mean) = (0.0, 0.0);
    for (i, point) in found.hit_points.iter().enumerate() {
        let is_specular = point.gloss.is_some_and(|g| found.gloss[g.get()].specular);
        if point.remaining_edges < 1 || is_specular {
            continue;
        }
        let mut stream = Stream::new(0, Purpose::Pilot, 1, i as u64);
        let [a, b] = [(); 2].map(|()| light(scene, lights, point, &mut stream));
        square += 0.5 * (a - b) * (a - b);
        mean += 0.5 * (a + b);
    }
    let points = found.hit_points.len().max(1) as f64;
    match mean {
        _ if mean > 0.0 => square * points / (mean * mean),
        // Nothing of what rays look for has been found.
        _ if lights.rays() > 0 => f64::INFINITY,
        _ => 0.0,
    }
}

/// What a visit finds at a hit point, in luminance, as if it were Lambertian.
fn light(scene: &Scene, lights: &Lights, point: &HitPoint, stream: &mut Stream) -> f64 {
    let scrambles: [Scramble; SCRAMBLES] =
        std::array::from_fn(|_| std::array::from_fn(|_| stream.next_bits()));
    let at = Receiver {
        origin: point.origin(),
        normal: point.shading_normal,
        edges: u32::from(point.remaining_edges),
    };
    let mut sum = Rgb::BLACK;
    let mut rays = 0;
    lights.fixed(scene, &at, &mut rays, |arrival| sum += arrival.irradiance);
    lights.sample(scene, &at, (0, &scrambles), &mut rays, |arrival| sum += arrival.irradiance);
    let light = f64::from((point.weight * sum).luminance());
    if light.is_finite() { light } else { 0.0 }
}
