//! Returning to a scene as it was.

use std::sync::Arc;

use foton_scene::description::{Crop, SceneDescription, SensorDescription};

use super::{EditableScene, Effect};

impl EditableScene {
    /// The description with its edits, and the sensors as the file has them.
    pub(in crate::engine) const fn edited(&self) -> &Arc<SceneDescription> {
        self.history.current()
    }

    /// Makes a description that was [`EditableScene::edited`] once the present one again, with sensors and region as they were then. By
    /// undoing and redoing where that leads there, else as a step that can be undone.
    pub(in crate::engine) fn return_to(
        &mut self,
        description: &Arc<SceneDescription>,
        sensors: Vec<SensorDescription>,
        region: Option<(usize, Crop)>,
    ) -> Result<Effect, String> {
        if !self.steps_to(description) {
            self.history.record("return", SceneDescription::clone(description));
        }
        self.chosen = None;
        self.moved = None;
        self.sensors = sensors;
        self.region = region;
        self.rebuild()
    }

    /// Puts all cameras where they were.
    pub(in crate::engine) fn put_back(&mut self, sensors: Vec<SensorDescription>) -> Result<Effect, String> {
        self.moved = None;
        self.sensors = sensors;
        self.renew_sensors()
    }

    /// Undoes, or redoes, until a description is there; where none is, all is as it was.
    fn steps_to(&mut self, description: &Arc<SceneDescription>) -> bool {
        let mut undone = 0;
        while !Arc::ptr_eq(self.history.current(), description) && self.history.undo().is_some() {
            undone += 1;
        }
        let mut redone = 0;
        while !Arc::ptr_eq(self.history.current(), description) && self.history.redo().is_some() {
            redone += 1;
        }
        if Arc::ptr_eq(self.history.current(), description) {
            return true;
        }
        (undone..redone).for_each(|_| drop(self.history.undo()));
        false
    }
}
