//! Why there is no window.

use foton_film::WriteError;
use thiserror::Error;

/// Why there is no window. The render can go on without one.
#[derive(Debug, Error)]
pub enum WindowError {
    /// No display, or no libraries to talk to it.
    #[error("no window can be opened: {0}")]
    NoDisplay(String),
    /// Nothing that can draw.
    #[error("no graphics adapter can draw a window: {0}")]
    NoAdapter(String),
    /// The log cannot be written.
    #[error(transparent)]
    Log(#[from] WriteError),
}

/// What the system says, without the place in a library's source.
pub(super) fn reason(error: &impl std::fmt::Display) -> String {
    let text = error.to_string();
    match text.strip_prefix("os error at ").and_then(|rest| rest.split_once(": ")) {
        Some((_, reason)) => reason.to_owned(),
        None => text,
    }
}
