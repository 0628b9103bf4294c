//! Arguments of `cargo test` that find a test.

pub(super) const GEOMETRY: &str = "-p foton-scene --test geometry";
pub(super) const SCENE: &str = "-p foton-scene --lib";
pub(super) const FORMAT: &str = "-p foton-format --lib";
pub(super) const MESHES: &str = "-p foton-format --test meshes";
pub(super) const PICTURES: &str = "-p foton-format --test pictures";
pub(super) const BAD_FILES: &str = "-p foton-format --test bad_files";
pub(super) const TRANSPORT: &str = "-p foton-transport --lib";
pub(super) const INTEGRATOR: &str = "-p foton-integrator --lib";
pub(super) const SURFACES: &str = "-p foton-tests --test surfaces";
pub(super) const ANALYTIC: &str = "-p foton-tests --test analytic";
pub(super) const LEDGER: &str = "-p foton-tests --test ledger";
pub(super) const CHECKPOINTS: &str = "-p foton-tests --test checkpoints";
pub(super) const CLI: &str = "-p foton --no-default-features --test cli";
pub(super) const FILM: &str = "-p foton-film --lib";
pub(super) const TEMPORARY: &str = "-p foton-film --test temporary_files";
pub(super) const WRITER: &str = "-p foton-format --test writer";
pub(super) const SAVING: &str = "-p foton-format --test saving";
pub(super) const ENGINE: &str = "-p foton-session --test engine";
pub(super) const MEASURE: &str = "-p foton-measure --lib";
pub(super) const CANCELLING: &str = "-p foton-format --test cancelling";
pub(super) const SESSION: &str = "-p foton-session --lib";
pub(super) const INPUT: &str = "-p foton-input";
