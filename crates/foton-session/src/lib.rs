//! Runs a render: threads, stop rules, stage clocks, interruption. It knows no files, no terminal and no window.
//!
//! ```
//! use foton_session::{Interrupt, Session, StopRule};
//! # use foton_scene::description::*;
//! # let mut description = SceneDescription::default();
//! # description.sensors.push(SensorDescription {
//! #     name: "sensor".into(), to_world: Default::default(), fov_degrees: 40.0, fov_axis: FovAxis::X,
//! #     width: 8, height: 8, filter: Filter::Box { radius: 0.5 }, near_clip: None, far_clip: None,
//! # });
//! let scene = std::sync::Arc::new(foton_scene::Scene::build(&description)?);
//! let settings = foton_integrator::Settings::default();
//! let interrupt = Interrupt::default();
//! let mut session = Session::start(scene, settings, None, &interrupt)?;
//! session.run(&StopRule::passes(2), &interrupt, &mut |_| Ok::<_, foton_session::StartError>(()))?;
//! assert_eq!(session.ppm().image().pixels.len(), 64);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod clock;
mod interrupt;
mod session;
mod stop;

pub use clock::StageTimes;
pub use interrupt::Interrupt;
pub use session::{Progress, Session, StartError, StopCause};
pub use stop::StopRule;
