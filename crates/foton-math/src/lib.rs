//! Values for light transport: colours, rays, frames, boxes, keyed random streams, and warps with their pdfs.
//!
//! Nothing here depends on a scene. Everything is `Copy`, single precision unless said otherwise, and free of state, but for
//! [`Cancel`], the request to stop that all layers share.

mod aabb;
mod cancel;
mod cancel_reader;
mod frame;
pub mod octahedral;
mod ray;
mod rgb;
pub mod sobol;
mod stream;
pub mod warp;

pub use aabb::Aabb;
pub use cancel::{Cancel, Cancelled, ShouldSuspend, Suspended};
pub use cancel_reader::CancelReader;
pub use frame::Frame;
pub use glam;
pub use ray::Ray;
pub use rgb::Rgb;
pub use stream::{Purpose, Stream};

/// Cases of a test: a hundredth of them under Miri, which takes thousands of times as long.
#[cfg(test)]
const fn cases(usual: u32) -> u32 {
    if cfg!(miri) { usual / 100 } else { usual }
}
