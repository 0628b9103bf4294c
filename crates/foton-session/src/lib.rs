//! Runs a render: threads, stop rules, stage clocks, interruption, snapshots, findings; and the [`Engine`], which a
//! window steers. It knows no scene files, no terminal and no window.
//!
//! ```
//! use foton_session::{Interrupt, Session, StopRule};
//! # use foton_scene::description::*;
//! # let mut description = SceneDescription::default();
//! # description.sensors.push(SensorDescription { width: 8, height: 8, ..SensorDescription::default() });
//! let scene = std::sync::Arc::new(foton_scene::Scene::build(&description)?);
//! let settings = foton_integrator::RenderSettings::default();
//! let interrupt = Interrupt::default();
//! let mut session = Session::start(scene, settings, None, interrupt.cancel())?;
//! session.run(&StopRule::passes(2), &interrupt, &mut |_| ());
//! assert_eq!(session.render().image().pixels.len(), 64);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod checkpoint;
mod clock;
mod dots;
pub mod engine;
pub mod findings;
pub mod folders;
mod in_time;
mod interrupt;
pub mod maps;
mod metadata;
mod panic;
mod preset;
mod session;
mod shown;
pub mod snapshot;
mod stop;
#[cfg(test)]
mod test_scene;
pub mod threads;
mod views;

pub use clock::StageTimes;
pub use engine::Engine;
pub use foton_integrator::{
    Alpha, ClassError, DirectLight, ErrorEstimate, KeptMaps, Ledger, Method, PathClass, Radii, RadiusFloor,
    RadiusRule, RadiusScale, RenderSettings, SettingChange, Stage,
};
pub use interrupt::Interrupt;
pub use metadata::SceneIdentity;
pub use panic::Panic;
pub use preset::Preset;
pub use session::{PassError, Progress, Session, StartError, StopCause};
pub use shown::Shown;
pub use stop::StopRule;
pub use views::Views;
