//! What a pass has brought to hit points. Only those have an entry for which a photon has counted: in most passes few do.

use foton_math::Rgb;
use foton_transport::photon_map::LANES;

use super::hit_points::{BLOCK, Irradiance};

/// Which lanes of a packet have an entry, and where the first of these lies among those of its block.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Lanes {
    mask: u16,
    first: u16,
}

impl Lanes {
    pub(super) const ALL: Self = Self { mask: u16::MAX, first: 0 };

    pub(super) const fn is_none(self) -> bool {
        self.mask == 0
    }

    /// Those lanes, each with the place of its entry.
    pub(super) fn each(self) -> impl Iterator<Item = (usize, usize)> {
        let first = usize::from(self.first);
        (0..LANES).filter(move |l| self.mask >> l & 1 != 0).enumerate().map(move |(i, l)| (l, first + i))
    }

    /// The place of a lane's entry.
    #[inline(always)]
    const fn place(self, lane: usize) -> Option<usize> {
        let bit = 1 << lane;
        if self.mask & bit == 0 {
            return None;
        }
        Some(self.first as usize + (self.mask & (bit - 1)).count_ones() as usize)
    }
}

/// What a pass has found of noise and bias at a slot, in luminance.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SlotMoments {
    /// 6(s − ½)Φ/(π r²).
    pub(crate) bias: f32,
    /// The answer about one class.
    pub(crate) answer: f32,
}

/// The entries of a block, in the order of slots.
#[derive(Debug, Default)]
pub(crate) struct Entries<const LAYERS: usize> {
    pub(super) irradiance: Vec<Irradiance<LAYERS>>,
    /// Empty unless the error is asked for.
    pub(super) moments: Vec<SlotMoments>,
    /// Between two batches of a pass, in place of the others.
    pub(super) sums: Vec<BatchSums<LAYERS>>,
}

impl<const LAYERS: usize> Entries<LAYERS> {
    /// Begins with none; returns what the batches before have left.
    pub(super) fn begin(&mut self) -> Vec<BatchSums<LAYERS>> {
        self.irradiance.clear();
        self.moments.clear();
        std::mem::take(&mut self.sums)
    }

    /// The lanes of a packet whose entries come next.
    pub(super) const fn next(&self, mask: u16) -> Lanes {
        let first = if self.sums.is_empty() { self.irradiance.len() } else { self.sums.len() };
        Lanes { mask, first: first as u16 }
    }

    /// Gives room back that is not needed: passes differ little.
    pub(super) fn end(&mut self) {
        self.irradiance.shrink_to_fit();
        self.moments.shrink_to_fit();
        self.sums.shrink_to_fit();
    }
}

/// What the batches of a pass so far have brought to a hit point: sums that no area has divided yet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BatchSums<const LAYERS: usize> {
    pub(super) flux: [Rgb; LAYERS],
    pub(super) count: u32,
    pub(super) moment: f32,
    pub(super) answer: f32,
    /// The [`DiscMoments`](super::adaptive::DiscMoments) of one slot.
    pub(super) light: f32,
    pub(super) squares: f32,
    pub(super) offset: [f32; 3],
}

/// All entries of a pass.
pub(crate) struct Arrived<const LAYERS: usize> {
    /// By packet.
    pub(super) lanes: Vec<Lanes>,
    /// By block of packets.
    pub(super) blocks: Vec<Entries<LAYERS>>,
}

impl<const LAYERS: usize> Arrived<LAYERS> {
    /// Nothing at all, at so many packets.
    pub(super) fn none(packets: usize) -> Self {
        let blocks = (0..packets.div_ceil(BLOCK)).map(|_| Entries::default()).collect();
        Self { lanes: vec![Lanes::default(); packets], blocks }
    }

    /// Whether no photon has counted anywhere.
    pub(crate) fn is_none(&self) -> bool {
        self.blocks.iter().all(|entries| entries.irradiance.is_empty())
    }

    /// What a slot has got, if a photon has counted there.
    #[inline(always)]
    pub(crate) fn irradiance(&self, slot: usize) -> Option<&Irradiance<LAYERS>> {
        let place = self.lanes[slot / LANES].place(slot % LANES)?;
        self.blocks[slot / (BLOCK * LANES)].irradiance.get(place)
    }

    /// The same in all classes together, with what the error goes by.
    #[inline(always)]
    pub(crate) fn with_moments(&self, slot: usize) -> Option<(Rgb, SlotMoments)> {
        let place = self.lanes[slot / LANES].place(slot % LANES)?;
        let Entries { irradiance, moments, .. } = &self.blocks[slot / (BLOCK * LANES)];
        Some((irradiance.get(place)?[0], moments.get(place).copied().unwrap_or_default()))
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        let of_block = |entries: &Entries<LAYERS>| {
            let Entries { irradiance, moments, sums } = entries;
            irradiance.capacity() * size_of::<Irradiance<LAYERS>>()
                + moments.capacity() * size_of::<SlotMoments>()
                + sums.capacity() * size_of::<BatchSums<LAYERS>>()
        };
        self.lanes.len() * size_of::<Lanes>() + self.blocks.iter().map(of_block).sum::<usize>()
    }

    /// Bytes held between the batches of a pass alone.
    #[cfg(test)]
    pub(super) fn bytes_between_batches(&self) -> usize {
        self.blocks.iter().map(|entries| entries.sums.capacity() * size_of::<BatchSums<LAYERS>>()).sum()
    }
}
