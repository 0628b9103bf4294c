//! Images: radiance, layers beside it, and its errors pixel by pixel.

use foton_film::{Image, Layer, LayerData, Plane};
use foton_math::Rgb;
use foton_transport::photon_map::PathClass;

use super::algorithm::Ppm;
use super::statistics::Statistics;
use crate::error::{ErrorEstimate, TileError};
use crate::layers::LayerKind;
use crate::sppm::Renewal;

impl Ppm {
    /// Image size in pixels.
    pub(crate) fn size(&self) -> (u32, u32) {
        let sensor = &self.scene.sensors()[self.settings.sensor];
        (sensor.width, sensor.height)
    }

    pub(super) fn as_image(&self, pixels: Vec<Rgb>) -> Image {
        let (width, height) = self.size();
        Image { width, height, pixels }
    }

    /// Radiance after all passes so far.
    #[must_use]
    pub(crate) fn image(&self) -> Image {
        let mut pixels = self.light.total(self.photons_emitted);
        self.add_direct(&mut pixels);
        pixels.iter_mut().enumerate().for_each(|(pixel, light)| *light += self.seen_emission(pixel));
        self.as_image(pixels)
    }

    /// Adds what shadow rays have brought.
    fn add_direct(&self, pixels: &mut [Rgb]) {
        if self.has_shadow_rays() {
            pixels.iter_mut().enumerate().for_each(|(pixel, light)| *light += self.direct_radiance(pixel));
        }
    }

    /// What shadow rays have brought to a pixel.
    fn direct_radiance(&self, pixel: usize) -> Rgb {
        let renewed = |renewal: &Renewal| renewal.seen.direct(pixel, self.photons_emitted);
        let of_renewal = || self.renewal.as_deref().map_or(Rgb::BLACK, renewed);
        self.direct.as_ref().map_or_else(of_renewal, |direct| direct.radiance(pixel))
    }

    /// Radiance of emitters that a pixel sees directly or by specular bounces, where that is not in its light from the start.
    fn seen_emission(&self, pixel: usize) -> Rgb {
        self.renewal
            .as_deref()
            .map_or(Rgb::BLACK, |renewal| renewal.seen.emission(pixel, self.photons_emitted))
    }

    /// Radiance of one pixel as it stands; black beyond the image.
    #[must_use]
    pub(crate) fn radiance(&self, pixel: usize) -> Rgb {
        let mut light = self.light.pixel(pixel, self.photons_emitted);
        if pixel < self.shapes.len() {
            light += self.direct_radiance(pixel);
            light += self.seen_emission(pixel);
        }
        light
    }

    /// Luminance of each pixel's direct light by shadow rays and its variance; `None` where photons bring it.
    #[must_use]
    pub(crate) fn direct_light(&self) -> Option<Vec<(f64, f64)>> {
        let direct = self.direct.as_ref()?;
        let elsewhere = direct.noise(0..self.shapes.len()).per_visit(0.0);
        let of = |pixel| direct.known(pixel).mean_and_variance(elsewhere);
        Some((0..self.shapes.len()).map(of).collect())
    }

    /// The last pass's own, independent estimate of what photons bring: their part of the image is the mean of these, weighted by photons.
    #[must_use]
    pub(crate) fn last_pass(&self) -> Image {
        let scale = 1.0 / self.last_photons.max(1) as f64;
        let pixels = self.light.last_pass().into_iter().map(|l| l * scale as f32);
        self.as_image(pixels.collect())
    }

    /// The statistics of a pixel's hit point in sample order.
    pub(super) fn statistics(&self, pixel: usize, h: usize) -> Statistics {
        let hit_points = &self.hit_points;
        let of_slot = || hit_points.statistics_of(hit_points.slot_of[h] as usize);
        self.renewal.as_deref().map_or_else(of_slot, |renewal| renewal.statistics(hit_points, pixel, h))
    }

    pub(super) fn per_pixel<T>(&self, f: impl Fn(&[Statistics]) -> T) -> Vec<T> {
        let mut statistics = self.hit_points.in_sample_order();
        let mut of_pixel = Vec::new();
        let spans = self.hit_points.pixel_start.windows(2).map(|w| (w[1] - w[0]) as usize);
        spans
            .map(|n| {
                of_pixel.clear();
                of_pixel.extend(statistics.by_ref().take(n));
                f(&of_pixel)
            })
            .collect()
    }

    /// A layer beside the image; `None` for a path class when [`RenderSettings::layers`](crate::RenderSettings::layers) is off.
    #[must_use]
    pub(crate) fn layer(&self, kind: LayerKind) -> Option<Layer> {
        let rgb = |kind| self.colour_layer(kind).map(LayerData::Rgb);
        let (width, height) = self.size();
        let channels = match kind {
            LayerKind::Direct | LayerKind::Caustic | LayerKind::Indirect | LayerKind::Emission => rgb(kind)?,
            LayerKind::Radius => LayerData::F32(Plane { width, height, values: self.mean_radii() }),
            LayerKind::PhotonCount => LayerData::U32(Plane { width, height, values: self.photons_found() }),
            LayerKind::ShapeId => LayerData::U32(Plane { width, height, values: self.shapes.to_vec() }),
            LayerKind::ErrorNoise | LayerKind::ErrorBias | LayerKind::ErrorTotal => {
                LayerData::F32(Plane { width, height, values: self.error_plane(kind)? })
            }
        };
        Some(Layer { name: kind.name().to_owned(), channels })
    }

    /// A layer of light; `None` for one that is not summed, or not of light.
    #[must_use]
    pub(crate) fn colour_layer(&self, kind: LayerKind) -> Option<Image> {
        let class = |class| self.light.class(class);
        let pixels = match kind {
            LayerKind::Direct => {
                let mut pixels = class(PathClass::Direct)?;
                self.add_direct(&mut pixels);
                pixels
            }
            LayerKind::Caustic => class(PathClass::Caustic)?,
            LayerKind::Indirect => class(PathClass::Indirect)?,
            LayerKind::Emission if self.renewal.is_some() => {
                (0..self.shapes.len()).map(|pixel| self.seen_emission(pixel)).collect()
            }
            LayerKind::Emission => self.light.emission().to_vec(),
            _ => return None,
        };
        Some(self.as_image(pixels))
    }

    /// Photons of the passes whose light was summed by class; `None` where none is.
    #[must_use]
    pub(crate) fn photons_by_class(&self) -> Option<u64> {
        self.light.photons_by_class()
    }

    /// How wrong the image still is; `None` without [`RenderSettings::error`](crate::RenderSettings::error), in the first passes, and in the dark.
    #[must_use]
    pub(crate) fn error(&self) -> Option<ErrorEstimate> {
        self.error.as_ref()?.estimate()
    }

    /// The means of all squares of 8 × 8 pixels with their errors, row by row; none without [`RenderSettings::error`](crate::RenderSettings::error).
    #[must_use]
    pub(crate) fn error_tiles(&self) -> Vec<TileError> {
        self.error.as_ref().map_or_else(Vec::new, |error| error.tiles(self.direct.as_ref()))
    }

    /// What bias from the radius has added to each pixel's luminance, as estimated (W/m²/sr): with its sign, and √3 times as noisy as the
    /// pixel. `None` without [`RenderSettings::error`](crate::RenderSettings::error).
    #[must_use]
    pub(crate) fn bias(&self) -> Option<Vec<f64>> {
        Some(self.error.as_ref()?.bias())
    }

    /// One of the errors' layers, in luminance (W/m²/sr); `None` for other layers, and without [`RenderSettings::error`](crate::RenderSettings::error).
    #[must_use]
    pub(crate) fn error_plane(&self, kind: LayerKind) -> Option<Vec<f32>> {
        let apart = (self.direct.as_ref(), self.renewal.as_deref());
        let (noise, bias) = self.light.error_planes(self.error.as_ref()?, apart);
        match kind {
            LayerKind::ErrorNoise => Some(noise),
            LayerKind::ErrorBias => Some(bias),
            LayerKind::ErrorTotal => Some(noise.iter().zip(&bias).map(|(n, b)| n.hypot(*b)).collect()),
            _ => None,
        }
    }
}
