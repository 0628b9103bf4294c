//! Two-pass photon mapping. `[JEN96]` `[JEN01]`
//!
//! First photons are traced and kept, wherever they land, in a global map and a map of caustics ([`maps`], [`make`]); then passes of
//! eye samples look light up in them ([`mapper`]): direct light by shadow rays, caustics from their map, indirect light by final
//! gathering ([`gather`]) or from the global map itself. The maps stay as they are. What passes average out is the noise of eye samples,
//! shadow rays and gather rays; how coarse the maps are is bias, which no number of passes lowers, and no error figure contains.

mod directions;
mod gather;
mod kept;
mod make;
mod mapper;
mod maps;
mod place;
pub(crate) mod settings;
mod shadow;
mod shoot;
#[cfg(test)]
mod tests;

pub use kept::KeptMaps;
pub(crate) use mapper::PhotonMapper;
pub use settings::{MapDisplay, PhotonMapSettings};
