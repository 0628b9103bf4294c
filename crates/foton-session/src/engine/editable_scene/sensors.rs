//! Cameras as things of the scene: the history has which there are and how large their images are, and the view has where they stand.

use foton_scene::description::SensorDescription;

use super::EditableScene;

/// The sensors of a step of the history, standing where they stand now.
pub(super) fn standing(step: &[SensorDescription], now: &[SensorDescription]) -> Vec<SensorDescription> {
    let stands = |sensor: &SensorDescription, there: &SensorDescription| SensorDescription {
        to_world: there.to_world,
        fov_degrees: there.fov_degrees,
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

    /// Puts a camera where the file has it. One that no file has stays.
    pub(super) fn reset_sensor(&mut self, sensor: usize) {
        let Some(now) = self.sensors.get_mut(sensor) else { return };
        let same = self.opened_sensors.iter().find(|s| s.name == now.name);
        if let Some(opened) = same.or_else(|| self.opened_sensors.get(sensor)) {
            now.to_world = opened.to_world;
            now.fov_degrees = opened.fov_degrees;
        }
    }
}
