//! The protections that `cargo xtask mutations` takes out, by the crates they stand in.

mod files;
mod format;
mod integrator;
mod program;
mod scene;

use super::mutation::Mutation;

/// All of them.
pub(super) fn all() -> impl Iterator<Item = &'static Mutation> {
    [scene::LIST, format::LIST, integrator::LIST, program::LIST, files::LIST].into_iter().flatten()
}
