//! What a description has already of the textures and materials of a file.

use std::collections::HashMap;
use std::rc::Rc;

use foton_math::glam::{DAffine2, DMat2, DVec2};

use super::texture::Picture;
use crate::image::Purpose;

/// What texture coordinates a surface has, seen from pbrt's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Coordinates {
    /// The same: meshes and cylinders.
    Same,
    /// Spheres, where pbrt's v begins at the lower pole.
    Sphere,
    /// Disks, where pbrt's u is the angle and its v grows towards the middle.
    Disc,
}

impl Coordinates {
    /// What makes pbrt's coordinates of the surface's.
    pub(crate) const fn to_pbrt(self) -> DAffine2 {
        let (columns, translation) = match self {
            Self::Same => ((DVec2::X, DVec2::Y), DVec2::ZERO),
            Self::Sphere => ((DVec2::X, DVec2::NEG_Y), DVec2::Y),
            Self::Disc => ((DVec2::NEG_Y, DVec2::X), DVec2::Y),
        };
        DAffine2 { matrix2: DMat2::from_cols(columns.0, columns.1), translation }
    }
}

/// What tells a texture of a description: the picture, by its address, a factor, what it is for, and the coordinates.
pub(crate) type TextureKey = (*const Picture, [u32; 3], Purpose, Coordinates);

/// Textures of a description.
#[derive(Default)]
pub(crate) struct MadeTextures {
    /// Their indices; `None` for one that is not valid, which was reported.
    pub(crate) indices: HashMap<TextureKey, Option<usize>>,
    /// Their pictures, so that no address stands for another one.
    pub(crate) pictures: Vec<Rc<Picture>>,
}

/// Materials of a description.
#[derive(Default)]
pub(crate) struct MadeMaterials {
    /// Their indices, by the number of the definition, the coordinates and the opacity; `None` for one that is not valid.
    pub(crate) indices: HashMap<(usize, Coordinates, Option<*const Picture>), Option<usize>>,
    /// Opacities, so that no address stands for another one.
    pub(crate) opacities: Vec<Rc<Picture>>,
}
