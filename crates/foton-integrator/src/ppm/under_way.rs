//! A pass under way: how far it is and what it has counted, so that it can be left anywhere and gone on with.

use std::num::NonZeroU32;

use foton_transport::light_paths::Batch;

use super::counts::Counts;
use super::direct::Lit;
use super::settings::Alpha;
use super::tally::Tally;

/// What is to be done next in a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum NextStep {
    /// Nothing has been done yet.
    Begin,
    /// Some photons have been traced.
    Trace,
    /// All of them have.
    Sort,
    /// They lie in the map; some hit points may have gathered them.
    Gather,
}

/// What holds for one pass alone. Not part of a saved state, which has no pass under way or planned.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Once {
    /// Its photons.
    pub(super) photons: Option<NonZeroU32>,
    /// The batches after which it ends.
    pub(super) batches: Option<NonZeroU32>,
}

/// A pass under way.
pub(crate) struct UnderWay {
    pub(crate) counts: Counts,
    /// Whether hit points are those of the pass, where each has new ones.
    pub(crate) has_hit_points: bool,
    /// Photons that the pass was to have, of which batches are parts; those that it has are fewer where it is cut short.
    planned: u64,
    photons_once: Option<NonZeroU32>,
    /// That of the whole pass: a change takes effect with the next one.
    pub(crate) alpha: Alpha,
    batches: Vec<Batch>,
    /// Batches that are done.
    done: usize,
    pub(super) next: NextStep,
    /// By block of packets, of those that have gathered the batch.
    pub(super) tallies: Vec<Option<Tally>>,
    /// By block of pixels, of those that shadow rays have lit.
    pub(crate) lit: Vec<Option<Lit>>,
    /// Whether shadow rays are done.
    pub(super) is_lit: bool,
}

impl UnderWay {
    /// At its very beginning.
    pub(super) fn new(counts: Counts, alpha: Alpha, batches: Vec<Batch>, once: Once) -> Self {
        let mut pass = Self {
            planned: counts.photons,
            photons_once: once.photons,
            counts,
            has_hit_points: false,
            alpha,
            batches,
            done: 0,
            next: NextStep::Begin,
            tallies: Vec::new(),
            lit: Vec::new(),
            is_lit: false,
        };
        if let Some(batches) = once.batches {
            pass.cut_after(batches.get() as usize);
        }
        pass
    }

    /// Photons of the pass, in all batches that it was to have.
    pub(super) const fn planned(&self) -> u64 {
        self.planned
    }

    /// Lets the pass end after so many of its batches, as a pass of the photons in them; not where they are none, or all. Each batch is
    /// dealt from the whole pass, so that those which are left out leave no emitter out.
    pub(super) fn cut_after(&mut self, batches: usize) {
        if batches == 0 || batches >= self.batches.len() {
            return;
        }
        self.counts.photons = self.batches[..batches].iter().map(|batch| batch.photons(self.planned)).sum();
        let closing = self.batches[batches - 1].closing();
        self.batches.truncate(batches);
        self.batches.push(closing);
    }

    /// Lets the pass end after the batch under way, or before it where `drops` says so and its photons have not all been traced.
    pub(super) fn cut(&mut self, drops: bool) {
        if drops && self.next < NextStep::Sort && self.done > 0 {
            self.cut_after(self.done);
            self.next = NextStep::Begin;
        } else {
            self.cut_after(self.done + 1);
        }
    }

    /// What held for this pass alone.
    pub(super) fn exceptions(&self) -> Once {
        let is_cut = self.batches.last().is_some_and(|batch| batch.is_closing());
        let batches = u32::try_from(self.batches.len() - 1).ok().and_then(NonZeroU32::new);
        Once { photons: self.photons_once, batches: batches.filter(|_| is_cut) }
    }

    /// The batch that is to be worked on; `None` once all are done.
    pub(super) fn batch(&self) -> Option<Batch> {
        self.batches.get(self.done).copied()
    }

    /// The batch is done.
    pub(super) fn end_batch(&mut self) {
        self.done += 1;
        self.next = NextStep::Begin;
    }

    /// Whether hit points have been refined, some or all: what they know then is of this pass, not of the one before.
    pub(super) fn has_refined(&self) -> bool {
        match self.batch() {
            None => true,
            Some(batch) => batch.is_last() && self.tallies.iter().any(Option::is_some),
        }
    }

    /// How much of the pass is done, from 0 to 1, by batches, where `traced` is the share of the batch's photons that have been traced. Of a
    /// batch, tracing counts for three quarters.
    pub(super) fn share(&self, traced: f64) -> f64 {
        let of_batch = match self.next {
            _ if self.batch().is_none() => 0.0,
            NextStep::Begin => 0.0,
            NextStep::Trace => 0.75 * traced,
            NextStep::Sort => 0.75,
            NextStep::Gather => {
                let done = self.tallies.iter().filter(|tally| tally.is_some()).count();
                0.8 + 0.2 * done as f64 / self.tallies.len().max(1) as f64
            }
        };
        (self.done as f64 + of_batch) / self.batches.len() as f64
    }
}
