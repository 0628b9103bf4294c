//! What a batch of photons needs to know, and a photon on its way.

use foton_math::{Ray, Rgb, Stream};
use foton_scene::{Scene, Sources};
use pulp::Arch;

use super::batch::Batch;
use crate::guide::{Cells, Training};
use crate::lobes::LobePolicy;
use crate::photon_map::{Grid, PathClass};

/// Photons traced side by side: few enough for the first-level cache.
pub(super) const WAVE: usize = 256;

/// Everything a photon pass needs to know.
pub struct PhotonPass<'a> {
    /// What photons meet.
    pub scene: &'a Scene,
    /// Where they start.
    pub sources: &'a Sources,
    /// How often from which emitter and with which primary numbers.
    pub cells: &'a Cells,
    /// What is noted of them; `None` in passes that cells are not learnt from.
    pub training: Option<Training<'a>>,
    /// Where hit points may gather them.
    pub grid: &'a Grid,
    /// Whether photons that come straight from an emitter are stored: not where shadow rays bring that light.
    pub stores_direct: bool,
    /// Whether photons end where light spreads: for a map of caustics, whose paths have specular lobes alone. `[JEN96]`
    pub ends_where_light_spreads: bool,
    /// Which lobes hit points gather photons for.
    pub policy: LobePolicy,
    /// Whether any hit point needs a photon's direction.
    pub directions: bool,
    /// The instruction set to run on; it changes no bit.
    pub arch: Arch,
    /// Longest whole path in edges; a photon path is at least one shorter.
    pub max_depth: u32,
    /// The seed of the photons' random streams.
    pub seed: u64,
    /// How many passes were before this one.
    pub pass: u64,
    /// Photons of the whole pass.
    pub photons: u64,
    /// Which of them are emitted now.
    pub batch: Batch,
}

/// The index of a sample that there is not.
pub(super) const NOT_NOTED: u32 = u32::MAX;

/// A photon on its way.
pub(super) struct Path {
    pub(super) ray: Ray,
    pub(super) power: Rgb,
    pub(super) class: PathClass,
    /// See [`Photon::is_lone`](crate::photon_map::Photon::is_lone).
    pub(super) lone: bool,
    /// Whether it was stored anywhere.
    pub(super) stored: bool,
    /// Edges up to the end of `ray`.
    pub(super) edges: u32,
    /// Index of the emitter.
    pub(super) emitter: u32,
    /// Index of its sample in the chunk; [`NOT_NOTED`] for none.
    pub(super) sample: u32,
    pub(super) stream: Stream,
}
