//! The `foton` command: reads arguments, renders, says how it goes.
//!
//! Exit codes: 0 done, 1 could not render or compare or write what was asked for, 2 bad usage. A render that a signal ended, and
//! whose image was written, is done.

mod all_methods;
mod all_sensors;
mod args;
mod compare;
mod console;
mod convert;
mod embedded;
mod figure;
mod info;
mod interrupts;
mod measure;
mod memory;
mod opening;
mod quick;
mod render;
mod roles;
mod settings;
mod signals;
#[cfg(feature = "window")]
mod window;
mod writing;

use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{CommandFactory, Parser};

use args::{Args, Command};
use console::{Console, Failure};
use foton_session::threads;

/// The window; where there can be none, a picture within a minute.
fn live(args: &Args, console: &mut Console) -> Result<(), Failure> {
    #[cfg(feature = "window")]
    match window::show(args) {
        Ok(()) => return Ok(()),
        Err(error @ foton_preview::WindowError::Log(_)) => {
            return Err(Failure::Window(error.to_string()));
        }
        Err(error) => console.line(&error.to_string()),
    }
    quick::render(args.scene.as_deref(), &args.read, console)
}

/// Starts the threads that scenes are built on; the exit code where the system gives none.
fn start_threads() -> Option<ExitCode> {
    let mut console = Console::new(false);
    match threads::start() {
        Ok(None) => None,
        Ok(Some(message)) => {
            console.warning(&message);
            None
        }
        Err(cause) => {
            console.failure(&Failure::Start(cause.into()));
            Some(ExitCode::FAILURE)
        }
    }
}

/// Says what is wrong with the arguments, or what was asked for about them. Arguments can be names of files, and those can hold
/// anything.
fn bad_usage(error: &clap::Error) -> ! {
    if error.use_stderr() {
        Console::new(false).line(error.to_string().trim_end());
        std::process::exit(error.exit_code());
    }
    error.exit()
}

fn main() -> ExitCode {
    signals::outlive_file_limit();
    let args = Args::try_parse().unwrap_or_else(|error| bad_usage(&error));
    if let Some((name, message)) = args.contradiction() {
        let mut command = Args::command();
        command.build();
        let error = name
            .and_then(|name| command.find_subcommand_mut(name))
            .map(|command| command.error(ErrorKind::ArgumentConflict, &message));
        bad_usage(&error.unwrap_or_else(|| command.error(ErrorKind::ArgumentConflict, message)));
    }
    if let Some(failure) = start_threads() {
        return failure;
    }
    let (result, mut console) = match &args.command {
        Some(Command::Render(args)) => {
            let mut console = Console::new(args.json);
            (render::render(args, &mut console), console)
        }
        Some(Command::Convert(args)) => {
            let console = Console::new(false);
            (convert::run(args, &console), console)
        }
        Some(Command::Info(args)) => {
            let console = Console::new(args.json);
            (info::print(args, &console), console)
        }
        Some(Command::Compare(args)) => {
            let console = Console::new(args.json);
            (compare::run(args, &console), console)
        }
        Some(Command::Measure(args)) => {
            let mut console = Console::new(args.json);
            (measure::run(args, &mut console), console)
        }
        None => {
            let mut console = Console::new(false);
            (live(&args, &mut console), console)
        }
    };
    // What was asked for on standard output and is not there was not done.
    let lost = console.lost().map(|cause| Failure::StandardOutput(cause.to_owned()));
    let result = result.and_then(|()| lost.map_or(Ok(()), Err));
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            console.failure(&failure);
            ExitCode::FAILURE
        }
    }
}
