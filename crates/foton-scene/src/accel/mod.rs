//! Rays against many primitives: an eight-wide tree behind two questions, nearest hit and any hit.
//!
//! [`cluster`] builds a binary tree, [`collapse`] makes nodes of eight boxes and leaves of four triangles of it, and both are
//! tested side by side. Boxes are padded so that the watertight triangle test behind them stays watertight.

mod cluster;
mod collapse;
mod divide;
mod node;

use foton_math::glam::{Vec2, Vec4};
use foton_math::{Aabb, Cancelled, Ray};
use rayon::prelude::*;

use crate::build::{BuildOptions, BuildStep};
use crate::plane::Plane;
use crate::primitive::{Primitive, ShearedRay};
use node::{BoxRay, Child, Node, QUAD, Quad, Target, WIDTH};

/// Boxes grow by this share of the scene's half-size on each side: rounding errors of the triangle test, with a margin.
const PADDING: f32 = 1e-6;

/// Nodes that a query near a box may visit for each primitive that it may: in most scenes it visits far fewer.
const NODES_PER_VISIT: usize = 64;

/// Places on a ray's stack before it spills to the heap.
const STACK: usize = 32;

/// A tree over primitives.
pub(crate) struct Accel {
    /// The first is the root; there is none without primitives.
    nodes: Vec<Node>,
    quads: Vec<Quad>,
    primitives: Vec<Primitive>,
    /// Those of triangles; whatever for other primitives.
    planes: Vec<Plane>,
}

/// The nearest thing on a ray.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// Distance in scene units.
    pub(crate) t: f32,
    /// Index of the primitive, in the tree's order.
    pub(crate) primitive: u32,
    /// Weights of a triangle's second and third vertex; zero for other primitives.
    pub(crate) barycentric: Vec2,
}

impl Accel {
    /// Builds the tree. Returns it with `order`, where `order[i]` is the old index of primitive `i`.
    pub(crate) fn build(
        primitives: &[Primitive],
        options: &BuildOptions<'_>,
    ) -> Result<(Self, Vec<u32>), Cancelled> {
        if primitives.is_empty() {
            return Ok((
                Self { nodes: Vec::new(), quads: Vec::new(), primitives: Vec::new(), planes: Vec::new() },
                Vec::new(),
            ));
        }
        let gauge = options.step(BuildStep::Tree, cluster::items(primitives.len()));
        let bounds = primitives.iter().fold(Aabb::EMPTY, |b, p| b.union(p.bounds()));
        let padding = bounds.size().max_element() * 0.5 * PADDING;
        let padded = |p: &Primitive| {
            let b = p.bounds();
            obvhs::aabb::Aabb { min: (b.min - padding).into(), max: (b.max + padding).into() }
        };
        let boxes: Vec<_> = primitives.iter().map(padded).collect();
        let tree = cluster::build(&boxes, &gauge)?;
        drop(boxes);
        let collapsed = collapse::collapse(&tree, primitives, &gauge)?;
        drop(tree);
        let ordered: Vec<Primitive> = collapsed.order.iter().map(|&i| primitives[i as usize]).collect();
        let planes = ordered.par_iter().map(Primitive::plane).collect();
        let accel = Self { nodes: collapsed.nodes, quads: collapsed.quads, primitives: ordered, planes };
        Ok((accel, collapsed.order))
    }

    /// The nearest hit in the ray's interval.
    ///
    /// Inlined into the loops over rays, which are compiled for several instruction sets.
    #[inline(always)]
    pub(crate) fn nearest(&self, ray: Ray) -> Option<Hit> {
        let (boxes, sheared) = (BoxRay::new(&ray), ShearedRay::new(ray));
        let mut best = Best { t: ray.t_max, primitive: u32::MAX, triangle: None };
        let mut stack = Stack::new();
        let mut next = self.nodes.first().map(|_| Place { t: 0.0, child: Child::node(0) });
        while let Some(place) = next {
            next = None;
            match place.child.target() {
                Target::Node(node) => {
                    let node = &self.nodes[node];
                    let (near, entered) = node.enter(&boxes, best.t);
                    next = descend(node, &near, entered, &mut stack);
                }
                Target::Quad(index) => {
                    let quad = &self.quads[index];
                    let (mut met, unsure) = quad.met(&sheared);
                    while met != 0 {
                        let lane = met.trailing_zeros();
                        met &= met - 1;
                        let primitive = quad.first + lane;
                        if let Some(t) =
                            sheared.hit_plane(&self.planes[primitive as usize], quad.corner(lane), best.t)
                            && best.is_beaten_by(t)
                            && (unsure >> lane & 1 == 0 || sheared.meets(&quad.triangle(lane)))
                        {
                            best = Best { t, primitive, triangle: Some((index as u32, lane)) };
                        }
                    }
                }
                Target::Other(other) => {
                    if let Some(t) = sheared.hit_other(&self.primitives[other], best.t)
                        && best.is_beaten_by(t)
                    {
                        best = Best { t, primitive: other as u32, triangle: None };
                    }
                }
            }
            while next.is_none() {
                let Some(place) = stack.pop() else { break };
                next = (place.t <= best.t).then_some(place);
            }
        }
        (best.primitive != u32::MAX).then(|| Hit {
            t: best.t,
            primitive: best.primitive,
            barycentric: best.triangle.map_or(Vec2::ZERO, |(quad, lane)| {
                sheared.weights(&self.quads[quad as usize].triangle(lane))
            }),
        })
    }

    /// Whether anything lies in the ray's interval.
    pub(crate) fn occluded(&self, ray: Ray) -> bool {
        let (boxes, sheared) = (BoxRay::new(&ray), ShearedRay::new(ray));
        let mut stack = Stack::new();
        if !self.nodes.is_empty() {
            stack.push(Place { t: 0.0, child: Child::node(0) });
        }
        while let Some(place) = stack.pop() {
            let hit = match place.child.target() {
                Target::Node(node) => {
                    let node = &self.nodes[node];
                    let (_, mut entered) = node.enter(&boxes, ray.t_max);
                    while entered != 0 {
                        stack.push(Place { t: 0.0, child: node.children[slot_of(entered)] });
                        entered &= entered - 1;
                    }
                    false
                }
                Target::Quad(quad) => {
                    let quad = &self.quads[quad];
                    let (met, unsure) = quad.met(&sheared);
                    (0..QUAD as u32).filter(|lane| met >> lane & 1 != 0).any(|lane| {
                        let plane = &self.planes[(quad.first + lane) as usize];
                        sheared.hit_plane(plane, quad.corner(lane), ray.t_max).is_some()
                            && (unsure >> lane & 1 == 0 || sheared.meets(&quad.triangle(lane)))
                    })
                }
                Target::Other(other) => sheared.hit_other(&self.primitives[other], ray.t_max).is_some(),
            };
            if hit {
                return true;
            }
        }
        false
    }

    /// Calls `visit` with the index of each primitive whose box, or that of its leaf, meets a box, until about `max` were visited:
    /// where very many lie in one place, visiting all from each would never end.
    pub(crate) fn for_each_near(&self, near: &Aabb, max: usize, mut visit: impl FnMut(usize)) {
        let (mut left, mut nodes) = (max, max.saturating_mul(NODES_PER_VISIT));
        let mut stack = Stack::new();
        if !self.nodes.is_empty() {
            stack.push(Place { t: 0.0, child: Child::node(0) });
        }
        while let Some(place) = stack.pop().filter(|_| left > 0 && nodes > 0) {
            match place.child.target() {
                Target::Node(node) => {
                    nodes -= 1;
                    let node = &self.nodes[node];
                    let mut met = node.near(near);
                    while met != 0 {
                        stack.push(Place { t: 0.0, child: node.children[slot_of(met)] });
                        met &= met - 1;
                    }
                }
                Target::Quad(quad) => {
                    let first = self.quads[quad].first as usize;
                    left = left.saturating_sub(self.quads[quad].len());
                    (first..first + self.quads[quad].len()).for_each(&mut visit);
                }
                Target::Other(other) => {
                    left -= 1;
                    visit(other);
                }
            }
        }
    }

    /// The primitives in the tree's order.
    pub(crate) fn primitives(&self) -> &[Primitive] {
        &self.primitives
    }

    /// The plane of a triangle, by its index in the tree's order.
    #[inline(always)]
    pub(crate) fn plane(&self, index: usize) -> &Plane {
        &self.planes[index]
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..])
            + size_of_val(&self.quads[..])
            + size_of_val(&self.primitives[..])
            + size_of_val(&self.planes[..])
    }
}

/// A place in the tree that a ray has still to visit.
#[derive(Clone, Copy)]
struct Place {
    /// Where the ray enters its box.
    t: f32,
    child: Child,
}

/// Places to visit, the next on top. Few trees are deep enough for the heap.
struct Stack {
    places: [Place; STACK],
    length: usize,
    spilled: Vec<Place>,
}

impl Stack {
    #[inline(always)]
    const fn new() -> Self {
        Self { places: [Place { t: 0.0, child: Child::NONE }; STACK], length: 0, spilled: Vec::new() }
    }

    #[inline(always)]
    fn push(&mut self, place: Place) {
        if let Some(free) = self.places.get_mut(self.length) {
            *free = place;
            self.length += 1;
        } else {
            self.spilled.push(place);
        }
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<Place> {
        if let Some(spilled) = self.spilled.pop() {
            return Some(spilled);
        }
        self.length = self.length.checked_sub(1)?;
        self.places.get(self.length).copied()
    }
}

/// The lowest slot of those in the mask.
#[inline(always)]
const fn slot_of(entered: u32) -> usize {
    entered.trailing_zeros() as usize & (WIDTH - 1)
}

/// Pushes the children entered, the farthest first, and returns the nearest.
#[inline(always)]
fn descend(node: &Node, near: &[Vec4; 2], mut entered: u32, stack: &mut Stack) -> Option<Place> {
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
struct Best {
    t: f32,
    primitive: u32,
    /// Quad and lane of the triangle hit.
    triangle: Option<(u32, u32)>,
}

impl Best {
    /// Of hits at one distance the first counts.
    #[inline(always)]
    const fn is_beaten_by(&self, t: f32) -> bool {
        t < self.t || self.primitive == u32::MAX
    }
}

#[cfg(test)]
mod tests;
