//! The `foton` command: reads arguments, renders, says how it goes.
//!
//! Exit codes: 0 done, 1 could not render or compare, 2 bad usage.

mod args;
mod compare;
mod convert;
mod embedded;
mod info;
mod job;
mod memory;
mod quick;
mod talk;

use std::process::ExitCode;

use clap::Parser;

use args::{Args, Command};
use talk::Talk;

fn main() -> ExitCode {
    let args = Args::parse();
    let (result, mut talk) = match args.command {
        Some(Command::Render(render)) => {
            let mut talk = Talk::new(render.json);
            (job::render(&render, &mut talk), talk)
        }
        Some(Command::Convert(args)) => {
            let talk = Talk::new(false);
            (convert::run(&args, &talk), talk)
        }
        Some(Command::Info(args)) => {
            let talk = Talk::new(args.json);
            (info::print(&args, &talk), talk)
        }
        Some(Command::Compare(args)) => {
            let talk = Talk::new(args.json);
            (compare::run(&args, &talk), talk)
        }
        None => {
            let mut talk = Talk::new(false);
            (quick::render(args.scene.as_deref(), &mut talk), talk)
        }
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            talk.failure(&failure);
            ExitCode::FAILURE
        }
    }
}
