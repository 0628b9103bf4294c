//! From a binary tree to eight-wide nodes and quads of triangles, at the least expected cost of a ray.
//!
//! The cheapest way to cut a binary subtree into at most i pieces, for every subtree and i, by dynamic programming as in
//! Ylitie, Karras and Laine (2017), section 3.1. `[YKL17]`

use foton_math::Cancelled;
use foton_math::glam::Vec3;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;

use super::node::{Child, Node, QUAD, Quad, WIDTH};
use crate::build::Gauge;
use crate::primitive::Primitive;

/// Cost of testing eight boxes: the unit.
const NODE_COST: f32 = 1.0;
/// Cost of testing four triangles.
const QUAD_COST: f32 = 1.0;
/// Cost of testing a sphere, a disc or a tube.
const OTHER_COST: f32 = 0.7;
/// Cost of an instance: of bringing a ray into its space and going through its tree.
const INSTANCE_COST: f32 = 12.0;
/// Says that a subtree holds what no quad can.
const MANY: u32 = u32::MAX;

/// A subtree's cheapest cuts.
#[derive(Clone, Copy, Default)]
struct Cuts {
    /// `cost[i]`: of at most i + 1 pieces, the last of exactly the children of one node.
    cost: [f32; WIDTH],
    /// `left[i]`: how many of the i + 1 pieces are the left child's; 0 where one piece fewer is as cheap.
    left: [u8; WIDTH],
    /// Triangles, or [`MANY`].
    triangles: u32,
}

/// A tree taken apart.
pub(super) struct Collapsed {
    pub(super) nodes: Vec<Node>,
    pub(super) quads: Vec<Quad>,
    /// `order[i]` is the old index of primitive i.
    pub(super) order: Vec<u32>,
}

struct Collapse<'a> {
    tree: &'a Bvh2,
    primitives: &'a [Primitive],
    cuts: Vec<Cuts>,
    out: Collapsed,
}

/// Collapses a tree with one primitive a leaf; what has an index behind those of all primitives is an instance.
pub(super) fn collapse(
    tree: &Bvh2,
    primitives: &[Primitive],
    gauge: &Gauge<'_>,
) -> Result<Collapsed, Cancelled> {
    let out = Collapsed {
        nodes: vec![Node::EMPTY],
        quads: Vec::new(),
        order: Vec::with_capacity(primitives.len()),
    };
    let mut collapse = Collapse { tree, primitives, cuts: vec![Cuts::default(); tree.nodes.len()], out };
    collapse.weigh(gauge)?;
    collapse.emit(gauge)?;
    Ok(collapse.out)
}

fn half_area(node: &Bvh2Node) -> f32 {
    let aabb = node.aabb();
    let size = Vec3::from(aabb.max) - Vec3::from(aabb.min);
    size.x * size.y + size.y * size.z + size.z * size.x
}

impl Collapse<'_> {
    fn primitive(&self, leaf: &Bvh2Node) -> u32 {
        self.tree.primitive_indices[leaf.first_index as usize]
    }

    /// Cost of testing what is in a leaf, and whether it is a triangle.
    fn cost(&self, leaf: &Bvh2Node) -> (f32, bool) {
        match self.primitives.get(self.primitive(leaf) as usize) {
            Some(Primitive::Triangle(_)) => (QUAD_COST, true),
            Some(_) => (OTHER_COST, false),
            None => (INSTANCE_COST, false),
        }
    }

    /// Children before parents.
    fn weigh(&mut self, gauge: &Gauge<'_>) -> Result<(), Cancelled> {
        let mut order = Vec::with_capacity(self.tree.nodes.len());
        let mut open = vec![0u32];
        while let Some(index) = open.pop() {
            order.push(index);
            let node = &self.tree.nodes[index as usize];
            if !node.is_leaf() {
                open.extend([node.first_index, node.first_index + 1]);
            }
        }
        for (i, index) in order.into_iter().rev().enumerate() {
            gauge.item(2 * i)?;
            let node = &self.tree.nodes[index as usize];
            let area = half_area(node);
            let cuts = if node.is_leaf() {
                let (cost, triangle) = self.cost(node);
                let cost = area * cost;
                Cuts { cost: [cost; WIDTH], left: [0; WIDTH], triangles: if triangle { 1 } else { MANY } }
            } else {
                let first = node.first_index as usize;
                cut(area, &self.cuts[first], &self.cuts[first + 1])
            };
            self.cuts[index as usize] = cuts;
        }
        Ok(())
    }

    /// Nodes from the root on, those of one parent's children side by side.
    fn emit(&mut self, gauge: &Gauge<'_>) -> Result<(), Cancelled> {
        let mut open = vec![(0u32, 0usize)];
        let mut pieces = Vec::with_capacity(WIDTH);
        while let Some((source, target)) = open.pop() {
            gauge.check()?;
            pieces.clear();
            if self.is_leaf(source) {
                pieces.push(source);
            } else {
                self.divide(source, WIDTH, &mut pieces);
            }
            for (slot, &piece) in pieces.iter().enumerate() {
                let child = if self.is_leaf(piece) {
                    self.emit_leaf(piece)
                } else {
                    self.out.nodes.push(Node::EMPTY);
                    open.push((piece, self.out.nodes.len() - 1));
                    Child::node(self.out.nodes.len() - 1)
                };
                let aabb = self.tree.nodes[piece as usize].aabb();
                self.out.nodes[target].set(slot, child, aabb.min.into(), aabb.max.into());
            }
        }
        Ok(())
    }

    /// The roots of a subtree's at most `count` pieces; of `WIDTH` ones as a node's children.
    fn divide(&self, index: u32, count: usize, pieces: &mut Vec<u32>) {
        let cuts = &self.cuts[index as usize];
        let mut count = count;
        while count > 1 && count < WIDTH && cuts.left[count - 1] == 0 {
            count -= 1;
        }
        if count == 1 {
            pieces.push(index);
            return;
        }
        let left = usize::from(cuts.left[count - 1]);
        let first = self.tree.nodes[index as usize].first_index;
        self.divide(first, left, pieces);
        self.divide(first + 1, count - left, pieces);
    }

    /// Whether a subtree becomes a leaf.
    fn is_leaf(&self, index: u32) -> bool {
        let cuts = &self.cuts[index as usize];
        self.tree.nodes[index as usize].is_leaf() || cuts.left[0] == 1
    }

    fn emit_leaf(&mut self, index: u32) -> Child {
        let leaf = &self.tree.nodes[index as usize];
        if leaf.is_leaf()
            && let Some(instance) = (self.primitive(leaf) as usize).checked_sub(self.primitives.len())
        {
            return Child::instance(instance);
        }
        let first = self.out.order.len();
        let mut open = vec![index];
        while let Some(index) = open.pop() {
            let node = &self.tree.nodes[index as usize];
            if node.is_leaf() {
                self.out.order.push(self.primitive(node));
            } else {
                open.extend([node.first_index + 1, node.first_index]);
            }
        }
        let corners = |&i: &u32| match self.primitives[i as usize] {
            Primitive::Triangle(corners) => Some(corners),
            _ => None,
        };
        if corners(&self.out.order[first]).is_none() {
            return Child::other(first);
        }
        self.out.quads.push(Quad::new(first, self.out.order[first..].iter().filter_map(corners)));
        Child::quad(self.out.quads.len() - 1)
    }
}

/// The cheapest cuts of a subtree of half-area `area` with these children. `left[0]` is 1 where one piece is a leaf.
fn cut(area: f32, left: &Cuts, right: &Cuts) -> Cuts {
    let triangles = left.triangles.saturating_add(right.triangles);
    let mut cuts =
        Cuts { triangles: if triangles <= QUAD as u32 { triangles } else { MANY }, ..Cuts::default() };
    for pieces in 2..=WIDTH {
        let mut best = (f32::INFINITY, 0);
        for k in 1..pieces {
            let cost = left.cost[k - 1] + right.cost[pieces - k - 1];
            if cost < best.0 {
                best = (cost, k as u8);
            }
        }
        (cuts.cost[pieces - 1], cuts.left[pieces - 1]) = best;
    }
    let as_node = cuts.cost[WIDTH - 1] + area * NODE_COST;
    let as_leaf = if cuts.triangles == MANY { f32::INFINITY } else { area * QUAD_COST };
    cuts.cost[0] = as_node.min(as_leaf);
    cuts.left[0] = u8::from(as_leaf <= as_node);
    for pieces in 2..WIDTH {
        if cuts.cost[pieces - 2] <= cuts.cost[pieces - 1] {
            (cuts.cost[pieces - 1], cuts.left[pieces - 1]) = (cuts.cost[pieces - 2], 0);
        }
    }
    cuts
}
