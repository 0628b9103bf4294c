//! Stochastic progressive photon mapping `[SPPM09]`: the passes of progressive photon mapping (`ppm/`), each over new eye samples.
//!
//! Photons, gather, accounts, suspension and checkpoints are those of `ppm/algorithm.rs`, whose [`Ppm`](crate::ppm::Ppm) holds a
//! [`Renewal`] where this is the method. What hit points keep there between passes, pixels keep here (`pixels.rs`): the photons found and
//! how far radii have shrunk. `samples.rs` follows the eye samples of a pass, `seen.rs` sums the light that needs no photons, `steps.rs` has
//! the steps that a pass takes more.
//!
//! A pass's own estimate of a pixel is unbiased but for the radius, whatever its samples see. So the mean of all passes converges where
//! eye samples that stand still leave an error for good: in antialiasing, narrow gloss and, once the camera has a lens, depth of field.

mod adaptive;
mod pixels;
mod renewal;
mod samples;
mod seen;
mod steps;
#[cfg(test)]
mod tests;

pub(crate) use renewal::Renewal;
