//! Mitsuba's XML: a file to a description, a description to a file, and an edited description back into its own file.

mod comments;
pub(crate) mod document;
pub(crate) mod names;
pub(crate) mod read;
pub(crate) mod save;
pub(crate) mod write;
