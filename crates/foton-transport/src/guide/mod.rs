//! Guided emission: photons start where the photons of earlier passes were worth their cost.
//!
//! What a photon does is decided by its emitter and the primary numbers with which it starts. That space is cut into cells
//! (`cells.rs`), each with a probability of its own; within a cell photons start as their emitter shines. A photon's power is
//! divided by the density, so light stays the same for any probabilities above zero, and passes stay independent of each other
//! given the cells: what the live error rests on holds. Markov chains would break it.
//!
//! Some passes are *training passes*. Each of their photons adds up what its light is worth where it is stored (`worth.rs`): its
//! part in the sum of squared noise over all pixels. From those samples (`samples.rs`) cells are cut anew (`growth.rs`), with
//! probabilities in proportion to √(mean square per cost), which minimise the noise for a given amount of work. Training on
//! whether photons arrive at all would starve the few that make caustics. After `[GBBE18]`, who cut the space of primary numbers
//! for camera paths.
//!
//! Photons of a map of caustics start by another rule, that of `projection.rs`: where emitters see what casts them.

mod cells;
mod growth;
mod projection;
mod samples;
#[cfg(test)]
mod tests;
mod worth;

pub use cells::{Cells, Start};
pub use growth::grow;
pub use samples::{Sample, Samples, Training, is_training_pass};
pub use worth::{Worth, WorthPoints};
