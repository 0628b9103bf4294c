//! Colours and numbers, and pictures of them over texture coordinates.

use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::DAffine2;

use crate::bitmap::{Bitmap, Wrap};

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

/// A number, or what is known of one: the ends between which it lies.
pub trait Amount: Copy {
    /// The least that it may be.
    fn least(self) -> f32;
    /// The most that it may be.
    fn most(self) -> f32;
}

impl Amount for f32 {
    fn least(self) -> f32 {
        self
    }

    fn most(self) -> f32 {
        self
    }
}

impl Amount for Number {
    /// Of a texture 0.
    fn least(self) -> f32 {
        self.constant().unwrap_or(0.0)
    }

    /// Of a texture 1.
    fn most(self) -> f32 {
        self.constant().unwrap_or(1.0)
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
        /// The two colours. A texture stands before this one in the list, and takes the coordinates of the surface.
        colours: [Colour; 2],
    },
    /// What a mesh states of its vertices or faces.
    Attribute {
        /// The name of the mesh's [`Attribute`](super::Attribute).
        name: String,
        /// Factor on the values.
        scale: f32,
        /// The largest number that comes of it: 1 for a share of light. What is below zero is zero.
        most: f32,
    },
}
