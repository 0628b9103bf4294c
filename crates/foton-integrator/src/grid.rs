//! A uniform grid over the hit points: which cells any disc touches, and dense numbers for just those.
//!
//! A photon in an untouched cell is not stored. Touched cells are numbered along x first, so a run of cells along x is one
//! range of numbers, and of photons once they are sorted by number. The bitmap stays within a core's second-level cache.

use std::sync::atomic::{AtomicU64, Ordering};

use foton_math::Aabb;
use foton_math::glam::{UVec3, Vec3};
use rayon::prelude::*;

use crate::packet::Packet;

/// Cells an edge of which is this many of the median radius: measured to be the best trade of candidates against rows.
const CELL_IN_RADII: f32 = 2.6;

/// Cells at most: 2^20 of them take 256 KiB with their ranks.
pub(crate) const MOST_CELLS: u32 = 1 << 20;

/// 64 cells along x.
#[derive(Clone, Copy, Debug, Default)]
struct Word {
    /// Which are touched.
    touched: u64,
    /// How many are touched in all words before.
    rank: u32,
}

/// The grid. Its cells are fixed by the first radii: results depend on their order. What is touched may be marked anew.
pub(crate) struct Grid {
    origin: Vec3,
    inverse_cell: f32,
    cells: UVec3,
    words: Vec<Word>,
    touched: u32,
}

impl Grid {
    /// A grid for the packets' first radii.
    pub(crate) fn new(packets: &[Packet]) -> Self {
        let bounds = packets.iter().fold(Aabb::EMPTY, |b, p| b.union(p.bounds()));
        if bounds.is_empty() {
            return Self {
                origin: Vec3::ZERO,
                inverse_cell: 1.0,
                cells: UVec3::ZERO,
                words: Vec::new(),
                touched: 0,
            };
        }
        let mut cell = CELL_IN_RADII * median_radius(packets);
        let count = |cell: f32| (bounds.size() / cell).floor() + 1.0;
        while count(cell).element_product() > MOST_CELLS as f32 {
            cell *= 1.02;
        }
        let cells = count(cell).as_uvec3();
        let words = (cells.element_product() as usize).div_ceil(64) + 1;
        let mut grid = Self {
            origin: bounds.min,
            inverse_cell: 1.0 / cell,
            cells,
            words: vec![Word::default(); words],
            touched: 0,
        };
        grid.mark(packets);
        grid
    }

    /// Marks the cells that discs touch now, and numbers them.
    pub(crate) fn mark(&mut self, packets: &[Packet]) {
        let bits: Vec<AtomicU64> = self.words.iter().map(|_| AtomicU64::new(0)).collect();
        packets.par_iter().for_each(|packet| {
            for disc in packet.disc_boxes() {
                self.for_each_row(&disc, |first, last| {
                    for cell in first..=last {
                        bits[cell as usize / 64].fetch_or(1 << (cell % 64), Ordering::Relaxed);
                    }
                });
            }
        });
        let mut rank = 0;
        for (word, bits) in self.words.iter_mut().zip(bits) {
            *word = Word { touched: bits.into_inner(), rank };
            rank += word.touched.count_ones();
        }
        self.touched = rank;
    }

    /// How many cells are touched.
    pub(crate) const fn touched(&self) -> u32 {
        self.touched
    }

    /// Bytes held.
    pub(crate) const fn bytes(&self) -> usize {
        self.words.len() * size_of::<Word>()
    }

    /// The number of the touched cell that holds `position`; `None` in an untouched cell or outside.
    #[inline]
    pub(crate) fn number(&self, position: Vec3) -> Option<u32> {
        let p = (position - self.origin) * self.inverse_cell;
        // Written so that NaN is outside too.
        if !p.cmpge(Vec3::ZERO).all() {
            return None;
        }
        let c = p.as_uvec3();
        if c.cmpge(self.cells).any() {
            return None;
        }
        let cell = (c.z * self.cells.y + c.y) * self.cells.x + c.x;
        let word = &self.words[cell as usize / 64];
        let bit = 1u64 << (cell % 64);
        (word.touched & bit != 0).then(|| word.rank + (word.touched & (bit - 1)).count_ones())
    }

    /// How many touched cells come before `cell`.
    fn rank(&self, cell: u32) -> u32 {
        let word = &self.words[cell as usize / 64];
        word.rank + (word.touched & ((1u64 << (cell % 64)) - 1)).count_ones()
    }

    /// Calls `f` with the first and last cell of each row along x that a box meets, in ascending order.
    fn for_each_row(&self, bounds: &Aabb, mut f: impl FnMut(u32, u32)) {
        let last = (self.cells - 1).as_vec3();
        let to_cell = |p: Vec3| ((p - self.origin) * self.inverse_cell).clamp(Vec3::ZERO, last).as_uvec3();
        let (low, high) = (to_cell(bounds.min), to_cell(bounds.max));
        for z in low.z..=high.z {
            for y in low.y..=high.y {
                let row = (z * self.cells.y + y) * self.cells.x;
                f(row + low.x, row + high.x);
            }
        }
    }

    /// Calls `f` with ranges of cell numbers that together hold every photon in a box, in ascending order.
    pub(crate) fn for_each_run(&self, bounds: &Aabb, mut f: impl FnMut(u32, u32)) {
        self.for_each_row(bounds, |first, last| {
            let (start, end) = (self.rank(first), self.rank(last + 1));
            if start < end {
                f(start, end);
            }
        });
    }
}

/// The median of all first radii: half of the hit points have a smaller one.
fn median_radius(packets: &[Packet]) -> f32 {
    let mut radius2: Vec<f32> =
        packets.iter().flat_map(|p| p.radius2.iter().copied()).filter(|&r2| r2 >= 0.0).collect();
    let middle = radius2.len() / 2;
    radius2.select_nth_unstable_by(middle, f32::total_cmp).1.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hit_point::HitPoint;
    use foton_math::{Purpose, Rgb, Stream, warp};

    fn packets() -> Vec<Packet> {
        let found: Vec<HitPoint> = (0..3000)
            .map(|i| {
                let mut s = Stream::new(5, Purpose::Test, 0, i);
                let radius = if i % 50 == 0 { 20.0 } else { 0.5 + s.next_1d() };
                HitPoint {
                    position: warp::square_to_sphere(s.next_2d()) * 300.0,
                    normal: Vec3::Z,
                    shading_normal: Vec3::Z,
                    origin: Vec3::ZERO,
                    weight: Rgb::WHITE,
                    gloss: None,
                    radius2: radius * radius,
                    slab2: 1.0,
                    budget: 9,
                    patch: 0,
                    smallest2: 0.0,
                }
            })
            .collect();
        crate::packet::group(&found, |_| true)
            .iter()
            .map(|g| Packet::new(g.iter().map(|&i| &found[i as usize])))
            .collect()
    }

    #[test]
    fn every_position_in_a_disc_has_a_number_within_the_packets_runs() {
        let packets = packets();
        let grid = Grid::new(&packets);
        let mut stream = Stream::new(6, Purpose::Test, 0, 0);
        for packet in &packets {
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
    fn positions_outside_or_far_from_all_discs_have_no_number() {
        let grid = Grid::new(&packets());
        assert_eq!(grid.number(Vec3::ZERO), None);
        assert_eq!(grid.number(Vec3::splat(1e6)), None);
        assert_eq!(grid.number(Vec3::splat(-1e6)), None);
        assert_eq!(grid.number(Vec3::splat(f32::NAN)), None);
        assert_eq!(Grid::new(&[]).number(Vec3::ZERO), None);
    }
}
