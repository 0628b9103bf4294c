//! Trees of what choosing neighbours does not come to an end with.

use foton_math::glam::Vec3;
use foton_math::{Aabb, Cancel, Purpose, Ray, Stream, warp};
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;

use super::{Accel, cluster, divide};
use crate::build::{BuildOptions, BuildStep};
use crate::primitive::Primitive;

fn triangle(corners: [[f32; 3]; 3]) -> Primitive {
    Primitive::Triangle(corners.map(Vec3::from_array))
}

/// Heaps of so many primitives: one square, balls in balls, a fan around a point, a strip of squares, and triangles in one place.
fn heaps(count: u32) -> Vec<(&'static str, Vec<Primitive>)> {
    let share = |i: u32| i as f32 / count as f32;
    let square = |i: u32| {
        let far = if i.is_multiple_of(2) { [1.0, -1.0, 0.0] } else { [-1.0, 1.0, 0.0] };
        triangle([[-1.0, -1.0, 0.0], [1.0, 1.0, 0.0], far])
    };
    let ball = |i: u32| Primitive::Sphere { centre: Vec3::ZERO, radius: 1.0 - 0.9 * share(i), inward: false };
    let rim = |i: u32| {
        let (y, x) = (std::f32::consts::TAU * share(i)).sin_cos();
        [x, y, 0.0]
    };
    let fan = |i: u32| triangle([[0.0; 3], rim(i), rim(i + 1)]);
    // Sides that single precision holds exactly: all boxes cost the same.
    let step = 1.0 / 8192.0;
    let strip = |i: u32| {
        let [low, high] = [i / 2, i / 2 + 1].map(|i| i as f32 * step);
        let third = if i.is_multiple_of(2) { [high, 0.0, 0.0] } else { [low, step, 0.0] };
        triangle([[low, 0.0, 0.0], [high, step, 0.0], third])
    };
    let point = |_| triangle([[0.5, 0.5, 0.5], [0.75, 0.5, 0.5], [0.5, 0.75, 0.5]]);
    let all = |of: &dyn Fn(u32) -> Primitive| (0..count).map(of).collect();
    vec![
        ("one square", all(&square)),
        ("balls in balls", all(&ball)),
        ("a fan", all(&fan)),
        ("a strip", all(&strip)),
        ("one triangle", all(&point)),
    ]
}

/// The depth of a tree, if each box is in it once and within those around it.
fn depth(tree: &Bvh2, boxes: usize) -> usize {
    let (mut seen, mut deepest) = (vec![false; boxes], 0);
    let mut open = vec![(0usize, 1)];
    while let Some((index, depth)) = open.pop() {
        let node = &tree.nodes[index];
        deepest = deepest.max(depth);
        if node.is_leaf() {
            let leaf = tree.primitive_indices[node.first_index as usize] as usize;
            assert!(!std::mem::replace(&mut seen[leaf], true), "{leaf} twice");
            continue;
        }
        for child in [node.first_index as usize, node.first_index as usize + 1] {
            let (around, within) = (node.aabb(), tree.nodes[child].aabb());
            assert!(around.min.cmple(within.min).all() && around.max.cmpge(within.max).all(), "{child}");
            open.push((child, depth + 1));
        }
    }
    assert!(seen.into_iter().all(|seen| seen), "all are there");
    deepest
}

/// Questions count the work: a round asks once in a few thousand boxes.
#[test]
fn a_heap_of_ties_takes_work_in_proportion_to_its_size() {
    const COUNT: u32 = 20_000;
    for (name, primitives) in heaps(COUNT) {
        let boxes: Vec<_> = primitives
            .iter()
            .map(|p| obvhs::aabb::Aabb { min: p.bounds().min.into(), max: p.bounds().max.into() })
            .collect();
        let options = BuildOptions { cancel: Cancel::after(2 * u64::from(COUNT)), ..BuildOptions::default() };
        let gauge = options.step(BuildStep::Tree, cluster::items(boxes.len()));
        let tree = cluster::build(&boxes, &gauge);
        let depth = depth(&tree.unwrap_or_else(|_| panic!("{name} takes too long")), boxes.len());
        assert!(depth < 160, "{name} is a chain: {depth}");
    }
}

/// Centres that draw together by the same factor: by cost alone each division takes one off.
#[test]
fn what_is_divided_becomes_no_chain() {
    let part = |i: u32| {
        let at = Vec3::X * 0.8f32.powi(i as i32);
        Bvh2Node::new(obvhs::aabb::Aabb { min: at.into(), max: (at * 1.01).into() }, 1, i)
    };
    let mut parts: Vec<_> = (0..300).map(part).collect();
    let mut nodes = vec![Bvh2Node::default(); 599];
    let options = BuildOptions::default();
    let deepest = divide::divide(&mut parts, &mut nodes, &options.step(BuildStep::Tree, 300));
    let tree = Bvh2 { nodes, primitive_indices: (0..300).collect(), ..Bvh2::default() };
    let deepest = deepest.expect("not cancelled");
    assert_eq!(depth(&tree, 300), deepest + 1);
    assert!(deepest < 30, "{deepest}");
}

#[test]
fn rays_hit_in_a_heap_of_ties_what_they_hit_one_by_one() {
    let mut stream = Stream::new(16, Purpose::Test, 0, 0);
    for (name, primitives) in heaps(1500) {
        let (accel, order) =
            Accel::build(&primitives, Vec::new(), &BuildOptions::default()).expect("not cancelled");
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.into_iter().eq(0..1500), "{name}");
        let bounds = primitives.iter().fold(Aabb::EMPTY, |all, p| all.union(p.bounds()));
        let mut hits = 0;
        for _ in 0..300 {
            let part = Vec3::new(stream.next_1d(), stream.next_1d(), stream.next_1d());
            let (target, from) =
                (bounds.min + part * bounds.size(), warp::square_to_sphere(stream.next_2d()));
            let ray = Ray::new(target - from * 3.0, from);
            let alone = |p: &Primitive| {
                let (accel, _) =
                    Accel::build(&[*p], Vec::new(), &BuildOptions::default()).expect("not cancelled");
                accel.nearest(ray).map(|hit| hit.t)
            };
            let nearest = primitives.iter().filter_map(alone).reduce(f32::min);
            assert_eq!(accel.nearest(ray).map(|hit| hit.t), nearest, "{name}");
            assert_eq!(accel.occluded(ray), nearest.is_some(), "{name}");
            hits += u32::from(nearest.is_some());
        }
        assert!(hits > 10, "{name}: {hits}");
    }
}
