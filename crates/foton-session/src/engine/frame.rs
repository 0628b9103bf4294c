//! What a window sees of a render: a picture and statistics, never a hit point or a scene.

use std::sync::Arc;
use std::time::Duration;

use foton_edit::{Gizmo, Inspection, Item, Segment, Target};
use foton_film::{Image, Plane};
use foton_integrator::{ErrorEstimate, Ledger, PathClass, Radii, RenderSettings};
use foton_math::Rgb;
use foton_scene::BuildStep;
use foton_scene::description::Lens;

use super::command::{Region, ViewMode};
use super::history::HistoryEntry;
use crate::clock::StageTimes;
pub use crate::dots::Dot;
use crate::findings::Finding;
use crate::stop::StopRule;

/// What the engine is doing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Activity {
    /// There is no scene.
    #[default]
    Empty,
    /// Small pictures, while the camera or an object moves.
    Moving,
    /// Building the scene after an edit.
    Building,
    /// Following eye paths.
    Collecting,
    /// Passes.
    Rendering,
    /// Waiting for a person.
    Paused,
    /// The stop rule is reached.
    Done,
}

/// A picture, row-major from the top left.
#[derive(Clone, Debug)]
pub enum Picture {
    /// Linear radiance.
    Colour(Arc<Image>),
    /// A measure, for false colours.
    Measure {
        /// What and in which unit.
        label: &'static str,
        /// The values.
        plane: Arc<Plane<f32>>,
    },
}

impl Picture {
    /// Width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        match self {
            Self::Colour(image) => [image.width, image.height],
            Self::Measure { plane, .. } => [plane.width, plane.height],
        }
    }
}

/// The path of a photon that lights a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnPath {
    /// Its edges as far as they are before the camera, in pixels of the image, from the emitter on.
    pub edges: Vec<Segment>,
    /// The kind of light that it brought.
    pub class: PathClass,
}

/// How far opening a scene is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuildProgress {
    /// The step of building that is under way; `None` while the file is read.
    pub step: Option<BuildStep>,
    /// The share of it that is done.
    pub share: f64,
}

/// Names of what a ray meets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SurfaceNames {
    /// The shape.
    pub shape: String,
    /// Its material.
    pub material: String,
}

/// What is known of the pixel that a person points at.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// Column and row.
    pub pixel: [u32; 2],
    /// Radiance as it stands.
    pub radiance: Rgb,
    /// Mean radius of its hit points in world units; `None` without hit points.
    pub radius: Option<f64>,
    /// Photons that its hit points have found.
    pub photons_found: u64,
    /// Hit points.
    pub hit_points: usize,
    /// Distance from the camera to its first hit point, in world units.
    pub distance: Option<f64>,
    /// Names of the shape and material that it sees first.
    pub surface: Option<SurfaceNames>,
    /// The outline of its first hit point's disc, in pixels of the image.
    pub disc: Vec<[f32; 2]>,
    /// Photons of the last pass within that disc.
    pub photons: Vec<Dot>,
    /// Paths of photons that its hit points gathered, if asked for.
    pub paths: Arc<Vec<DrawnPath>>,
}

/// A sensor of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorFacts {
    /// Its name.
    pub name: String,
    /// Field of view in degrees along its own axis.
    pub fov_degrees: f64,
    /// How wide its image is in world units, where it has no perspective.
    pub width: Option<f64>,
    /// Its lens, if it has one.
    pub lens: Option<Lens>,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// As an element of Mitsuba XML.
    pub xml: String,
}

/// What is chosen.
#[derive(Clone, Debug, PartialEq)]
pub struct Selection {
    /// Which shape or light.
    pub target: Target,
    /// Its fields.
    pub inspection: Inspection,
    /// Its outline.
    pub outline: Vec<Segment>,
    /// Its handles; `None` where there is nothing to drag, or it is not in the image.
    pub gizmo: Option<Gizmo>,
    /// How far the drag under way is, in words.
    pub drag: Option<String>,
}

/// What a window says of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneFacts {
    /// Its name.
    pub name: String,
    /// Its name for people: that of its folder where the file is called `scene.xml`.
    pub title: String,
    /// Its file, if it has one.
    pub file: Option<std::path::PathBuf>,
    /// Its sensors.
    pub sensors: Vec<SensorFacts>,
    /// Surfaces.
    pub shapes: usize,
    /// Half the diagonal of what they take up, in world units.
    pub radius: f64,
    /// All shapes, lights and cameras.
    pub contents: Arc<Vec<Item>>,
    /// Whether the scene differs from its file.
    pub is_edited: bool,
    /// What its file says without effect, and what else a person should know of it, as when it was opened.
    pub warnings: Arc<Vec<String>>,
    /// Whether it has edits that no file holds; where its cameras stand does not count.
    pub is_unsaved: bool,
    /// What undoing would take back.
    pub undo: Option<String>,
    /// What redoing would make again.
    pub redo: Option<String>,
}

/// How a render stands.
#[derive(Clone, Debug, Default)]
pub struct RenderStats {
    /// Passes.
    pub passes: u64,
    /// Photons emitted.
    pub photons: u64,
    /// Photons emitted in the last pass.
    pub photons_in_pass: u64,
    /// Time of rendering, loading and pauses not included.
    pub elapsed: Duration,
    /// Photons a second over the last passes.
    pub photons_per_s: f64,
    /// Rays a second over the last passes.
    pub rays_per_s: f64,
    /// Time by stage in all.
    pub stages: StageTimes,
    /// Hit points.
    pub hit_points: u64,
    /// Share of hit points that have found no photon: unknown, not dark.
    pub no_photon_share: f64,
    /// How wrong the image still is, once there are passes enough to tell.
    pub error: Option<ErrorEstimate>,
    /// Where the emitted power went.
    pub ledger: Ledger,
    /// Spread of radii in world units.
    pub radii: Radii,
    /// Bytes held.
    pub bytes: usize,
    /// What a person should know of the render.
    pub findings: Arc<Vec<Finding>>,
}

/// The newest state of the engine.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Counts frames.
    pub number: u64,
    /// Counts starts: another number is another render.
    pub render: u64,
    /// The number of the render that the picture is of: of the one before while the next has none.
    pub pictured: u64,
    /// What goes on.
    pub activity: Activity,
    /// Whether another scene is being opened.
    pub opening: Option<String>,
    /// How far building that scene is; `None` while its file is read.
    pub building: Option<BuildProgress>,
    /// Size of the whole image in pixels.
    pub size: [u32; 2],
    /// The part of that which the picture is of.
    pub window: Region,
    /// The part that a person has chosen to render alone.
    pub region: Option<Region>,
    /// The picture of the window; of fewer pixels while things move.
    pub picture: Option<Picture>,
    /// What the picture is of.
    pub view: ViewMode,
    /// How the render stands.
    pub stats: RenderStats,
    /// Bytes of renders from before edits, which undo brings back.
    pub kept_bytes: f64,
    /// How much of the pass under way is done, from 0 to 1.
    pub pass_share: f64,
    /// The share of the eye samples that have been followed, while that is under way for all pixels.
    pub collecting: Option<f64>,
    /// The settings as they are now: α and photons of the next pass.
    pub settings: RenderSettings,
    /// Threads; `None`: as many as the machine has.
    pub threads: Option<usize>,
    /// When it will stop.
    pub stop: StopRule,
    /// Passes that were kept, the oldest first.
    pub history: Arc<Vec<HistoryEntry>>,
    /// Frames of a turntable that are written, and all of them, while one turns.
    pub turntable: Option<[u32; 2]>,
    /// How much rendering the render's checkpoint does not have yet; `None` without a checkpoint.
    pub checkpoint_age: Option<Duration>,
    /// The scene.
    pub scene: Arc<SceneFacts>,
    /// Photons of the last pass, if asked for.
    pub dots: Arc<Vec<Dot>>,
    /// The pixel asked about.
    pub probe: Option<Probe>,
    /// What is chosen.
    pub selection: Option<Selection>,
    /// Where lights without a surface are.
    pub lights: Vec<Segment>,
}
