//! Methods of light transport: progressive photon mapping (`ppm/`), whose eye pass collects hit points once and whose photon passes
//! refine them for ever after; stochastic progressive photon mapping (`sppm/`), with new hit points for each photon pass; and methods that
//! estimate each pixel by samples of its own (`sampled/`): path tracing (`path/`) and Whitted's ray tracing (`whitted/`).
//!
//! [`Render`] is a render by any of them. `ppm/algorithm.rs` and `sampled/algorithm.rs` have a method on one screen; each step has a file
//! of its own. There are no files, windows or clocks here: a caller that wants to time stages is told when they begin.

mod by_block;
mod changes;
mod error;
mod feature;
mod layers;
mod memory;
mod path;
mod photon_map;
mod ppm;
mod render;
mod report;
mod sampled;
mod settings;
mod shutter;
mod sppm;
mod suits;
#[cfg(test)]
mod test_scene;
mod white;
mod whitted;

pub use error::{ClassError, ErrorEstimate, TileError};
pub use feature::Feature;
pub use foton_transport::codec::StateError;
pub use foton_transport::kd_tree::KernelFilter;
pub use foton_transport::photon_map::PathClass;
pub use foton_transport::{
    Cancel, Cancelled, Halt, Ledger, LightUse, LobeUse, Loss, NotFinite, Quantity, ShouldSuspend, Stage,
    Suspended,
};
pub use layers::LayerKind;
pub use memory::MemoryEstimate;
pub use photon_map::{KeptMaps, MapDisplay, PhotonMapSettings};
pub use ppm::{
    Alpha, DirectLight, Disc, EyeSamples, PhotonPath, PpmSettings, Radii, RadiusFloor, RadiusRule,
    RadiusScale, Statistics, Step, StoredPhoton, Variants, lobe_use,
};
pub use render::Render;
pub use report::{PassReport, Start};
pub use settings::{Method, RenderSettings, SettingChange};
pub use white::WHITE;
