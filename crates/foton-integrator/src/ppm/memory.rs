//! What a render will take, estimated before it is taken.

use std::fmt;

use foton_math::{Cancel, Purpose, Rgb};
use foton_scene::Scene;
use foton_transport::camera_paths::{Gloss, HitPoint};
use foton_transport::light_paths::{Batch, MAX_PHOTONS};
use foton_transport::photon_map::{LANES, MAX_CELLS, Packet, Photon, PhotonMap};

use super::adaptive::RadiusStatistics;
use super::direct::{Direct, by_shadow_rays};
use super::eye_samples::eye_pass;
use super::guidance::Guidance;
use super::hit_points::{Irradiance, ShadowOrigin};
use super::lobes::lobe_use;
use super::radiance::Radiance;
use super::settings::RadiusRule;
use super::slots::EarlierBatches;
use super::statistics::Statistics;
use crate::error::ErrorSums;
use crate::settings::RenderSettings;

/// Share of a packet's lanes that are used, measured on the shipped scenes: 0.8 to 0.95.
const FILL: f64 = 0.8;

/// Photons stored per photon emitted, a bound for closed scenes of high albedo: measured 2.5 to 3.5.
const STORED_PER_EMITTED: f64 = 4.0;

/// Pixels of the pilot, spread evenly.
const PILOT_PIXELS: u32 = 4096;

/// A render's memory, from a pilot of the eye pass over some of the pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MemoryEstimate {
    /// Hit points expected.
    pub hit_points: f64,
    /// Pixels.
    pub pixels: f64,
    /// Bytes for the scene and its tree.
    pub scene_bytes: f64,
    /// Bytes for hit points, their statistics and this pass's light.
    pub hit_point_bytes: f64,
    /// Bytes for images.
    pub pixel_bytes: f64,
    /// Bytes for the photons of a batch, their sorted copy, and the counters of the sort.
    pub photon_bytes: f64,
    /// Bytes while hit points are laid out, beyond those that stay.
    pub layout_bytes: f64,
}

/// The largest number of hit points, with room for the lanes of packets that stay empty: they are numbered by 32 bits.
const MAX_HIT_POINTS: f64 = FILL * u32::MAX as f64 * 0.9;

impl MemoryEstimate {
    /// Bytes of the program itself, measured from outside on a scene of nothing.
    pub const PROGRAM_BYTES: f64 = (16 << 20) as f64;

    /// Why the render is not to be started, where it would take more than `limit` bytes, or has more hit points or pixels than
    /// can be numbered; `None` where it may.
    #[must_use]
    pub fn refusal(&self, limit: Option<f64>) -> Option<String> {
        if self.hit_points.max(self.pixels) > MAX_HIT_POINTS {
            return Some(format!(
                "this render has {:.1} billion hit points in {:.1} billion pixels; {:.1} billion of either can be numbered",
                self.hit_points / 1e9,
                self.pixels / 1e9,
                MAX_HIT_POINTS / 1e9
            ));
        }
        let limit = limit.filter(|&limit| self.peak_bytes() > limit)?;
        Some(format!("this render needs about {self}; {:.0} MiB may be used", limit / f64::from(1 << 20)))
    }

    /// The largest number of bytes that are held at one time. Photons come after hit points have been laid out.
    #[must_use]
    pub fn peak_bytes(&self) -> f64 {
        let lasting = self.scene_bytes + self.hit_point_bytes + self.pixel_bytes;
        Self::PROGRAM_BYTES + lasting + self.photon_bytes.max(self.layout_bytes)
    }

    /// The largest number of bytes that are held at one time while another render of the scene, already under way, is kept.
    #[must_use]
    pub fn beside(&self, other: &Self) -> f64 {
        self.peak_bytes() + other.hit_point_bytes + other.pixel_bytes + other.photon_bytes
    }

    /// That of renders of one scene that share their photons ([`Variants`](crate::Variants)): each has hit points, pixels, and its share
    /// of the photons with their sorted copy; those are handed out from one more. `None` of none.
    #[must_use]
    pub fn together(all: &[Self]) -> Option<Self> {
        let first = all.first()?;
        let sum = |of: fn(&Self) -> f64| all.iter().map(of).sum::<f64>();
        Some(Self {
            hit_point_bytes: sum(|e| e.hit_point_bytes),
            pixel_bytes: sum(|e| e.pixel_bytes),
            photon_bytes: sum(|e| e.photon_bytes) + first.photon_bytes,
            ..*first
        })
    }

    /// Estimates a render on so many threads.
    #[must_use]
    pub fn pilot(scene: &Scene, settings: &RenderSettings, threads: usize) -> Self {
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
        let slot = size_of::<Packet>() / LANES
            + size_of::<Statistics>()
            + size_of::<f32>()
            + if shadow { size_of::<ShadowOrigin>() } else { 0 }
            + if settings.error { ErrorSums::BYTES_PER_HIT_POINT } else { 0 }
            + if adapts { size_of::<RadiusStatistics>() } else { 0 }
            + if shaded { 3 * size_of::<f32>() } else { 0 };
        let slot = slot as f64 + layers * size_of::<Irradiance<1>>() as f64;
        let per_pixel =
            Radiance::BYTES_PER_PIXEL + if settings.layers { Radiance::BYTES_BY_CLASS } else { 0 };
        let per_pixel = per_pixel + if shadow { Direct::BYTES_PER_PIXEL } else { 0 };
        let per_pixel = per_pixel + if settings.error { ErrorSums::BYTES_PER_PIXEL } else { 0 };
        let photon = 2.0 * size_of::<Photon>() as f64 + size_of::<u32>() as f64;
        let pass = settings.ppm.photons_per_pass.get().into();
        let batches = Batch::all(pass, MAX_PHOTONS);
        let batch = batches.map(|b| b.photons(pass)).max().unwrap_or(0);
        let guidance =
            if settings.ppm.guided { Guidance::max_bytes(pass, scene.emitters().len()) } else { 0 };
        let slot = slot + if batch < pass { EarlierBatches::bytes_per_slot(adapts) as f64 } else { 0.0 };
        Self {
            hit_points,
            pixels: pixels as f64,
            scene_bytes: scene.bytes() as f64,
            hit_point_bytes: hit_points * (slot / FILL + (size_of::<u32>() + size_of::<Rgb>()) as f64)
                + glossy * size_of::<Option<Gloss>>() as f64 / FILL,
            pixel_bytes: pixels as f64 * (per_pixel + 2 * size_of::<u32>() + size_of::<Rgb>()) as f64,
            photon_bytes: batch as f64 * STORED_PER_EMITTED * photon
                + (PhotonMap::counter_bytes(batch, MAX_CELLS, threads) + guidance) as f64,
            // Found hit points twice while chunks are joined, or once beside the points that are being grouped.
            layout_bytes: 2.0
                * (hit_points * size_of::<HitPoint>() as f64 + glossy * size_of::<Gloss>() as f64),
        }
    }
}

impl fmt::Display for MemoryEstimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mib = |bytes: f64| bytes / f64::from(1 << 20);
        write!(
            f,
            "{:.0} MiB: scene {:.0}, {:.2} M hit points {:.0} (and {:.0} while they are laid out), pixels {:.0}, photons {:.0}",
            mib(self.peak_bytes()),
            mib(self.scene_bytes),
            self.hit_points / 1e6,
            mib(self.hit_point_bytes),
            mib(self.layout_bytes),
            mib(self.pixel_bytes),
            mib(self.photon_bytes),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn renders_that_share_photons_share_the_scene_alone() {
        let one = MemoryEstimate {
            hit_points: 10.0,
            pixels: 5.0,
            scene_bytes: 1e9,
            hit_point_bytes: 1e6,
            pixel_bytes: 1e5,
            photon_bytes: 1e8,
            layout_bytes: 1e3,
        };
        let three = MemoryEstimate::together(&[one; 3]).expect("three");
        assert_eq!(three.peak_bytes(), MemoryEstimate::PROGRAM_BYTES + 1e9 + 3.0 * 1.1e6 + 4.0 * 1e8);
        assert_eq!(three.hit_points, one.hit_points, "each numbers its own");
        assert_eq!(MemoryEstimate::together(&[]), None);
    }
}
