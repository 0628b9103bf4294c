//! Paths from the emitters: photons, from surface to surface, a batch at a time.

mod batch;
mod draws;
mod pass;
mod retrace;
mod scatter;
mod trace;

pub use batch::{Batch, MAX_PHOTONS};
pub use pass::PhotonPass;
pub use retrace::Way;
