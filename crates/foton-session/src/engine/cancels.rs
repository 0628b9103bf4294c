//! The requests to stop that the engine's handle shares with its thread.

use foton_integrator::Cancel;

/// The requests to stop that the engine's handle shares with its thread.
#[derive(Clone, Default)]
pub(super) struct Cancels {
    /// Discards the pass, or gives up the build, that is under way, for something newer.
    pub(super) work: Cancel,
    /// Gives up whatever is built, once the engine is to end.
    pub(super) quit: Cancel,
}
