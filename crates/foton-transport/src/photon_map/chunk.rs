//! What one task emits.

use super::photon::Photon;
use crate::guide::Sample;
use crate::ledger::{Ledger, Loss};
use crate::light_use::LightUse;
use crate::not_finite::LeftOut;

/// Photons that one task emits.
pub const CHUNK: u64 = 4096;

/// What one task emits. Reused from pass to pass, so that photons need no new memory once it has grown.
#[derive(Default)]
pub struct Chunk {
    /// Whether all its photons have been traced in the batch under way.
    pub is_traced: bool,
    /// Photons that were stored, in the order of emission.
    pub photons: Vec<Photon>,
    /// Number of the cell of each photon.
    pub cells: Vec<u32>,
    /// What training passes note of them.
    pub samples: Vec<Sample>,
    /// What became of their power.
    pub ledger: Ledger,
    /// Rays traced.
    pub rays: u64,
    /// By emitter.
    pub lights: Vec<LightUse>,
    /// By material.
    pub losses: Vec<Loss>,
    /// The first photon whose power was no number.
    pub left_out: Option<LeftOut>,
}

impl Chunk {
    /// Notes a photon whose power was no number, if it is the first.
    #[cold]
    pub fn leave_out(&mut self, left_out: LeftOut) {
        self.left_out.get_or_insert(left_out);
    }
}
