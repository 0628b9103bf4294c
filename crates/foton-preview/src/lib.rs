//! The live window: it draws the newest frame and sends commands. It sees frames, statistics and commands, never a hit point,
//! a photon or a scene.
