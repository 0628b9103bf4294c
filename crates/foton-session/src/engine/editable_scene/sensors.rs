//! Cameras as things of the scene: the history has which there are and how large their images are, and the view has where they stand.

use foton_edit::pick;
use foton_math::glam::DVec3;
use foton_scene::description::SensorDescription;

use super::EditableScene;

/// The sensors of a step of the history, standing where they stand now.
pub(super) fn standing(step: &[SensorDescription], now: &[SensorDescription]) -> Vec<SensorDescription> {
    let stands = |sensor: &SensorDescription, there: &SensorDescription| SensorDescription {
        to_world: there.to_world,
        fov_degrees: there.fov_degrees,
        lens: there.lens,
        ..sensor.clone()
    };
    if step.len() == now.len() {
        return step.iter().zip(now).map(|(sensor, there)| stands(sensor, there)).collect();
    }
    let found = |sensor: &SensorDescription| now.iter().find(|s| s.name == sensor.name);
    step.iter()
        .map(|sensor| found(sensor).map_or_else(|| sensor.clone(), |there| stands(sensor, there)))
        .collect()
}

impl EditableScene {
    /// The index of the camera of a name that had an index before.
    pub(in crate::engine) fn sensor_named(&self, name: &str, before: usize) -> usize {
        let at = |i: usize| self.sensors.get(i).is_some_and(|s| s.name == name);
        if at(before) {
            return before;
        }
        let found = self.sensors.iter().position(|s| s.name == name);
        found.unwrap_or_else(|| before.min(self.sensors.len().saturating_sub(1)))
    }

    /// How far along a camera's z lies what is seen at a film position, in world units.
    pub(super) fn depth_at(&self, sensor: usize, film: [f64; 2]) -> Option<f64> {
        let to_world = &self.sensors.get(sensor)?.to_world;
        let seen = pick(&self.scene, sensor, film)?;
        let forward = to_world.matrix3.z_axis.normalize();
        Some((DVec3::from(seen.position) - to_world.translation).dot(forward))
    }

    /// Half the diagonal of what the scene's surfaces take up, in world units.
    pub(super) fn radius(&self) -> f64 {
        self.scene.normalisation().world_length(f64::from(self.scene.bounds().radius()))
    }

    /// Puts a camera where the file has it. One that no file has stays.
    pub(super) fn reset_sensor(&mut self, sensor: usize) {
        let Some(now) = self.sensors.get_mut(sensor) else { return };
        let same = self.opened_sensors.iter().find(|s| s.name == now.name);
        if let Some(opened) = same.or_else(|| self.opened_sensors.get(sensor)) {
            now.to_world = opened.to_world;
            now.fov_degrees = opened.fov_degrees;
            now.lens = opened.lens;
        }
    }
}
