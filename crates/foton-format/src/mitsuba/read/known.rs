//! What a reader has read so far of materials and textures.

use std::collections::{HashMap, HashSet};

use foton_scene::description::{Bsdf, Colour};

use crate::image::Purpose;
use crate::mitsuba::document::NodeId;

/// Materials read so far.
#[derive(Default)]
pub(crate) struct Materials {
    /// What a BSDF's element says; `None` if that is not valid.
    pub(crate) sides: HashMap<NodeId, Option<Sides>>,
    /// The BSDF's place in the description.
    pub(crate) indices: HashMap<NodeId, usize>,
    /// Materials of shapes that name none: grey, and black for emitters.
    pub(crate) defaults: [Option<usize>; 2],
    /// BSDFs being read, outermost first.
    pub(crate) open: Vec<NodeId>,
}

/// What a BSDF says of both sides of a surface.
#[derive(Clone, Copy)]
pub(crate) struct Sides {
    pub(crate) front: Bsdf,
    pub(crate) back: Option<Bsdf>,
    pub(crate) opacity: Option<Colour>,
}

/// Textures read so far.
#[derive(Default)]
pub(crate) struct Textures {
    /// Indices by element and purpose; `None` if it is not valid.
    pub(crate) indices: HashMap<(NodeId, Purpose), Option<usize>>,
    /// Textures being read, outermost first.
    pub(crate) open: Vec<NodeId>,
    /// Textures that were read.
    pub(crate) used: HashSet<NodeId>,
}
