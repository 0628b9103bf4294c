//! Building the tree: level by level the median along the longest side of what is left.

use std::cmp::Ordering;

use foton_math::Aabb;
use foton_math::glam::Vec3;
use rayon::prelude::*;

use super::balance::{in_order, left_of};
use super::packed_photon::PackedPhoton;

/// Trees of fewer photons are built by one thread.
const BY_ONE_THREAD: usize = 4096;

/// Photons as a left-balanced tree.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KdTree {
    /// Level by level: the children of node i are 2i + 1 and 2i + 2.
    nodes: Vec<PackedPhoton>,
}

impl KdTree {
    /// The tree of some photons. It depends on which they are, not on their order, nor on threads.
    #[must_use]
    pub fn new(mut photons: Vec<PackedPhoton>) -> Self {
        divide(&mut photons);
        let n = photons.len();
        let nodes = (0..n).into_par_iter().map(|node| photons[in_order(node, n)]).collect();
        Self { nodes }
    }

    /// The tree with these nodes, level by level; `None` if they are not in the order of one.
    #[must_use]
    pub fn from_nodes(nodes: Vec<PackedPhoton>) -> Option<Self> {
        let tree = Self { nodes };
        let all = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };
        tree.is_ordered(0, all).then_some(tree)
    }

    /// Whether the tree below a node lies in a box, and each half of it on its side.
    fn is_ordered(&self, node: usize, within: Aabb) -> bool {
        let Some(photon) = self.nodes.get(node) else { return true };
        let (axis, at) = (photon.axis(), photon.position);
        if at.cmplt(within.min).any() || at.cmpgt(within.max).any() {
            return false;
        }
        let (mut below, mut above) = (within, within);
        below.max[axis] = at[axis];
        above.min[axis] = at[axis];
        self.is_ordered(2 * node + 1, below) && self.is_ordered(2 * node + 2, above)
    }

    /// All photons, level by level.
    #[must_use]
    #[inline]
    pub fn nodes(&self) -> &[PackedPhoton] {
        &self.nodes
    }

    /// How many photons there are.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there is none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Bytes held.
    #[must_use]
    pub const fn bytes(&self) -> usize {
        self.nodes.capacity() * size_of::<PackedPhoton>()
    }
}

/// Orders photons such that the root of their tree stands behind all that is left of it, and so on below.
fn divide(photons: &mut [PackedPhoton]) {
    if photons.is_empty() {
        return;
    }
    let axis = longest_side(photons);
    let (left, root, right) =
        photons.select_nth_unstable_by(left_of(photons.len()), |a, b| along(axis, a, b));
    root.set_axis(axis);
    if left.len() < BY_ONE_THREAD {
        divide(left);
        divide(right);
    } else {
        rayon::join(|| divide(left), || divide(right));
    }
}

/// The axis along which photons spread most.
fn longest_side(photons: &[PackedPhoton]) -> usize {
    let bounds = photons.iter().fold(Aabb::EMPTY, |b, p| b.with(p.position));
    let size = bounds.size();
    if size.x >= size.y && size.x >= size.z { 0 } else { 1 + usize::from(size.z > size.y) }
}

/// By one coordinate; where that is equal, by all else that the photons are, so that the order of none is left to chance.
fn along(axis: usize, a: &PackedPhoton, b: &PackedPhoton) -> Ordering {
    a.position[axis].total_cmp(&b.position[axis]).then_with(|| a.rank().cmp(&b.rank()))
}
