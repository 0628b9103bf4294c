//! Why there is no result.

use std::io;
use std::path::{Path, PathBuf};

use foton_film::{ReadError, WriteError};
use foton_integrator::Cancelled;
use thiserror::Error;

use crate::CompareError;

/// Why there is no result.
#[derive(Debug, Error)]
pub enum SweepError {
    /// Stopped before there was anything to compare.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A result cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A result that took long cannot be written where it belongs; it is elsewhere.
    #[error("{cause}; it is {} instead", spare.display())]
    Rescued {
        /// Why.
        cause: WriteError,
        /// Where it is.
        spare: PathBuf,
    },
    /// An image cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A folder or table cannot be made or read.
    #[error("{}: {cause}", path.display())]
    Io {
        /// Of the file.
        path: PathBuf,
        /// What the system says.
        cause: io::Error,
    },
    /// The folder holds another sweep.
    #[error("{} holds a sweep of something else; take another folder, or remove it. There: {there}; now: {now}", folder.display())]
    OtherSweep {
        /// The folder.
        folder: PathBuf,
        /// What it holds.
        there: String,
        /// What was asked for.
        now: String,
    },
    /// A table in the folder is none.
    #[error("{}: not a table of this version; remove it to run its part again", path.display())]
    Table {
        /// Of the table.
        path: PathBuf,
    },
    /// The reference has another size.
    #[error("the reference does not fit: {0}")]
    Compare(#[from] CompareError),
    /// Nothing in the picture reflects light.
    #[error("nothing that is seen reflects any light: there is no error to measure")]
    Dark,
}

/// An error of the system about a file.
pub(super) fn io_error(path: &Path) -> impl Fn(io::Error) -> SweepError {
    let path = path.to_owned();
    move |cause| SweepError::Io { path: path.clone(), cause }
}
