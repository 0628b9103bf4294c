//! Every position in a disc has a cell, wherever discs are.

use super::*;
use crate::camera_paths::HitPoint;
use foton_math::{Purpose, Rgb, Stream, warp};

const fn hit_point(position: Vec3, radius: f32) -> HitPoint {
    HitPoint {
        position,
        normal: Vec3::Z,
        shading_normal: Vec3::Z,
        offset: 0.0,
        weight: Rgb::WHITE,
        gloss: None,
        footprint: radius * radius,
        radius2: radius * radius,
        curved: true,
        smallest2: 0.0,
        remaining_edges: 9,
        patch: 0,
    }
}

/// Discs on a sphere, or on a ground that is seen to its horizon.
fn packets(ground: bool) -> Vec<Packet> {
    let found: Vec<HitPoint> = (0..3000)
        .map(|i| {
            let mut s = Stream::new(5, Purpose::Test, 0, i);
            let radius = if i % 50 == 0 { 20.0 } else { 0.5 + s.next_1d() };
            // Most are near.
            let (out, turn) = (2f32.powf(15.0 * s.next_1d().powi(4)), 6.0 * s.next_1d());
            let (position, radius) = if ground {
                (Vec3::new(out * turn.cos(), -7.0, out * turn.sin()), 0.05 * out)
            } else {
                (warp::square_to_sphere(s.next_2d()) * 300.0, radius)
            };
            hit_point(position, radius)
        })
        .collect();
    super::super::groups::group(&found, |_| true, super::super::groups::BAND, &Cancel::default())
        .expect("not cancelled")
        .iter()
        .map(|g| Packet::new(g.iter().map(|&i| &found[i as usize])))
        .collect()
}

fn grid_of(packets: &[Packet]) -> Grid {
    Grid::new(packets, &Cancel::default()).expect("not cancelled")
}

#[test]
fn a_grid_that_is_cancelled_is_none_wherever_that_comes() {
    let packets = packets(true);
    let needed = (0..).find(|&n| Grid::new(&packets, &Cancel::after(n)).is_ok()).expect("in the end");
    assert!(needed > 5 + packets.len() as u64 / 2, "{needed}");
}

/// A bit at a time it would take minutes.
#[test]
fn wide_discs_among_narrow_ones_mark_cells_by_the_word() {
    let bits: Vec<AtomicU64> = (0..4).map(|_| AtomicU64::new(0)).collect();
    let all = [(0, 0), (5, 70), (63, 64), (64, 127), (130, 255), (255, 255)];
    for (first, last) in all {
        bits.iter().for_each(|b| b.store(0, Ordering::Relaxed));
        mark_row(&bits, first, last);
        let set = |cell: u32| bits[cell as usize / 64].load(Ordering::Relaxed) >> (cell % 64) & 1 != 0;
        assert!((0..256).all(|cell| set(cell) == (first..=last).contains(&cell)), "{first} {last}");
    }
}

#[test]
fn every_position_in_a_disc_has_a_number_within_the_packets_runs() {
    for ground in [false, true] {
        find_all_positions(&packets(ground));
    }
}

#[test]
fn cells_grow_where_discs_do() {
    let packets = packets(true);
    let grid = grid_of(&packets);
    assert!(grid.growth.is_some() && grid_of(&self::packets(false)).growth.is_none());
    // With equal cells those near the middle would be as wide as a 1024th of the whole, 64: hundreds of discs each.
    let near = grid.in_cells(Vec3::new(2.0, -7.0, 0.0)) - grid.in_cells(Vec3::new(1.0, -7.0, 0.0));
    assert!(near.x > 0.5, "{near}");
}

fn find_all_positions(packets: &[Packet]) {
    let grid = grid_of(packets);
    let mut stream = Stream::new(6, Purpose::Test, 0, 0);
    for packet in packets {
        let mut runs = Vec::new();
        grid.for_each_run(&packet.bounds(), |a, b| runs.push(a..b));
        assert!(runs.windows(2).all(|w| w[0].end <= w[1].start), "ascending and apart");
        for disc in packet.disc_boxes() {
            for _ in 0..20 {
                let d = warp::square_to_sphere(stream.next_2d()) * stream.next_1d();
                let p = disc.centre() + d * disc.size().x * 0.499;
                let number = grid.number(p).expect("touched");
                assert!(number < grid.touched() && runs.iter().any(|r| r.contains(&number)), "{p}");
            }
        }
    }
}

#[test]
fn a_line_that_is_longer_than_numbers_are_fine_has_a_grid() {
    let of = |radius: f32, length: f32| {
        let hit = |x: f32| hit_point(Vec3::X * x, radius);
        Packet::new([hit(0.0), hit(length)].iter())
    };
    for (radius, length) in [(1e-30, 1e30), (0.0, 1.0), (1e-20, 3e38), (1e18, 1e18)] {
        assert!(grid_of(&[of(radius, length)]).touched() > 0, "{radius} {length}");
    }
}

#[test]
fn positions_outside_or_far_from_all_discs_have_no_number() {
    let grid = grid_of(&packets(false));
    assert_eq!(grid.number(Vec3::ZERO), None);
    assert_eq!(grid.number(Vec3::splat(1e6)), None);
    assert_eq!(grid.number(Vec3::splat(-1e6)), None);
    assert_eq!(grid.number(Vec3::splat(f32::NAN)), None);
    assert_eq!(grid_of(&[]).number(Vec3::ZERO), None);
}

#[test]
fn a_grid_of_everywhere_has_one_cell_for_all_places() {
    let grid = Grid::everywhere();
    for at in [Vec3::ZERO, Vec3::splat(-4096.0), Vec3::new(1e9, -1e9, 3.0)] {
        assert_eq!(grid.number(at), Some(0));
    }
    assert_eq!((grid.touched(), grid.number(Vec3::splat(f32::NAN))), (1, None));
}
