//! A shape as a file states it, before it stands at its place in the world: those of objects stand at many.

use std::rc::Rc;
use std::sync::Arc;

use foton_math::Rgb;
use foton_scene::description::Mesh;

use super::round::Round;
use super::state::{Definition, Transforms};
use super::texture::ImageFile;
use super::texture::Picture;
use crate::diagnostic::Place;

/// A surface in its own space.
pub(crate) enum Body {
    Mesh(Arc<Mesh>),
    Round(Round),
}

/// A shape that has no place in the world yet.
pub(crate) struct Shape {
    pub(crate) body: Body,
    /// To the space of its object, or to the world.
    pub(crate) transforms: Transforms,
    /// Whether the file turns its normals around.
    pub(crate) reverses: bool,
    pub(crate) material: Rc<Definition>,
    /// Share of light that meets it at all.
    pub(crate) opacity: Option<Rc<Picture>>,
    pub(crate) emission: Option<Emission>,
    /// Of its directive.
    pub(crate) place: Place,
}

/// What a shape emits.
pub(crate) struct Emission {
    /// Radiance, before a picture or a power changes it.
    pub(crate) radiance: Rgb,
    pub(crate) picture: Option<ImageFile>,
    /// Luminous power of all of the shape, which its radiance is scaled to.
    pub(crate) power: Option<f64>,
    pub(crate) two_sided: bool,
}
