//! A binary tree over boxes, from its leaves up: boxes in the order of Morton's curve choose among their neighbours there, and those
//! that choose each other are joined, round by round. `[MB18]`
//!
//! Some scenes give each round one pair to join: boxes that are equal, or of which each holds the one before, choose in a row. So
//! all rounds together may visit a number of boxes that is proportional to the scene's; what is then left is divided from the top
//! ([`super::divide`]). In scenes that are no such heap, rounds halve what is left and end long before.

use foton_math::Cancelled;
use obvhs::aabb::Aabb;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::bvh2::{Bvh2, DEFAULT_MAX_STACK_DEPTH};
use obvhs::ploc::morton::morton_encode_u64_unorm;
use rayon::prelude::*;

use super::divide::divide;
use crate::build::Gauge;

/// Neighbours on each side that are considered.
const NEIGHBOURS: usize = 6;

/// Rounds at the beginning that consider one neighbour on each side only.
const QUICK_ROUNDS: usize = 2;

/// Boxes that all rounds visit, for each box of the scene. The shipped scenes need 3 to 5.
const VISITS_PER_BOX: usize = 24;

/// Boxes that may be visited in any scene: so few take no time.
const FREE_VISITS: usize = 1 << 18;

/// Of all nodes, this share is put elsewhere at first, where that makes rays cheaper, and then ever fewer.
const MOVED_SHARE: f32 = 0.02;

/// Rounds of moving nodes.
const MOVES: usize = 16;

/// The weight of a stage of building a tree in how far that is, for each box.
const STAGES: usize = 3;

/// What [`build`] and what follows it count, for so many boxes.
pub(super) const fn items(boxes: usize) -> usize {
    STAGES * boxes
}

/// Builds a tree with one box a leaf.
pub(super) fn build(boxes: &[Aabb], gauge: &Gauge<'_>) -> Result<Bvh2, Cancelled> {
    let mut tree = Bvh2 { primitive_indices: (0..boxes.len() as u32).collect(), ..Bvh2::default() };
    let mut rounds = Rounds::new(boxes, gauge)?;
    let depth = rounds.join_all(&mut tree.nodes, gauge)?;
    tree.max_depth = DEFAULT_MAX_STACK_DEPTH.max(depth + 1);
    tree.children_are_ordered_after_parents = true;
    let mut optimizer = ReinsertionOptimizer::default();
    for round in 0..MOVES {
        gauge.add(boxes.len() / MOVES)?;
        let share = 1.0 / (2 * round + 1) as f32;
        optimizer.run(&mut tree, MOVED_SHARE, Some(vec![share]));
    }
    Ok(tree)
}

/// Boxes and trees of them that are still to be joined, in the order of the curve.
struct Rounds {
    nodes: Vec<Bvh2Node>,
    /// Those of the next round.
    joined: Vec<Bvh2Node>,
    /// How far along the curve each one's choice lies.
    choices: Vec<i8>,
}

impl Rounds {
    fn new(boxes: &[Aabb], gauge: &Gauge<'_>) -> Result<Self, Cancelled> {
        let all = boxes.iter().fold(Aabb::empty(), |all, b| all.union(b));
        let scale = 1.0 / all.diagonal().as_dvec3();
        let offset = -all.min.as_dvec3() * scale;
        let code = |b: &Aabb| morton_encode_u64_unorm(b.center().as_dvec3() * scale + offset);
        let mut order: Vec<(u64, u32)> =
            boxes.par_iter().zip(0u32..boxes.len() as u32).map(|(b, i)| (code(b), i)).collect();
        gauge.check()?;
        order.par_sort_unstable();
        gauge.check()?;
        let nodes = order.iter().map(|&(_, i)| Bvh2Node::new(boxes[i as usize], 1, i)).collect();
        Ok(Self { nodes, joined: Vec::with_capacity(boxes.len()), choices: vec![0; boxes.len()] })
    }

    /// Joins until one is left, into `tree`, whose first node becomes the root. The depth of the tree at most.
    fn join_all(&mut self, tree: &mut Vec<Bvh2Node>, gauge: &Gauge<'_>) -> Result<usize, Cancelled> {
        let boxes = self.nodes.len();
        tree.resize((2 * boxes).saturating_sub(1), Bvh2Node::default());
        let (mut free, mut rounds, mut visits) = (tree.len(), 0, FREE_VISITS + VISITS_PER_BOX * boxes);
        while self.nodes.len() > 1 {
            let before = self.nodes.len();
            let Some(left) = visits.checked_sub(before) else {
                let below = divide(&mut self.nodes, &mut tree[..free], gauge)?;
                return Ok(rounds + below);
            };
            visits = left;
            if rounds < QUICK_ROUNDS {
                self.choose_next();
            } else {
                self.choose(gauge)?;
            }
            self.join(tree, &mut free);
            gauge.add(before - self.nodes.len())?;
            rounds += 1;
        }
        if let (Some(root), Some(node)) = (tree.first_mut(), self.nodes.first()) {
            *root = *node;
        }
        Ok(rounds)
    }

    /// Each chooses the cheaper one of the two beside it, of equal ones the next.
    fn choose_next(&mut self) {
        let mut last = f32::INFINITY;
        for (pair, choice) in self.nodes.windows(2).zip(&mut self.choices) {
            let cost = joined_area(&pair[0], &pair[1]);
            *choice = if last < cost { -1 } else { 1 };
            last = cost;
        }
        self.choices[self.nodes.len() - 1] = -1;
    }

    /// Each chooses the cheapest one of those near it, of equal ones the last.
    fn choose(&mut self, gauge: &Gauge<'_>) -> Result<(), Cancelled> {
        // `costs[i % NEIGHBOURS][d]`: of joining i with i + 1 + d, for the last few i.
        let mut costs = [[0.0; NEIGHBOURS]; NEIGHBOURS];
        for (i, node) in self.nodes.iter().enumerate() {
            gauge.check_at(i)?;
            let (mut min_cost, mut choice) = (f32::INFINITY, 0);
            for back in (1..=NEIGHBOURS.min(i)).rev() {
                let cost = costs[(i - back) % NEIGHBOURS][back - 1];
                if cost <= min_cost {
                    (min_cost, choice) = (cost, -(back as i8));
                }
            }
            let costs = &mut costs[i % NEIGHBOURS];
            for (ahead, other) in self.nodes[i + 1..].iter().take(NEIGHBOURS).enumerate() {
                let cost = joined_area(node, other);
                costs[ahead] = cost;
                if cost <= min_cost {
                    (min_cost, choice) = (cost, ahead as i8 + 1);
                }
            }
            self.choices[i] = choice;
        }
        Ok(())
    }

    /// Joins those that chose each other, where the later one stood. Their pairs lie in `tree` from `free` on.
    fn join(&mut self, tree: &mut [Bvh2Node], free: &mut usize) {
        let chosen_by = |i: usize| i.wrapping_add_signed(isize::from(self.choices[i]));
        self.joined.clear();
        for (i, node) in self.nodes.iter().enumerate() {
            let other = chosen_by(i);
            if other == i || chosen_by(other) != i {
                self.joined.push(*node);
            } else if other < i {
                let earlier = &self.nodes[other];
                *free -= 2;
                (tree[*free], tree[*free + 1]) = (*node, *earlier);
                self.joined.push(Bvh2Node::new(node.aabb().union(earlier.aabb()), 0, *free as u32));
            }
        }
        std::mem::swap(&mut self.nodes, &mut self.joined);
    }
}

/// Half the area of the box around two.
#[inline(always)]
fn joined_area(a: &Bvh2Node, b: &Bvh2Node) -> f32 {
    a.aabb().union(b.aabb()).half_area()
}
