//! Direct light by shadow rays: sampled points of emitters, one at a time, and which emitters those are.
//!
//! What lies in between blocks, but for surfaces that light passes straight through: thin glass, masks, nothing. Those weigh it.

mod arrival;
mod lights;
mod tree;

pub use arrival::{Arrival, Receiver, SHORTENED, arrival};
pub use lights::{Lights, SCRAMBLES, Scramble};
pub use tree::LightTree;
