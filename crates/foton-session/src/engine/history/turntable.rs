//! The turntable: the camera goes once around what it looks at, in steps, and a PNG of each is written after so many passes.

use std::num::NonZeroU32;

use foton_scene::description::SensorDescription;

use super::film::Film;

/// One that turns.
pub(crate) struct Turntable {
    pub(crate) steps: NonZeroU32,
    /// Passes of each frame.
    pub(crate) passes: u64,
    /// Frames that are written.
    pub(crate) done: u32,
    pub(crate) film: Film,
    /// Cameras as they were.
    pub(crate) before: Vec<SensorDescription>,
}

impl Turntable {
    /// Frames that are written, and all.
    pub(crate) fn progress(&self) -> [u32; 2] {
        [self.done, self.steps.get()]
    }
}
