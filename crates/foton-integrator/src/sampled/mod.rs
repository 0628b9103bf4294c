//! Methods that estimate each pixel by samples of its own: passes of eye samples, each the same for all methods but for what its
//! [`Estimator`](estimator::Estimator) does with a sample. `algorithm.rs` has a pass on one screen.

mod algorithm;
mod block;
mod estimator;
mod output;
mod parts;
mod progress;
pub(crate) mod sample;
mod state;
mod sums;
#[cfg(test)]
mod tests;

pub(crate) use algorithm::Sampled;
pub(crate) use parts::{features, memory};
