//! Joining triangles that share an edge: equal edges are found by sorting their hashes.

use foton_math::Cancelled;
use foton_math::glam::Vec3;
use rayon::prelude::*;

use super::sets::Sets;
use super::side::Side;
use crate::build::gauge::Gauge;
use crate::primitive::Primitive;

/// Where more triangles share an edge, each is compared with this many only.
const MAX_AT_AN_EDGE: usize = 16;

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

/// Edges that are sorted at once, without a check for cancellation.
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
pub(super) fn join_equal_edges(
    primitives: &[Primitive],
    stores: &(impl Fn(u32) -> bool + Sync),
    sets: &mut Sets,
    free: &mut [u8],
    gauge: &Gauge<'_>,
) -> Result<(), Cancelled> {
    let sides_of = |i: usize| match primitives[i] {
        Primitive::Triangle(corners) if gauge.check().is_ok() && stores(i as u32) => Some(corners),
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
    let joints: Vec<Joint> = parts(&edges)
        .into_par_iter()
        .filter(|_| gauge.check().is_ok())
        .flat_map_iter(|part| part.chunk_by(|a, b| a.hash == b.hash))
        .flat_map_iter(|group| {
            // Those behind the first have others before them.
            let later = group.iter().enumerate().skip(1).filter(|(i, _)| gauge.check_at(*i).is_ok());
            later.flat_map(|(i, edge)| joints(primitives, edge, &group[..i.min(MAX_AT_AN_EDGE)]))
        })
        .collect();
    gauge.check()?;
    drop(edges);
    for (number, Joint { primitives: [a, b], sides, turned }) in joints.into_iter().enumerate() {
        gauge.item(number)?;
        sets.join(a, b, turned);
        for (primitive, side) in [(a, sides[0]), (b, sides[1])] {
            free[primitive as usize] &= !(1 << side);
        }
    }
    Ok(())
}

/// Sorted edges in parts of about [`Gauge::EVERY`], equal ones in one.
fn parts(edges: &[Edge]) -> Vec<&[Edge]> {
    let (mut parts, mut rest) = (Vec::with_capacity(edges.len() / Gauge::EVERY + 1), edges);
    while let Some(last) = rest.get(Gauge::EVERY - 1) {
        let behind = rest[Gauge::EVERY..].iter().take_while(|edge| edge.hash == last.hash).count();
        let (part, after) = rest.split_at(Gauge::EVERY + behind);
        parts.push(part);
        rest = after;
    }
    parts.push(rest);
    parts
}

/// Two triangles that continue each other at an edge.
struct Joint {
    primitives: [u32; 2],
    sides: [u8; 2],
    /// Whether their normals point to different sides.
    turned: bool,
}

/// What continues a triangle at an edge, of those that have an equal one.
fn joints(primitives: &[Primitive], edge: &Edge, others: &[Edge]) -> impl Iterator<Item = Joint> {
    let side = |e: &Edge| match primitives[e.primitive as usize] {
        Primitive::Triangle(corners) => Side::new(corners, usize::from(e.side)),
        _ => None,
    };
    let one = side(edge);
    others.iter().filter_map(move |other| {
        let turned = one.as_ref()?.continued_by(&side(other)?)?;
        Some(Joint { primitives: [edge.primitive, other.primitive], sides: [edge.side, other.side], turned })
    })
}

#[cfg(test)]
mod tests;
