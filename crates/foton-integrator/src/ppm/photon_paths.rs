//! The paths of the photons that light a pixel: those of the last pass are traced once more, as many as a person waits for.
//!
//! It changes nothing of the render. World units.

use foton_math::Rgb;
use foton_math::glam::DVec3;
use foton_transport::light_paths::{Batch, PhotonPass, Way};
use foton_transport::photon_map::{CHUNK, LANES, PathClass, Photon};
use rayon::prelude::*;

use super::algorithm::Ppm;
use super::lanes::counting_lanes;

/// Photons that are traced again at most: about a tenth of a processor second.
const RETRACED: u64 = 1 << 16;

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

impl Ppm {
    /// Paths of photons of the last pass that count for a pixel's hit points as their discs are now, `at_most` of them: of a large pass
    /// those among its first 65,536. Where emission has learnt since, photons as it would emit them now. `pixel` counts along rows.
    #[must_use]
    pub(crate) fn paths_to(&self, pixel: usize, at_most: usize) -> Vec<PhotonPath> {
        let Some(pass) = self.passes.checked_sub(1).filter(|_| pixel + 1 < self.hit_points.pixel_start.len())
        else {
            return Vec::new();
        };
        let Some(batch) = Batch::all(self.last_photons, self.max_in_batch).next() else { return Vec::new() };
        let photon_pass = PhotonPass { pass, ..self.photon_pass(self.last_photons, batch) };
        let photons = batch.photons(self.last_photons).min(RETRACED);
        let mut found: Vec<Way> = Vec::new();
        // Some chunks at a time, so that a bright pixel is answered at once; the same ones on any number of threads.
        const AT_ONCE: u64 = 4 * CHUNK;
        for first in (0..photons).step_by(AT_ONCE as usize) {
            let firsts = (first..photons.min(first + AT_ONCE)).step_by(CHUNK as usize);
            let firsts: Vec<u64> = firsts.collect();
            let ways = firsts.into_par_iter().map(|first| {
                photon_pass.ways(first..photons.min(first + CHUNK), &|photon| self.counts_for(pixel, photon))
            });
            found.extend(ways.collect::<Vec<_>>().into_iter().flatten());
            if found.len() >= at_most {
                break;
            }
        }
        found.truncate(at_most);
        found.iter().map(|way| self.path(way)).collect()
    }

    /// Whether a photon counts for any hit point of a pixel.
    fn counts_for(&self, pixel: usize, photon: &Photon) -> bool {
        self.hit_points.of_pixel(pixel).any(|h| {
            let slot = self.hit_points.slot_of[h] as usize;
            let packet = &self.hit_points.packets[slot / LANES];
            let gloss = self.hit_points.gloss(slot);
            counting_lanes(packet, photon)[slot % LANES] != 0
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
