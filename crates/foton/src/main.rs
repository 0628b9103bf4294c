//! The `foton` command: reads arguments, renders, says how it goes.
//!
//! Exit codes: 0 done, 1 could not render or compare or write what was asked for, 2 bad usage. A render that a signal ended, and
//! whose image was written, is done.

mod args;
mod compare;
mod convert;
mod embedded;
mod figure;
mod info;
mod job;
mod measure;
mod memory;
mod quick;
mod roles;
mod signals;
mod talk;
#[cfg(feature = "window")]
mod window;

use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{CommandFactory, Parser};

use args::{Args, Command};
use foton_session::threads;
use talk::{Failure, Talk};

/// The window; where there can be none, a picture within a minute.
fn live(args: &Args, talk: &mut Talk) -> Result<(), Failure> {
    #[cfg(feature = "window")]
    match window::show(args.scene.as_deref(), args.frame_log.as_deref()) {
        Ok(()) => return Ok(()),
        Err(error @ foton_preview::WindowError::Log(_)) => {
            return Err(Failure::Window(error.to_string()));
        }
        Err(error) => talk.line(&error.to_string()),
    }
    quick::render(args.scene.as_deref(), talk)
}

/// Starts the threads that scenes are built on; the exit code where the system gives none.
fn start_threads() -> Option<ExitCode> {
    let mut talk = Talk::new(false);
    match threads::start() {
        Ok(None) => None,
        Ok(Some(message)) => {
            talk.warning(&message);
            None
        }
        Err(cause) => {
            talk.failure(&Failure::Start(cause.into()));
            Some(ExitCode::FAILURE)
        }
    }
}

/// Says what is wrong with the arguments, or what was asked for about them. Arguments can be names of files, and those can hold
/// anything.
fn bad_usage(error: &clap::Error) -> ! {
    if error.use_stderr() {
        Talk::new(false).line(error.to_string().trim_end());
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
    let (result, mut talk) = match &args.command {
        Some(Command::Render(render)) => {
            let mut talk = Talk::new(render.json);
            (job::render(render, &mut talk), talk)
        }
        Some(Command::Convert(args)) => {
            let talk = Talk::new(false);
            (convert::run(args, &talk), talk)
        }
        Some(Command::Info(args)) => {
            let talk = Talk::new(args.json);
            (info::print(args, &talk), talk)
        }
        Some(Command::Compare(args)) => {
            let talk = Talk::new(args.json);
            (compare::run(args, &talk), talk)
        }
        Some(Command::Measure(args)) => {
            let mut talk = Talk::new(args.json);
            (measure::run(args, &mut talk), talk)
        }
        None => {
            let mut talk = Talk::new(false);
            (live(&args, &mut talk), talk)
        }
    };
    // What was asked for on standard output and is not there was not done.
    let lost = talk.lost().map(|cause| Failure::StandardOutput(cause.to_owned()));
    let result = result.and_then(|()| lost.map_or(Ok(()), Err));
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            talk.failure(&failure);
            ExitCode::FAILURE
        }
    }
}
