//! The paths of the photons that light a pixel: chunks in which some of them were stored are traced once more.
//!
//! It changes nothing of the render. World units.

use foton_math::Rgb;
use foton_math::glam::DVec3;
use foton_transport::light_paths::{Batch, PhotonPass, Way};
use foton_transport::photon_map::{CHUNK, LANES, PathClass, Photon};
use rayon::prelude::*;

use super::algorithm::Ppm;
use super::lanes::counting_lanes;

/// Photons that are traced again at most where nothing is known of which: about a tenth of a processor second.
const RETRACED: u64 = 1 << 16;

/// Chunks that are traced again at most.
const CHUNKS: usize = 32;

/// The way of a photon from its emitter to a disc.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotonPath {
    /// Where it was emitted, where it turned, and where it was gathered.
    pub points: Vec<DVec3>,
    /// The kind of light that it brought.
    pub class: PathClass,
    /// Its power as it arrived, in parts of its pass's: brighter ones bring more.
    pub power: Rgb,
}

/// Photons to be traced again: a pass's size, one of its batches, and a range of that.
struct Piece {
    pass: u64,
    photons: u64,
    batch: Batch,
    first: u64,
}

impl Ppm {
    /// Paths of photons that count for a pixel's hit points as their discs are now, `at_most` of them: of the last pass, or of the one under
    /// way as far as it is; of passes in several batches, those among the first 65,536. `pixel` counts along rows.
    #[must_use]
    pub(crate) fn paths_to(&self, pixel: usize, at_most: usize) -> Vec<PhotonPath> {
        if self.passes == 0 || pixel + 1 >= self.hit_points.pixel_start.len() {
            return Vec::new();
        }
        let mut found: Vec<Way> = Vec::new();
        // Some chunks at a time, so that a bright pixel is answered at once; the same ones on any number of threads.
        for pieces in self.pieces(pixel).chunks(4) {
            let ways = pieces.par_iter().map(|piece| {
                let cells = self.guidance.cells_of(piece.pass == self.passes);
                let own = self.photon_pass(piece.photons, piece.batch);
                let pass = PhotonPass { pass: piece.pass, cells, training: None, ..own };
                let end = piece.batch.photons(piece.photons).min(piece.first + CHUNK);
                pass.ways(piece.first..end, &|photon| self.counts_for(pixel, photon))
            });
            found.extend(ways.collect::<Vec<_>>().into_iter().flatten());
            if found.len() >= at_most {
                break;
            }
        }
        found.truncate(at_most);
        found.iter().map(|way| self.path(way)).collect()
    }

    /// Where photons for a pixel are to be looked for: chunks in which some were stored; or the first ones, where chunks are not those of
    /// the last pass.
    fn pieces(&self, pixel: usize) -> Vec<Piece> {
        let (pass, photons) = (self.passes - 1, self.last_photons);
        let mut batches = Batch::all(photons, self.max_in_batch);
        let Some(batch) = batches.next() else { return Vec::new() };
        let has_one = batches.next().is_none();
        let under_way = self.under_way.as_ref().and_then(|pass| Some((pass.planned(), pass.batch()?)));
        let has_counting =
            |i: usize| self.chunks[i].photons.iter().any(|photon| self.counts_for(pixel, photon));
        let piece = |i: usize| {
            let first = i as u64 * CHUNK;
            match under_way {
                Some((photons, batch)) if self.chunks[i].is_traced && !batch.is_closing() => {
                    Some(Piece { pass: self.passes, photons, batch, first })
                }
                Some((_, batch)) if !batch.is_first() => None,
                _ => (has_one && first < photons).then_some(Piece { pass, photons, batch, first }),
            }
        };
        let known: Vec<usize> = (0..self.chunks.len()).into_par_iter().filter(|&i| has_counting(i)).collect();
        let known: Vec<Piece> = known.into_iter().filter_map(piece).take(CHUNKS).collect();
        if !known.is_empty() || has_one {
            return known;
        }
        let firsts = (0..batch.photons(photons).min(RETRACED)).step_by(CHUNK as usize);
        firsts.map(|first| Piece { pass, photons, batch, first }).collect()
    }

    /// Whether a photon counts for any hit point of a pixel.
    fn counts_for(&self, pixel: usize, photon: &Photon) -> bool {
        self.hit_points.of_pixel(pixel).any(|h| {
            let slot = self.hit_points.slot_of[h] as usize;
            let packet = &self.hit_points.packets[slot / LANES];
            let gloss = self.hit_points.gloss(slot);
            counting_lanes(packet, &packet.tests(), photon)[slot % LANES] != 0
                && gloss.is_none_or(|gloss| !gloss.specular || photon.is_lone())
        })
    }

    fn path(&self, way: &Way) -> PhotonPath {
        let normalisation = self.scene.normalisation();
        PhotonPath {
            points: way.points.iter().map(|&point| normalisation.world_point(point)).collect(),
            class: PathClass::ALL[way.photon.class_index()],
            power: way.photon.power,
        }
    }
}
