//! What a description asks of its textures: numbers that are shares of light where a surface takes them for that, textures that are made
//! of earlier ones, and meshes that have what textures show of them.

use foton_math::Rgb;

use super::error::BuildError;
use crate::description::{Colour, Geometry, SceneDescription, ShapeDescription, Texture, TextureKind};

/// Textures inside one another may be this deep: a lookup over an area asks all of them.
const MAX_DEPTH: u32 = 8;

/// What is known of each texture.
pub(super) struct Textures<'a> {
    all: &'a [Texture],
    /// The smallest and the largest number of each.
    ranges: Vec<[f32; 2]>,
}

impl<'a> Textures<'a> {
    /// # Errors
    /// Where one is made of itself, or has numbers that are none.
    pub(super) fn check(all: &'a [Texture]) -> Result<Self, BuildError> {
        let mut ranges: Vec<[f32; 2]> = Vec::with_capacity(all.len());
        let mut depths: Vec<u32> = Vec::with_capacity(all.len());
        for texture in all {
            let bad = || BuildError::BadTexture(texture.name.clone());
            let mut depth = 0;
            let range = match &texture.kind {
                // Those that lack pixels are found where they are named.
                TextureKind::Bitmap { bitmap, .. } => of_all(bitmap.pixels.iter().copied()),
                TextureKind::Checkerboard { colours } => {
                    let mut both = [f32::INFINITY, f32::NEG_INFINITY];
                    for colour in colours {
                        let one = match *colour {
                            Colour::Constant(c) => of_all([c].into_iter()),
                            Colour::Texture(inner) => {
                                let inner_depth = depths.get(inner).ok_or_else(bad)?;
                                depth = depth.max(inner_depth + 1);
                                Some(ranges[inner])
                            }
                        };
                        let [low, high] = one.ok_or_else(bad)?;
                        both = [both[0].min(low), both[1].max(high)];
                    }
                    Some(both)
                }
                TextureKind::Attribute { scale, most, .. } => {
                    (scale.is_finite() && *most >= 0.0).then_some([0.0, *most])
                }
            };
            let range = range.filter(|_| texture.to_uv.is_finite() && depth <= MAX_DEPTH);
            ranges.push(range.ok_or_else(bad)?);
            depths.push(depth);
        }
        Ok(Self { all, ranges })
    }

    /// Whether a texture is there and has pixels.
    ///
    /// # Errors
    /// With the name of what asks for it.
    pub(super) fn is_there(&self, index: usize, asking: &str) -> Result<(), BuildError> {
        let good = match self.all.get(index).map(|t| &t.kind) {
            Some(TextureKind::Bitmap { bitmap, .. }) => bitmap.is_sound(),
            Some(TextureKind::Checkerboard { colours }) => {
                colours.iter().all(|c| inner(c).is_none_or(|i| self.is_there(i, asking).is_ok()))
            }
            Some(TextureKind::Attribute { .. }) => true,
            None => false,
        };
        if good { Ok(()) } else { Err(BuildError::NoTexture(asking.to_owned())) }
    }

    /// Whether a texture shows nothing of meshes.
    ///
    /// # Errors
    /// With the name of what asks for it.
    pub(super) fn is_of_no_mesh(&self, index: usize, asking: &str) -> Result<(), BuildError> {
        match &self.all[index].kind {
            TextureKind::Bitmap { .. } => Ok(()),
            TextureKind::Checkerboard { colours } => {
                colours.iter().filter_map(inner).try_for_each(|i| self.is_of_no_mesh(i, asking))
            }
            TextureKind::Attribute { .. } => Err(BuildError::NoTexture(asking.to_owned())),
        }
    }

    /// Whether all numbers of a texture that is there lie from 0 to `most`.
    ///
    /// # Errors
    /// With the name of the texture.
    pub(super) fn is_within(&self, index: usize, most: f32) -> Result<(), BuildError> {
        let [low, high] = self.ranges[index];
        let good = low >= 0.0 && high <= most;
        if good { Ok(()) } else { Err(BuildError::BadTexture(self.all[index].name.clone())) }
    }
}

/// The smallest and the largest channel; `None` if any is no finite number.
fn of_all(colours: impl Iterator<Item = Rgb>) -> Option<[f32; 2]> {
    let mut range = Some([f32::INFINITY, f32::NEG_INFINITY]);
    for c in colours {
        let [low, high] = range.filter(|_| c.is_finite())?;
        let [r, g, b] = c.to_array();
        range = Some([low.min(r).min(g).min(b), high.max(r).max(g).max(b)]);
    }
    range
}

fn inner(colour: &Colour) -> Option<usize> {
    match *colour {
        Colour::Constant(_) => None,
        Colour::Texture(index) => Some(index),
    }
}

/// Whether a shape has what a texture on it shows of meshes.
///
/// # Errors
/// With the name of the shape, and what it lacks.
pub(super) fn check_attributes(
    texture: usize,
    shape: &ShapeDescription,
    description: &SceneDescription,
) -> Result<(), BuildError> {
    match &description.textures[texture].kind {
        TextureKind::Bitmap { .. } => Ok(()),
        TextureKind::Checkerboard { colours } => {
            colours.iter().filter_map(inner).try_for_each(|i| check_attributes(i, shape, description))
        }
        TextureKind::Attribute { name, .. } => {
            let has = match &shape.geometry {
                Geometry::Mesh(mesh) => mesh.attributes.iter().any(|a| a.name == *name),
                _ => false,
            };
            let lacks = || BuildError::NoAttribute { shape: shape.name.clone(), attribute: name.clone() };
            if has { Ok(()) } else { Err(lacks()) }
        }
    }
}
