//! Tracing a batch of photons: from emitters, from surface to surface, stored wherever light spreads near a hit point.

use std::ops::Range;

use foton_math::{Cancel, Purpose, Ray, ShouldSuspend, Stream, Suspended};
use foton_scene::Hit;
use pulp::{Simd, WithSimd};
use rayon::prelude::*;

use super::draws::{Draw, Draws};
use super::pass::{NOT_NOTED, Path, PhotonPass, WAVE};
use crate::guide::{Sample, Start};
use crate::ledger::{Ledger, Loss, energy};
use crate::light_use::LightUse;
use crate::not_finite::{Halt, LeftOut, Quantity, Surface};
use crate::photon_map::{CHUNK, Chunk, PathClass};

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
        let mut next = Vec::with_capacity(WAVE);
        let mut hits = Vec::with_capacity(WAVE);
        let mut draws = Draws::default();
        // Loops and no closures: those are not compiled for the chosen instruction set.
        for first in range.clone().step_by(WAVE) {
            for index in pass.batch.indices(first..range.end.min(first + WAVE as u64)) {
                pass.start(index, chunk, &mut paths);
            }
            while !paths.is_empty() {
                chunk.rays += paths.len() as u64;
                hits.clear();
                for path in &paths {
                    hits.push(pass.scene.nearest_hit(path.ray));
                }
                draws.draw(&paths);
                for (i, (path, hit)) in paths.iter().zip(&hits).enumerate() {
                    pass.go_on(path, hit.as_ref(), draws.of(i), chunk, &mut next);
                }
                std::mem::swap(&mut paths, &mut next);
                next.clear();
            }
        }
    }
}

impl PhotonPass<'_> {
    /// Makes `chunks` ready for the photons of the batch.
    pub fn begin(&self, chunks: &mut Vec<Chunk>) {
        let photons = self.batch.photons(self.photons);
        chunks.resize_with(photons.div_ceil(CHUNK) as usize, Chunk::default);
        chunks.iter_mut().for_each(|chunk| chunk.is_traced = false);
    }

    /// Emits and follows all photons of the batch into `chunks`, the same ones for any number of threads; where that was suspended,
    /// those that are left.
    ///
    /// # Errors
    /// When cancelled or suspended.
    pub fn shoot(
        &self,
        chunks: &mut [Chunk],
        cancel: &Cancel,
        should_suspend: ShouldSuspend<'_>,
    ) -> Result<(), Halt> {
        let photons = self.batch.photons(self.photons);
        let left = chunks.par_iter_mut().enumerate().filter(|(_, chunk)| !chunk.is_traced);
        left.try_for_each(|(i, chunk)| {
            cancel.check()?;
            if should_suspend() {
                return Err(Suspended.into());
            }
            let first = i as u64 * CHUNK;
            chunk.photons.clear();
            chunk.cells.clear();
            chunk.samples.clear();
            chunk.ledger = Ledger::default();
            chunk.rays = 0;
            chunk.lights.clear();
            chunk.lights.resize(self.scene.emitters().len(), LightUse::default());
            chunk.losses.clear();
            chunk.losses.resize(self.scene.materials().len(), Loss::default());
            chunk.left_out = None;
            let range = first..photons.min(first + CHUNK);
            self.arch.dispatch(Follow { pass: self, range, chunk: &mut *chunk });
            chunk.is_traced = true;
            Ok(())
        })
    }

    /// Emits a photon, unless there is no emitter or its power is not finite.
    #[inline(always)]
    pub(super) fn start(&self, index: u64, chunk: &mut Chunk, paths: &mut Vec<Path>) {
        let stream = Stream::new(self.seed, Purpose::Photon, self.pass, index);
        let mut numbers = stream.clone();
        // Stratified over the pass: each cell gets its share of photons up to one.
        let u = (index as f64 + f64::from(numbers.next_1d())) / self.photons as f64;
        let within = std::array::from_fn(|_| numbers.next_1d());
        let Some(from) = self.cells.start(u, within) else { return };
        let emitter = from.emitter;
        let start = self.sources.emit(emitter, from.primary);
        let power = start.power / from.density as f32;
        if !power.is_finite() {
            chunk.ledger.dropped += 1;
            chunk.lights[emitter].emitted += 1;
            chunk.lights[emitter].dropped += 1;
            chunk.leave_out(LeftOut {
                quantity: Quantity::EmittedPower,
                light: Some(emitter as u32),
                surface: Surface::Unknown,
                position: start.origin,
            });
            return;
        }
        chunk.ledger.emitted += energy(power);
        let sample = self.note_start(index, &from, chunk);
        if power.is_black() {
            // Aimed where its emitter does not shine.
            chunk.lights[emitter].count(false);
            return;
        }
        paths.push(Path {
            ray: Ray::new(start.origin, start.direction),
            power,
            class: PathClass::Direct,
            lone: false,
            stored: false,
            edges: 1,
            emitter: emitter as u32,
            sample,
            stream,
        });
    }

    /// Begins to note a photon in a training pass; the index of its sample.
    #[inline(always)]
    fn note_start(&self, index: u64, from: &Start, chunk: &mut Chunk) -> u32 {
        if self.training.is_none_or(|training| !index.is_multiple_of(training.stride)) {
            return NOT_NOTED;
        }
        chunk.samples.push(Sample::new(from));
        chunk.samples.len() as u32 - 1
    }

    /// What becomes of a photon where its ray ends. If it goes on, it is added to `next`: written once, where it is read.
    #[inline(always)]
    pub(super) fn go_on(
        &self,
        path: &Path,
        hit: Option<&Hit>,
        draw: Draw,
        chunk: &mut Chunk,
        next: &mut Vec<Path>,
    ) {
        let before = next.len();
        if let Some(sample) = chunk.samples.get_mut(path.sample as usize) {
            sample.has_flown();
        }
        let stored = match hit {
            Some(hit) => self.scatter(path, &self.scene.surface(&path.ray, hit), draw, chunk, next),
            None => {
                chunk.ledger.escaped += energy(path.power);
                path.stored
            }
        };
        if next.len() == before {
            chunk.lights[path.emitter as usize].count(stored);
        }
    }
}
