//! What passes have made: images, layers, errors.

use foton_film::{Image, Layer};
use foton_math::Rgb;

use super::{Render, Running};
use crate::error::{ErrorEstimate, TileError};
use crate::layers::LayerKind;

impl Render {
    /// Radiance after all passes so far.
    #[must_use]
    pub fn image(&self) -> Image {
        each!(&self.0, r => r.image())
    }

    /// Radiance of one pixel as it stands; black beyond the image.
    #[must_use]
    pub fn radiance(&self, pixel: usize) -> Rgb {
        each!(&self.0, r => r.radiance(pixel))
    }

    /// The last pass's own, independent estimate of what photons bring: their part of the image is the mean of these, weighted by
    /// photons.
    #[must_use]
    pub fn last_pass(&self) -> Image {
        each!(&self.0, r => r.last_pass())
    }

    /// Luminance of each pixel's direct light by shadow rays (W/m²/sr) and its variance; `None` where photons bring it.
    #[must_use]
    pub fn direct_light(&self) -> Option<Vec<(f64, f64)>> {
        each!(&self.0, r => r.direct_light())
    }

    /// A layer beside the image; `None` for one that is not made.
    #[must_use]
    pub fn layer(&self, kind: LayerKind) -> Option<Layer> {
        each!(&self.0, r => r.layer(kind))
    }

    /// A layer of light; `None` for one that is not made, or no light.
    #[must_use]
    pub fn colour_layer(&self, kind: LayerKind) -> Option<Image> {
        each!(&self.0, r => r.colour_layer(kind))
    }

    /// Photons of the passes whose light was summed by class, fewer than [`Render::photons_emitted`] where a state without that was
    /// restored; `None` without [`RenderSettings::layers`](crate::RenderSettings::layers).
    #[must_use]
    pub fn photons_by_class(&self) -> Option<u64> {
        each!(&self.0, r => r.photons_by_class())
    }

    /// How wrong the image still is; `None` without [`RenderSettings::error`](crate::RenderSettings::error), in the first passes, and in the dark.
    #[must_use]
    pub fn error(&self) -> Option<ErrorEstimate> {
        each!(&self.0, r => r.error())
    }

    /// The means of all squares of 8 × 8 pixels with their errors, row by row; none without [`RenderSettings::error`](crate::RenderSettings::error).
    #[must_use]
    pub fn error_tiles(&self) -> Vec<TileError> {
        each!(&self.0, r => r.error_tiles())
    }

    /// The bias of each pixel's luminance, as estimated (W/m²/sr): with its sign, and √3 times as noisy as the pixel. `None`
    /// without [`RenderSettings::error`](crate::RenderSettings::error).
    #[must_use]
    pub fn bias(&self) -> Option<Vec<f64>> {
        each!(&self.0, r => r.bias())
    }

    /// One of the errors' layers, in luminance (W/m²/sr); `None` for other layers, and without [`RenderSettings::error`](crate::RenderSettings::error).
    #[must_use]
    pub fn error_plane(&self, kind: LayerKind) -> Option<Vec<f32>> {
        each!(&self.0, r => r.error_plane(kind))
    }
}
