//! Photons sorted by grid cell: the photons of a run of cells are neighbours in memory.

use rayon::prelude::*;

use super::chunk::{CHUNK, Chunk};
use super::photon::Photon;

/// All photons of a pass in the order of their cells, and within a cell in the order of emission.
#[derive(Default)]
pub struct PhotonMap {
    photons: Vec<Photon>,
    /// The photons of cell c are `cell_start[c]..cell_start[c + 1]`.
    cell_start: Vec<u32>,
}

impl PhotonMap {
    /// Sorts by counting; stable, so the order does not depend on the number of threads.
    pub fn build(&mut self, chunks: &[Chunk], cells: u32) {
        let total: usize = chunks.iter().map(|c| c.photons.len()).sum();
        self.photons.resize(total, Photon::NONE);
        self.count(chunks, cells as usize);
        // Each task owns a range of cells of about equally many photons, scans every cell number and moves its own.
        let tasks = rayon::current_num_threads().clamp(1, 64);
        let mut ranges = Vec::with_capacity(tasks);
        let mut rest = &mut self.photons[..];
        let mut first = 0usize;
        for task in 1..=tasks {
            let goal = (total * task / tasks) as u32;
            let last = self.cell_start.partition_point(|&s| s < goal).clamp(first, cells as usize);
            let last = if task == tasks { cells as usize } else { last };
            let length = (self.cell_start[last] - self.cell_start[first]) as usize;
            let (part, tail) = rest.split_at_mut(length);
            ranges.push((first..last, part));
            rest = tail;
            first = last;
        }
        let cell_start = &self.cell_start;
        ranges.into_par_iter().for_each(|(range, part)| {
            let base = cell_start[range.start];
            let mut next: Vec<u32> = cell_start[range.clone()].iter().map(|s| s - base).collect();
            for chunk in chunks {
                for (photon, &cell) in chunk.photons.iter().zip(&chunk.cells) {
                    if let Some(slot) = (cell as usize).checked_sub(range.start).and_then(|c| next.get_mut(c))
                    {
                        part[*slot as usize] = *photon;
                        *slot += 1;
                    }
                }
            }
        });
    }

    /// All photons, cell by cell.
    #[inline]
    pub fn photons(&self) -> &[Photon] {
        &self.photons
    }

    /// Counts photons by cell and sums the counts up.
    fn count(&mut self, chunks: &[Chunk], cells: usize) {
        let share = chunks.len().div_ceil(rayon::current_num_threads()).max(1);
        let counts: Vec<Vec<u32>> = chunks
            .par_chunks(share)
            .map(|part| {
                let mut count = vec![0u32; cells];
                for &cell in part.iter().flat_map(|c| &c.cells) {
                    count[cell as usize] += 1;
                }
                count
            })
            .collect();
        self.cell_start.clear();
        self.cell_start.push(0);
        let mut sum = 0;
        for cell in 0..cells {
            sum += counts.iter().map(|c| c[cell]).sum::<u32>();
            self.cell_start.push(sum);
        }
    }

    /// The photons of a range of cells.
    #[inline]
    pub fn run(&self, first: u32, end: u32) -> &[Photon] {
        &self.photons[self.cell_start[first as usize] as usize..self.cell_start[end as usize] as usize]
    }

    /// The largest number of bytes for the counters of the sort: each thread has one for each cell, and those for all photons stay.
    pub const fn counter_bytes(photons_emitted: u64, cells: u32, threads: usize) -> u64 {
        let chunks = photons_emitted.div_ceil(CHUNK);
        let parts = if chunks < threads as u64 { chunks } else { threads as u64 };
        (parts + 1) * cells as u64 * size_of::<u32>() as u64
    }

    /// Bytes held.
    pub const fn bytes(&self) -> usize {
        self.photons.capacity() * size_of::<Photon>() + self.cell_start.capacity() * size_of::<u32>()
    }
}

#[cfg(test)]
mod tests {
    use super::super::photon::PathClass;
    use super::*;
    use foton_math::glam::Vec3;
    use foton_math::{Purpose, Rgb, Stream};

    #[test]
    fn photons_of_a_cell_stay_in_the_order_of_emission_for_any_number_of_threads() {
        let cells = 37;
        let mut stream = Stream::new(3, Purpose::Test, 0, 0);
        let chunks: Vec<Chunk> = (0..9)
            .map(|c| {
                let mut chunk = Chunk::default();
                for i in 0..c * 50 {
                    let power = Rgb::splat((c * 1000 + i) as f32);
                    chunk.photons.push(Photon::new(
                        Vec3::ZERO,
                        Vec3::Z,
                        0,
                        None,
                        power,
                        PathClass::Direct,
                        1,
                    ));
                    // Every third cell stays empty.
                    let cell = (stream.next_1d() * cells as f32) as u32;
                    chunk.cells.push(cell - u32::from(cell % 3 == 1));
                }
                chunk
            })
            .collect();
        for threads in [1, 2, 7] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let mut map = PhotonMap::default();
            // Twice: buffers are used again.
            pool.install(|| (map.build(&chunks[..4], cells), map.build(&chunks, cells)));
            let mut seen = 0;
            for cell in 0..cells {
                let got: Vec<f32> = map.run(cell, cell + 1).iter().map(|p| p.power.r).collect();
                let expected: Vec<f32> = chunks
                    .iter()
                    .flat_map(|c| c.photons.iter().zip(&c.cells))
                    .filter(|&(_, &c)| c == cell)
                    .map(|(p, _)| p.power.r)
                    .collect();
                assert_eq!(got, expected, "{threads} threads, cell {cell}");
                seen += got.len();
            }
            assert_eq!((seen, map.photons().len()), (1800, 1800));
        }
    }
}
