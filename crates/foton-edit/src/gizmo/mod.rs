//! Handles over the picture by which a person moves, turns and scales what is selected.
//!
//! A [`Gizmo`] says what can be done to a thing and where its handles are on the film, however large they are drawn; a
//! [`Pull`] turns a drag of one of them into an [`Edit`](crate::Edit). Nothing is drawn here.

mod handle;
mod layout;
mod place;
mod pull;
mod snap;

pub use handle::{Handle, Tool};
pub use layout::{HandleShape, nearest};
pub use place::Gizmo;
pub use pull::Pull;
