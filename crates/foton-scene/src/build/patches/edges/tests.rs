//! Edges in parts against edges sorted at once.

use super::*;
use crate::build::{BuildOptions, BuildStep};

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
