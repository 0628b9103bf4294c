//! What a reader has read so far of materials and textures.

use std::collections::{HashMap, HashSet};

use foton_scene::description::{Bsdf, Coating, Colour, Number, Relief};

use crate::diagnostic::Place;
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

/// What a BSDF says of both sides of a surface: a material before it stands in the description.
#[derive(Clone)]
pub(crate) struct Sides {
    pub(crate) front: Bsdf,
    pub(crate) back: Option<Bsdf>,
    pub(crate) coatings: [Option<Coating>; 2],
    pub(crate) opacity: Option<Colour>,
    pub(crate) relief: Option<Relief>,
    /// What is blended with it in turn, each with its share.
    pub(crate) mixture: Vec<(Sides, Number)>,
    /// The element that says it, if no other material refers to that.
    pub(crate) node: Option<NodeId>,
}

impl Sides {
    /// One side that is described by a BSDF alone.
    pub(crate) const fn of(front: Bsdf) -> Self {
        Self {
            front,
            back: None,
            coatings: [None; 2],
            opacity: None,
            relief: None,
            mixture: Vec::new(),
            node: None,
        }
    }

    /// Changes this material and all that are blended with it.
    pub(crate) fn for_each<E>(
        &mut self,
        change: &mut impl FnMut(&mut Self) -> Result<(), E>,
    ) -> Result<(), E> {
        change(self)?;
        self.mixture.iter_mut().try_for_each(|(other, _)| other.for_each(change))
    }
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
    /// Where those of the description stand.
    pub(crate) places: HashMap<usize, Place>,
    /// Textures of what a mesh does not state, with the file of the mesh, that were reported.
    pub(crate) lacking: HashSet<(usize, String)>,
}
