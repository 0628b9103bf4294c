//! The history of a session: passes that were kept with their pictures and states, to compare with and to return to; and films.
//!
//! Pictures and states lie in a folder of this process in the user's cache; a thread of its own writes them and keeps within a
//! limit by removing the oldest. What a render needs beside them (the scene as it was edited, the camera, settings) is shared.

mod entry;
mod film;
mod rooms;
mod store;
mod turntable;

pub(super) use entry::in_words;
pub use entry::{HistoryEntry, Thumbnail, shrunk};
pub(super) use film::Film;
pub(super) use store::{Files, History, Kept};
pub(super) use turntable::Turntable;
