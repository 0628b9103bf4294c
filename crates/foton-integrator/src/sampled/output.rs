//! Images, layers and errors, pixel by pixel.

use foton_film::{Image, Layer, LayerData, Plane};
use foton_math::Rgb;
use foton_math::glam::DVec3;
use foton_transport::photon_map::PathClass;

use super::algorithm::Sampled;
use crate::error::{ErrorEstimate, TileError};
use crate::layers::LayerKind;
use crate::ppm::{Disc, PhotonPath, Radii, StoredPhoton};

impl Sampled {
    fn size(&self) -> (u32, u32) {
        let sensor = &self.scene.sensors()[self.settings.sensor];
        (sensor.width, sensor.height)
    }

    fn as_image(&self, pixels: Vec<Rgb>) -> Image {
        let (width, height) = self.size();
        Image { width, height, pixels }
    }

    pub(crate) fn image(&self) -> Image {
        self.as_image(self.sums.image())
    }

    pub(crate) fn radiance(&self, pixel: usize) -> Rgb {
        self.sums.radiance(pixel)
    }

    pub(crate) fn last_pass(&self) -> Image {
        self.as_image(self.sums.last.clone())
    }

    /// Nothing is apart from the rest.
    pub(crate) const fn direct_light(&self) -> Option<Vec<(f64, f64)>> {
        None
    }

    pub(crate) fn layer(&self, kind: LayerKind) -> Option<Layer> {
        let (width, height) = self.size();
        let channels = match kind {
            LayerKind::Direct | LayerKind::Caustic | LayerKind::Indirect | LayerKind::Emission => {
                LayerData::Rgb(self.colour_layer(kind)?)
            }
            LayerKind::Radius | LayerKind::PhotonCount => return None,
            LayerKind::ShapeId => LayerData::U32(Plane { width, height, values: self.sums.shapes.clone() }),
            LayerKind::ErrorNoise | LayerKind::ErrorBias | LayerKind::ErrorTotal => {
                LayerData::F32(Plane { width, height, values: self.error_plane(kind)? })
            }
        };
        Some(Layer { name: kind.name().to_owned(), channels })
    }

    pub(crate) fn colour_layer(&self, kind: LayerKind) -> Option<Image> {
        let pixels = match kind {
            LayerKind::Direct => self.sums.class(PathClass::Direct)?,
            LayerKind::Caustic => self.sums.class(PathClass::Caustic)?,
            LayerKind::Indirect => self.sums.class(PathClass::Indirect)?,
            LayerKind::Emission => self.sums.emission(),
            _ => return None,
        };
        Some(self.as_image(pixels))
    }

    /// None of none, where light is summed by class.
    pub(crate) fn photons_by_class(&self) -> Option<u64> {
        self.sums.has_classes().then_some(0)
    }

    pub(crate) fn error(&self) -> Option<ErrorEstimate> {
        let error = self.sums.error.as_ref()?;
        let is_unknown = self.settings.method.error_is_unknown(&self.scene).is_some();
        error.estimate().filter(|_| !is_unknown)
    }

    pub(crate) fn error_tiles(&self) -> Vec<TileError> {
        self.sums.error.as_ref().map_or_else(Vec::new, |error| error.tiles())
    }

    pub(crate) fn bias(&self) -> Option<Vec<f64>> {
        self.sums.error.as_ref().map(|_| vec![0.0; self.pixels()])
    }

    pub(crate) fn error_plane(&self, kind: LayerKind) -> Option<Vec<f32>> {
        let error = self.sums.error.as_ref()?;
        match kind {
            LayerKind::ErrorNoise | LayerKind::ErrorTotal => Some(error.noise()),
            LayerKind::ErrorBias => Some(vec![0.0; self.pixels()]),
            _ => None,
        }
    }
}

/// Hit points and photons, of which there are none.
impl Sampled {
    pub(crate) fn radii(&self) -> Radii {
        Radii::default()
    }

    pub(crate) const fn discs(&self, _pixel: usize) -> Vec<Disc> {
        Vec::new()
    }

    pub(crate) const fn stored_photons(&self, _at_most: usize) -> Vec<StoredPhoton> {
        Vec::new()
    }

    pub(crate) const fn photons_near(
        &self,
        _position: DVec3,
        _radius: f64,
        _at_most: usize,
    ) -> Vec<StoredPhoton> {
        Vec::new()
    }

    pub(crate) const fn paths_to(&self, _pixel: usize, _at_most: usize) -> Vec<PhotonPath> {
        Vec::new()
    }

    pub(crate) fn mean_radii(&self) -> Vec<f32> {
        vec![0.0; self.pixels()]
    }

    pub(crate) fn photons_found(&self) -> Vec<u32> {
        vec![0; self.pixels()]
    }

    pub(crate) fn unknown_share(&self) -> Vec<f32> {
        vec![0.0; self.pixels()]
    }
}
