//! What a walk through a tree keeps: the places that are still to be visited, and the nearest hit so far.

use foton_math::glam::Vec4;

use super::node::{Child, Node, WIDTH};

/// Places on a ray's stack before it spills to the heap.
const STACK: usize = 32;

/// A place in the tree that a ray has still to visit.
#[derive(Clone, Copy)]
pub(super) struct Place {
    /// Where the ray enters its box.
    pub(super) t: f32,
    pub(super) child: Child,
}

/// Places to visit, the next on top. Few trees are deep enough for the heap.
pub(super) struct Stack {
    places: [Place; STACK],
    length: usize,
    spilled: Vec<Place>,
}

impl Stack {
    #[inline(always)]
    pub(super) const fn new() -> Self {
        Self { places: [Place { t: 0.0, child: Child::NONE }; STACK], length: 0, spilled: Vec::new() }
    }

    #[inline(always)]
    pub(super) fn push(&mut self, place: Place) {
        if let Some(free) = self.places.get_mut(self.length) {
            *free = place;
            self.length += 1;
        } else {
            self.spilled.push(place);
        }
    }

    #[inline(always)]
    pub(super) fn pop(&mut self) -> Option<Place> {
        if let Some(spilled) = self.spilled.pop() {
            return Some(spilled);
        }
        self.length = self.length.checked_sub(1)?;
        self.places.get(self.length).copied()
    }
}

/// The lowest slot of those in the mask.
#[inline(always)]
pub(super) const fn slot_of(entered: u32) -> usize {
    entered.trailing_zeros() as usize & (WIDTH - 1)
}

/// Pushes the children entered, the farthest first, and returns the nearest.
#[inline(always)]
pub(super) fn descend(node: &Node, near: &[Vec4; 2], mut entered: u32, stack: &mut Stack) -> Option<Place> {
    if entered == 0 {
        return None;
    }
    let place = |slot: usize| Place { t: near[slot / 4].as_ref()[slot % 4], child: node.children[slot] };
    let mut sorted = [place(slot_of(entered)); WIDTH];
    let mut count = 1;
    entered &= entered - 1;
    while entered != 0 && count < WIDTH {
        let place = place(slot_of(entered));
        entered &= entered - 1;
        // Insertion from the far end; few boxes are entered at once.
        let mut i = count;
        while i > 0 && place.t < sorted[i - 1].t {
            sorted[i] = sorted[i - 1];
            i -= 1;
        }
        sorted[i] = place;
        count += 1;
    }
    for place in sorted[1..count].iter().rev() {
        stack.push(*place);
    }
    Some(sorted[0])
}

/// The nearest hit so far.
pub(super) struct Best {
    pub(super) t: f32,
    pub(super) primitive: u32,
    /// Quad and lane of the triangle hit, if it is the scene's own.
    pub(super) triangle: Option<(u32, u32)>,
}

impl Best {
    /// Of hits at one distance the first counts.
    #[inline(always)]
    pub(super) const fn is_beaten_by(&self, t: f32) -> bool {
        t < self.t || self.primitive == u32::MAX
    }
}
