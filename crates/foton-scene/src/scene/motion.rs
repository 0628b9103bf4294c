//! A scene of which something moves, at one time after the other.

use std::sync::Arc;

use foton_math::glam::DVec3;
use foton_math::{Cancel, Cancelled};

use super::Scene;
use crate::build::{BuildError, BuildOptions};
use crate::description::{SceneDescription, SensorDescription};

/// What it takes to build a scene at another time.
pub(crate) struct Moving {
    pub(crate) description: SceneDescription,
    /// Of the world at all times, so that scene units are the same.
    pub(crate) bounds: (DVec3, DVec3),
}

impl Scene {
    /// Whether anything that a sensor sees moves while its shutter is open.
    #[must_use]
    pub fn blurs(&self, sensor: usize) -> bool {
        self.moving.as_ref().is_some_and(|moving| moving.description.motion.blurs(sensor))
    }

    /// The scene as it is after a share, from 0 to 1, of the time that a sensor's shutter is open; itself where nothing moves. Shapes,
    /// materials and emitters have the same indices, and scene units are the same.
    ///
    /// # Errors
    /// When cancelled.
    pub fn after_share_of_shutter(
        self: &Arc<Self>,
        sensor: usize,
        share: f64,
        cancel: &Cancel,
    ) -> Result<Arc<Self>, Cancelled> {
        let Some(moving) = self.moving.as_ref().filter(|_| self.blurs(sensor)) else {
            return Ok(Arc::clone(self));
        };
        let [open, close] = moving.description.motion.shutter(sensor);
        let now = moving.description.at(open + share * (close - open));
        let options = BuildOptions { cancel: cancel.clone(), ..BuildOptions::default() };
        match self.build_at_another_time(&now, moving.bounds, &options) {
            Ok(scene) => Ok(Arc::new(Self { moving: self.moving.clone(), ..scene })),
            // What could be built once can be built anywhere on its way.
            Err(BuildError::Cancelled(cancelled)) => Err(cancelled),
            Err(_) => Ok(Arc::clone(self)),
        }
    }

    /// What moves, seen by other sensors.
    pub(crate) fn moving_with(&self, sensors: &[SensorDescription]) -> Option<Arc<Moving>> {
        let moving = self.moving.as_ref()?;
        let description = SceneDescription { sensors: sensors.to_vec(), ..moving.description.clone() };
        Some(Arc::new(Moving { description, bounds: moving.bounds }))
    }
}
