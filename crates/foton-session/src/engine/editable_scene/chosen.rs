//! What is chosen in a scene, and how it is being dragged.

use foton_edit::{DragPlane, Outline, Target, anchor};
use foton_math::glam::DVec3;
use foton_scene::description::SceneDescription;

/// What is chosen, and how it is being dragged.
pub(super) struct Chosen {
    pub(super) target: Target,
    pub(super) outline: Outline,
    /// From its middle to where it was picked, in world units: whatever moves it, a step back too, moves both.
    pub(super) grip: DVec3,
    pub(super) drag: Option<Drag>,
}

/// A drag under way.
pub(super) struct Drag {
    pub(super) plane: DragPlane,
    /// Where on the film it began.
    pub(super) from: [f64; 2],
}

impl Chosen {
    /// Where it was picked, now that the scene is as described.
    pub(super) fn picked(&self, description: &SceneDescription) -> DVec3 {
        anchor(description, self.target).unwrap_or_default() + self.grip
    }
}
