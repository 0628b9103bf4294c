//! Methods of light transport. Progressive photon mapping collects hit points in one eye pass, and photon passes refine them for ever
//! after; stochastic progressive photon mapping has an eye pass before each photon pass.
//!
//! [`Render`] is a render by any of them. `ppm/algorithm.rs` has progressive photon mapping on one screen; each step has a file of its
//! own. There are no files, windows or clocks here: a
//! caller that wants to time stages is told when they begin.

mod changes;
mod error;
mod layers;
mod ppm;
mod render;
mod settings;
mod sppm;

pub use error::{ClassError, ErrorEstimate, TileError};
pub use foton_transport::codec::StateError;
pub use foton_transport::photon_map::PathClass;
pub use foton_transport::{
    Cancel, Cancelled, Halt, Ledger, LightUse, LobeUse, Loss, NotFinite, Quantity, ShouldSuspend, Stage,
    Suspended,
};
pub use layers::LayerKind;
pub use ppm::{
    Alpha, DirectLight, Disc, EyeSamples, Feature, MemoryEstimate, PassReport, PhotonPath, PpmSettings,
    Radii, RadiusFloor, RadiusRule, RadiusScale, Start, Statistics, Step, StoredPhoton, Variants, features,
    lobe_use,
};
pub use render::Render;
pub use settings::{Method, RenderSettings, SettingChange};
