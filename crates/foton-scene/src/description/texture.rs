//! Colours and numbers, and pictures of them over texture coordinates.

use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::DAffine2;

/// A colour that is the same everywhere, or comes from a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Colour {
    /// The same everywhere.
    Constant(Rgb),
    /// Index into [`SceneDescription::textures`](super::SceneDescription::textures).
    Texture(usize),
}

impl From<Rgb> for Colour {
    fn from(c: Rgb) -> Self {
        Self::Constant(c)
    }
}

/// A number that is the same everywhere, or comes from a texture.
///
/// A texture's number is the luminance of a bitmap and the mean channel of other colours, as in Mitsuba 3, brought into the range of
/// what it stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Number {
    /// The same everywhere.
    Constant(f32),
    /// Index into [`SceneDescription::textures`](super::SceneDescription::textures).
    Texture(usize),
}

impl Number {
    /// The number where it is the same everywhere.
    #[must_use]
    pub const fn constant(self) -> Option<f32> {
        if let Self::Constant(x) = self { Some(x) } else { None }
    }
}

impl From<f32> for Number {
    fn from(x: f32) -> Self {
        Self::Constant(x)
    }
}

/// A colour over texture coordinates.
#[derive(Clone, Debug)]
pub struct Texture {
    /// The id in the file, or a name made from the type.
    pub name: String,
    /// Applied to texture coordinates before the lookup.
    pub to_uv: DAffine2,
    /// Where the colour comes from.
    pub kind: TextureKind,
}

/// Where a texture's colour comes from.
#[derive(Clone, Debug)]
pub enum TextureKind {
    /// Pixels.
    Bitmap {
        /// The pixels.
        bitmap: Arc<Bitmap>,
        /// What lies beyond the unit square.
        wrap: Wrap,
        /// Whether colours are interpolated between pixel centres.
        bilinear: bool,
    },
    /// Two colours on a board of 2 × 2 fields to the unit square; the field at the origin has the first.
    Checkerboard {
        /// The two colours.
        colours: [Rgb; 2],
    },
}

/// Linear pixels, row-major from the top left; texture coordinate v points up, so v = 0 is the last row's lower edge.
#[derive(Clone, Debug, Default)]
pub struct Bitmap {
    /// Width in pixels, at least 1.
    pub width: u32,
    /// Height in pixels, at least 1.
    pub height: u32,
    /// `width × height` pixels.
    pub pixels: Vec<Rgb>,
}

impl Bitmap {
    /// Whether there is at least one pixel, and as many as width and height say.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        let pixels = u64::from(self.width) * u64::from(self.height);
        pixels > 0 && pixels == self.pixels.len() as u64
    }
}

/// What a bitmap shows beyond the unit square.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The same again.
    #[default]
    Repeat,
    /// The same again, mirrored each time.
    Mirror,
    /// The edge's pixels.
    Clamp,
}
