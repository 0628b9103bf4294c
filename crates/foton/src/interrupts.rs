//! How signals and limits of the system end a render.

use std::sync::Mutex;
use std::thread;
use std::time::Duration;

use foton_session::{Interrupt, StopCause};

use crate::console::{Console, Failure};
use crate::signals;

/// Loading that has not heard of a signal after this long is ended with the program. Most steps hear it within milliseconds; those of
/// libraries, such as decoding one picture, hear nothing.
const GRACE: Duration = Duration::from_millis(700);

/// The step of loading under way, for the message where the program ends in it.
static STEP: Mutex<&str> = Mutex::new("starting");

/// Begins a step of loading.
pub(crate) fn begin_step(step: &'static str) {
    *STEP.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = step;
    inject_deafness(step);
}

/// Takes for ever and hears nothing where the environment variable `FOTON_DEAF` names the step, so that tests see what comes of it.
/// Programs that people get do not have this.
#[cfg(debug_assertions)]
fn inject_deafness(step: &str) {
    if std::env::var("FOTON_DEAF").is_ok_and(|deaf| deaf == step) {
        let _ = std::io::Write::write_all(&mut std::io::stderr(), b"deaf\n");
        loop {
            thread::park();
        }
    }
}

#[cfg(not(debug_assertions))]
const fn inject_deafness(_: &str) {}

/// Ctrl-C, SIGTERM and the limits of the system end the render after the batch of photons under way, and say so at once; a second one
/// discards the pass. Before there are passes one is enough.
pub(crate) fn interrupt_on_signals(console: &Console) -> Interrupt {
    let interrupt = Interrupt::while_loading();
    let handler = interrupt.clone();
    let json = console.is_json();
    let say = console.teller();
    let on_end = move || {
        handler.request();
        if handler.finishes_a_pass() {
            say(
                "interrupted: the render ends after the photons under way; interrupt again to discard their pass",
            );
        }
        let interrupt = handler.clone();
        // Without a thread the step is waited for.
        let _ =
            thread::Builder::new().name("grace".to_owned()).spawn(move || end_after_grace(&interrupt, json));
    };
    if let Err(error) = signals::on_end(on_end) {
        console.warning(&format!("Ctrl-C will not be handled: {error}"));
    }
    interrupt
}

/// Ends the program where what is loaded has not heard of the request: nothing is lost by that.
fn end_after_grace(interrupt: &Interrupt, json: bool) {
    thread::sleep(GRACE);
    if interrupt.may_end_at_once() {
        let step = *STEP.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        Console::new(json).failure(&Failure::Interrupted(step));
        std::process::exit(1);
    }
}

/// Says that a limit of the system ended a render, if one did.
pub(crate) fn say_limit(cause: StopCause, console: &Console) {
    if let Some(why) = signals::limit().filter(|_| cause == StopCause::Interrupted) {
        console.warning(&format!("the render ends early: {why}"));
    }
}
