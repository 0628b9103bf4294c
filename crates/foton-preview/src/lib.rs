//! The live window: it draws the newest frame and sends commands. It sees frames, statistics and commands, never a hit point,
//! a photon or a scene.
//!
//! [`run`] is all there is to call. Inside, `state` holds what is known and set, `panels` draw it, `present` puts pictures on
//! the screen, and `window` ties them to the system.

mod difference;
mod editing;
mod files;
mod light_scale;
mod looking;
mod message;
mod panels;
mod preferences;
mod present;
mod state;
mod themes;
mod turns;
mod window;

pub use looking::BuiltIn;
pub use window::{Close, Options, WindowError, run};
