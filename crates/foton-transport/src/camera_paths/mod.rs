//! Paths from the camera: through mirrors, glass and narrow gloss to the surfaces that gather light.

mod earlier;
mod eye_pass;
mod highlights;
mod hit_point;
mod pixel_samples;
mod radius;
mod trace;
mod walk;

pub use eye_pass::{EyePass, EyePaths, NO_SHAPE};
pub use hit_point::{Gloss, GlossIndex, HitPoint, slab2};
pub use pixel_samples::PixelSamples;
pub use radius::FirstRadius;
