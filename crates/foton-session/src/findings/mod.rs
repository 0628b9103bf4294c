//! Findings: what a person should know of a scene or a render and cannot read off its image. The console prints them and the
//! window displays them; what stops a render is an error and is not here.

mod render;
mod scene;
#[cfg(test)]
mod tests;

pub use render::{MIN_CUT_OFF, above_goal, of_emitters, of_ledger, of_render, of_settings};
pub use scene::{of_scene, without_light};

/// What a finding is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FindingKind {
    /// Triangles without area were left out.
    DegenerateTriangles,
    /// A shape is so small where it stands that single precision rounds it.
    RoundedShape,
    /// A camera, a surface or an emitter is far away from the rest.
    FarAway,
    /// A shape hides another that lies exactly in it.
    HiddenShape,
    /// Nothing emits light.
    NoEmitter,
    /// Eye paths follow narrow glossy lobes in directions chosen once.
    NarrowGloss,
    /// Caustics of delta emitters on narrow gloss come as photons.
    NarrowCaustics,
    /// The method finds no light on some paths of the scene.
    LightMissed,
    /// The method cannot tell how wrong its image is.
    ErrorUnknown,
    /// The method shows no motion blur.
    MotionFrozen,
    /// The first radius is larger than the scene.
    RadiusBeyondScene,
    /// Few photons of an emitter reach what is seen.
    StarvedEmitter,
    /// Power was cut off at the longest path.
    PowerCutOff,
    /// Eye paths were dropped because their weight was not finite.
    EyePathsDropped,
    /// Photons were dropped because their power was not finite.
    PhotonsDropped,
    /// The radius floor leaves a bias above the error that the render is to reach.
    RadiusFloorAboveGoal,
}

impl FindingKind {
    /// Whether it is a property of the method, which is not to be repaired, rather than a warning.
    #[must_use]
    pub const fn is_note(self) -> bool {
        matches!(self, Self::NarrowGloss | Self::NarrowCaustics | Self::ErrorUnknown)
    }
}

/// Something that a person should know.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// What it is about.
    pub kind: FindingKind,
    /// Name of the shape, emitter, material or camera where it was found, if it is a single one.
    pub place: Option<String>,
    /// A sentence, without a full stop.
    pub text: String,
}

impl Finding {
    fn new(kind: FindingKind, place: Option<&str>, text: impl Into<String>) -> Self {
        Self { kind, place: place.map(str::to_owned), text: text.into() }
    }
}

/// How a program calls the settings that findings recommend.
#[derive(Clone, Copy, Debug)]
pub struct SettingNames {
    /// The first radius.
    pub radius: &'static str,
    /// The radius floor.
    pub radius_floor: &'static str,
    /// Eye samples a pixel.
    pub eye_samples: &'static str,
    /// The longest path.
    pub max_depth: &'static str,
}

impl SettingNames {
    /// Options of the command line.
    pub const OPTIONS: Self = Self {
        radius: "--radius",
        radius_floor: "--radius-floor",
        eye_samples: "--spp",
        max_depth: "--max-depth",
    };

    /// Controls of the window. It has none for the longest path, which the scene file sets.
    pub const CONTROLS: Self = Self {
        radius: "First radius",
        radius_floor: "Smallest radius",
        eye_samples: "Samples/pixel",
        max_depth: "Max depth",
    };
}
