//! Photons that stay: 20 bytes each in a left-balanced tree, which finds the nearest ones of a point. `[JEN96]` `[JEN01]`
//!
//! Unlike the grid of `photon_map/`, which is made anew in each pass for discs that are known, this tree knows nothing of who will
//! ask: it serves any camera, and can be kept in a file.

mod balance;
mod density;
mod nearest;
mod packed_photon;
mod rgbe;
#[cfg(test)]
mod tests;
mod tree;

pub use density::{Estimate, KernelFilter};
pub use nearest::{Found, Nearest};
pub use packed_photon::{MAX_EDGES, MapClass, PACKED_BYTES, PackedPhoton};
pub use rgbe::Rgbe;
pub use tree::KdTree;
