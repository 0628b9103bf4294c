//! What the engine's thread knows, by purpose.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicUsize;
use std::time::{Duration, Instant};

use foton_integrator::RenderSettings;
use rayon::ThreadPool;

use crate::checkpoint::Keeper;
use crate::engine::command::{Region, ViewMode};
use crate::engine::frame::{DrawnPath, Picture, RenderStats};
use crate::engine::kept::{Kept, Subject};
use crate::engine::level::Level;
use crate::engine::render::LevelRender;
use crate::engine::run::Run;
use crate::engine::starting::Starting;
use crate::metadata::SceneIdentity;
use crate::snapshot::Look;
use crate::stop::StopRule;

/// Whether passes are rendered.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub(in crate::engine) enum Flow {
    /// Passes, until the stop rule.
    #[default]
    Run,
    /// So many passes, then wait.
    Steps(u64),
}

/// What a person has asked of the render.
#[derive(Default)]
pub(in crate::engine) struct Plan {
    pub(in crate::engine) settings: RenderSettings,
    pub(super) threads: Option<usize>,
    pub(super) stop: StopRule,
    pub(in crate::engine) flow: Flow,
    /// Whether more moves of the camera or of an object are to follow.
    pub(super) moving: bool,
}

/// The render under way.
#[derive(Default)]
pub(in crate::engine) struct Current {
    pub(in crate::engine) render: Option<LevelRender>,
    /// The whole render, while its hit points are collected.
    pub(super) starting: Option<Starting>,
    /// What the whole render is of.
    pub(super) subject: Option<Subject>,
    /// Those from before edits.
    pub(super) kept: Kept,
    /// There is always a pass to look at: one that was started anew in a pause is to have its first.
    pub(in crate::engine) owes_a_pass: bool,
    /// Changes with each start.
    pub(in crate::engine) number: u64,
    /// A render that cannot start is not tried again until something changes.
    pub(super) refused: bool,
    pub(super) last_pass: Duration,
    /// One for all renders: threads that come and go leave memory behind that the system's allocator does not give back.
    pub(super) pool: Option<Arc<ThreadPool>>,
}

/// Files that are written on the way, and the one to go on from.
pub(in crate::engine) struct Files {
    /// Files that were asked for and are not written yet.
    pub(in crate::engine) unwritten: Arc<AtomicUsize>,
    pub(super) auto_snapshots: Option<PathBuf>,
    /// What pictures of the render are called.
    pub(in crate::engine) run: Option<Run>,
    /// How PNGs show radiance.
    pub(in crate::engine) look: Look,
    /// The checkpoint that follows the render.
    pub(in crate::engine) keeper: Option<Keeper>,
    /// The checkpoint that the next whole render goes on from.
    pub(in crate::engine) resuming: Option<PathBuf>,
    /// The scene that it is of, where it is one of the history; else that of the file.
    pub(in crate::engine) resuming_as: Option<SceneIdentity>,
}

/// Paths of photons to a pixel. Tracing them takes a moment: they are renewed for another pixel, and when the render has twice as many
/// passes.
#[derive(Default)]
pub(super) struct ProbedPaths {
    /// The render, the pixel, and the logarithm of the passes.
    pub(super) of: Option<(u64, [u32; 2], u32)>,
    pub(super) drawn: Arc<Vec<DrawnPath>>,
}

/// What frames are to carry.
pub(super) struct View {
    pub(super) mode: ViewMode,
    /// Whether they carry the photons of the last pass.
    pub(super) photons: bool,
    /// Paths of photons to the pixel that is probed, if frames carry them.
    pub(super) paths: Option<ProbedPaths>,
    pub(super) probed: Option<[u32; 2]>,
}

/// What a picture is of.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct PictureOf {
    pub(super) render: u64,
    pub(super) level: Level,
    pub(super) passes: u64,
    pub(super) mode: ViewMode,
}

/// What frames have carried.
pub(super) struct Published {
    pub(super) frames: u64,
    /// The whole picture as it last was: retained while the next render has none.
    pub(super) picture: Option<Picture>,
    pub(super) picture_of: Option<PictureOf>,
    /// How a render stood after a pass, for one goal of its error.
    pub(super) stats: Option<(u64, u64, Option<f64>, RenderStats)>,
    /// The render that it is of.
    pub(super) pictured: u64,
    /// The part of the whole image that it shows.
    pub(super) window: Region,
    pub(super) last_frame: Instant,
    /// Whether there is something that no frame has carried.
    pub(super) unseen: bool,
}

impl Default for Published {
    fn default() -> Self {
        Self {
            frames: 0,
            picture: None,
            picture_of: None,
            stats: None,
            pictured: 0,
            window: Region { x: 0, y: 0, width: 0, height: 0 },
            last_frame: Instant::now(),
            unseen: true,
        }
    }
}
