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

#[test]
fn parts_hold_all_edges_and_tear_no_equal_ones_apart() {
    let every = Gauge::EVERY as u32;
    for (count, equal) in [(0, 1), (every, 1), (every + 1, 1), (10 * every, 3), (5 * every, 2 * every)] {
        let edge = |i: u32| Edge { hash: u64::from(i / equal), primitive: i, side: 0 };
        let edges: Vec<Edge> = (0..count).map(edge).collect();
        let parts = parts(&edges);
        assert!(parts.concat() == edges, "{count} {equal}");
        for pair in parts.windows(2) {
            assert_ne!(pair[0].last().map(|e| e.hash), pair[1].first().map(|e| e.hash), "{count} {equal}");
        }
        assert!(parts.len() >= (count / (every + equal)) as usize);
    }
}
