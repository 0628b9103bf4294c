//! A batch of photons: from emitters, from surface to surface, stored wherever light spreads near a hit point.

use std::ops::Range;

use foton_math::glam::Vec3;
use foton_math::{Purpose, Ray, Rgb, Stream};
use foton_scene::{Lobe, Scene, Surface, Transport};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::batch::Batch;
use crate::cancel::{Cancel, Cancelled};
use crate::eye_pass::{leaves_wrongly, on_the_right_side, shading_normal_towards};
use crate::grid::Grid;
use crate::ledger::{Ledger, Loss, energy, left_out};
use crate::light_use::LightUse;
use crate::photon::{PathClass, Photon};
use crate::settings::DirectLight;

/// Photons that one task emits.
const CHUNK: u64 = 4096;

/// Numbers that each edge of a path may draw, and that come before the first.
const DIMENSIONS: u64 = 8;

/// |ω·n_g| counts as at least this in the shading normals' correction.
pub(crate) const SMALLEST_COSINE: f32 = 1e-2;

/// Everything a photon pass needs to know.
pub(crate) struct PhotonPass<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) grid: &'a Grid,
    pub(crate) direct_light: DirectLight,
    /// Whether any hit point asks where a photon came from.
    pub(crate) directions: bool,
    pub(crate) arch: Arch,
    /// Longest whole path in edges; a photon path is at least one shorter.
    pub(crate) max_depth: u32,
    pub(crate) seed: u64,
    pub(crate) pass: u64,
    /// Photons of the whole pass.
    pub(crate) photons: u64,
    /// Which of them are emitted now.
    pub(crate) batch: Batch,
}

/// What one task emits. Kept between passes, so that no pass allocates once they have grown.
#[derive(Default)]
pub(crate) struct Chunk {
    pub(crate) photons: Vec<Photon>,
    /// Number of the cell of each photon.
    pub(crate) cells: Vec<u32>,
    pub(crate) ledger: Ledger,
    pub(crate) rays: u64,
    /// By emitter.
    pub(crate) lights: Vec<LightUse>,
    /// By material.
    pub(crate) losses: Vec<Loss>,
}

/// A photon on its way.
#[derive(Clone, Copy)]
struct Flight {
    ray: Ray,
    power: Rgb,
    class: PathClass,
    /// Edges up to the end of `ray`.
    edges: u32,
}

/// The work on a chunk, compiled for each instruction set; the best that the machine has is taken. Everything that each photon
/// runs through is inlined into it. No instruction set changes a result.
struct Follow<'a, 'b> {
    pass: &'a PhotonPass<'b>,
    range: Range<u64>,
    chunk: &'a mut Chunk,
}

impl WithSimd for Follow<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { pass, range, chunk } = self;
        for index in pass.batch.indices(range) {
            let stream = Stream::new(pass.seed, Purpose::Photon, pass.pass, index);
            let Some((emitter, flight)) = pass.emit(index, stream.clone()) else { continue };
            if !flight.power.is_finite() {
                chunk.ledger.dropped += 1;
                chunk.lights[emitter].emitted += 1;
                chunk.lights[emitter].dropped += 1;
                continue;
            }
            let stored = chunk.photons.len();
            pass.follow(flight, &stream, chunk);
            chunk.lights[emitter].count(chunk.photons.len() > stored);
        }
    }
}

impl PhotonPass<'_> {
    /// Emits and follows all photons of the batch into `chunks`, the same ones for any number of threads.
    pub(crate) fn shoot(&self, chunks: &mut Vec<Chunk>, cancel: &Cancel) -> Result<(), Cancelled> {
        let photons = self.batch.photons(self.photons);
        chunks.resize_with(photons.div_ceil(CHUNK) as usize, Chunk::default);
        chunks.par_iter_mut().enumerate().try_for_each(|(i, chunk)| {
            cancel.check()?;
            let first = i as u64 * CHUNK;
            chunk.photons.clear();
            chunk.cells.clear();
            chunk.ledger = Ledger::default();
            chunk.rays = 0;
            chunk.lights.clear();
            chunk.lights.resize(self.scene.emitters().len(), LightUse::default());
            chunk.losses.clear();
            chunk.losses.resize(self.scene.materials().len(), Loss::default());
            let range = first..photons.min(first + CHUNK);
            self.arch.dispatch(Follow { pass: self, range, chunk });
            Ok(())
        })
    }

    #[inline(always)]
    fn follow(&self, mut flight: Flight, stream: &Stream, chunk: &mut Chunk) {
        chunk.ledger.emitted += energy(flight.power);
        loop {
            chunk.rays += 1;
            let Some(surface) = self.scene.nearest(flight.ray) else {
                chunk.ledger.escaped += energy(flight.power);
                return;
            };
            let mut numbers = stream.from_dimension(u64::from(flight.edges) * DIMENSIONS);
            match self.scatter(flight, &surface, &mut numbers, chunk) {
                Some(next) => flight = next,
                None => return,
            }
        }
    }

    /// The index of the emitter, and the photon as it leaves it.
    fn emit(&self, index: u64, mut numbers: Stream) -> Option<(usize, Flight)> {
        // Stratified over the pass: each emitter gets its share of photons up to one.
        let u = (index as f64 + f64::from(numbers.next_1d())) / self.photons as f64;
        let (index, probability) = self.scene.choose_emitter(u)?;
        let emitter = &self.scene.emitters()[index];
        let start = emitter.emit(numbers.next_1d(), numbers.next_2d(), numbers.next_2d());
        let flight = Flight {
            ray: Ray::new(start.origin, start.direction),
            power: start.power / probability as f32,
            class: PathClass::Direct,
            edges: 1,
        };
        Some((index, flight))
    }

    /// Stores the photon where light spreads, and sends it on.
    #[inline(always)]
    fn scatter(
        &self,
        flight: Flight,
        surface: &Surface,
        numbers: &mut Stream,
        chunk: &mut Chunk,
    ) -> Option<Flight> {
        let wo = -flight.ray.direction;
        let outward = wo.dot(surface.normal) > 0.0;
        let Some(scattering) = self.scene.scattering(surface, outward) else {
            chunk.ledger.absorbed += energy(flight.power);
            return None;
        };
        if scattering.bsdf.keeps() {
            self.store(&flight, surface, wo, chunk);
        }
        let normal = shading_normal_towards(surface, wo);
        let frame = self.scene.shading_frame(surface, normal);
        let local = frame.to_local(wo);
        let sample = scattering.sample(local, Transport::Importance, numbers.next_1d(), numbers.next_2d());
        let Some(sample) = sample else {
            chunk.ledger.absorbed += energy(flight.power);
            return None;
        };
        let scattered = flight.power * sample.weight;
        let direction = frame.to_outer(sample.wi).normalize();
        let reflects = sample.wi.z * local.z > 0.0;
        let followed = sample.lobe == Lobe::Followed;
        let correction = if !followed && leaves_wrongly(surface, wo, direction, reflects) {
            0.0
        } else if sample.wi == -local {
            // Straight on, as if there were no surface.
            1.0
        } else {
            adjoint_correction(surface.normal, normal, wo, direction)
        };
        let corrected = scattered * correction;
        let material = self.scene.shapes()[surface.shape as usize].material as usize;
        if !corrected.is_finite() {
            // Dropped before it reaches a sum: one NaN would be all that is left of the image.
            chunk.ledger.dropped += 1;
            chunk.ledger.lost += energy(flight.power);
            chunk.losses[material].dropped += 1;
            return None;
        }
        chunk.ledger.absorbed += left_out(flight.power, sample.weight);
        if correction != 1.0 {
            chunk.ledger.shading_normals += left_out(scattered, Rgb::splat(correction));
        }
        if corrected.is_black() {
            return None;
        }
        if flight.edges + 1 >= self.max_depth {
            chunk.ledger.truncated += energy(corrected);
            chunk.losses[material].truncated += energy(corrected);
            return None;
        }
        let power = roulette(corrected, flight.power, numbers.next_1d(), &mut chunk.ledger)?;
        let direction =
            if followed { on_the_right_side(surface, wo, direction, reflects) } else { direction };
        Some(Flight {
            ray: Ray::new(surface.ray_origin(direction), direction),
            power,
            class: flight.class.scattered(followed),
            edges: flight.edges + 1,
        })
    }

    #[inline(always)]
    fn store(&self, flight: &Flight, surface: &Surface, wo: Vec3, chunk: &mut Chunk) {
        if flight.class == PathClass::Direct && self.direct_light == DirectLight::ShadowRays {
            return;
        }
        if let Some(cell) = self.grid.number(surface.position) {
            let normal = surface.normal * 1f32.copysign(wo.dot(surface.normal));
            let edges = flight.edges.min(255) as u8;
            let from = self.directions.then_some(wo);
            chunk.photons.push(Photon::new(
                surface.position,
                normal,
                from,
                flight.power,
                flight.class,
                edges,
            ));
            chunk.cells.push(cell);
        }
    }
}

/// |ωi·n_s| |ωo·n_g| / (|ωi·n_g| |ωo·n_s|) for light from `wo` scattered to `wi`: photons see the adjoint of a BSDF with
/// interpolated normals. `[VEA97]` section 5.3
fn adjoint_correction(n_g: Vec3, n_s: Vec3, wo: Vec3, wi: Vec3) -> f32 {
    if n_g == n_s {
        return 1.0;
    }
    let upper = wo.dot(n_s).abs() * wi.dot(n_g).abs();
    let lower = wo.dot(n_g).abs().max(SMALLEST_COSINE) * wi.dot(n_s).abs().max(SMALLEST_COSINE);
    upper / lower
}

/// Survival in proportion to the power that is left, so that all photons carry about the same.
fn roulette(power: Rgb, before: Rgb, u: f32, ledger: &mut Ledger) -> Option<Rgb> {
    let chance = power.max_component() / before.max_component();
    if chance >= 1.0 {
        return Some(power);
    }
    ledger.roulette += energy(power);
    if u >= chance {
        return None;
    }
    let survivor = power / chance;
    ledger.roulette -= energy(survivor);
    Some(survivor)
}
