//! What a pass counts on its way, beside light.

use foton_transport::photon_map::Chunk;
use foton_transport::{Ledger, LeftOut, LightUse, Loss, Omissions};

use super::tally::Tally;

/// What the batches of a pass have counted so far, on top of the passes before. It becomes the render's own once the pass is whole: a pass
/// that is cancelled has not happened.
pub(crate) struct Counts {
    pub(crate) ledger: Ledger,
    pub(crate) lights: Vec<LightUse>,
    pub(crate) losses: Vec<Loss>,
    /// Photons of the pass.
    pub(crate) photons: u64,
    /// Rays traced in the pass.
    pub(crate) rays: u64,
    /// Photons stored in the pass.
    pub(crate) stored: u64,
    pub(crate) tally: Tally,
    /// The first value of the pass that was not finite.
    pub(crate) left_out: Option<LeftOut>,
}

impl Counts {
    /// Adds a batch that has been traced and gathered.
    pub(crate) fn add(&mut self, chunks: &[Chunk], tally: &Tally) {
        for chunk in chunks {
            self.ledger += chunk.ledger;
            self.lights.iter_mut().zip(&chunk.lights).for_each(|(sum, &light)| *sum += light);
            self.losses.iter_mut().zip(&chunk.losses).for_each(|(sum, &loss)| *sum += loss);
            self.rays += chunk.rays;
            self.stored += chunk.photons.len() as u64;
            self.left_out = self.left_out.or(chunk.left_out);
        }
        self.leave_out(tally.omissions);
        self.tally += *tally;
    }

    /// Counts what was left out beside photons.
    pub(crate) fn leave_out(&mut self, omissions: Omissions) {
        self.ledger.dropped += omissions.count;
        self.left_out = self.left_out.or(omissions.first);
    }
}
