//! The scene of the description as it is edited: built at once, or later where that was given up for something newer.

use std::sync::Arc;

use foton_integrator::Cancel;
use foton_scene::description::SceneDescription;
use foton_scene::{BuildError, BuildOptions, Scene};

use super::sensors::standing;
use super::{EditableScene, Effect};

/// Scenes of fewer surfaces are built before anyone could give that up.
const QUICK: usize = 10_000;

impl EditableScene {
    /// Makes `next` the description under edit, unless no scene can be made of it.
    pub(super) fn take(&mut self, next: SceneDescription) -> Result<Effect, String> {
        let built = self.scene_of(&next, &self.cancels.work)?;
        self.history.proceed(next);
        self.refresh();
        self.renew(built);
        Ok(Effect::Restart)
    }

    /// The scene of a description with the sensors as they are; `None` where building it was given up.
    fn scene_of(&self, description: &SceneDescription, cancel: &Cancel) -> Result<Option<Scene>, String> {
        let description = &SceneDescription { sensors: self.rendered_sensors(), ..description.clone() };
        let is_quick = description.primitives_to_build() < QUICK;
        let cancel = if is_quick { Cancel::default() } else { cancel.clone() };
        match self.scene.rebuild(description, &BuildOptions { cancel, ..BuildOptions::default() }) {
            Ok(scene) => Ok(Some(scene)),
            Err(BuildError::Cancelled(_)) => Ok(None),
            Err(cause) => Err(cause.to_string()),
        }
    }

    /// The scene is now that of the history's description, if it was built.
    fn renew(&mut self, built: Option<Scene>) {
        self.is_stale = built.is_none();
        if let Some(scene) = built {
            self.scene = Arc::new(scene);
            self.built = Arc::clone(self.history.current());
        }
    }

    /// Whether building the scene of an edit was given up: [`EditableScene::freshen`] does it.
    pub(in crate::engine) const fn is_stale(&self) -> bool {
        self.is_stale
    }

    /// Builds the scene of an edit, if that was given up before. Whether there is one, or else it was given up again.
    ///
    /// # Errors
    /// When no scene can be made of it: edits since the last one of which one was made are then taken back.
    pub(in crate::engine) fn freshen(&mut self) -> Result<bool, String> {
        let message = match self.build(&self.cancels.work.clone()) {
            Ok(()) => return Ok(!self.is_stale),
            Err(message) => message,
        };
        while !Arc::ptr_eq(self.history.current(), &self.built) && self.history.undo().is_some() {}
        self.rebuild()?;
        Err(message)
    }

    /// Builds the scene of the description as it is, unless that is given up.
    pub(super) fn build(&mut self, cancel: &Cancel) -> Result<(), String> {
        let built = self.scene_of(&self.description, cancel)?;
        self.renew(built);
        Ok(())
    }

    /// The scene of the history's description, whose cameras stand where they stand now.
    pub(super) fn rebuild(&mut self) -> Result<Effect, String> {
        let now = standing(&self.history.current().sensors, &self.sensors);
        if now.len() != self.sensors.len() {
            self.moved = None;
        }
        self.sensors = now;
        let before = Arc::clone(&self.description);
        self.refresh();
        self.chosen = self.chosen.take().and_then(|chosen| chosen.found_in(&before, &self.description));
        self.build(&self.cancels.work.clone())?;
        Ok(Effect::Restart)
    }
}
