//! The nearest photons of a point.

use foton_math::glam::Vec3;

use super::packed_photon::PackedPhoton;
use super::tree::KdTree;

/// Levels of a tree with as many photons as single indices tell apart.
const LEVELS: usize = 33;

/// A photon that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Its squared distance.
    pub distance2: f32,
    /// Its place in [`KdTree::nodes`].
    pub index: u32,
}

impl Found {
    /// Nearer first; of equally near ones the first in the tree.
    #[inline]
    fn is_before(&self, other: &Self) -> bool {
        (self.distance2, self.index) < (other.distance2, other.index)
    }
}

/// The nearest photons that a search has found: at most as many as were asked for. To be used again, so that searches need no new memory.
#[derive(Clone, Debug, Default)]
pub struct Nearest {
    /// Once it is full, a heap: none of `2i + 1` and `2i + 2` is behind `i`, so that the farthest is the first.
    found: Vec<Found>,
    wanted: usize,
    /// No photon beyond is of interest.
    limit2: f32,
}

impl Nearest {
    /// The photons, in no particular order, but in the same one each time.
    #[must_use]
    pub fn found(&self) -> &[Found] {
        &self.found
    }

    /// The farthest photon, if there are as many as were asked for.
    #[must_use]
    pub fn farthest(&self) -> Option<Found> {
        if self.found.len() == self.wanted { self.found.first().copied() } else { None }
    }

    fn add(&mut self, photon: Found) {
        if self.found.len() < self.wanted {
            self.found.push(photon);
            if self.found.len() == self.wanted {
                (0..self.wanted / 2).rev().for_each(|i| self.sink(i));
                self.limit2 = self.found[0].distance2;
            }
        } else if photon.is_before(&self.found[0]) {
            self.found[0] = photon;
            self.sink(0);
            self.limit2 = self.found[0].distance2;
        }
    }

    /// Moves an entry down to where none below is behind it.
    fn sink(&mut self, mut at: usize) {
        loop {
            let mut last = at;
            for child in [2 * at + 1, 2 * at + 2] {
                if child < self.found.len() && self.found[last].is_before(&self.found[child]) {
                    last = child;
                }
            }
            if last == at {
                return;
            }
            self.found.swap(at, last);
            at = last;
        }
    }
}

impl KdTree {
    /// Finds the `wanted` nearest photons of a point within a distance among those that count; `counts` gets each with its offset from
    /// the point.
    #[inline]
    pub fn nearest(
        &self,
        point: Vec3,
        distance2: f32,
        wanted: usize,
        into: &mut Nearest,
        counts: impl Fn(&PackedPhoton, Vec3) -> bool,
    ) {
        into.found.clear();
        (into.wanted, into.limit2) = (wanted, distance2);
        if wanted > 0 {
            self.visit(point, distance2, |photon, offset, here| {
                if counts(photon, offset) {
                    into.add(here);
                }
                into.limit2
            });
        }
    }

    /// The nearest photon of a point within a distance that counts.
    #[inline]
    #[must_use]
    pub fn nearest_one(
        &self,
        point: Vec3,
        distance2: f32,
        counts: impl Fn(&PackedPhoton, Vec3) -> bool,
    ) -> Option<Found> {
        let mut found: Option<Found> = None;
        self.visit(point, distance2, |photon, offset, here| {
            if found.is_none_or(|f| here.is_before(&f)) && counts(photon, offset) {
                found = Some(here);
            }
            found.map_or(distance2, |f| f.distance2)
        });
        found
    }

    /// Visits photons within a distance of a point, near ones first as far as the tree knows, each with its offset. `of` gives the squared
    /// distance within which further ones are still of interest.
    #[inline(always)]
    fn visit(&self, point: Vec3, distance2: f32, mut of: impl FnMut(&PackedPhoton, Vec3, Found) -> f32) {
        let (nodes, mut limit2) = (self.nodes(), distance2);
        // Nodes that wait, each with the squared distance to the plane that it lies behind.
        let mut waiting = [(0u32, 0f32); LEVELS];
        let (mut depth, mut node) = (0, 0);
        loop {
            while let Some(photon) = nodes.get(node) {
                let offset = photon.position - point;
                let here = Found { distance2: offset.length_squared(), index: node as u32 };
                if here.distance2 <= limit2 {
                    limit2 = of(photon, offset, here);
                }
                let ahead = offset[photon.axis()];
                let (near, far) =
                    (2 * node + 1 + usize::from(ahead < 0.0), 2 * node + 1 + usize::from(ahead >= 0.0));
                if far < nodes.len() && ahead * ahead <= limit2 {
                    waiting[depth % LEVELS] = (far as u32, ahead * ahead);
                    depth += 1;
                }
                node = near;
            }
            loop {
                if depth == 0 {
                    return;
                }
                depth -= 1;
                let (far, behind2) = waiting[depth];
                if behind2 <= limit2 {
                    node = far as usize;
                    break;
                }
            }
        }
    }
}
