//! What a comparison of two programs in a scene came to.

use super::curve::{Curve, MEASURES};

/// What a scene came to: a curve a seed, of each program.
pub(super) struct Outcome {
    pub(super) scene: String,
    pub(super) base: Vec<Curve>,
    pub(super) new: Vec<Curve>,
    /// Of the reference itself, in each measure.
    pub(super) noise: [f64; MEASURES.len()],
}
