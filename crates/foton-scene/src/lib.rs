//! The immutable scene: shapes, rays against them, BSDFs, emitters and sensors.
//!
//! [`SceneDescription`] is what a person or a file says, in world units; [`Scene`] is what rays meet, rescaled and
//! indexed. No files here, no integration: the format crate reads the one, the integrator asks the other.

pub mod description;
