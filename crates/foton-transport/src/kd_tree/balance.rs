//! The shape of a left-balanced tree: all levels full but the last, which is filled from the left. `[JEN01]`
//!
//! Such a tree needs no pointers: the children of node i are 2i + 1 and 2i + 2.

/// Nodes in the left one of the two trees below the root of a tree of `n` nodes.
pub(super) const fn left_of(n: usize) -> usize {
    if n < 2 {
        return 0;
    }
    // The last level has room for `last` nodes, half of them on the left.
    let last = 1 << n.ilog2();
    let half = last / 2;
    let in_last = n - (last - 1);
    half - 1 + if in_last < half { in_last } else { half }
}

/// Where a node stands if a tree of `n` is written from left to right instead of level by level.
pub(super) const fn in_order(node: usize, n: usize) -> usize {
    // The way from the root: the bits of node + 1 after the highest.
    let way = node + 1;
    let (mut first, mut count) = (0, n);
    let mut bit = way.ilog2();
    while bit > 0 {
        bit -= 1;
        let left = left_of(count);
        if way >> bit & 1 == 0 {
            count = left;
        } else {
            first += left + 1;
            count -= left + 1;
        }
    }
    first + left_of(count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_node_has_one_place_from_left_to_right_between_its_children() {
        for n in (1..200).chain([255, 256, 257, 1000, 1023, 1024, 1025]) {
            let places: Vec<usize> = (0..n).map(|node| in_order(node, n)).collect();
            let mut sorted = places.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, (0..n).collect::<Vec<_>>(), "{n} nodes");
            for node in 0..n {
                let children = [2 * node + 1, 2 * node + 2].map(|c| places.get(c).copied());
                assert!(children[0].is_none_or(|left| left < places[node]));
                assert!(children[1].is_none_or(|right| right > places[node]));
            }
        }
    }
}
