//! The immutable scene: shapes, rays against them, BSDFs, emitters and sensors.
//!
//! [`SceneDescription`] is what a person or a file says, in world units; [`Scene`] is what rays meet, rescaled and
//! indexed. No files here, no integration: the format crate reads the one, the integrator asks the other.

mod accel;
mod attributes;
mod bitmap;
pub mod bsdf;
mod build;
mod census;
mod coincident;
mod coordinates;
pub mod description;
mod discrete;
mod emitter;
mod far;
mod filter;
pub mod metals;
mod normalise;
pub mod parameter;
mod placement;
mod plane;
pub mod plugins;
mod primitive;
mod scene;
mod sensor;
mod sources;
mod surface;
mod texture;

pub use accel::Hit;
pub use bsdf::{Bsdf, BsdfSample, Coat, LobeFlags, LobeSample, LobeSamples, Scattering, Transport};
pub use build::{BuildError, BuildOptions, BuildStep, Instancing, Tell};
pub use census::{BsdfKind, Census};
pub use description::SceneDescription;
pub use emitter::{Emission, Emitter, Extent, Illumination};
pub use far::{Far, FarKind};
pub use filter::FilterSampler;
pub use normalise::Normalisation;
pub use scene::{Footprint, Scene, Shape};
pub use sensor::Sensor;
pub use sources::{PRIMARY_NUMBERS, PrimaryNumbers, Sources};
pub use surface::Surface;
