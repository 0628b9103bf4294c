//! Progressive photon mapping. `algorithm.rs` is the method on one screen; each step has a file of its own.

mod adaptive;
mod algorithm;
mod by_block;
mod counts;
mod direct;
mod eye_samples;
mod features;
mod gather;
mod hit_points;
mod inspect;
mod laid_out;
mod lanes;
mod light;
mod lobes;
mod memory;
mod output;
mod progress;
mod radiance;
mod refine;
mod report;
mod rule;
pub(crate) mod settings;
mod slots;
mod state;
mod statistics;
mod steps;
mod sweep;
mod tally;
#[cfg(test)]
mod tests;
mod under_way;
mod variants;

pub(crate) use algorithm::Ppm;
pub(crate) use direct::{Direct, Noise};
pub use eye_samples::EyeSamples;
pub use features::{Feature, features};
pub(crate) use hit_points::{HitPoints, Irradiance};
pub use inspect::{Disc, Radii, StoredPhoton};
pub use lobes::lobe_use;
pub use memory::MemoryEstimate;
pub(crate) use radiance::Radiance;
pub use report::{PassReport, Start};
pub use settings::{Alpha, DirectLight, PpmSettings, RadiusFloor, RadiusRule, RadiusScale};
pub use statistics::Statistics;
pub use variants::{Step, Variants};
