//! A batch of photons: from emitters, from surface to surface, stored wherever light spreads near a hit point.

mod scatter;

pub(crate) use scatter::SMALLEST_COSINE;

use std::ops::Range;

use foton_math::{Purpose, Ray, Rgb, Stream};
use foton_scene::{Hit, Scene};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::batch::Batch;
use crate::cancel::{Cancel, Cancelled};
use crate::grid::Grid;
use crate::ledger::{Ledger, Loss, energy};
use crate::light_use::LightUse;
use crate::photon::{PathClass, Photon};
use crate::settings::DirectLight;

/// Photons that one task emits.
const CHUNK: u64 = 4096;

/// Photons followed side by side: few enough for the nearest cache.
const WAVE: usize = 256;

/// Numbers that each edge of a path may draw, and that come before the first.
const DIMENSIONS: u64 = 8;

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

/// One photon among those that are followed side by side.
struct Path {
    flight: Flight,
    stream: Stream,
    /// Index of the emitter.
    emitter: u32,
    /// Whether it was stored anywhere.
    stored: bool,
}

/// The work on a chunk, compiled for each instruction set; the best that the machine has is taken. No instruction set changes a
/// result.
///
/// Photons go in waves: all to their next surface, then all on from there. A processor then works on several at once, where each
/// step of one photon waits for the last.
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
        let mut paths = Vec::with_capacity(WAVE);
        let mut hits = Vec::with_capacity(WAVE);
        for first in range.clone().step_by(WAVE) {
            for index in pass.batch.indices(first..range.end.min(first + WAVE as u64)) {
                paths.extend(pass.start(index, chunk));
            }
            while !paths.is_empty() {
                chunk.rays += paths.len() as u64;
                hits.clear();
                for path in &paths {
                    hits.push(pass.scene.nearest_hit(path.flight.ray));
                }
                pass.go_on(&mut paths, &hits, chunk);
            }
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

    /// Emits a photon; `None` where there is no emitter, or where its power is no number.
    #[inline(always)]
    fn start(&self, index: u64, chunk: &mut Chunk) -> Option<Path> {
        let stream = Stream::new(self.seed, Purpose::Photon, self.pass, index);
        let (emitter, flight) = self.emit(index, stream.clone())?;
        if !flight.power.is_finite() {
            chunk.ledger.dropped += 1;
            chunk.lights[emitter].emitted += 1;
            chunk.lights[emitter].dropped += 1;
            return None;
        }
        chunk.ledger.emitted += energy(flight.power);
        Some(Path { flight, stream, emitter: emitter as u32, stored: false })
    }

    /// Sends all paths on from where they hit, and keeps those that go on.
    #[inline(always)]
    fn go_on(&self, paths: &mut Vec<Path>, hits: &[Option<Hit>], chunk: &mut Chunk) {
        let mut kept = 0;
        // A loop and no closure: closures are not compiled for the chosen instruction set.
        for (i, hit) in hits.iter().enumerate() {
            let flight = paths[i].flight;
            let next = if let Some(hit) = hit {
                let surface = self.scene.surface(&flight.ray, hit);
                let mut numbers = paths[i].stream.from_dimension(u64::from(flight.edges) * DIMENSIONS);
                let before = chunk.photons.len();
                let next = self.scatter(&flight, &surface, &mut numbers, chunk);
                paths[i].stored |= chunk.photons.len() > before;
                next
            } else {
                chunk.ledger.escaped += energy(flight.power);
                None
            };
            if let Some(next) = next {
                paths[i].flight = next;
                paths.swap(kept, i);
                kept += 1;
            } else {
                chunk.lights[paths[i].emitter as usize].count(paths[i].stored);
            }
        }
        paths.truncate(kept);
    }

    /// The index of the emitter, and the photon as it leaves it.
    #[inline(always)]
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
}
