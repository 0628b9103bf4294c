//! How signals and limits of the system end a render.

use foton_session::{Interrupt, StopCause};

use crate::console::Console;
use crate::signals;

/// Ctrl-C, SIGTERM and the limits of the system end the render after its pass; a second one discards the pass. Before there are passes
/// one is enough.
pub(crate) fn interrupt_on_signals(console: &Console) -> Interrupt {
    let interrupt = Interrupt::while_loading();
    let handler = interrupt.clone();
    if let Err(error) = signals::on_end(move || handler.request()) {
        console.warning(&format!("Ctrl-C will not be handled: {error}"));
    }
    interrupt
}

/// Says that a limit of the system ended a render, if one did.
pub(crate) fn say_limit(cause: StopCause, console: &Console) {
    if let Some(why) = signals::limit().filter(|_| cause == StopCause::Interrupted) {
        console.warning(&format!("the render ends early: {why}"));
    }
}
