//! What a window may ask of the engine, and what the engine says beside frames.

use std::path::PathBuf;

use foton_edit::{DragMode, FieldId, Handle, Make, NewThing, Target, Value};
use foton_integrator::{DirectLight, Method, RadiusFloor, RadiusRule, RenderSettings};
pub use foton_scene::description::Crop as Region;

use super::gesture::Gesture;
use crate::snapshot::Look;
use crate::stop::StopRule;

/// A scene to open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// One that ships with the program, by its name.
    BuiltIn(String),
    /// A file.
    File(PathBuf),
}

/// What restarts a render when it changes. The rest of [`RenderSettings`] changes between passes.
#[derive(Clone, Debug, PartialEq)]
pub struct Configuration {
    /// The method.
    pub method: Method,
    /// First radius in world units; `None`: from the pixel's footprint.
    pub radius: Option<f64>,
    /// How far radii shrink.
    pub radius_floor: RadiusFloor,
    /// How radii shrink.
    pub radius_rule: RadiusRule,
    /// How direct light is estimated.
    pub direct_light: DirectLight,
    /// Eye samples a pixel.
    pub samples_per_pixel: std::num::NonZeroU32,
    /// The seed of all random streams.
    pub seed: u64,
    /// Index of the sensor.
    pub sensor: usize,
    /// The part of the sensor's image that is rendered; `None`: what the scene says.
    pub region: Option<Region>,
    /// Longest path in edges; `None`: what the scene says.
    pub max_depth: Option<u32>,
    /// Threads; `None`: as many as the machine has.
    pub threads: Option<usize>,
}

impl Configuration {
    /// What these settings say, of a part of the image.
    #[must_use]
    pub fn of(settings: &RenderSettings, threads: Option<usize>, region: Option<Region>) -> Self {
        Self {
            method: settings.method,
            radius: settings.ppm.radius,
            radius_floor: settings.ppm.radius_floor,
            radius_rule: settings.ppm.radius_rule,
            direct_light: settings.ppm.direct_light,
            samples_per_pixel: settings.samples_per_pixel,
            seed: settings.seed,
            sensor: settings.sensor,
            region,
            max_depth: settings.max_depth,
            threads,
        }
    }

    /// Settings with this configuration.
    pub(super) fn apply(&self, settings: &mut RenderSettings) {
        settings.method = self.method;
        settings.ppm.radius = self.radius;
        settings.ppm.radius_floor = self.radius_floor;
        settings.ppm.radius_rule = self.radius_rule;
        settings.ppm.direct_light = self.direct_light;
        settings.samples_per_pixel = self.samples_per_pixel;
        settings.seed = self.seed;
        settings.sensor = self.sensor;
        settings.max_depth = self.max_depth;
    }
}

/// An edit of the scene. Film positions are pixels from the image's top left corner.
#[derive(Clone, Debug, PartialEq)]
pub enum SceneEdit {
    /// Takes hold of a handle of what is selected.
    BeginDrag {
        /// Which handle.
        handle: Handle,
        /// Where.
        film: [f64; 2],
        /// From the middle of the handles to their ends, in pixels.
        reach: f64,
    },
    /// Drags the handle that is held.
    DragTo {
        /// Where to.
        film: [f64; 2],
        /// Whether in round steps.
        snap: bool,
    },
    /// Lets go.
    EndDrag {
        /// Where.
        film: [f64; 2],
        /// Whether in round steps.
        snap: bool,
    },
    /// Puts what is held back.
    CancelDrag,
    /// Moves what is selected by small steps: to the right and downwards in the image.
    Nudge {
        /// How many steps.
        steps: [f64; 2],
        /// Which way it may go.
        mode: DragMode,
    },
    /// Turns the selected light so that it shines at what is seen there.
    AimAt([f64; 2]),
    /// Sets a field of what is selected.
    SetField {
        /// Which one.
        field: FieldId,
        /// To what.
        value: Value,
        /// Whether a control that is dragged was let go: all until then is one step of the history.
        done: bool,
    },
    /// Gives what is selected a material of its own.
    OwnMaterial,
    /// Gives what is selected another material.
    Remake {
        /// What it becomes.
        make: Make,
        /// The new material's name.
        name: String,
        /// Whether all shapes that share the old material get it.
        all: bool,
    },
    /// Gives a thing another name.
    Rename {
        /// Which one.
        target: Target,
        /// The name.
        name: String,
    },
    /// Hides a thing, or shows it again.
    Hide {
        /// Which one.
        target: Target,
        /// Whether it is hidden from now on.
        hide: bool,
    },
    /// Copies a thing and selects the copy.
    Duplicate(Target),
    /// Takes a thing out of the scene.
    Delete(Target),
    /// Adds a thing where the camera looks and selects it.
    Add(NewThing),
    /// Adds the shapes of a mesh file and selects the first.
    Import(PathBuf),
    /// Takes the last step back.
    Undo,
    /// Makes the step again that was taken back last.
    Redo,
}

impl SceneEdit {
    /// Whether more of the same is to follow at once.
    pub(super) const fn is_moving(&self) -> bool {
        matches!(self, Self::BeginDrag { .. } | Self::DragTo { .. } | Self::SetField { done: false, .. })
    }
}

/// The picture that frames carry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewMode {
    /// All radiance.
    Radiance,
    /// Reflected light of some path classes, in their order, and emitters.
    Classes {
        /// Direct, caustic, indirect.
        reflected: [bool; 3],
        /// Emitters seen directly or by specular bounces.
        emission: bool,
    },
    /// Radius.
    Radius,
    /// Photons found.
    PhotonCount,
    /// Luminance of the radiance.
    Luminance,
    /// Share of hit points that have found no photon.
    Unknown,
    /// How wrong each pixel still is; radiance where the error is not estimated.
    Error(ErrorPart),
}

/// What makes a pixel wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorPart {
    /// Too few photons.
    Noise,
    /// Radii too large.
    Bias,
    /// Both.
    Total,
}

/// What a window may ask.
#[derive(Clone, Debug)]
pub enum Command {
    /// Opens a scene; the present one goes on until it is there.
    Open(Source),
    /// Forgets a scene that is being opened.
    CancelOpen,
    /// From the next pass on.
    Steer(foton_integrator::SettingChange),
    /// Restarts with other settings.
    Configure(Configuration),
    /// Waits, in the middle of a pass too.
    Pause,
    /// Goes on.
    Resume,
    /// One pass, or what is left of one, then waits.
    Step,
    /// Restarts with the same settings.
    Restart,
    /// When to stop.
    StopAt(StopRule),
    /// Moves the camera; while `moving`, pictures are small and quick.
    Camera {
        /// How.
        gesture: Gesture,
        /// Whether more is to follow at once.
        moving: bool,
    },
    /// Whether more moves are to follow at once.
    Moving(bool),
    /// Puts the camera back where the scene's file has it.
    ResetCamera,
    /// Selects the surface or light at a film position.
    Choose(Option<[f64; 2]>),
    /// Selects a shape, light or camera.
    Select(Option<Target>),
    /// Changes the scene.
    Edit(SceneEdit),
    /// What frames carry.
    SetView(ViewMode),
    /// Whether frames carry the photons of the last pass.
    ShowPhotons(bool),
    /// Whether probes are to carry paths of photons.
    ShowPaths(bool),
    /// The pixel that a person points at.
    Probe(Option<[u32; 2]>),
    /// Writes the render as it stands: an EXR and a PNG into a folder, such as `ring-001-p000016.exr`. The number counts runs.
    Snapshot(PathBuf),
    /// How the PNGs of snapshots show radiance from now on.
    SetLook(Look),
    /// Snapshots at powers of two, into a folder.
    AutoSnapshots(Option<PathBuf>),
    /// Keeps the pass in the history.
    Remember,
    /// Goes on from a pass of the history, by its number.
    ReturnTo(u64),
    /// Writes the kept passes of the render that one of them is of as a film into a new folder in this one.
    ExportFilm {
        /// The number of one of them.
        of: u64,
        /// Where the new folder goes.
        folder: PathBuf,
    },
    /// Turns the camera once around what it looks at, with a frame of a film for each step.
    Turntable {
        /// Steps of the way around.
        steps: std::num::NonZeroU32,
        /// Passes of each frame.
        passes: u64,
        /// Where the folder of the film goes.
        folder: PathBuf,
    },
    /// Gives the turntable up.
    EndTurntable,
    /// Writes the scene with its edits to a file.
    SaveScene(PathBuf),
    /// Writes the render to a checkpoint, and again every half minute and at the end, until it restarts.
    KeepCheckpoint(PathBuf),
    /// Goes on from a checkpoint of this scene and configuration, whole or by `foton render`.
    ResumeCheckpoint(PathBuf),
    /// Ends the engine's thread.
    Quit,
}

impl Command {
    /// Whether it ends with files on the disk.
    pub(super) const fn writes(&self) -> bool {
        matches!(self, Self::Snapshot(_) | Self::SaveScene(_) | Self::KeepCheckpoint(_))
    }

    /// Whether a camera that turns by itself is then somebody's else.
    pub(super) const fn ends_turntable(&self) -> bool {
        matches!(
            self,
            Self::Open(_)
                | Self::Configure(_)
                | Self::Restart
                | Self::ResumeCheckpoint(_)
                | Self::ReturnTo(_)
                | Self::EndTurntable
                | Self::Camera { .. }
                | Self::ResetCamera
                | Self::Edit(_)
        )
    }

    /// Whether a scene that is being built, or a small picture, would be for nothing.
    pub(super) const fn interrupts(&self) -> bool {
        matches!(
            self,
            Self::Configure(_)
                | Self::Restart
                | Self::ResumeCheckpoint(_)
                | Self::ReturnTo(_)
                | Self::Turntable { .. }
                | Self::EndTurntable
                | Self::Camera { .. }
                | Self::ResetCamera
                | Self::Choose(_)
                | Self::Select(_)
                | Self::Edit(_)
                | Self::Quit
        )
    }
}

/// What must not get lost when frames are skipped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// A scene was opened.
    Opened {
        /// Its name.
        name: String,
        /// What its file says without effect, and findings in the scene.
        warnings: Vec<String>,
    },
    /// Files were written.
    Saved(Vec<PathBuf>),
    /// The scene was written, and is that of the file from now on.
    SceneSaved(PathBuf),
    /// Something to know.
    Notice(String),
    /// Something that was asked for could not be done.
    Failed(String),
}
