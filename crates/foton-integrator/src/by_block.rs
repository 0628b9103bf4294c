//! What blocks of hit points come to, one after the other or in parallel, where the work may be suspended between two of them.

use foton_transport::ShouldSuspend;
use rayon::prelude::*;

/// What each block came to; `None` for those that are still to be worked on.
pub(crate) struct ByBlock<'a, T> {
    pub(crate) done: &'a mut Vec<Option<T>>,
    pub(crate) should_suspend: ShouldSuspend<'a>,
}

impl<'a, T: Send + Sync> ByBlock<'a, T> {
    /// Makes room for that many blocks, and hands out the place of each.
    pub(crate) fn places(self, blocks: usize) -> impl IndexedParallelIterator<Item = Place<'a, T>> {
        let should_suspend = self.should_suspend;
        self.done.resize_with(blocks, || None);
        self.done.par_iter_mut().map(move |result| Place { result, should_suspend })
    }
}

/// Where the result of a block goes.
pub(crate) struct Place<'a, T> {
    result: &'a mut Option<T>,
    should_suspend: ShouldSuspend<'a>,
}

impl<T> Place<'_, T> {
    /// Works on the block, unless that was done before or all work is to make way.
    pub(crate) fn fill(self, work: impl FnOnce() -> T) {
        if self.result.is_none() && !(self.should_suspend)() {
            *self.result = Some(work());
        }
    }
}
