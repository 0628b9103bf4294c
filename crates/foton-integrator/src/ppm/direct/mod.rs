//! Direct light by shadow rays, with sums of its own: it does not depend on photons, nor its weights on how many there are.
//!
//! A pixel's hit points are lit together, so that one *visit* by shadow rays is one unbiased estimate of its direct light. The
//! first pass lights every pixel; from then on passes take turns with them (`order.rs`), as many as make the rays up to a quarter
//! of a pass, the more the noisier a pilot finds them, by what is counted and never by clocks. Light of points, spots and suns is the same each time: it is found once.
//!
//! Visits take turns with two sequences of Sobol' points, whose scrambles are independent: the points of each are stratified, so that
//! the noise falls faster than that of independent ones, and the difference of both sequences' means still says how large it is
//! `[OWE98]`. Rays of one pixel never serve another, so variances of pixels add up.

mod choice;
mod lighting;
mod lit;
mod noise;
mod order;
mod sums;

pub(crate) use choice::by_shadow_rays;
pub(crate) use lighting::Lighting;
pub(crate) use lit::Lit;
pub(crate) use noise::Noise;
pub(crate) use sums::Direct;
