//! A pass in batches of photons that are traced, sorted and gathered together, so that memory does not grow with the pass.
//!
//! How a pass falls into batches depends on its photons alone, never on memory or threads, for light is summed batch by batch
//! and the order of a sum is in its bits. Photons are dealt out in turn: each batch is stratified over the emitters as its pass is.

use std::ops::Range;

/// A pass of up to this many photons is one batch.
pub const MAX_PHOTONS: u64 = 1 << 20;

/// One batch of a pass: photons `number`, `number + of`, `number + 2 of` …
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Batch {
    number: u64,
    of: u64,
    is_closing: bool,
}

impl Batch {
    /// The batches of a pass of `photons`, at most `max` in each. At least one, since a pass without photons is one too.
    pub fn all(photons: u64, max: u64) -> impl Iterator<Item = Self> {
        let of = photons.div_ceil(max).max(1);
        (0..of).map(move |number| Self { number, of, is_closing: false })
    }

    /// What a pass ends with that ends after this batch although others were to follow: a last batch without photons.
    #[must_use]
    pub const fn closing(self) -> Self {
        Self { number: self.of.saturating_sub(1), of: self.of, is_closing: true }
    }

    /// Whether it has no photons, since the pass was cut short.
    #[inline]
    pub const fn is_closing(self) -> bool {
        self.is_closing
    }

    /// Whether sums begin here.
    #[inline]
    pub const fn is_first(self) -> bool {
        self.number == 0
    }

    /// Whether the pass ends here.
    #[inline]
    pub const fn is_last(self) -> bool {
        self.number + 1 == self.of
    }

    /// How many of a pass's photons are in it.
    #[inline]
    pub const fn photons(self, pass: u64) -> u64 {
        if self.is_closing { 0 } else { pass.saturating_sub(self.number).div_ceil(self.of) }
    }

    /// The indices in the pass of a range of its photons.
    pub fn indices(self, range: Range<u64>) -> impl Iterator<Item = u64> {
        range.map(move |i| i * self.of + self.number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_photon_is_in_one_batch_and_no_batch_is_too_large() {
        for (photons, max) in [(0, 5), (1, 5), (5, 5), (6, 5), (23, 5), (30, 7), (1000, 1)] {
            let batches: Vec<Batch> = Batch::all(photons, max).collect();
            let mut seen: Vec<u64> = batches.iter().flat_map(|b| b.indices(0..b.photons(photons))).collect();
            seen.sort_unstable();
            assert_eq!(seen, (0..photons).collect::<Vec<_>>(), "{photons} by {max}");
            assert!(batches.iter().all(|b| b.photons(photons) <= max));
            assert!(batches[0].is_first() && batches[batches.len() - 1].is_last());
            assert_eq!(batches.iter().filter(|b| b.is_first() || b.is_last()).count(), batches.len().min(2));
        }
    }

    #[test]
    fn a_pass_that_is_cut_short_closes_with_a_batch_without_photons() {
        let batches: Vec<Batch> = Batch::all(23, 5).collect();
        let closing = batches[1].closing();
        assert!(closing.is_last() && !closing.is_first() && closing.is_closing());
        assert!(closing.photons(23) == 0 && !batches[4].is_closing());
    }

    #[test]
    fn passes_up_to_the_maximum_are_one_batch_in_the_order_of_their_indices() {
        let [batch] = Batch::all(MAX_PHOTONS, MAX_PHOTONS).collect::<Vec<_>>()[..] else { panic!("one") };
        assert!(batch.is_first() && batch.is_last());
        assert!(batch.indices(3..6).eq(3..6));
        assert_eq!(Batch::all(MAX_PHOTONS + 1, MAX_PHOTONS).count(), 2);
    }
}
