//! A checkpoint that is kept up to date.

use std::path::PathBuf;
use std::time::Duration;

use crate::metadata::SceneIdentity;

/// A checkpoint that is kept.
pub(super) struct Kept {
    pub(super) path: PathBuf,
    /// The scene that it is of, whatever is opened or edited next.
    pub(super) scene: SceneIdentity,
    /// How long the render had taken when it was last written.
    pub(super) written: Duration,
}
