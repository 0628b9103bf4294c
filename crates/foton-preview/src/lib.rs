//! The live window: it draws the newest frame and sends commands. It sees frames, statistics and commands, never a hit point,
//! a photon or a scene.

// The window, which uses all of it, is not there yet.
#[cfg_attr(not(test), allow(dead_code))]
mod files;
#[cfg_attr(not(test), allow(dead_code))]
mod present;
