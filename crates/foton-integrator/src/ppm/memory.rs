//! What a render will take, estimated before it is taken.

use foton_math::{Aabb, Cancel, Purpose, Rgb};
use foton_scene::Scene;
use foton_transport::camera_paths::{EyePaths, Gloss, HitPoint};
use foton_transport::guide::Cells;
use foton_transport::light_paths::{Batch, MAX_PHOTONS, PhotonPass};
use foton_transport::photon_map::{Grid, LANES, MAX_CELLS, Packet, Photon, PhotonMap};
use pulp::Arch;

use super::arrived::{BatchSums, Lanes, SlotMoments};
use super::direct::{Direct, by_shadow_rays};
use super::eye_samples::eye_pass;
use super::guidance::Guidance;
use super::hit_points::Irradiance;
use super::kept::{KeptRadius, KeptStatistics};
use super::laid_out::{discs, has_moments};
use super::lobes::{LOBE_POLICY, lobe_use};
use super::radiance::Radiance;
use crate::error::ErrorSums;
use crate::memory::{FILL, MemoryEstimate};
use crate::settings::RenderSettings;
use crate::sppm::Renewal;

/// Photons of the pilot.
const PILOT_PHOTONS: u64 = 4096;

/// Hit points for which a photon counts where hit points are many, about: those of a few pixels.
const HIT_POINTS_PER_PHOTON: f64 = 16.0;

/// Pixels of the pilot, spread evenly.
const PILOT_PIXELS: u32 = 4096;

/// Estimates a render on so many threads, from a pilot of the eye pass over some of the pixels, and one of a few photons.
pub(crate) fn memory(scene: &Scene, settings: &RenderSettings, threads: usize) -> MemoryEstimate {
    let sensor = &scene.sensors()[settings.sensor];
    let pixels = u64::from(sensor.width) * u64::from(sensor.height);
    let sampled = pixels.min(u64::from(PILOT_PIXELS));
    let one_sample = RenderSettings { samples_per_pixel: std::num::NonZeroU32::MIN, ..settings.clone() };
    let pass = eye_pass(scene, &one_sample, settings.max_depth_in(scene), Purpose::Pilot);
    let pilot = pass.follow((0..sampled).map(|i| (i * pixels / sampled) as u32), &Cancel::default());
    let each = pixels as f64 * f64::from(settings.samples_per_pixel.get()) / sampled as f64;
    let hit_points = pilot.hit_points.len() as f64 * each;
    let glossy = pilot.gloss.len() as f64 * each;
    let pass = u64::from(settings.ppm.photons_per_pass.get());
    let batch = Batch::all(pass, MAX_PHOTONS).map(|b| b.photons(pass)).max().unwrap_or(0);
    let slots = Slots::new((scene, settings), &pilot, hit_points, (pass, batch));
    let in_samples = hit_points * (size_of::<u32>() + size_of::<Rgb>()) as f64;
    let of_gloss = glossy * size_of::<Gloss>() as f64;
    let laid_out = hit_points * (slots.of_packet / FILL + slots.laid_out) + in_samples + of_gloss;
    let hit_point_bytes = laid_out + hit_points * slots.kept;
    let found = hit_points * size_of::<HitPoint>() as f64 + glossy * size_of::<Gloss>() as f64;
    // What is found is there beside what is laid out, without what hit points keep.
    let starting = found + hit_points * size_of::<u32>() as f64 + laid_out;
    let renews = settings.method.renews_eye_samples();
    let photon = 2.0 * size_of::<Photon>() as f64 + size_of::<u32>() as f64;
    let guidance = if settings.ppm.guided { Guidance::max_bytes(pass, scene.emitters().len()) } else { 0 };
    MemoryEstimate {
        hit_points,
        pixels: pixels as f64,
        scene_bytes: scene.bytes() as f64,
        // Where each pass lays hit points out, those of the pass before stay until then, and so does room for photons.
        hit_point_bytes: if renews { hit_point_bytes + starting } else { hit_point_bytes },
        pixel_bytes: pixels as f64 * of_pixel(scene, settings) as f64,
        photon_bytes: batch as f64 * stored_per_emitted(scene, settings, &pilot) * photon
            + (PhotonMap::counter_bytes(batch, MAX_CELLS, threads) + guidance) as f64,
        layout_bytes: if renews { 0.0 } else { (starting - hit_point_bytes).max(0.0) },
    }
}

/// Bytes a hit point, about.
struct Slots {
    /// Of packets, over the lanes of each.
    of_packet: f64,
    /// Of what else eye samples alone decide.
    laid_out: f64,
    /// Of statistics, and of what a pass brings.
    kept: f64,
}

impl Slots {
    /// Those of a render of so many hit points, with passes of so many photons in batches of so many.
    fn new(
        (scene, settings): (&Scene, &RenderSettings),
        pilot: &EyePaths,
        hit_points: f64,
        (pass, batch): (u64, u64),
    ) -> Self {
        let layers = if settings.layers { 3 } else { 1 };
        let of_packet = size_of::<Packet>() + size_of::<Aabb>() + size_of::<Lanes>() + size_of::<u32>();
        let laid_out = size_of::<f32>() + if by_shadow_rays(scene, settings) { size_of::<f32>() } else { 0 };
        let found = pilot.hit_points.len().max(1) as f64;
        let bent = pilot.hit_points.iter().filter(|h| h.shading_normal != h.normal).count() as f64 / found;
        let shading =
            if lobe_use(scene).shading_normals { bent * 3.0 * size_of::<f32>() as f64 } else { 0.0 };
        let moments = if settings.error { size_of::<SlotMoments>() } else { 0 };
        let brought = layers * size_of::<Irradiance<1>>() + moments;
        let sums = size_of::<BatchSums<1>>() + (layers - 1) * size_of::<Rgb>();
        let brought = if batch < pass { brought.max(sums) } else { brought };
        let lit = (HIT_POINTS_PER_PHOTON * pass as f64 / hit_points.max(1.0)).min(1.0);
        let radius = if has_moments(settings) { size_of::<KeptRadius>() } else { 0 };
        Self {
            of_packet: of_packet as f64 / LANES as f64 + shading,
            laid_out: laid_out as f64,
            kept: (size_of::<KeptStatistics>() + radius) as f64 + lit * brought as f64,
        }
    }
}

/// Bytes a pixel.
fn of_pixel(scene: &Scene, settings: &RenderSettings) -> usize {
    let renews = settings.method.renews_eye_samples();
    Radiance::BYTES_PER_PIXEL
        + if settings.layers { Radiance::BYTES_BY_CLASS } else { 0 }
        + if renews { Renewal::bytes_per_pixel(has_moments(settings)) } else { 0 }
        + if by_shadow_rays(scene, settings) && !renews { Direct::BYTES_PER_PIXEL } else { 0 }
        + if settings.error { ErrorSums::bytes_per_pixel(renews) } else { 0 }
        + 2 * size_of::<u32>()
        + size_of::<Rgb>()
}

/// Photons stored per photon emitted, wherever hit points are.
fn stored_per_emitted(scene: &Scene, settings: &RenderSettings, pilot: &EyePaths) -> f64 {
    let sources = scene.sources(&discs(&pilot.hit_points));
    let (cells, grid) = (Cells::unguided(&sources), Grid::everywhere());
    let max_depth = settings.max_depth_in(scene);
    let Some(batch) = Batch::all(PILOT_PHOTONS, MAX_PHOTONS).next().filter(|_| max_depth > 1) else {
        return 0.0;
    };
    let pass = PhotonPass {
        scene,
        sources: &sources,
        cells: &cells,
        training: None,
        grid: &grid,
        stores_direct: !by_shadow_rays(scene, settings),
        ends_where_light_spreads: false,
        policy: LOBE_POLICY,
        directions: false,
        arch: Arch::new(),
        max_depth,
        seed: 0,
        pass: 0,
        photons: PILOT_PHOTONS,
        batch,
    };
    let mut chunks = Vec::new();
    pass.begin(&mut chunks);
    // Neither of the two that may break this off is asked for.
    let _ = pass.shoot(&mut chunks, &Cancel::default(), &|| false);
    chunks.iter().map(|chunk| chunk.photons.len()).sum::<usize>() as f64 / PILOT_PHOTONS as f64
}
