//! How a pass is gathered and refined.

use foton_transport::light_paths::Batch;
use pulp::Arch;

use super::settings::Alpha;
use crate::error::Question;

/// How a pass is gathered.
#[derive(Clone, Copy)]
pub(crate) struct Rule {
    pub(crate) alpha: Alpha,
    /// Whether the error is asked for.
    pub(crate) error: bool,
    /// Whether radii adapt to bias.
    pub(crate) adapts: bool,
    /// What all r² are multiplied by, where they shrink together.
    pub(crate) common: Option<f64>,
    pub(crate) batch: Batch,
    /// What the error sums over one class.
    pub(crate) question: Question,
    pub(crate) arch: Arch,
}
