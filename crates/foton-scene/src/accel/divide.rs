//! What rounds of joining do not come to an end with, divided from the top: where the surface area heuristic says, but never so
//! unevenly that the tree could become a chain. `[WAL07]`

use foton_math::Cancelled;
use foton_math::glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::node::Bvh2Node;

use crate::build::Gauge;

/// Places along an axis between which a division is chosen.
const BINS: usize = 16;

/// Each side of a division has at least one in so many of what is divided, or both have half of it.
const MIN_SHARE: usize = 8;

/// A stretch of what is divided, and the node that it becomes.
struct Stretch {
    node: usize,
    first: usize,
    end: usize,
    depth: usize,
}

/// Makes one tree of all `parts`, whose root becomes the first of `tree`; the others fill the rest of it, children in pairs. The depth
/// below the root. Its time is that of sorting the parts.
pub(super) fn divide(
    parts: &mut [Bvh2Node],
    tree: &mut [Bvh2Node],
    gauge: &Gauge<'_>,
) -> Result<usize, Cancelled> {
    let mut open = vec![Stretch { node: 0, first: 0, end: parts.len(), depth: 0 }];
    let (mut free, mut deepest) = (1, 0);
    while let Some(Stretch { node, first, end, depth }) = open.pop() {
        deepest = deepest.max(depth);
        let part = &mut parts[first..end];
        if let [only] = part {
            tree[node] = *only;
            gauge.item(first)?;
            continue;
        }
        gauge.check()?;
        let (bounds, left) = halve(part);
        tree[node] = Bvh2Node::new(bounds, 0, free as u32);
        let (middle, depth) = (first + left, depth + 1);
        open.push(Stretch { node: free, first, end: middle, depth });
        open.push(Stretch { node: free + 1, first: middle, end, depth });
        free += 2;
    }
    Ok(deepest)
}

fn empty() -> Aabb {
    Aabb { min: Vec3A::INFINITY, max: Vec3A::NEG_INFINITY }
}

/// Puts first what is to be on one side of a division. The box of all, and how many those are.
fn halve(parts: &mut [Bvh2Node]) -> (Aabb, usize) {
    let (mut bounds, mut centres) = (empty(), empty());
    for part in parts.iter() {
        bounds = bounds.union(part.aabb());
        let centre = part.aabb().center();
        centres = centres.union(&Aabb { min: centre, max: centre });
    }
    let axis = centres.largest_axis();
    let (low, extent) = (centres.min[axis], centres.max[axis] - centres.min[axis]);
    if extent > 0.0 {
        let bin = |part: &Bvh2Node| {
            let share = (part.aabb().center_axis(axis) - low) / extent;
            ((share * BINS as f32) as usize).min(BINS - 1)
        };
        if let Some(border) = cheapest_border(parts, bin) {
            let left = partition(parts, |part| bin(part) < border);
            if left.min(parts.len() - left) >= parts.len() / MIN_SHARE {
                return (bounds, left);
            }
        }
    }
    // Those in one place are told apart by their size.
    let key = |part: &Bvh2Node| {
        if extent > 0.0 { part.aabb().center_axis(axis) } else { part.aabb().half_area() }
    };
    let middle = parts.len() / 2;
    // Pairs lie where they were joined: no two parts have one number.
    let number = |part: &Bvh2Node| (part.prim_count, part.first_index);
    parts.select_nth_unstable_by(middle, |a, b| {
        key(a).total_cmp(&key(b)).then_with(|| number(a).cmp(&number(b)))
    });
    (bounds, middle)
}

/// The bin before which a division costs rays least; `None` where all lie in one.
fn cheapest_border(parts: &[Bvh2Node], bin: impl Fn(&Bvh2Node) -> usize) -> Option<usize> {
    let mut bins = [(empty(), 0usize); BINS];
    for part in parts {
        let (bounds, count) = &mut bins[bin(part)];
        *bounds = bounds.union(part.aabb());
        *count += 1;
    }
    // `below[i]`: the cost of all that lies before bin i.
    let cost =
        |(bounds, count): &(Aabb, usize)| if *count == 0 { 0.0 } else { bounds.half_area() * *count as f32 };
    let add = |sum: &mut (Aabb, usize), bin: &(Aabb, usize)| *sum = (sum.0.union(&bin.0), sum.1 + bin.1);
    let (mut sum, mut below) = ((empty(), 0), [(0.0, 0); BINS]);
    for (bin, below) in bins.iter().zip(&mut below) {
        *below = (cost(&sum), sum.1);
        add(&mut sum, bin);
    }
    let (mut sum, mut best) = ((empty(), 0), (f32::INFINITY, None));
    for border in (1..BINS).rev() {
        add(&mut sum, &bins[border]);
        let (cost, is_division) = (below[border].0 + cost(&sum), below[border].1 > 0 && sum.1 > 0);
        if is_division && cost < best.0 {
            best = (cost, Some(border));
        }
    }
    best.1
}

/// Puts those that `is_left` picks before the others; how many they are.
fn partition(parts: &mut [Bvh2Node], is_left: impl Fn(&Bvh2Node) -> bool) -> usize {
    let mut left = 0;
    for i in 0..parts.len() {
        if is_left(&parts[i]) {
            parts.swap(left, i);
            left += 1;
        }
    }
    left
}
