//! Rays against many primitives: an eight-wide tree behind two questions, nearest hit and any hit.
//! Meshes that several shapes share have trees of their own below it ([`instance`]).
//!
//! [`cluster`] builds a binary tree, [`collapse`] makes nodes of eight boxes and leaves of four triangles of it, and both are
//! tested side by side. Boxes are padded so that the watertight triangle test behind them stays watertight.

mod cluster;
mod collapse;
mod divide;
mod instance;
mod mesh_tree;
mod node;
mod stack;

use std::cell::RefCell;
use std::collections::HashSet;
use std::sync::Arc;

use foton_math::glam::Vec2;
use foton_math::{Aabb, Cancelled, Ray};
use rayon::prelude::*;

use crate::build::{BuildOptions, BuildStep, Patch};
use crate::description::Mesh;
use crate::normalise::Normalisation;
use crate::plane::Plane;
use crate::primitive::{Primitive, ShearedRay};
pub(crate) use instance::{Instance, padding_for};
pub(crate) use mesh_tree::MeshTree;
use node::{BoxRay, Child, Node, QUAD, Quad, Target};
use stack::{Best, Place, Stack, descend, slot_of};

/// Boxes grow by this share of the scene's half-size on each side: rounding errors of the triangle test, with a margin.
pub(crate) const PADDING: f32 = 1e-6;

/// Nodes that a query near a box may visit for each primitive that it may: in most scenes it visits far fewer.
const NODES_PER_VISIT: usize = 64;

/// A tree over primitives and instances.
#[derive(Default)]
pub(crate) struct Accel {
    /// The first is the root; there is none without primitives.
    nodes: Vec<Node>,
    quads: Vec<Quad>,
    primitives: Vec<Primitive>,
    /// Those of triangles; whatever for other primitives.
    planes: Vec<Plane>,
    /// Meshes that several shapes share. Their triangles have indices behind those of `primitives`, one instance after the other.
    instances: Vec<Instance>,
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
        instances: Vec<Instance>,
        options: &BuildOptions<'_>,
    ) -> Result<(Self, Vec<u32>), Cancelled> {
        let boxes = || primitives.iter().map(Primitive::bounds).chain(instances.iter().map(|i| i.bounds));
        let bounds = boxes().fold(Aabb::EMPTY, Aabb::union);
        let padding = bounds.size().max_element() * 0.5 * PADDING;
        Self::build_padded(primitives, instances, padding, options)
    }

    /// The same with boxes that are so much larger than what is in them.
    pub(crate) fn build_padded(
        primitives: &[Primitive],
        mut instances: Vec<Instance>,
        padding: f32,
        options: &BuildOptions<'_>,
    ) -> Result<(Self, Vec<u32>), Cancelled> {
        let count = primitives.len() + instances.len();
        if count == 0 {
            return Ok((Self::default(), Vec::new()));
        }
        let gauge = options.step(BuildStep::Tree, cluster::items(count));
        let padded =
            |b: Aabb| obvhs::aabb::Aabb { min: (b.min - padding).into(), max: (b.max + padding).into() };
        let all = primitives.iter().map(Primitive::bounds).chain(instances.iter().map(|i| i.bounds));
        let boxes: Vec<_> = all.map(padded).collect();
        let tree = cluster::build(&boxes, &gauge)?;
        drop(boxes);
        let collapsed = collapse::collapse(&tree, primitives, &gauge)?;
        drop(tree);
        let ordered: Vec<Primitive> = collapsed.order.iter().map(|&i| primitives[i as usize]).collect();
        let planes = ordered.par_iter().map(Primitive::plane).collect();
        let mut first = primitives.len() as u32;
        for instance in &mut instances {
            instance.first = first;
            first += instance.len() as u32;
        }
        let (nodes, quads) = (collapsed.nodes, collapsed.quads);
        Ok((Self { nodes, quads, primitives: ordered, planes, instances }, collapsed.order))
    }

    /// Makes of a tree over the triangles of one mesh one for instances. `triangles` are their numbers in the mesh in the tree's
    /// order, `patches` what continues what, and `free` edges that nothing continues; `to_boxes` brings the mesh into the tree's space, where boxes are `padding` too large.
    pub(crate) fn into_mesh_tree(
        self,
        mesh: &Arc<Mesh>,
        triangles: Vec<u32>,
        (patches, free): (Vec<Patch>, Vec<(u32, u8)>),
        (to_boxes, padding): (Normalisation, f32),
    ) -> MeshTree {
        MeshTree::new((self.nodes, &self.quads), mesh, triangles, (patches, free), (to_boxes, padding))
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
                Target::Instance(instance) => self.instances[instance].nearest(&sheared, &mut best),
            }
            while next.is_none() {
                let Some(place) = stack.pop() else { break };
                next = (place.t <= best.t).then_some(place);
            }
        }
        (best.primitive != u32::MAX).then(|| Hit {
            t: best.t,
            primitive: best.primitive,
            barycentric: match best.triangle {
                Some((quad, lane)) => sheared.weights(&self.quads[quad as usize].triangle(lane)),
                None => self.weights_of(best.primitive, &sheared),
            },
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
                Target::Instance(instance) => self.instances[instance].occludes(&sheared),
            };
            if hit {
                return true;
            }
        }
        false
    }

    /// The weights where a ray meets a primitive that is no triangle of the scene's own.
    #[inline(always)]
    fn weights_of(&self, primitive: u32, ray: &ShearedRay) -> Vec2 {
        let placed = self.placed(primitive);
        let corners =
            |(instance, triangle): (usize, usize)| self.instances[instance].placed(triangle).corners;
        placed.map_or(Vec2::ZERO, |placed| ray.weights(&corners(placed)))
    }

    /// Calls `visit` with the index of each primitive whose box, or that of its leaf, meets a box, until about `max` were visited:
    /// where very many lie in one place, visiting all from each would never end. Instances are left out.
    pub(crate) fn for_each_near(&self, near: &Aabb, max: usize, visit: impl FnMut(usize)) {
        self.walk_near(near, max, visit, |_, _| {});
    }

    /// The same of all primitives, those of instances too.
    pub(crate) fn for_each_near_of_all(&self, near: &Aabb, max: usize, visit: impl FnMut(usize)) {
        self.for_each_near_of_others(near, max, None, visit);
    }

    /// The same, but for those of one instance.
    pub(crate) fn for_each_near_of_others(
        &self,
        near: &Aabb,
        max: usize,
        but: Option<usize>,
        visit: impl FnMut(usize),
    ) {
        let visit = RefCell::new(visit);
        let of_instance = |i: usize, left: &mut usize| {
            if Some(i) == but {
                return;
            }
            let instance = &self.instances[i];
            instance.for_each_near(near, left, |i| visit.borrow_mut()(instance.index(i) as usize));
        };
        self.walk_near(near, max, |i| visit.borrow_mut()(i), of_instance);
    }

    /// Calls `visit` with each primitive, and `visit_instance` with each instance and how many primitives it may visit, whose box meets
    /// a box.
    fn walk_near(
        &self,
        near: &Aabb,
        max: usize,
        mut visit: impl FnMut(usize),
        mut visit_instance: impl FnMut(usize, &mut usize),
    ) {
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
                    let quad = &self.quads[quad];
                    for lane in 0..quad.len() {
                        left = left.saturating_sub(1);
                        visit(quad.first as usize + lane);
                    }
                }
                Target::Other(other) => {
                    left -= 1;
                    visit(other);
                }
                Target::Instance(instance) => visit_instance(instance, &mut left),
            }
        }
    }

    /// The scene's own primitives, in the tree's order: all but those of instances.
    pub(crate) fn primitives(&self) -> &[Primitive] {
        &self.primitives
    }

    /// Meshes that several shapes share, where they stand.
    pub(crate) fn instances(&self) -> &[Instance] {
        &self.instances
    }

    /// The index of the instance that a primitive belongs to, if any, and its place in the instance's tree.
    #[inline(always)]
    pub(crate) fn placed(&self, primitive: u32) -> Option<(usize, usize)> {
        if (primitive as usize) < self.primitives.len() { None } else { self.found(primitive) }
    }

    #[inline(never)]
    fn found(&self, primitive: u32) -> Option<(usize, usize)> {
        let i = self.instances.partition_point(|i| i.index(0) <= primitive).checked_sub(1)?;
        Some((i, (primitive - self.instances[i].index(0)) as usize))
    }

    /// A primitive by its index, in scene units.
    #[inline(always)]
    pub(crate) fn primitive(&self, index: u32) -> Primitive {
        match self.placed(index) {
            None => self.primitives[index as usize],
            Some((instance, triangle)) => self.instances[instance].primitive(triangle),
        }
    }

    /// The plane of a triangle, by its index in the tree's order.
    #[inline(always)]
    pub(crate) fn plane(&self, index: usize) -> &Plane {
        &self.planes[index]
    }

    /// The trees of instances, each once.
    pub(crate) fn mesh_trees(&self) -> impl Iterator<Item = &Arc<MeshTree>> {
        let mut seen = HashSet::new();
        self.instances.iter().map(|i| &i.tree).filter(move |tree| seen.insert(Arc::as_ptr(tree)))
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..])
            + size_of_val(&self.quads[..])
            + size_of_val(&self.primitives[..])
            + size_of_val(&self.planes[..])
            + size_of_val(&self.instances[..])
            + self.mesh_trees().map(|tree| tree.bytes()).sum::<usize>()
    }
}

#[cfg(test)]
mod tests;
