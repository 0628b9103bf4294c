//! A tree of many emitters: one is found in the logarithm of their number, by bounds of what those of a branch can give. `[CK18]`

use std::f32::consts::{FRAC_PI_2, PI};

use foton_math::Aabb;
use foton_math::glam::Vec3;
use foton_scene::Extent;

use super::arrival::Receiver;

/// This share of the choice is uniform over all emitters: bounds may be wide of the mark.
const UNIFORM: f64 = 0.1;

/// Within its reach an emitter counts as if it shone with at least this share of its largest intensity.
const DIMMEST: f32 = 0.1;

/// A tree over emitters; empty without any.
#[derive(Clone, Debug, Default)]
pub struct LightTree {
    /// The root first. The first child of a branch comes right behind it.
    nodes: Vec<Node>,
    /// Node of each emitter, in the order of nodes.
    leaves: Vec<u32>,
    /// Index and node of each emitter, by index.
    by_emitter: Vec<(u32, u32)>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    centre: Vec3,
    /// Of a ball around the bounds.
    radius: f32,
    axis: Vec3,
    /// cos and sin of [`Extent::normals`].
    normals: [f32; 2],
    /// cos of [`Extent::reach`].
    reach: f32,
    intensity: f32,
    kind: Kind,
    /// Index of the branch above; its own for the root.
    parent: u32,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    /// An emitter's index.
    Leaf(u32),
    /// The index of the second child.
    Branch(u32),
}

impl LightTree {
    /// Over emitters by their indices.
    #[must_use]
    pub fn new(mut emitters: Vec<(u32, Extent)>) -> Self {
        let mut tree = Self::default();
        if !emitters.is_empty() {
            tree.add(&mut emitters, 0);
            let of = |&leaf: &u32| tree.emitter(leaf).map(|emitter| (emitter, leaf));
            tree.by_emitter = tree.leaves.iter().filter_map(of).collect();
            tree.by_emitter.sort_unstable();
        }
        tree
    }

    /// Whether there is nothing to choose from.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Adds a branch or a leaf for these emitters; returns its bounds.
    fn add(&mut self, emitters: &mut [(u32, Extent)], parent: u32) -> Extent {
        let index = self.nodes.len() as u32;
        if let [(emitter, extent)] = *emitters {
            self.nodes.push(Node::new(&extent, Kind::Leaf(emitter), parent));
            self.leaves.push(index);
            return extent;
        }
        let middle = split(emitters);
        // The bounds are known once the children's are.
        self.nodes.push(Node::new(&emitters[0].1, Kind::Branch(0), parent));
        let (first, second) = emitters.split_at_mut(middle);
        let first = self.add(first, index);
        let child = self.nodes.len() as u32;
        let second = self.add(second, index);
        let extent = union(&first, &second);
        self.nodes[index as usize] = Node::new(&extent, Kind::Branch(child), parent);
        extent
    }

    /// The emitter that `u` in [0, 1) chooses, and the probability of that; `None` if none of them can give light.
    #[must_use]
    pub fn choose(&self, at: &Receiver, u: f64) -> Option<(u32, f64)> {
        if u < UNIFORM {
            let leaf = (u / UNIFORM * self.leaves.len() as f64) as usize;
            let leaf = self.leaves[leaf.min(self.leaves.len() - 1)];
            return Some((self.emitter(leaf)?, self.probability_of(leaf, at)));
        }
        let (mut node, mut chance, mut left) = (0u32, 1.0, (u - UNIFORM) / (1.0 - UNIFORM));
        while let Kind::Branch(second) = self.nodes[node as usize].kind {
            let share = self.first_share(node, second, at)?;
            if left < share {
                (node, chance, left) = (node + 1, chance * share, left / share);
            } else {
                let rest = 1.0 - share;
                (node, chance, left) = (second, chance * rest, (left - share) / rest);
            }
            left = left.min(1.0 - f64::EPSILON);
        }
        Some((self.emitter(node)?, self.uniform() + (1.0 - UNIFORM) * chance))
    }

    /// The probability of an emitter for light at a point; 0 if it is none of these.
    #[must_use]
    pub fn probability(&self, emitter: u32, at: &Receiver) -> f64 {
        let found = self.by_emitter.binary_search_by_key(&emitter, |&(emitter, _)| emitter);
        found.map_or(0.0, |i| self.probability_of(self.by_emitter[i].1, at))
    }

    /// The probability of each emitter with its index, for light at a point.
    pub fn probabilities(&self, at: &Receiver) -> impl Iterator<Item = (u32, f64)> {
        self.leaves.iter().filter_map(|&leaf| Some((self.emitter(leaf)?, self.probability_of(leaf, at))))
    }

    fn emitter(&self, leaf: u32) -> Option<u32> {
        match self.nodes[leaf as usize].kind {
            Kind::Leaf(emitter) => Some(emitter),
            Kind::Branch(_) => None,
        }
    }

    fn uniform(&self) -> f64 {
        UNIFORM / self.leaves.len() as f64
    }

    /// The probability of the emitter of a leaf.
    fn probability_of(&self, leaf: u32, at: &Receiver) -> f64 {
        let (mut node, mut chance) = (leaf, 1.0);
        while node != 0 {
            let parent = self.nodes[node as usize].parent;
            let Kind::Branch(second) = self.nodes[parent as usize].kind else { break };
            let share = self.first_share(parent, second, at);
            chance *= share.map_or(0.0, |share| if node == second { 1.0 - share } else { share });
            node = parent;
        }
        self.uniform() + (1.0 - UNIFORM) * chance
    }

    /// The chance of the first child of a branch; `None` if neither can give light.
    fn first_share(&self, branch: u32, second: u32, at: &Receiver) -> Option<f64> {
        let of = |node: u32| f64::from(self.nodes[node as usize].importance(at));
        let (first, second) = (of(branch + 1), of(second));
        (first + second > 0.0).then(|| first / (first + second))
    }
}

impl Node {
    fn new(extent: &Extent, kind: Kind, parent: u32) -> Self {
        let Extent { bounds, axis, normals, reach, intensity } = *extent;
        Self {
            centre: bounds.centre(),
            // A little more, so that rounding leaves nothing out.
            radius: 0.5 * bounds.size().length() * (1.0 + 1e-5) + 1e-6 * bounds.centre().abs().max_element(),
            axis,
            normals: [normals.cos(), if normals >= PI { 0.0 } else { normals.sin() }],
            reach: if reach >= FRAC_PI_2 { 0.0 } else { reach.cos() },
            intensity,
            kind,
            parent,
        }
    }

    /// A bound of what its emitters can give, up to a factor for what is near: intensity · cos θ cos θ′ / d², angles being the smallest
    /// possible ones; 0 where no light can be.
    fn importance(&self, at: &Receiver) -> f32 {
        let offset = self.centre - at.origin;
        let distance2 = offset.length_squared();
        let radius2 = self.radius * self.radius;
        if distance2 <= radius2 {
            return self.intensity / radius2.max(f32::MIN_POSITIVE);
        }
        let direction = offset / distance2.sqrt();
        let sine2 = radius2 / distance2;
        // Of the angle under which the ball is seen.
        let ball = [(1.0 - sine2).sqrt(), sine2.sqrt()];
        let arriving = less(direction.dot(at.normal), ball);
        if arriving <= 0.0 {
            return 0.0;
        }
        let leaving = self.leaving(-self.axis.dot(direction), ball);
        if leaving < self.reach - 1e-5 {
            return 0.0;
        }
        self.intensity * arriving * leaving.max(DIMMEST) / distance2
    }

    /// cos of the smallest angle between a normal and a line to the receiver, where `cosine` is that between axis and centre.
    fn leaving(&self, cosine: f32, ball: [f32; 2]) -> f32 {
        let [cos_n, sin_n] = self.normals;
        if cosine >= cos_n {
            return 1.0;
        }
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        less(cosine * cos_n + sine * sin_n, ball)
    }
}

/// cos(max(0, a − b)), of cos a and of cos b and sin b with b in [0, π].
fn less(cos_a: f32, [cos_b, sin_b]: [f32; 2]) -> f32 {
    let sin_a = (1.0 - cos_a * cos_a).max(0.0).sqrt();
    if cos_a >= cos_b { 1.0 } else { cos_a * cos_b + sin_a * sin_b }
}

/// Orders emitters so that those from the returned index on make the second child: by the axis along which they spread most, half
/// of them each.
fn split(emitters: &mut [(u32, Extent)]) -> usize {
    let centre = |e: &(u32, Extent)| e.1.bounds.centre();
    let bounds = emitters.iter().fold(Aabb::EMPTY, |b, e| b.with(centre(e)));
    let size = bounds.size();
    let axis = if size.x >= size.y && size.x >= size.z { 0 } else { 1 + usize::from(size.z > size.y) };
    let middle = emitters.len() / 2;
    emitters.select_nth_unstable_by(middle, |a, b| {
        centre(a)[axis].total_cmp(&centre(b)[axis]).then(a.0.cmp(&b.0))
    });
    middle
}

/// Bounds of both.
fn union(a: &Extent, b: &Extent) -> Extent {
    let (axis, normals) = cone((a.axis, a.normals), (b.axis, b.normals));
    Extent {
        bounds: a.bounds.union(b.bounds),
        axis,
        normals,
        reach: a.reach.max(b.reach),
        intensity: a.intensity + b.intensity,
    }
}

/// A cone around two.
fn cone(a: (Vec3, f32), b: (Vec3, f32)) -> (Vec3, f32) {
    let (wide, narrow) = if a.1 >= b.1 { (a, b) } else { (b, a) };
    let between = wide.0.dot(narrow.0).clamp(-1.0, 1.0).acos();
    if between + narrow.1 <= wide.1 {
        return wide;
    }
    let half = 0.5 * (wide.1 + between + narrow.1) + 1e-4;
    let across = (narrow.0 - wide.0 * wide.0.dot(narrow.0)).try_normalize();
    match across.filter(|_| half < PI) {
        Some(across) => {
            let turn = half - wide.1;
            ((wide.0 * turn.cos() + across * turn.sin()).normalize(), half)
        }
        None => (wide.0, PI),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foton_math::{Purpose, Stream};

    /// Small lamps of all kinds in a box around the origin, which is not among them.
    fn lamps(n: u32) -> Vec<(u32, Extent)> {
        let mut stream = Stream::new(1, Purpose::Test, 0, 0);
        let mut number = move || 2.0 * stream.next_1d() - 1.0;
        let lamp = |i| {
            let at = Vec3::new(number(), number(), number()) * 10.0;
            let axis = Vec3::new(number(), number(), number() + 1.5).normalize();
            let bounds = Aabb { min: at - 0.05, max: at + 0.05 };
            let (normals, reach) =
                [(0.0, FRAC_PI_2), (PI, FRAC_PI_2), (0.0, 0.4), (0.6, FRAC_PI_2)][i as usize % 4];
            (7 * i, Extent { bounds, axis, normals, reach, intensity: 1.0 + number() })
        };
        (0..n).map(lamp).collect()
    }

    fn receiver(i: u64) -> Receiver {
        let mut stream = Stream::new(2, Purpose::Test, 0, i);
        let mut number = || 2.0 * stream.next_1d() - 1.0;
        let origin = Vec3::new(number(), number(), number()) * 12.0;
        Receiver { origin, normal: Vec3::new(number(), number(), number()).normalize(), edges: 1 }
    }

    /// What a lamp gives, if its middle stands for all of it.
    fn given(extent: &Extent, at: &Receiver) -> f64 {
        let d = extent.bounds.centre() - at.origin;
        let direction = d.normalize();
        let angle = (-direction).dot(extent.axis).clamp(-1.0, 1.0).acos();
        let leaving = (angle - extent.normals).max(0.0);
        let shines = leaving < extent.reach;
        let light = extent.intensity * direction.dot(at.normal).max(0.0) * leaving.cos() / d.length_squared();
        if shines { f64::from(light) } else { 0.0 }
    }

    #[test]
    fn a_choice_has_the_probability_that_it_says_and_that_of_its_share() {
        let lamps = lamps(37);
        let tree = LightTree::new(lamps);
        for i in 0..20 {
            let (at, n) = (receiver(i), 20_000);
            let mut counts = std::collections::BTreeMap::new();
            for k in 0..n {
                let Some((emitter, probability)) = tree.choose(&at, (f64::from(k) + 0.5) / f64::from(n))
                else {
                    continue;
                };
                let entry = counts.entry(emitter).or_insert((0u32, probability));
                entry.0 += 1;
                assert!((entry.1 / probability - 1.0).abs() < 1e-12);
            }
            for (emitter, probability) in tree.probabilities(&at) {
                let (count, said) = counts.get(&emitter).copied().unwrap_or((0, probability));
                assert!((said / probability - 1.0).abs() < 1e-12, "{said} {probability}");
                // Numbers go through the unit interval evenly: two intervals, each off by a step at most.
                assert!((f64::from(count) / f64::from(n) - probability).abs() < 2.1 / f64::from(n));
            }
        }
    }

    #[test]
    fn lamps_are_chosen_by_what_they_give() {
        let lamps = lamps(10_000);
        let tree = LightTree::new(lamps.clone());
        let (mut by_tree, mut by_power) = (0.0, 0.0);
        for i in 0..50 {
            // Below all lamps: right beside one no choice by branches is good.
            let at = receiver(i);
            let at = Receiver { origin: at.origin.with_z(-12.0), ..at };
            let probabilities: std::collections::BTreeMap<u32, f64> = tree.probabilities(&at).collect();
            let power: f64 = lamps.iter().map(|(_, e)| f64::from(e.intensity)).sum();
            let given: Vec<f64> = lamps.iter().map(|(_, e)| given(e, &at)).collect();
            let all: f64 = given.iter().sum();
            if all == 0.0 {
                continue;
            }
            for ((emitter, extent), given) in lamps.iter().zip(given) {
                let p = probabilities[emitter];
                assert!(p >= UNIFORM / 10_000.0, "each lamp may be chosen");
                by_tree += given * given / p / (all * all);
                by_power += given * given / (f64::from(extent.intensity) / power) / (all * all);
            }
        }
        // The mean square of one sample over the squared mean: 1 were the choice perfect.
        assert!(by_tree < 0.1 * by_power && by_tree / 50.0 < 8.0, "{by_tree} {by_power}");
    }

    #[test]
    fn bounds_of_a_branch_are_above_what_its_lamps_give() {
        let lamps = lamps(64);
        let tree = LightTree::new(lamps.clone());
        for i in 0..200 {
            let at = receiver(i);
            let root = &tree.nodes[0];
            let far = root.centre + (at.origin - root.centre).normalize() * 40.0;
            let at = Receiver { origin: far, ..at };
            let all: f64 = lamps.iter().map(|(_, e)| given(e, &at)).sum();
            // Distances are to the middle: so far away they differ by (40 + 17)²/40² at most.
            assert!(all <= 3.1 * f64::from(root.importance(&at)) + 1e-12);
        }
    }

    #[test]
    fn one_lamp_is_always_chosen_and_none_never() {
        let tree = LightTree::new(lamps(1));
        assert_eq!(tree.choose(&receiver(0), 0.99), Some((0, 1.0)));
        assert!(LightTree::new(Vec::new()).is_empty());
    }
}
