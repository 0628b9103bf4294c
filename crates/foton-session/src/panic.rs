//! Panics are our bugs. One in a pass must not take the image of all passes before with it: it is caught where the pass was
//! begun, said, and the render stops.

use std::any::Any;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};

use foton_integrator::Stage;

/// A panic in a render.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Panic {
    /// The part of the render that was under way; `None` before the first.
    pub stage: Option<Stage>,
    /// What it said.
    pub message: String,
}

impl Panic {
    /// Whether the image is still that of the last complete pass. Only while a pass is added to the pixels is it neither that
    /// nor the next.
    #[must_use]
    pub fn leaves_the_image_whole(&self) -> bool {
        self.stage != Some(Stage::Radiance)
    }
}

impl fmt::Display for Panic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("foton has a fault and the render stops")?;
        if let Some(stage) = self.stage {
            write!(f, ", in its stage \"{}\"", stage.name())?;
        }
        write!(f, ": {}", self.message)
    }
}

impl std::error::Error for Panic {}

/// Does work; where it panics, what it said. What the work was changing is half-changed then.
pub(crate) fn catch_panic<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| message(&*panic))
}

fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message").to_owned()
}

/// Fails on purpose where the environment variable `FOTON_FAULT` says `SEED:STAGE:PASS`, so that tests see what comes of it.
/// Programs that people get do not have this.
#[cfg(debug_assertions)]
pub(crate) fn inject_fault(seed: u64, stage: Stage, pass: u64) {
    static FAULT: std::sync::OnceLock<Option<String>> = std::sync::OnceLock::new();
    let fault = FAULT.get_or_init(|| std::env::var("FOTON_FAULT").ok());
    let here = || format!("{seed}:{}:{pass}", stage.name());
    if fault.as_ref().is_some_and(|fault| *fault == here()) {
        // On another thread of the pool, as most faults would be.
        rayon::join(|| (), || panic!("FOTON_FAULT asked for this"));
    }
}

#[cfg(not(debug_assertions))]
pub(crate) const fn inject_fault(_: u64, _: Stage, _: u64) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_panics_is_caught_with_its_message_and_threads_go_on() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("threads");
        let fails = |n: u32| {
            let work = || rayon::join(|| n, || assert!(n != 1, "number {n}")).0;
            catch_panic(|| pool.install(work))
        };
        assert_eq!(fails(1), Err("number 1".to_owned()));
        assert_eq!(fails(2), Ok(2));
        assert_eq!(catch_panic(|| std::panic::panic_any(7)), Err::<(), _>("no message".to_owned()));
    }
}
