//! What a render will take, estimated before it is taken.

use foton_math::{Aabb, Cancel, Purpose, Rgb};
use foton_scene::Scene;
use foton_transport::camera_paths::{Gloss, HitPoint};
use foton_transport::light_paths::{Batch, MAX_PHOTONS};
use foton_transport::photon_map::{LANES, MAX_CELLS, Packet, Photon, PhotonMap};

use super::adaptive::RadiusStatistics;
use super::arrived::BatchSums;
use super::direct::{Direct, by_shadow_rays};
use super::eye_samples::eye_pass;
use super::guidance::Guidance;
use super::hit_points::{Irradiance, ShadowOrigin};
use super::lobes::lobe_use;
use super::radiance::Radiance;
use super::settings::RadiusRule;
use super::statistics::Statistics;
use crate::error::ErrorSums;
use crate::memory::{FILL, MemoryEstimate};
use crate::settings::RenderSettings;
use crate::sppm::Renewal;

/// Photons stored per photon emitted, a bound for closed scenes of high albedo: measured 2.5 to 3.5.
const STORED_PER_EMITTED: f64 = 4.0;

/// Pixels of the pilot, spread evenly.
const PILOT_PIXELS: u32 = 4096;

/// Estimates a render on so many threads, from a pilot of the eye pass over some of the pixels.
pub(crate) fn memory(scene: &Scene, settings: &RenderSettings, threads: usize) -> MemoryEstimate {
    let sensor = &scene.sensors()[settings.sensor];
    let pixels = u64::from(sensor.width) * u64::from(sensor.height);
    let sampled = pixels.min(u64::from(PILOT_PIXELS));
    let one_sample = RenderSettings { samples_per_pixel: std::num::NonZeroU32::MIN, ..settings.clone() };
    let pass = eye_pass(scene, &one_sample, settings.max_depth_in(scene), Purpose::Pilot);
    let pilot = pass.follow((0..sampled).map(|i| (i * pixels / sampled) as u32), &Cancel::default());
    let (found, glossy) = (pilot.hit_points.len(), pilot.gloss.len());
    let samples = pixels as f64 * f64::from(settings.samples_per_pixel.get());
    let hit_points = found as f64 / sampled as f64 * samples;
    let glossy = glossy as f64 / sampled as f64 * samples;
    let layers = if settings.layers { 3.0 } else { 1.0 };
    let shadow = by_shadow_rays(scene, settings);
    let shaded = lobe_use(scene).shading_normals;
    let adapts = settings.error || settings.ppm.radius_rule == RadiusRule::Adaptive;
    let slot = (size_of::<Packet>() + size_of::<Aabb>()) / LANES
        + size_of::<Statistics>()
        + size_of::<f32>()
        + if shadow { size_of::<ShadowOrigin>() } else { 0 }
        + if settings.error { ErrorSums::BYTES_PER_HIT_POINT } else { 0 }
        + if adapts { size_of::<RadiusStatistics>() } else { 0 }
        + if shaded { 3 * size_of::<f32>() } else { 0 };
    let slot = slot as f64 + layers * size_of::<Irradiance<1>>() as f64;
    let per_pixel = Radiance::BYTES_PER_PIXEL + if settings.layers { Radiance::BYTES_BY_CLASS } else { 0 };
    let renews = settings.method.renews_eye_samples();
    let per_pixel = per_pixel
        + if renews { Renewal::bytes_per_pixel(adapts) } else { 0 }
        + if shadow && !renews { Direct::BYTES_PER_PIXEL } else { 0 }
        + if settings.error { ErrorSums::bytes_per_pixel(renews) } else { 0 };
    let photon = 2.0 * size_of::<Photon>() as f64 + size_of::<u32>() as f64;
    let pass = settings.ppm.photons_per_pass.get().into();
    let batches = Batch::all(pass, MAX_PHOTONS);
    let batch = batches.map(|b| b.photons(pass)).max().unwrap_or(0);
    let guidance = if settings.ppm.guided { Guidance::max_bytes(pass, scene.emitters().len()) } else { 0 };
    let slot = slot + if batch < pass { size_of::<BatchSums<1>>() as f64 } else { 0.0 };
    let hit_point_bytes = hit_points * (slot / FILL + (size_of::<u32>() + size_of::<Rgb>()) as f64)
        + glossy * size_of::<Option<Gloss>>() as f64 / FILL;
    // Found hit points twice while chunks are joined, or once beside the points that are being grouped.
    let layout_bytes = 2.0 * (hit_points * size_of::<HitPoint>() as f64 + glossy * size_of::<Gloss>() as f64);
    MemoryEstimate {
        hit_points,
        pixels: pixels as f64,
        scene_bytes: scene.bytes() as f64,
        // Where each pass lays hit points out, those of the pass before stay until then, and so does room for photons.
        hit_point_bytes: if renews { 2.0 * hit_point_bytes + layout_bytes } else { hit_point_bytes },
        pixel_bytes: pixels as f64 * (per_pixel + 2 * size_of::<u32>() + size_of::<Rgb>()) as f64,
        photon_bytes: batch as f64 * STORED_PER_EMITTED * photon
            + (PhotonMap::counter_bytes(batch, MAX_CELLS, threads) + guidance) as f64,
        layout_bytes: if renews { 0.0 } else { layout_bytes },
    }
}
