//! The threads that a render runs on, and those that a scene is built on.

use std::sync::Arc;
use std::thread::available_parallelism;

use foton_input::quoted;
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use thiserror::Error;

/// The most threads that can be asked for.
pub const MAX: usize = 1024;

/// The variable of the environment that says how many threads there are by default, as for other programs that use Rayon.
const VARIABLE: &str = "RAYON_NUM_THREADS";

/// How many threads a render has: as many as are asked for, else as `RAYON_NUM_THREADS` says, else as the machine has.
#[must_use]
pub fn count(asked: Option<usize>) -> usize {
    let stated = || std::env::var(VARIABLE).ok().and_then(|text| stated(&text).ok().flatten());
    let machine = || available_parallelism().map_or(1, usize::from);
    asked.or_else(stated).unwrap_or_else(machine).clamp(1, MAX)
}

/// The number that a text states, `None` where it leaves that to the machine, or what is wrong with it.
fn stated(text: &str) -> Result<Option<usize>, String> {
    match text.parse::<usize>() {
        Ok(0) => Ok(None),
        Ok(number) if number <= MAX => Ok(Some(number)),
        _ if text.is_empty() => Ok(None),
        _ => Err(format!(
            "{VARIABLE} is {}, which is no number of threads from 1 to {MAX}: there are as many as the machine has",
            quoted(text)
        )),
    }
}

/// Why there are no threads.
#[derive(Debug, Error)]
#[error("{0}")]
pub struct NoThreads(String);

impl NoThreads {
    fn of_system(error: ThreadPoolBuildError) -> Self {
        Self(error.to_string())
    }
}

/// Address space of a thread's stack: the standard library's default.
#[cfg(target_os = "linux")]
const STACK: u64 = 2 << 20;

/// Starts the threads that scenes are built on, once, before any work for them; what is wrong with `RAYON_NUM_THREADS`, if anything.
///
/// # Errors
/// Where the system gives no threads.
pub fn start() -> Result<Option<String>, NoThreads> {
    let (text, count) = (std::env::var_os(VARIABLE).unwrap_or_default(), count(None));
    check_room(count)?;
    ThreadPoolBuilder::new().num_threads(count).build_global().map_err(NoThreads::of_system)?;
    Ok(stated(&text.to_string_lossy()).err())
}

/// Whether the stacks of so many threads fit into the address space that the system allows. Where they do not, the threads that start
/// first may find no memory, which ends the program before anyone is told why.
fn check_room(count: usize) -> Result<(), NoThreads> {
    #[cfg(target_os = "linux")]
    if let Some(limit) = rustix::process::getrlimit(rustix::process::Resource::As).current {
        let stacks = (count as u64).saturating_mul(STACK);
        if stacks > limit {
            let [stacks, limit] = [stacks, limit].map(|bytes| bytes >> 20);
            return Err(NoThreads(format!(
                "the stacks of {count} threads take {stacks} MiB, and the system confines the program to {limit} MiB (ulimit -v)"
            )));
        }
    }
    #[cfg(not(target_os = "linux"))]
    let _ = count;
    Ok(())
}

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
pub(crate) fn pool(threads: Option<usize>, rank: Rank) -> Result<Arc<ThreadPool>, NoThreads> {
    let count = count(threads);
    check_room(count)?;
    let pool = ThreadPoolBuilder::new().num_threads(count).start_handler(move |_| step_back(rank)).build();
    pool.map(Arc::new).map_err(NoThreads::of_system)
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
    fn no_variable_asks_for_more_threads_than_a_machine_bears() {
        assert_eq!(
            ["", "0", "1", "1024"].map(|text| stated(text).ok().flatten()),
            [None, None, Some(1), Some(1024)]
        );
        for text in ["1025", "1000000000", "99999999999999999999999", "-1", "two", "2 "] {
            assert!(stated(text).is_err_and(|said| said.contains(text)), "{text}");
        }
        assert_eq!(count(Some(usize::MAX)), MAX);
    }

    #[test]
    fn stacks_that_fit_nowhere_are_refused_before_any_thread_starts() {
        // Where nothing is confined, any number fits.
        let confined = rustix::process::getrlimit(rustix::process::Resource::As).current;
        assert_eq!(check_room(1 << 50).is_err(), confined.is_some());
        assert!(check_room(1).is_ok());
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
