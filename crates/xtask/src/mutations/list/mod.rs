//! The protections that `cargo xtask mutations` takes out, by the crates they stand in.

mod format;
mod integrator;
mod program;
mod scene;

use super::Mutation;

const GEOMETRY: &str = "-p foton-scene --test geometry";
const SCENE: &str = "-p foton-scene --lib";
const INPUT: &str = "-p foton-input";
const FORMAT: &str = "-p foton-format --lib";
const MESHES: &str = "-p foton-format --test meshes";
const PICTURES: &str = "-p foton-format --test pictures";
const BAD_FILES: &str = "-p foton-format --test bad_files";
const INTEGRATOR: &str = "-p foton-integrator --lib";
const SURFACES: &str = "-p foton-tests --test surfaces";
const ANALYTIC: &str = "-p foton-tests --test analytic";
const LEDGER: &str = "-p foton-tests --test ledger";
const CHECKPOINTS: &str = "-p foton-tests --test checkpoints";
const CLI: &str = "-p foton --no-default-features --test cli";

/// All of them.
pub(super) fn all() -> impl Iterator<Item = &'static Mutation> {
    [scene::LIST, format::LIST, integrator::LIST, program::LIST].into_iter().flatten()
}
