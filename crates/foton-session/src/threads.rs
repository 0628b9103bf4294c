//! The threads that a render runs on.

use std::sync::Arc;

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

/// How the render's threads stand to the rest of the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rank {
    /// As any other thread: nobody waits at this machine.
    Equal,
    /// Behind threads that draw and answer: whoever moves a slider is served first, and passes take what is left. An idle
    /// machine gives them all of it, so a pass that nobody disturbs costs the same.
    Behind,
}

/// How much nicer render threads are than the window's. The scheduler of Linux gives a thread ten steps down about a tenth of
/// the share of its neighbour, so that a frame drawn by the processor takes about the time that it takes on an idle machine.
#[cfg(target_os = "linux")]
const STEPS_BEHIND: i32 = 10;

/// Threads to render on, by default as many as the machine has; one pool serves any number of renders, one at a time.
pub(crate) fn pool(threads: Option<usize>, rank: Rank) -> Result<Arc<ThreadPool>, ThreadPoolBuildError> {
    ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(0))
        .start_handler(move |_| step_back(rank))
        .build()
        .map(Arc::new)
}

/// Ranks the calling thread. Linux keeps niceness by thread; elsewhere it belongs to the process, and the window would sink
/// with its render, so nothing is done there.
fn step_back(rank: Rank) {
    #[cfg(target_os = "linux")]
    if rank == Rank::Behind {
        // A system that refuses (a sandbox) only draws later.
        let _ = rustix::process::nice(STEPS_BEHIND);
    }
    #[cfg(not(target_os = "linux"))]
    let _ = rank;
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    fn niceness() -> i32 {
        rustix::process::nice(0).expect("may be asked")
    }

    #[test]
    fn threads_behind_are_nicer_and_leave_the_caller_as_it_was() {
        let before = niceness();
        let equal = pool(Some(2), Rank::Equal).expect("threads");
        let behind = pool(Some(2), Rank::Behind).expect("threads");
        assert_eq!(equal.install(niceness), before);
        assert_eq!(behind.install(niceness), (before + STEPS_BEHIND).min(19));
        assert_eq!(niceness(), before);
    }
}
