//! Photons sorted by the cells of a grid over the hit points that may ask for them.

mod chunk;
mod grid;
mod groups;
mod map;
mod packet;
mod photon;

pub use chunk::{CHUNK, Chunk};
pub use grid::{Grid, MAX_CELLS};
pub use groups::{BAND, Groups, group};
pub use map::PhotonMap;
pub use packet::{LANES, Packet, PacketTests, rows};
pub use photon::{PathClass, Photon};
