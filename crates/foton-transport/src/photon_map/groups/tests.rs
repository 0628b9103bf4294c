//! Grouping of hit points.

use super::*;
use foton_math::{Purpose, Rgb, Stream};

fn scattered(n: u64) -> Vec<HitPoint> {
    (0..n)
        .map(|i| {
            let mut s = Stream::new(1, Purpose::Test, 0, i);
            HitPoint {
                position: Vec3::new(s.next_1d(), s.next_1d(), 0.01 * s.next_1d()) * 100.0,
                normal: Vec3::Z,
                shading_normal: Vec3::Z,
                offset: 0.0,
                weight: Rgb::WHITE,
                gloss: None,
                footprint: 0.25,
                radius2: 4.0,
                curved: true,
                remaining_edges: 9,
                patch: 0,
                smallest2: 0.0,
            }
        })
        .collect()
}

#[test]
fn each_hit_point_is_in_one_group_and_groups_are_full_and_narrow() {
    // Two bands and a part of one.
    let found = scattered(150_000);
    let groups = group(&found, |_| true, BAND, &Cancel::default()).expect("not cancelled");
    let mut seen = vec![false; found.len()];
    for g in groups.iter() {
        assert!(!g.is_empty() && g.len() <= LANES);
        let b = g.iter().fold(Aabb::EMPTY, |b, &i| b.with(found[i as usize].position));
        assert!(b.size().max_element() <= MAX_WIDTH * 2.0);
        for &i in g {
            assert!(!std::mem::replace(&mut seen[i as usize], true), "{i} twice");
        }
    }
    assert!(seen.iter().all(|&s| s));
    let fill = found.len() as f64 / (groups.count() * LANES) as f64;
    assert!(fill > 0.8, "{fill}");
}

#[test]
fn grouping_that_is_cancelled_gives_no_groups_wherever_that_comes() {
    let found = scattered(2_000);
    let grouped = |checks| group(&found, |_| true, BAND, &Cancel::after(checks));
    let needed = (0..10_000).find(|&n| grouped(n).is_ok()).expect("in the end");
    assert!(needed > found.len() as u64 / LANES as u64, "{needed}");
}

#[test]
fn coinciding_hit_points_are_grouped_too() {
    let mut found = scattered(100);
    for h in &mut found {
        h.position = Vec3::ONE;
    }
    assert_eq!(
        group(&found, |_| true, BAND, &Cancel::default())
            .expect("not cancelled")
            .iter()
            .map(<[u32]>::len)
            .sum::<usize>(),
        100
    );
}
