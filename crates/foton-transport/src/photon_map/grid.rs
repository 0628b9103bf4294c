//! A uniform grid over the hit points: which cells any disc touches, and dense numbers for just those.
//!
//! A photon in an untouched cell is not stored. Touched cells are numbered along x first, so a run of cells along x is one
//! range of numbers, and of photons once they are sorted by number. The bitmap stays within a core's second-level cache.
//!
//! Where hit points reach far beyond the middle ones, as on a ground seen to its horizon, cells grow with the distance from those,
//! axis by axis, as discs do there: boxes stay boxes, and near the middle cells are as small as discs.

use std::sync::atomic::{AtomicU64, Ordering};

use foton_math::glam::{UVec3, Vec3};
use foton_math::{Aabb, Cancel, Cancelled};
use rayon::prelude::*;

use super::packet::{LANES, Packet};

/// Cells an edge of which is this many of the median radius: measured to be the best trade of candidates against rows.
const CELL_IN_RADII: f32 = 2.6;

/// The largest number of cells: 2^20 of them take 256 KiB with their ranks.
pub const MAX_CELLS: u32 = 1 << 20;

/// Cells grow where hit points reach beyond this many times their median distance from the middle.
const FAR: f32 = 16.0;

/// 64 cells along x.
#[derive(Clone, Copy, Debug, Default)]
struct Word {
    /// Which are touched.
    touched: u64,
    /// How many are touched in all words before.
    rank: u32,
}

/// How cells grow: axis by axis with the logarithm of the distance from the middle, which is cut into straight pieces that the bits
/// of a floating-point number give for nothing.
#[derive(Clone, Copy, Debug)]
struct Growth {
    centre: Vec3,
    inverse_scale: f32,
}

impl Growth {
    /// The growth for these packets, if they reach far.
    fn of(packets: &[Packet], bounds: &Aabb, cancel: &Cancel) -> Result<Option<Self>, Cancelled> {
        // Few scenes do, and one hit point of each packet mostly shows that clearly.
        if Self::by(packets, 1, bounds, 0.5 * FAR, cancel)?.is_none() {
            return Ok(None);
        }
        Self::by(packets, LANES, bounds, FAR, cancel)
    }

    /// The growth by the first lanes of packets, if they reach as far as `far` median distances.
    fn by(
        packets: &[Packet],
        lanes: usize,
        bounds: &Aabb,
        far: f32,
        cancel: &Cancel,
    ) -> Result<Option<Self>, Cancelled> {
        let median = |axis: usize| {
            cancel.check()?;
            let mut of_axis: Vec<f32> = packets
                .iter()
                .flat_map(|p| p.position[axis][..lanes].iter().zip(&p.radius2))
                .filter_map(|(x, radius2)| (*radius2 >= 0.0).then_some(*x))
                .collect();
            Ok(median_of(&mut of_axis))
        };
        let centre = Vec3::new(median(0)?, median(1)?, median(2)?);
        let mut distances: Vec<f32> = packets
            .iter()
            .flat_map(|p| {
                let at = |l: usize| Vec3::new(p.position[0][l], p.position[1][l], p.position[2][l]);
                (0..lanes).filter(|&l| p.radius2[l] >= 0.0).map(move |l| (at(l) - centre).abs().max_element())
            })
            .collect();
        cancel.check()?;
        let scale = median_of(&mut distances);
        let farthest = (bounds.max - centre).abs().max((bounds.min - centre).abs()).max_element();
        Ok((farthest > far * scale && scale > 0.0).then(|| Self { centre, inverse_scale: 1.0 / scale }))
    }

    /// ± log₂(1 + |x|/scale) axis by axis, about: exact at powers of two and straight between, so that it grows with x whatever is
    /// rounded.
    #[inline(always)]
    fn place(&self, position: Vec3) -> Vec3 {
        let x = (position - self.centre) * self.inverse_scale;
        let log = |x: f32| {
            let bits = (1.0 + x.abs()).to_bits() as i32 - 1f32.to_bits() as i32;
            (bits as f32 / (1 << 23) as f32).copysign(x)
        };
        Vec3::new(log(x.x), log(x.y), log(x.z))
    }
}

/// The grid. Its cells are fixed by the first radii: results depend on their order. Touched cells may be marked again.
pub struct Grid {
    growth: Option<Growth>,
    /// Where cells begin, after their growth.
    origin: Vec3,
    inverse_cell: f32,
    cells: UVec3,
    words: Vec<Word>,
    touched: u32,
}

impl Grid {
    /// A grid for the packets' first radii.
    ///
    /// # Errors
    /// When cancelled.
    pub fn new(packets: &[Packet], cancel: &Cancel) -> Result<Self, Cancelled> {
        let bounds = packets.iter().fold(Aabb::EMPTY, |b, p| b.union(p.bounds()));
        if bounds.is_empty() {
            return Ok(Self {
                growth: None,
                origin: Vec3::ZERO,
                inverse_cell: 1.0,
                cells: UVec3::ZERO,
                words: Vec::new(),
                touched: 0,
            });
        }
        let growth = Growth::of(packets, &bounds, cancel)?;
        let place = |p: Vec3| growth.map_or(p, |g| g.place(p));
        let (origin, size) = (place(bounds.min), place(bounds.max) - place(bounds.min));
        let mut cell = CELL_IN_RADII * median_radius(packets) * growth.map_or(1.0, |g| g.inverse_scale);
        // No cell is smaller than a row of all cells allows: from there the loop ends soon, whatever the sizes are.
        cell = cell.max(size.max_element() / MAX_CELLS as f32).max(f32::MIN_POSITIVE);
        let count = |cell: f32| (size / cell).floor() + 1.0;
        while count(cell).element_product() > MAX_CELLS as f32 {
            cell *= 1.02;
        }
        let cells = count(cell).as_uvec3();
        let words = (cells.element_product() as usize).div_ceil(64) + 1;
        let mut grid = Self {
            growth,
            origin,
            inverse_cell: 1.0 / cell,
            cells,
            words: vec![Word::default(); words],
            touched: 0,
        };
        grid.mark_unless(packets, cancel)?;
        Ok(grid)
    }

    /// A single cell that holds all places: for photons that are kept wherever they land.
    #[must_use]
    pub fn everywhere() -> Self {
        // Far beyond any scene, so that all of it is in the middle of the cell.
        const FAR: f32 = 1e30;
        Self {
            growth: None,
            origin: Vec3::splat(-FAR),
            inverse_cell: 0.5 / FAR,
            cells: UVec3::ONE,
            words: vec![Word { touched: 1, rank: 0 }, Word { touched: 0, rank: 1 }],
            touched: 1,
        }
    }

    /// Marks the cells that discs touch now, and numbers them.
    pub fn mark(&mut self, packets: &[Packet]) {
        // Never cancelled.
        let _ = self.mark_unless(packets, &Cancel::default());
    }

    /// As [`Grid::mark`], unless cancelled: then what was marked before stays.
    fn mark_unless(&mut self, packets: &[Packet], cancel: &Cancel) -> Result<(), Cancelled> {
        let bits: Vec<AtomicU64> = self.words.iter().map(|_| AtomicU64::new(0)).collect();
        packets.par_iter().try_for_each(|packet| {
            cancel.check()?;
            let mut marked = None;
            for disc in packet.disc_boxes() {
                // Neighbours mostly touch the same cells.
                let cells = self.cells_of(&disc);
                if marked.replace(cells) != Some(cells) {
                    self.for_each_row(cells, |first, last| mark_row(&bits, first, last));
                }
            }
            Ok(())
        })?;
        let mut rank = 0;
        for (word, bits) in self.words.iter_mut().zip(bits) {
            *word = Word { touched: bits.into_inner(), rank };
            rank += word.touched.count_ones();
        }
        self.touched = rank;
        Ok(())
    }

    /// How many cells are touched.
    #[inline]
    pub const fn touched(&self) -> u32 {
        self.touched
    }

    /// Bytes held.
    pub const fn bytes(&self) -> usize {
        self.words.len() * size_of::<Word>()
    }

    /// Position in cells.
    #[inline(always)]
    fn in_cells(&self, position: Vec3) -> Vec3 {
        let place = self.growth.map_or(position, |growth| growth.place(position));
        (place - self.origin) * self.inverse_cell
    }

    /// The number of the touched cell that holds `position`; `None` in an untouched cell or outside.
    #[inline]
    pub fn number(&self, position: Vec3) -> Option<u32> {
        let p = self.in_cells(position);
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
    #[inline]
    fn rank(&self, cell: u32) -> u32 {
        let word = &self.words[cell as usize / 64];
        word.rank + (word.touched & ((1u64 << (cell % 64)) - 1)).count_ones()
    }

    /// The first and the last cell along each axis that a box meets.
    #[inline]
    fn cells_of(&self, bounds: &Aabb) -> (UVec3, UVec3) {
        let last = (self.cells - 1).as_vec3();
        let to_cell = |p: Vec3| self.in_cells(p).clamp(Vec3::ZERO, last).as_uvec3();
        (to_cell(bounds.min), to_cell(bounds.max))
    }

    /// Calls `f` with the first and last cell of each row along x of a block of cells, in ascending order.
    #[inline]
    fn for_each_row(&self, (low, high): (UVec3, UVec3), mut f: impl FnMut(u32, u32)) {
        for z in low.z..=high.z {
            for y in low.y..=high.y {
                let row = (z * self.cells.y + y) * self.cells.x;
                f(row + low.x, row + high.x);
            }
        }
    }

    /// Calls `f` with ranges of cell numbers that together hold every photon in a box, in ascending order.
    #[inline]
    pub fn for_each_run(&self, bounds: &Aabb, mut f: impl FnMut(u32, u32)) {
        self.for_each_row(self.cells_of(bounds), |first, last| {
            let (start, end) = (self.rank(first), self.rank(last + 1));
            if start < end {
                f(start, end);
            }
        });
    }
}

/// Sets the bits of some cells, 64 at a time: a wide disc among narrow ones touches a million of them.
fn mark_row(bits: &[AtomicU64], first: u32, last: u32) {
    let (first_word, last_word) = (first / 64, last / 64);
    for word in first_word..=last_word {
        let from = if word == first_word { u64::MAX << (first % 64) } else { u64::MAX };
        let to = if word == last_word { u64::MAX >> (63 - last % 64) } else { u64::MAX };
        let (mask, bits) = (from & to, &bits[word as usize]);
        // Most are set already, and reading is cheaper than writing.
        if bits.load(Ordering::Relaxed) & mask != mask {
            bits.fetch_or(mask, Ordering::Relaxed);
        }
    }
}

/// The median of all first radii: half of the hit points have a smaller one.
fn median_radius(packets: &[Packet]) -> f32 {
    let mut radius2: Vec<f32> =
        packets.iter().flat_map(|p| p.radius2.iter().copied()).filter(|&r2| r2 >= 0.0).collect();
    median_of(&mut radius2).sqrt()
}

/// The median; zero of nothing.
fn median_of(values: &mut [f32]) -> f32 {
    let middle = values.len() / 2;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(middle, f32::total_cmp).1 }
}

#[cfg(test)]
mod tests;
