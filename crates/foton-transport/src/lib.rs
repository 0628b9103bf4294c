//! What methods of light transport share: paths from the camera, paths from the emitters, the photon map between them, direct
//! light, and the accounts of power.
//!
//! No method lives here, and there are no files, windows or clocks. Positions, lengths and radii are in scene units
//! ([`foton_scene::Scene::normalisation`]); power and radiance are those of the scene.

pub mod camera_paths;
pub mod codec;
mod differential;
pub mod direct_light;
pub mod guide;
pub mod kd_tree;
mod ledger;
pub mod light_paths;
mod light_use;
mod lobes;
mod not_finite;
pub mod photon_map;
pub mod shading;
mod stage;
pub mod straight;
mod vertex;

pub use differential::{Bend, Differential};
pub use foton_math::{Cancel, Cancelled, ShouldSuspend, Suspended};
pub use ledger::{Ledger, Loss};
pub use light_use::LightUse;
pub use lobes::{Bounce, LobePolicy, LobeSplit, LobeUse};
pub use not_finite::{Halt, LeftOut, NotFinite, Omissions, Quantity, Surface};
pub use stage::Stage;
pub use vertex::{Departure, Vertex};
