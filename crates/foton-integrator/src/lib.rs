//! Progressive photon mapping: an eye pass collects hit points once, photon passes refine them for ever after.
//!
//! [`Ppm`] is the algorithm in one screen; each stage has a file of its own. There are no files, windows or clocks here: a
//! caller that wants to time stages is told when they begin.

mod adaptive;
mod batch;
mod direct_light;
mod error;
mod eye_pass;
mod features;
mod gather;
mod grid;
mod highlights;
mod hit_point;
mod inspect;
mod layers;
mod ledger;
mod light;
mod light_use;
mod memory;
mod not_finite;
mod packet;
mod photon;
mod photon_map;
mod photon_pass;
mod ppm;
mod radiance;
mod radius;
mod refine;
mod sampling;
mod settings;
mod slots;
mod stage;
mod state;
mod straight;
#[cfg(test)]
mod test_scene;
mod variants;

pub use error::{ClassError, ErrorEstimate, TileError};
pub use features::{Feature, features};
pub use foton_math::{Cancel, Cancelled};
pub use inspect::{Disc, Radii, StoredPhoton};
pub use layers::LayerKind;
pub use ledger::{Ledger, Loss};
pub use light_use::LightUse;
pub use memory::MemoryEstimate;
pub use not_finite::{Halt, NotFinite, Quantity};
pub use photon::PathClass;
pub use ppm::{PassReport, Ppm, Start};
pub use refine::Statistics;
pub use settings::{Alpha, Change, DirectLight, RadiusFloor, RadiusRule, RadiusScale, Settings};
pub use stage::Stage;
pub use state::StateError;
pub use variants::{Step, Variants};
