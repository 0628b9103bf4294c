//! Cells of the space of emitters and primary numbers, and how probable each is.

use foton_scene::{PRIMARY_NUMBERS, PrimaryNumbers, Sources};

use crate::codec::{Reader, StateError, Writer};

/// The largest number of cells beyond one for each emitter.
pub(super) const MAX_CUTS: usize = 1 << 13;

/// A box of primary numbers of one emitter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    /// Index of the emitter.
    pub(super) emitter: u32,
    /// Where it begins along each axis.
    pub(super) low: PrimaryNumbers,
    /// How far it extends along each axis: positive.
    pub(super) size: PrimaryNumbers,
}

impl Cell {
    /// All primary numbers of an emitter.
    pub(super) const fn whole(emitter: u32) -> Self {
        Self { emitter, low: [0.0; PRIMARY_NUMBERS], size: [1.0; PRIMARY_NUMBERS] }
    }

    /// The share of its emitter's primary numbers in it.
    pub(super) fn volume(&self) -> f64 {
        self.size.iter().map(|&s| f64::from(s)).product()
    }

    /// The primary numbers at the place `u` within it, below 1.
    #[inline(always)]
    pub(super) fn at(&self, u: PrimaryNumbers) -> PrimaryNumbers {
        std::array::from_fn(|i| (self.low[i] + u[i] * self.size[i]).min(1.0 - f32::EPSILON / 2.0))
    }
}

/// Where a photon starts.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// Index of the emitter.
    pub emitter: usize,
    /// Its primary numbers.
    pub primary: PrimaryNumbers,
    /// Density of both: the probability of the cell over its volume. Power is divided by it.
    pub density: f64,
}

/// A distribution over emitters and their primary numbers: constant within each of its cells, which fill the space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cells {
    cells: Vec<Cell>,
    probabilities: Vec<f64>,
    /// `cumulative[i]` is the sum of the first i + 1 probabilities; the last is 1.
    cumulative: Vec<f64>,
}

impl Cells {
    /// One cell for each emitter, as probable as it is without guidance.
    #[must_use]
    pub fn unguided(sources: &Sources) -> Self {
        let (cells, probabilities) =
            sources.choices().map(|(i, chance)| (Cell::whole(i as u32), chance)).unzip();
        Self::new(cells, probabilities)
    }

    /// Cells with their probabilities, which are positive and sum to 1 but for rounding.
    pub(super) fn new(cells: Vec<Cell>, probabilities: Vec<f64>) -> Self {
        let mut sum = 0.0;
        let mut cumulative: Vec<f64> = probabilities
            .iter()
            .map(|p| {
                sum += p;
                sum
            })
            .collect();
        if let Some(last) = cumulative.last_mut() {
            *last = 1.0;
        }
        Self { cells, probabilities, cumulative }
    }

    /// How many there are.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether nothing emits.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = (&Cell, f64)> + '_ {
        self.cells.iter().zip(self.probabilities.iter().copied())
    }

    /// The start of a photon: `choice` in [0, 1) chooses the cell, `within` the place in it. `None` where nothing emits.
    #[must_use]
    #[inline(always)]
    pub fn start(&self, choice: f64, within: PrimaryNumbers) -> Option<Start> {
        let last = self.cells.len().checked_sub(1)?;
        let index = self.cumulative.partition_point(|&c| c <= choice).min(last);
        let cell = &self.cells[index];
        let density = self.probabilities[index] / cell.volume();
        Some(Start { emitter: cell.emitter as usize, primary: cell.at(within), density })
    }

    /// The share of photons that start at each of so many emitters.
    #[must_use]
    pub fn shares(&self, emitters: usize) -> Vec<f64> {
        let mut shares = vec![0.0; emitters];
        for (cell, probability) in self.iter() {
            shares[cell.emitter as usize] += probability;
        }
        shares
    }

    /// Bytes held.
    #[must_use]
    pub const fn bytes(&self) -> usize {
        self.cells.capacity() * size_of::<Cell>()
            + (self.probabilities.capacity() + self.cumulative.capacity()) * size_of::<f64>()
    }

    /// The largest number of bytes that those of a scene with so many emitters take.
    #[must_use]
    pub const fn max_bytes(emitters: usize) -> usize {
        (emitters + MAX_CUTS) * (size_of::<Cell>() + 2 * size_of::<f64>())
    }

    /// Writes them into a state.
    pub fn write(&self, out: &mut Writer) {
        out.u64(self.cells.len() as u64);
        for (cell, probability) in self.iter() {
            out.u64(cell.emitter.into());
            for number in cell.low.into_iter().chain(cell.size) {
                out.u64(number.to_bits().into());
            }
            out.f64(probability);
        }
    }

    /// Takes them back from a state of a render with so many emitters.
    ///
    /// # Errors
    /// When they are not those of such a render.
    pub fn read(input: &mut Reader<'_>, emitters: usize) -> Result<Self, StateError> {
        let count = input.count()?;
        let (mut cells, mut probabilities) = (Vec::new(), Vec::new());
        for _ in 0..count {
            let emitter = input.u64()?;
            if emitter >= emitters as u64 {
                return Err(StateError::OtherRender);
            }
            let mut cell = Cell::whole(emitter as u32);
            for number in cell.low.iter_mut().chain(&mut cell.size) {
                let bits = u32::try_from(input.u64()?).map_err(|_| StateError::Impossible)?;
                *number = f32::from_bits(bits);
            }
            let probability = input.finite()?;
            let is_inside = |(low, size): (f32, f32)| low >= 0.0 && size > 0.0 && low + size <= 1.0;
            if !cell.low.into_iter().zip(cell.size).all(is_inside) || probability <= 0.0 {
                return Err(StateError::Impossible);
            }
            cells.push(cell);
            probabilities.push(probability);
        }
        Ok(Self::new(cells, probabilities))
    }
}
