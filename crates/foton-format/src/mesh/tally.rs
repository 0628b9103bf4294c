//! What a file has wrong so often that it is counted, not listed: one warning each, at the place of the first.

use crate::mesh::words::Problem;

/// How often something was mended or left out, and where first.
#[derive(Default)]
pub(crate) struct Tally {
    count: usize,
    first: Problem,
}

impl Tally {
    /// Counts one more; `place` is asked for the first alone.
    pub(crate) fn add(&mut self, place: impl FnOnce() -> Problem) {
        self.add_many(1, place);
    }

    /// Counts some more.
    pub(crate) fn add_many(&mut self, count: usize, place: impl FnOnce() -> Problem) {
        if self.count == 0 && count > 0 {
            self.first = place();
        }
        self.count += count;
    }

    /// The warning, if there is something to warn of: its first words for one and for several, and how it goes on.
    pub(crate) fn warning(self, one: &str, several: &str, rest: &str) -> Option<Problem> {
        let Self { count, first: (place, before) } = self;
        let what = if count == 1 { one } else { several };
        (count > 0).then(|| (place, format!("{before}{count} {what} {rest}")))
    }
}
