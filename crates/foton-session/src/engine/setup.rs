//! What the engine is given.

use std::sync::Arc;

use super::loader::Loader;

/// What the engine is given.
pub struct Setup {
    /// How scenes are opened and saved.
    pub loader: Arc<dyn Loader>,
    /// Called from the engine's thread when a frame or event is there.
    pub wake: Box<dyn Fn() + Send>,
    /// Renders beyond this many bytes are refused.
    pub memory_limit: Option<f64>,
}
