//! How far an image is from its reference: RMSE, relMSE, means, FLIP, and a picture of where they differ.
//!
//! All of it works on linear images in memory; reading and writing them is `foton-film`'s. A pixel that is not finite
//! in either image is counted, left out of every figure and marked in every map, never averaged. Whether a
//! difference is noise takes several renders with different seeds: [`sweep`] makes them.
//!
//! ```
//! use foton_film::Image;
//! use foton_math::Rgb;
//! use foton_measure::Pair;
//!
//! let reference = Image { width: 2, height: 1, pixels: vec![Rgb::splat(0.5), Rgb::splat(2.0)] };
//! let image = Image { width: 2, height: 1, pixels: vec![Rgb::splat(0.5), Rgb::splat(2.2)] };
//! let pair = Pair::new(&image, &reference)?;
//! assert!((pair.rmse().all - (0.04f64 / 2.0).sqrt()).abs() < 1e-7);
//! assert!((pair.rel_mse().all - 0.04 / 4.01 / 2.0).abs() < 1e-8);
//! assert!((pair.ratio().all - 2.7 / 2.5).abs() < 1e-7);
//! // Both pixels are beyond white in one channel or equal: a display, and so FLIP, sees no difference.
//! assert_eq!(pair.flip().mean, 0.0);
//! # Ok::<(), foton_measure::CompareError>(())
//! ```

mod convolve;
mod flip;
mod heat;
mod pair;
pub mod plot;
mod sheet;
pub mod sweep;
mod white;

pub use flip::{Flip, PIXELS_PER_DEGREE};
pub use heat::{heat, scale_top, viridis};
pub use pair::{Channels, CompareError, NonFinite, Pair};
pub use sheet::{Panel, contact_sheet};
pub use sweep::processor_time;
pub use white::without_bright_emitters;
