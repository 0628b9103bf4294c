//! Textures as pbrt composes them, before they become textures of a description.

use std::rc::Rc;

use foton_math::Rgb;
use foton_math::glam::DAffine2;
use foton_scene::description::Wrap;

use crate::image::Curve;
use crate::mitsuba::read::properties::Located;

/// A colour over texture coordinates; a number is a grey.
#[derive(Clone, Debug)]
pub(crate) enum Picture {
    /// The same everywhere.
    Constant(Rgb),
    /// Pixels of a file.
    Image(ImageFile),
    /// Squares of side 1 in turn; the one at the origin has the first.
    Squares { to_st: DAffine2, squares: [Rc<Self>; 2] },
    /// One times the other.
    Product([Rc<Self>; 2]),
    /// From the first to the second by an amount.
    Mix { ends: [Rc<Self>; 2], amount: Rc<Self> },
    /// Numbers by a function of them.
    Curved { of: Rc<Self>, by: fn(f32) -> f32 },
    /// Interpolated between the corners (0, 0), (0, 1), (1, 0) and (1, 1).
    Corners { to_st: DAffine2, colours: [Rgb; 4] },
}

/// Pixels of a file, and what becomes of them.
#[derive(Clone, Debug)]
pub(crate) struct ImageFile {
    pub(crate) filename: Located<String>,
    pub(crate) curve: Curve,
    pub(crate) scale: f32,
    /// Whether each number x is 1 − x, before it is scaled.
    pub(crate) invert: bool,
    pub(crate) wrap: Wrap,
    pub(crate) bilinear: bool,
    pub(crate) to_st: DAffine2,
}

impl Picture {
    /// The colour where it is the same everywhere.
    pub(crate) const fn constant(&self) -> Option<Rgb> {
        if let Self::Constant(colour) = self { Some(*colour) } else { None }
    }

    /// One picture times another.
    pub(crate) fn product(a: Rc<Self>, b: Rc<Self>) -> Rc<Self> {
        match (a.constant(), b.constant()) {
            (Some(x), Some(y)) => Rc::new(Self::Constant(x * y)),
            (Some(Rgb::WHITE), _) => b,
            (_, Some(Rgb::WHITE)) => a,
            _ => Rc::new(Self::Product([a, b])),
        }
    }

    /// The same times a number.
    pub(crate) fn times(self: &Rc<Self>, factor: f32) -> Rc<Self> {
        Self::product(Rc::clone(self), Rc::new(Self::Constant(Rgb::splat(factor))))
    }
}
