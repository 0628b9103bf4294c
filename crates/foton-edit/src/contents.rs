//! What a scene has, as a list for people: every shape, light and camera.

use foton_scene::description::SceneDescription;

use super::target::Target;
use super::{inspect, light, things};

/// A shape, light or camera in a list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Item {
    /// Which one it is.
    pub target: Target,
    /// Its name.
    pub name: String,
    /// What it is, in words.
    pub kind: String,
    /// Whether it emits light.
    pub is_light: bool,
    /// Whether a person has hidden it.
    pub is_hidden: bool,
}

/// All shapes that emit nothing, all lights, and all cameras; each kind in the order of the scene.
#[must_use]
pub fn contents(description: &SceneDescription) -> Vec<Item> {
    let item = |target, name: &str, kind: String, is_light| Item {
        target,
        name: name.to_owned(),
        kind,
        is_light,
        is_hidden: things::is_hidden(description, target),
    };
    let shapes = description.shapes.iter().enumerate().map(|(i, shape)| {
        item(Target::Shape(i), &shape.name, inspect::shape_kind(description, shape), shape.radiance.is_some())
    });
    let (lamps, surfaces): (Vec<Item>, Vec<Item>) = shapes.partition(|item| item.is_light);
    let emitters = description.emitters.iter().enumerate().map(|(i, emitter)| {
        item(Target::Emitter(i), &emitter.name, light::kind_name(&emitter.kind).to_owned(), true)
    });
    let sensors = description.sensors.iter().enumerate().map(|(i, sensor)| {
        let size = format!("camera, {} × {}", sensor.width, sensor.height);
        item(Target::Sensor(i), &sensor.name, size, false)
    });
    surfaces.into_iter().chain(lamps).chain(emitters).chain(sensors).collect()
}
