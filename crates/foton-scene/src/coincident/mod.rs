//! Surfaces that lie in one another: which of them a ray meets, and what the boundary of two clear ones is.
//!
//! Exporters set a glass block exactly on a floor and state the face between water and glass twice. A ray meets both at one
//! distance, or in the order that rounding gives them, and the next ray starts beyond both. So pairs of primitives that share a
//! part of a surface, within what single precision can tell apart, are found when a scene is built, and where a ray hits one of
//! them the hit is settled: an emitter before what is opaque, that before what is clear, then the order of the file; the faces
//! of two dielectrics become the one boundary between their inner media. Scenes without such pairs pay for a test of an empty list.

mod find;
mod settle;
mod share;
mod sheet;

pub(crate) use share::Coincidences;
