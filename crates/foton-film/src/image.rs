//! Images in memory: colours, scalar planes and named layers. Values only; nothing is filtered or accumulated here.

use foton_math::Rgb;

use crate::ContentError;

/// A colour image: linear radiance (W·sr⁻¹·m⁻² per channel) with sRGB primaries, row-major from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width · height` colours; pixel (x, y) stands at `y · width + x`.
    pub pixels: Vec<Rgb>,
}

impl Image {
    /// A black image.
    #[must_use]
    pub fn black(width: u32, height: u32) -> Self {
        Self { width, height, pixels: vec![Rgb::BLACK; area(width, height)] }
    }

    /// Refuses an image that has no pixels or not as many as its size says.
    pub(crate) fn check(&self) -> Result<(), ContentError> {
        let Self { width, height, ref pixels } = *self;
        if width == 0 || height == 0 {
            return Err(ContentError::Empty { width, height });
        }
        if pixels.len() != area(width, height) {
            return Err(ContentError::PixelCount { width, height, found: pixels.len() });
        }
        Ok(())
    }
}

/// One scalar per pixel, row-major from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane<T> {
    /// Values in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width · height` values; pixel (x, y) stands at `y · width + x`.
    pub values: Vec<T>,
}

/// A named image that travels beside the main one in an EXR file, of the same size.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// The prefix of its channels, such as `direct`, `caustic`, `radius`, `photon_count`; unique in a file.
    pub name: String,
    /// What it holds.
    pub channels: LayerData,
}

/// The channels of a [`Layer`].
#[derive(Clone, Debug, PartialEq)]
pub enum LayerData {
    /// Linear colours: the channels `NAME.R`, `NAME.G` and `NAME.B`.
    Rgb(Image),
    /// Measures such as a radius: the channel `NAME.Y`.
    F32(Plane<f32>),
    /// Counts and indices: the channel `NAME.Y`, stored as 32-bit integers.
    U32(Plane<u32>),
}

impl LayerData {
    /// Width, height, and the number of values per channel.
    fn shape(&self) -> (u32, u32, usize) {
        match self {
            Self::Rgb(image) => (image.width, image.height, image.pixels.len()),
            Self::F32(plane) => (plane.width, plane.height, plane.values.len()),
            Self::U32(plane) => (plane.width, plane.height, plane.values.len()),
        }
    }
}

impl Layer {
    /// Refuses a layer that does not fit over `image`, or whose name cannot prefix a channel.
    pub(crate) fn check(&self, image: &Image) -> Result<(), ContentError> {
        let name = || self.name.clone();
        if self.name.is_empty() || self.name.contains('\0') || self.name.len() > 200 {
            return Err(ContentError::LayerName { name: name() });
        }
        let (width, height, found) = self.channels.shape();
        if (width, height) != (image.width, image.height) || found != image.pixels.len() {
            let expected = (image.width, image.height);
            return Err(ContentError::LayerSize { name: name(), width, height, found, expected });
        }
        Ok(())
    }
}

/// Pixels of a `width` × `height` image.
pub(crate) fn area(width: u32, height: u32) -> usize {
    width as usize * height as usize
}
