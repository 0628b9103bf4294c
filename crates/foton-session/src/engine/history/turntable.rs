//! The turntable: the camera goes once around what it looks at, in steps, and a PNG of each is written after so many passes.

use std::num::NonZeroU32;

use foton_scene::description::SensorDescription;

use super::film::Film;

/// One that turns.
pub(in crate::engine) struct Turntable {
    pub(in crate::engine) steps: NonZeroU32,
    /// Passes of each frame.
    pub(in crate::engine) passes: u64,
    /// Frames that are written.
    pub(in crate::engine) done: u32,
    pub(in crate::engine) film: Film,
    /// Cameras as they were.
    pub(in crate::engine) before: Vec<SensorDescription>,
}

impl Turntable {
    /// Frames that are written, and all.
    pub(in crate::engine) fn progress(&self) -> [u32; 2] {
        [self.done, self.steps.get()]
    }
}
