//! Tests of whole passes.

mod batches;
mod cutting;
mod eye_samples;
mod instruction_sets;
mod paths;
mod suspending;
mod unlit;

use super::algorithm::Ppm;

impl Ppm {
    /// Passes of more than `max` photons fall into batches from now on.
    pub(super) fn with_batches_of(self, max: u64) -> Self {
        Self { max_in_batch: max, ..self }
    }
}
