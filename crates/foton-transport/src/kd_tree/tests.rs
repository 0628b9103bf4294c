//! The tree and its searches against looking at every photon, and estimates against the density that photons were made with.

use std::f32::consts::PI;

use foton_math::glam::Vec3;
use foton_math::{Purpose, Rgb, Stream};

use super::{Estimate, Found, KdTree, KernelFilter, MapClass, Nearest, PackedPhoton, Rgbe};

fn photon(position: Vec3, patch: u8) -> PackedPhoton {
    PackedPhoton::new(position, Rgbe::new(Rgb::WHITE, [0.0; 3]), Vec3::Z, patch, MapClass::Indirect, 2)
}

/// Photons of several kinds of places: anywhere, on a plane, on a line, many on one point.
fn photons(n: u32, seed: u64) -> Vec<PackedPhoton> {
    let mut stream = Stream::new(seed, Purpose::Test, 0, 0);
    (0..n)
        .map(|i| {
            let mut at = Vec3::new(stream.next_1d(), stream.next_1d(), stream.next_1d());
            match seed % 4 {
                1 => at.z = 0.25,
                2 => (at.y, at.z) = (0.5, 0.5),
                3 if i % 3 == 0 => at = Vec3::splat(0.5),
                3 => at = (at * 8.0).round() / 8.0,
                _ => {}
            }
            photon(at, (i % 3) as u8)
        })
        .collect()
}

fn by_looking_at_all(
    tree: &KdTree,
    point: Vec3,
    distance2: f32,
    counts: impl Fn(&PackedPhoton) -> bool,
) -> Vec<Found> {
    let mut all: Vec<Found> = tree
        .nodes()
        .iter()
        .enumerate()
        .filter(|(_, p)| counts(p))
        .map(|(i, p)| Found { distance2: (p.position - point).length_squared(), index: i as u32 })
        .filter(|f| f.distance2 <= distance2)
        .collect();
    all.sort_by(|a, b| a.distance2.total_cmp(&b.distance2).then(a.index.cmp(&b.index)));
    all
}

#[test]
fn searches_find_what_looking_at_every_photon_finds() {
    let mut nearest = Nearest::default();
    for seed in 0..24 {
        let n = [1, 2, 3, 7, 40, 301, 1000, 9001][seed as usize / 3];
        let tree = KdTree::new(photons(n, seed));
        assert_eq!(tree.len(), n as usize);
        let mut stream = Stream::new(seed, Purpose::Test, 1, 0);
        for query in 0..60u32 {
            let point = Vec3::new(stream.next_1d(), stream.next_1d(), stream.next_1d()) * 1.2 - 0.1;
            // On a photon, too.
            let point =
                if query % 5 == 0 { tree.nodes()[query as usize % tree.len()].position } else { point };
            let distance2 = [f32::INFINITY, 0.3, 0.01, 0.0][query as usize % 4];
            let wanted = [1, 2, 5, 50, 500][query as usize % 5];
            let counts = |p: &PackedPhoton| query % 3 > 0 || p.patch() == 1;
            let mut all = by_looking_at_all(&tree, point, distance2, counts);
            let one = tree.nearest_one(point, distance2, |p, _| counts(p));
            assert_eq!(one, all.first().copied(), "{n} photons");
            tree.nearest(point, distance2, wanted, &mut nearest, |p, offset| {
                assert_eq!(offset, p.position - point);
                counts(p)
            });
            all.truncate(wanted);
            let mut found = nearest.found().to_vec();
            found.sort_by(|a, b| a.distance2.total_cmp(&b.distance2).then(a.index.cmp(&b.index)));
            assert_eq!(found, all, "{n} photons, {wanted} wanted");
            let farthest = (all.len() == wanted).then(|| all[wanted - 1]);
            assert_eq!(nearest.farthest(), farthest);
        }
    }
}

#[test]
fn a_tree_depends_on_its_photons_alone_and_is_known_by_its_order() {
    for seed in 0..8 {
        let n = 5000;
        let mut all = photons(n, seed);
        let tree = KdTree::new(all.clone());
        all.reverse();
        all.swap(3, 1000);
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            assert!(pool.install(|| KdTree::new(all.clone())) == tree, "photons in another order");
        }
        let nodes = tree.nodes().to_vec();
        assert!(KdTree::from_nodes(nodes.clone()).as_ref() == Some(&tree));
        let mut bad = nodes;
        bad[1].position += 10.0;
        assert!(KdTree::from_nodes(bad).is_none());
    }
    assert!(KdTree::new(Vec::new()).is_empty());
    assert_eq!(KdTree::default().nearest_one(Vec3::ZERO, f32::INFINITY, |_, _| true), None);
}

/// A thousand planes of evenly spread photons, as many as chance puts there: the mean estimate is their density, by each filter, where
/// the disc is that of the k-th photon, where it is the largest one, and where it is sometimes this and sometimes that.
#[test]
fn the_expected_estimate_is_the_density_for_any_filter_and_limit() {
    const DENSITY: f32 = 40.0;
    const TRIALS: u64 = 3000;
    let mut nearest = Nearest::default();
    let k = 12;
    let typical2 = k as f32 / (PI * DENSITY);
    for filter in KernelFilter::ALL {
        for limit2 in [100.0, 1.5 * typical2, typical2, 0.2 * typical2] {
            let (mut sum, mut square) = (0.0, 0.0);
            for trial in 0..TRIALS {
                let mut stream = Stream::new(7, Purpose::Test, 0, trial);
                // Cells so small that there is hardly ever more than one photon in each make it Poisson's process.
                let n = (0..1000u32).filter(|_| stream.next_1d() < DENSITY * 4.0 / 1000.0).count();
                let all = (0..n)
                    .map(|_| {
                        photon(Vec3::new(2.0 * stream.next_1d() - 1.0, 2.0 * stream.next_1d() - 1.0, 0.0), 0)
                    })
                    .collect();
                let tree = KdTree::new(all);
                tree.nearest(Vec3::ZERO, limit2, k, &mut nearest, |_, _| true);
                let estimate = Estimate::of(&nearest, limit2, filter, |_| Rgb::WHITE);
                let x = f64::from(estimate.per_area.g);
                sum += x;
                square += x * x;
            }
            let n = TRIALS as f64;
            let (mean, variance) = (sum / n, (square / n - (sum / n).powi(2)) / n);
            // Photons of one row of cells or none: the number is binomial, whose mean is that of Poisson's.
            let off = (mean - f64::from(DENSITY)) / variance.sqrt();
            assert!(off.abs() < 4.0, "{filter:?} within {limit2}: {mean}, off by {off} σ");
        }
    }
}
