//! Which primitives continue each other. A photon on one counts for a hit point on the other; a photon on any other surface
//! does not, however close that is.
//!
//! A *patch* is a set of primitives joined at their edges where the surface goes on at less than about 84°: the triangles of a
//! mesh, whether or not its file shares their vertices, and rectangles that abut. A crease or fold as sharp as that ends a patch,
//! and so does a card that lies on a floor. Neither names of shapes nor groups of files are looked at.
//!
//! Triangles with equal vertices are joined at once. What then still has a free edge is probed: a ray just beyond the edge finds
//! what lies flush with it.

use foton_math::glam::{DVec3, Vec2, Vec3};
use foton_math::{Aabb, Cancelled, Frame, Ray};
use rayon::prelude::*;

use super::gauge::{BuildOptions, BuildStep, Gauge};
use crate::accel::Accel;
use crate::primitive::{Primitive, ShearedRay};
use crate::surface::locate;

/// Surfaces continue each other where their normals, turned to the same side, have at least this cosine: what the gather asks
/// of a photon's normal, too.
const MIN_COSINE: f64 = 0.1;

/// Normals of a patch that all have at least this cosine (0.26°) say that it is flat.
const FLAT_COSINE: f32 = 1.0 - 1e-5;

/// Edges are probed at this many steps between neighbouring coordinates of single precision beyond them.
const PROBED_STEPS: f32 = 16.0;

/// Of more triangles at one edge, each is compared with so many only.
const MAX_AT_AN_EDGE: usize = 16;

/// Of the primitives near an edge so many are looked at.
const MAX_NEAR: usize = 32;

/// Numbers of patches, beside 0 for surfaces that keep no photon.
const NUMBERS: usize = 127;

/// Of more patches, so many of the largest have a number of their own; the others share the rest in the order of a space-filling
/// curve, so that neighbours differ.
const LARGEST: usize = 64;

/// What a primitive belongs to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Patch {
    /// Number of the patch in the high 7 bits, and in the lowest whether the primitive's normal is turned against the patch's.
    pub(crate) key: u8,
    /// Whether the patch leaves its tangent planes.
    pub(crate) curved: bool,
}

/// Finds the patches of those primitives that `keeps` picks, in the tree's order.
pub(super) fn find(
    accel: &Accel,
    keeps: impl Fn(usize) -> bool + Sync,
    options: &BuildOptions<'_>,
) -> Result<Vec<Patch>, Cancelled> {
    let primitives = accel.primitives();
    let gauge = options.step(BuildStep::Patches, 2 * primitives.len());
    let mut sets = Sets::new(primitives.len());
    let mut free: Vec<u8> = vec![0b111; primitives.len()];
    join_equal_edges(primitives, &keeps, &mut sets, &mut free, &gauge)?;
    // What is left of a loop over threads once it is cancelled has nothing to do.
    let found: Vec<(u32, u32, bool)> = (0..primitives.len())
        .into_par_iter()
        .filter(|&i| gauge.item(i).is_ok() && gauge.check().is_ok() && keeps(i))
        .flat_map_iter(|i| probed(accel, i, free[i], &keeps))
        .collect();
    for (i, (a, b, turned)) in found.into_iter().enumerate() {
        gauge.check_at(i)?;
        sets.join(a, b, turned);
    }
    number(primitives, &keeps, &mut sets, &gauge)
}

/// One side of a triangle.
struct Side {
    ends: [Vec3; 2],
    third: Vec3,
    normal: DVec3,
    /// Unit direction in the triangle's plane, away from the edge and into the triangle.
    inward: DVec3,
}

impl Side {
    /// `None` for a triangle that is too thin to have a plane.
    fn new(corners: [Vec3; 3], side: usize) -> Option<Self> {
        let [a, b, c] = [0, 1, 2].map(|i| corners[(side + i) % 3]);
        let (from, to) = (a.as_dvec3(), c.as_dvec3());
        let along = (b.as_dvec3() - from).try_normalize()?;
        let across = to - from;
        let inward = (across - along * across.dot(along)).try_normalize()?;
        Some(Self { ends: [a, b], third: c, normal: along.cross(inward), inward })
    }

    /// Whether `other`, which has the same edge, continues this one; if so, whether its normal is turned against this one's.
    fn continued_by(&self, other: &Self) -> Option<bool> {
        let [a, b] = self.ends;
        if other.ends != [a, b] && other.ends != [b, a] {
            return None;
        }
        let goes_on = self.inward.dot(other.inward) < -MIN_COSINE;
        (goes_on || self.third == other.third).then(|| self.normal.dot(other.normal) < 0.0)
    }
}

/// An edge of a triangle, by what is equal for the triangles on both of its sides.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Edge {
    hash: u64,
    primitive: u32,
    side: u8,
}

fn hash_of_edge(a: Vec3, b: Vec3) -> u64 {
    // Adding zero makes one zero of both.
    let bits = |v: Vec3| (v + Vec3::ZERO).to_array().map(f32::to_bits);
    let (a, b) = (bits(a), bits(b));
    let (low, high) = if a <= b { (a, b) } else { (b, a) };
    low.into_iter().chain(high).fold(0, |hash: u64, word| {
        let mixed = (hash ^ u64::from(word)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        mixed ^ (mixed >> 29)
    })
}

/// Edges that are sorted at once, without a question whether building goes on.
const SORTED_AT_ONCE: usize = 1 << 18;

/// Sorts edges: first into parts by the highest bits of their hashes, which lie evenly.
fn sorted(mut edges: Vec<Edge>, gauge: &Gauge<'_>) -> Result<Vec<Edge>, Cancelled> {
    gauge.check()?;
    let bits = (edges.len() / SORTED_AT_ONCE).next_power_of_two().trailing_zeros();
    if bits == 0 {
        edges.par_sort_unstable();
        return Ok(edges);
    }
    let part_of = |edge: &Edge| (edge.hash >> (u64::BITS - bits)) as usize;
    let mut ends = vec![0usize; 1 << bits];
    for (i, edge) in edges.iter().enumerate() {
        gauge.check_at(i)?;
        ends[part_of(edge)] += 1;
    }
    let mut sum = 0;
    for end in &mut ends {
        // Where the part begins; it moves on to its end.
        sum += std::mem::replace(end, sum);
    }
    let mut in_parts = vec![Edge::default(); edges.len()];
    for (i, edge) in edges.iter().enumerate() {
        gauge.check_at(i)?;
        let place = &mut ends[part_of(edge)];
        in_parts[*place] = *edge;
        *place += 1;
    }
    drop(edges);
    let (mut parts, mut rest, mut before) = (Vec::new(), &mut in_parts[..], 0);
    for end in ends {
        let (part, after) = rest.split_at_mut(end - before);
        parts.push(part);
        (rest, before) = (after, end);
    }
    parts.into_par_iter().try_for_each(|part| {
        part.sort_unstable();
        gauge.check()
    })?;
    Ok(in_parts)
}

/// Joins triangles that have both vertices of an edge in common, and clears the bits of their sides in `free`.
fn join_equal_edges(
    primitives: &[Primitive],
    keeps: &(impl Fn(usize) -> bool + Sync),
    sets: &mut Sets,
    free: &mut [u8],
    gauge: &Gauge<'_>,
) -> Result<(), Cancelled> {
    let sides_of = |i: usize| match primitives[i] {
        Primitive::Triangle(corners) if gauge.check().is_ok() && keeps(i) => Some(corners),
        _ => None,
    };
    let edges: Vec<Edge> = (0..primitives.len())
        .into_par_iter()
        .flat_map_iter(|i| {
            sides_of(i).into_iter().flat_map(move |corners| {
                (0..3u8).map(move |side| {
                    let s = usize::from(side);
                    let hash = hash_of_edge(corners[s], corners[(s + 1) % 3]);
                    Edge { hash, primitive: i as u32, side }
                })
            })
        })
        .collect();
    let edges = sorted(edges, gauge)?;
    let side = |e: &Edge| match primitives[e.primitive as usize] {
        Primitive::Triangle(corners) => Side::new(corners, usize::from(e.side)),
        _ => None,
    };
    let groups = edges.chunk_by(|a, b| a.hash == b.hash);
    for (number, group) in groups.enumerate().filter(|(_, group)| group.len() > 1) {
        gauge.item(number)?;
        for (i, edge) in group.iter().enumerate().skip(1) {
            gauge.check_at(i)?;
            let Some(one) = side(edge) else { continue };
            for other_edge in &group[..i.min(MAX_AT_AN_EDGE)] {
                let Some(turned) = side(other_edge).and_then(|other| one.continued_by(&other)) else {
                    continue;
                };
                sets.join(edge.primitive, other_edge.primitive, turned);
                for e in [edge, other_edge] {
                    free[e.primitive as usize] &= !(1 << e.side);
                }
            }
        }
    }
    Ok(())
}

/// What continues a primitive flush beyond its free edges: pairs of primitives, and whether their normals are turned.
fn probed(
    accel: &Accel,
    index: usize,
    free: u8,
    keeps: &(impl Fn(usize) -> bool + Sync),
) -> Vec<(u32, u32, bool)> {
    let mut found = Vec::new();
    let mut probe = |edge: Rim| {
        if let Some((other, turned)) = edge.continued_in(accel, keeps) {
            found.push((index as u32, other, turned));
        }
    };
    match accel.primitives()[index] {
        Primitive::Triangle(corners) => {
            for side in (0..3).filter(|side| free >> side & 1 != 0) {
                let Some(edge) = Side::new(corners, side) else { continue };
                let [a, b] = edge.ends;
                let step = step_at(a.abs().max(b.abs()).max_element());
                // Of two edges that overlap one has an end within the other, or is within it.
                let inset = (2.0 * step / a.distance(b).max(f32::MIN_POSITIVE)).min(0.25);
                let (normal, outward) = (edge.normal.as_vec3(), -edge.inward.as_vec3());
                for share in [0.5, inset, 1.0 - inset] {
                    probe(Rim { point: a.lerp(b, share), outward, normal, step });
                }
            }
        }
        Primitive::Cylinder { from, axis, radius } => {
            let Some(unit) = axis.try_normalize() else { return found };
            let frame = Frame::from_normal(unit);
            let step = step_at(from.abs().max((from + axis).abs()).max_element() + radius.abs());
            for (end, outward) in [(from, -unit), (from + axis, unit)] {
                for normal in [frame.tangent, frame.bitangent, -frame.tangent, -frame.bitangent] {
                    let turned = normal * 1f32.copysign(radius);
                    probe(Rim { point: end + normal * radius.abs(), outward, normal: turned, step });
                }
            }
        }
        Primitive::Sphere { .. } | Primitive::Disc { .. } => {}
    }
    found
}

/// How far beyond an edge it is probed where coordinates are as large as this.
fn step_at(largest_coordinate: f32) -> f32 {
    PROBED_STEPS * f32::EPSILON * largest_coordinate.max(f32::MIN_POSITIVE)
}

/// A point of a surface's edge.
struct Rim {
    point: Vec3,
    /// Unit direction along the surface and away from it.
    outward: Vec3,
    normal: Vec3,
    step: f32,
}

impl Rim {
    /// The primitive that lies flush beyond the edge, and whether its normal is turned. One that goes on below or above the
    /// surface itself, as the floor does under a card, does not continue it.
    fn continued_in(&self, accel: &Accel, keeps: &impl Fn(usize) -> bool) -> Option<(u32, bool)> {
        let Self { point, outward, normal, step } = *self;
        let height = 4.0 * step;
        let cosine_along = |origin: Vec3, direction: Vec3| {
            let ray = Ray { origin, direction, t_min: 0.0, t_max: 2.0 * height };
            let sheared = ShearedRay::new(ray);
            let near = Aabb::EMPTY.with(origin).with(ray.at(ray.t_max));
            let mut nearest: Option<(f32, u32, f32)> = None;
            accel.for_each_near(&near, MAX_NEAR, |index| {
                let primitive = &accel.primitives()[index];
                let farthest = nearest.map_or(ray.t_max, |(t, ..)| t);
                let Some(t) = sheared.hit_other(primitive, farthest).filter(|_| keeps(index)) else { return };
                let (_, _, other) = locate(primitive, Vec2::ZERO, ray.at(t));
                let cosine = normal.dot(other);
                if f64::from(cosine.abs()) > MIN_COSINE {
                    nearest = Some((t, index as u32, cosine));
                }
            });
            nearest.map(|(_, index, cosine)| (index, cosine))
        };
        let (other, cosine) = cosine_along(point + outward * step + normal * height, -normal)?;
        let inside = point - outward * (2.0 * step);
        let overlaps = [normal, -normal]
            .into_iter()
            .any(|side| cosine_along(inside + side * (step / PROBED_STEPS), side).is_some());
        (!overlaps).then_some((other, cosine < 0.0))
    }
}

/// Disjoint sets of primitives, each of which knows whether its normal is turned against that of the set.
struct Sets {
    parent: Vec<u32>,
    /// Whether turned against the parent.
    turned: Vec<bool>,
}

impl Sets {
    fn new(primitives: usize) -> Self {
        Self { parent: (0..primitives as u32).collect(), turned: vec![false; primitives] }
    }

    /// The set of a primitive, and whether it is turned against it.
    fn root(&mut self, mut i: u32) -> (u32, bool) {
        let mut turned = false;
        while self.parent[i as usize] != i {
            let parent = self.parent[i as usize];
            // Halves the way for the next who asks.
            self.turned[i as usize] ^= self.turned[parent as usize];
            self.parent[i as usize] = self.parent[parent as usize];
            turned ^= self.turned[i as usize];
            i = self.parent[i as usize];
        }
        (i, turned)
    }

    fn join(&mut self, a: u32, b: u32, turned: bool) {
        let ((a, a_turned), (b, b_turned)) = (self.root(a), self.root(b));
        if a != b {
            // The first primitive stands for the set: numbers do not depend on the order of joining.
            let (low, high) = (a.min(b), a.max(b));
            self.parent[high as usize] = low;
            self.turned[high as usize] = turned ^ a_turned ^ b_turned;
        }
    }
}

/// Numbers patches so that neighbours differ.
fn number(
    primitives: &[Primitive],
    keeps: &impl Fn(usize) -> bool,
    sets: &mut Sets,
    gauge: &Gauge<'_>,
) -> Result<Vec<Patch>, Cancelled> {
    let root = |i: usize| gauge.check_at(i).map(|()| sets.root(i as u32));
    let roots: Vec<(u32, bool)> = (0..primitives.len()).map(root).collect::<Result<_, _>>()?;
    let mut boxes = vec![Aabb::EMPTY; primitives.len()];
    let mut curved = vec![false; primitives.len()];
    let normal = |i: usize| match primitives[i] {
        Primitive::Triangle(corners) => crate::plane::triangle_normal(corners),
        Primitive::Disc { normal, .. } => Some(normal),
        Primitive::Sphere { .. } | Primitive::Cylinder { .. } => None,
    };
    let mut patches: Vec<u32> = Vec::new();
    for (i, &(root, _)) in roots.iter().enumerate().filter(|(i, _)| keeps(*i)) {
        gauge.check_at(i)?;
        let root = root as usize;
        if root == i {
            patches.push(i as u32);
        }
        boxes[root] = boxes[root].union(primitives[i].bounds());
        let flat = normal(i).zip(normal(root)).is_some_and(|(n, of_root)| n.dot(of_root).abs() > FLAT_COSINE);
        curved[root] |= !flat;
    }
    let mut number_of = vec![0u8; primitives.len()];
    if patches.len() > NUMBERS {
        let size = |&i: &u32| boxes[i as usize].size().length_squared();
        patches.sort_by(|a, b| size(b).total_cmp(&size(a)).then(a.cmp(b)));
        let all = patches.iter().fold(Aabb::EMPTY, |b, &i| b.union(boxes[i as usize]));
        patches[LARGEST..].sort_by_key(|&i| (along_curve(&boxes[i as usize], &all), i));
    }
    for (place, &i) in patches.iter().enumerate() {
        let number = if place < LARGEST { place } else { LARGEST + (place - LARGEST) % (NUMBERS - LARGEST) };
        number_of[i as usize] = number as u8 + 1;
    }
    let patch = |(i, &(root, turned)): (usize, &(u32, bool))| {
        let (number, curved) = (number_of[root as usize], curved[root as usize]);
        if keeps(i) { Patch { key: number << 1 | u8::from(turned), curved } } else { Patch::default() }
    };
    gauge.check()?;
    Ok(roots.iter().enumerate().map(patch).collect())
}

/// Place of a box's middle along Morton's curve through another box, in cubes: what is close in space is mostly close along it.
fn along_curve(of: &Aabb, all: &Aabb) -> u64 {
    let share = (of.centre() - all.min) / all.size().max_element().max(f32::MIN_POSITIVE);
    let [x, y, z] = (share * 1023.0).clamp(Vec3::ZERO, Vec3::splat(1023.0)).to_array().map(|c| c as u64);
    (0..10).fold(0, |code, bit| {
        let at = |c: u64, place: u64| (c >> bit & 1) << (3 * bit + place);
        code | at(x, 0) | at(y, 1) | at(z, 2)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_in_parts_are_sorted_as_all_at_once() {
        let options = BuildOptions::default();
        let gauge = options.step(BuildStep::Patches, 1);
        for count in [3, 5 * SORTED_AT_ONCE as u32] {
            let edge = |i: u32| {
                // Every hash twice.
                let hash = u64::from(i / 2).wrapping_mul(0x9e37_79b9_7f4a_7c15);
                Edge { hash, primitive: count - i, side: (i % 3) as u8 }
            };
            let edges: Vec<Edge> = (0..count).map(edge).collect();
            let mut wanted = edges.clone();
            wanted.sort_unstable();
            assert!(sorted(edges, &gauge) == Ok(wanted), "{count}");
        }
    }
}
