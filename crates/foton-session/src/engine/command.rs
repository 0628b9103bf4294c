//! What a window may ask of the engine, and what the engine says beside frames.

use std::path::PathBuf;

use foton_integrator::{Change, DirectLight, Settings};
use foton_math::glam::DAffine3;

use crate::stop::StopRule;

/// A scene to open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// One that ships with the program, by its name.
    BuiltIn(String),
    /// A file.
    File(PathBuf),
}

/// What starts a render anew when it changes. The rest of [`Settings`] changes between passes.
#[derive(Clone, Debug, PartialEq)]
pub struct Configuration {
    /// First radius in world units; `None`: from the pixel's footprint.
    pub radius: Option<f64>,
    /// How direct light is estimated.
    pub direct_light: DirectLight,
    /// Eye samples a pixel.
    pub samples_per_pixel: std::num::NonZeroU32,
    /// The seed of all random streams.
    pub seed: u64,
    /// Index of the sensor.
    pub sensor: usize,
    /// Whether direct, caustic and indirect light are kept apart.
    pub layers: bool,
    /// Longest path in edges; `None`: what the scene says.
    pub max_depth: Option<u32>,
    /// Threads; `None`: as many as the machine has.
    pub threads: Option<usize>,
}

impl Configuration {
    /// What these settings say.
    #[must_use]
    pub fn of(settings: &Settings, threads: Option<usize>) -> Self {
        Self {
            radius: settings.radius,
            direct_light: settings.direct_light,
            samples_per_pixel: settings.samples_per_pixel,
            seed: settings.seed,
            sensor: settings.sensor,
            layers: settings.layers,
            max_depth: settings.max_depth,
            threads,
        }
    }

    /// Settings with this configuration.
    pub(super) fn apply(&self, settings: &mut Settings) {
        settings.radius = self.radius;
        settings.direct_light = self.direct_light;
        settings.samples_per_pixel = self.samples_per_pixel;
        settings.seed = self.seed;
        settings.sensor = self.sensor;
        settings.layers = self.layers;
        settings.max_depth = self.max_depth;
    }
}

/// Where the camera is and what it spans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Camera to world, as in a scene file: it looks along +z, +y is up, +x points to the image's left.
    pub to_world: DAffine3,
    /// Field of view in degrees along the sensor's own axis.
    pub fov_degrees: f64,
}

/// The picture that frames carry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// All radiance.
    Radiance,
    /// Reflected light of some path classes, in their order, and emitters; the render must keep classes apart.
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
}

/// What a window may ask.
#[derive(Clone, Debug)]
pub enum Command {
    /// Opens a scene; the present one goes on until it is there.
    Open(Source),
    /// Forgets a scene that is being opened.
    CancelOpen,
    /// From the next pass on.
    Change(Change),
    /// Starts anew.
    Configure(Configuration),
    /// Finishes the pass under way and waits.
    Pause,
    /// Goes on.
    Resume,
    /// One pass, then waits.
    Step,
    /// Starts anew with the same settings.
    Restart,
    /// When to stop.
    StopAt(StopRule),
    /// Moves the camera; while `moving`, pictures are small and quick.
    Look {
        /// Where to.
        look: Look,
        /// Whether more is to follow at once.
        moving: bool,
    },
    /// Puts the camera back where the scene's file has it.
    ResetLook,
    /// What frames carry.
    Show(Shown),
    /// Whether frames carry the photons of the last pass.
    ShowPhotons(bool),
    /// The pixel that a person points at.
    Probe(Option<[u32; 2]>),
    /// Writes the render as it stands: an EXR and a PNG into a folder, under the next free number.
    Snapshot(PathBuf),
    /// Snapshots at powers of two, into a folder.
    AutoSnapshots(Option<PathBuf>),
    /// Writes the scene with its edits to a file.
    SaveScene(PathBuf),
    /// Ends the engine's thread.
    Quit,
}

impl Command {
    /// Whether the pass under way would be for nothing.
    pub(super) const fn interrupts(&self) -> bool {
        matches!(
            self,
            Self::Configure(_) | Self::Restart | Self::Look { .. } | Self::ResetLook | Self::Quit
        )
    }
}

/// What must not get lost when frames are skipped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// A scene was opened; what its file says without effect.
    Opened {
        /// Its name.
        name: String,
        /// Findings, each with its place.
        warnings: Vec<String>,
    },
    /// Files were written.
    Saved(Vec<PathBuf>),
    /// Something to know.
    Notice(String),
    /// Something that was asked for could not be done.
    Failed(String),
}
