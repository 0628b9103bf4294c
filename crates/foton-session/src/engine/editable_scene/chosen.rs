//! What is selected in a scene, and how it is being dragged.

use foton_edit::{Outline, Pull, Target, anchor, name_of};
use foton_math::glam::DVec3;
use foton_scene::description::SceneDescription;

/// What is selected, and how it is being dragged.
pub(super) struct Chosen {
    pub(super) target: Target,
    /// Its name: what it is found by when the scene has other things.
    pub(super) name: String,
    pub(super) outline: Outline,
    /// From its middle to where it was picked, in world units: whatever moves it, a step back too, moves both.
    pub(super) grip: DVec3,
    pub(super) drag: Option<Drag>,
}

/// A drag under way.
pub(super) struct Drag {
    pub(super) pull: Pull,
    /// How far it is, in words.
    pub(super) words: String,
}

impl Chosen {
    /// A selection of something that was picked at a point, or from a list.
    pub(super) fn new(description: &SceneDescription, target: Target, picked: Option<DVec3>) -> Self {
        let middle = anchor(description, target).unwrap_or_default();
        Self {
            target,
            name: name_of(description, target).to_owned(),
            outline: Outline::new(description, target),
            grip: picked.map_or(DVec3::ZERO, |picked| picked - middle),
            drag: None,
        }
    }

    /// Where it was picked, now that the scene is as described.
    pub(super) fn picked(&self, description: &SceneDescription) -> DVec3 {
        anchor(description, self.target).unwrap_or_default() + self.grip
    }

    /// The same thing in another description; `None` where it is not there.
    pub(super) fn found_in(self, before: &SceneDescription, now: &SceneDescription) -> Option<Self> {
        let count = |d: &SceneDescription| match self.target {
            Target::Shape(_) => d.shapes.len(),
            Target::Emitter(_) => d.emitters.len(),
            Target::Sensor(_) => d.sensors.len(),
        };
        let all = (0..count(now)).map(|i| match self.target {
            Target::Shape(_) => Target::Shape(i),
            Target::Emitter(_) => Target::Emitter(i),
            Target::Sensor(_) => Target::Sensor(i),
        });
        // Where there are as many as before it may have another name.
        let same_place = Some(self.target).filter(|_| count(before) == count(now));
        let is_it = |target: &Target| name_of(now, *target) == self.name;
        let target = same_place.or_else(|| all.into_iter().find(is_it))?;
        let name = name_of(now, target).to_owned();
        let outline = Outline::new(now, target);
        Some(Self { target, name, outline, drag: None, ..self })
    }
}
