//! Signals of the system: which of them end a render after its pass, and what outlives a limit on the size of files.
//!
//! Not here: what a render does when it is to end; see `foton_session::Interrupt`.

use std::io;

/// Lets a write beyond the limit on the size of files (`ulimit -f`) fail with an error, as on a full disk. Unheard, SIGXFSZ ends
/// the program in the middle of it. To be called first.
pub(crate) fn outlive_file_limit() {
    // Without it the signal does what it always did.
    #[cfg(unix)]
    let _ = unix::hear_nothing_of_it();
}

/// Does something, on a thread of its own, each time that Ctrl-C, SIGTERM or their like ask for an end.
pub(crate) fn on_end(act: impl FnMut() + Send + 'static) -> io::Result<()> {
    #[cfg(unix)]
    return unix::on_end(act);
    #[cfg(not(unix))]
    ctrlc::set_handler(act).map_err(io::Error::other)
}

/// Why the system ended a render, where it was a limit and not a person.
pub(crate) fn limit() -> Option<&'static str> {
    #[cfg(unix)]
    return unix::limit();
    #[cfg(not(unix))]
    None
}

#[cfg(unix)]
mod unix {
    use std::io;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, AtomicI32, Ordering};
    use std::thread;

    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXCPU, SIGXFSZ};
    use signal_hook::iterator::Signals;

    /// The last of the signals that say of a limit.
    static LIMIT: AtomicI32 = AtomicI32::new(0);

    pub(super) fn hear_nothing_of_it() -> io::Result<()> {
        if !is_ignored(SIGXFSZ) {
            signal_hook::flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)))?;
        }
        Ok(())
    }

    pub(super) fn on_end(mut act: impl FnMut() + Send + 'static) -> io::Result<()> {
        // What whoever began this program has turned off stays so, as `nohup` does; a person's own wishes are heard.
        let others = [SIGHUP, SIGXCPU, SIGXFSZ].into_iter().filter(|signal| !is_ignored(*signal));
        let mut signals = Signals::new([SIGINT, SIGTERM].into_iter().chain(others))?;
        let listen = move || {
            for signal in signals.forever() {
                if [SIGXCPU, SIGXFSZ].contains(&signal) {
                    LIMIT.store(signal, Ordering::Relaxed);
                }
                act();
            }
        };
        thread::Builder::new().name("signals".to_owned()).spawn(listen).map(drop)
    }

    pub(super) fn limit() -> Option<&'static str> {
        match LIMIT.load(Ordering::Relaxed) {
            SIGXCPU => Some("the limit on processor time is reached (SIGXCPU, ulimit -t)"),
            SIGXFSZ => Some("a file has reached the limit on its size (SIGXFSZ, ulimit -f)"),
            _ => None,
        }
    }

    /// Whether the program was started with a signal turned off; only Linux is asked.
    fn is_ignored(signal: i32) -> bool {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
        ignored >> (signal - 1) & 1 == 1
    }
}
