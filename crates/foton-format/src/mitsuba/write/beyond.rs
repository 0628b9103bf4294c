//! What a scene has that Mitsuba 3 does not: it is written in words of our own or of Mitsuba 0.6, which foton reads back.

use foton_scene::description::{Coating, EmitterKind, Filter, SceneDescription, SensorDescription};
use foton_scene::plugins::sensors;

/// What Mitsuba 3 will not make of a scene that is written, a sentence each; nothing is said twice.
#[must_use]
pub fn beyond_mitsuba_3(scene: &SceneDescription) -> Vec<String> {
    let mut said = materials(scene);
    if !scene.motion.is_still() {
        said.push(
            "what moves is written with its keyframes: Mitsuba 3 has no motion and will refuse the file"
                .to_owned(),
        );
    }
    if scene.hidden != foton_scene::description::Hidden::default() {
        said.push("what is hidden is marked as such for foton: Mitsuba 3 will show it".to_owned());
    }
    let is_wide = |filter: Filter| matches!(filter, Filter::Box { radius } if radius != 0.5);
    if scene.sensors.iter().any(|sensor| is_wide(sensor.filter)) {
        said.push("box filters become half a pixel wide to each side: Mitsuba 3 has no others".to_owned());
    }
    if scene.sensors.iter().any(|sensor| sensors::of(sensor) == sensors::TELECENTRIC) {
        said.push(
            "an orthographic camera with a lens is written as the \"telecentric\" of Mitsuba 0.6: Mitsuba 3 has none and will \
             refuse the file"
                .to_owned(),
        );
    }
    if scene.emitters.iter().any(|e| matches!(e.kind, EmitterKind::Goniometric { .. })) {
        said.push(
            "a measured lamp is written as \"goniometric\": Mitsuba 3 has none and will refuse the file"
                .to_owned(),
        );
    }
    let misses_middle = |sensor: &&SensorDescription| sensor.principal_point_offset != [0.0; 2];
    if scene.sensors.iter().filter(misses_middle).any(|sensor| sensors::of(sensor) != sensors::PERSPECTIVE) {
        said.push(
            "a camera without perspective or with a lens has a \"principal_point_offset\": Mitsuba 3 takes that of a \
             \"perspective\" alone and will refuse the file"
                .to_owned(),
        );
    }
    said
}

/// Materials that Mitsuba 3 does not have, once for each plugin.
fn materials(scene: &SceneDescription) -> Vec<String> {
    let mut said: Vec<(&str, String)> = Vec::new();
    for material in &scene.materials {
        let name = &material.name;
        let mut say = |plugin: &'static str, how: &str, what: &str| {
            if said.iter().all(|(known, _)| *known != plugin) {
                let message = format!(
                    "the material \"{name}\" is written {how} of Mitsuba 0.6: Mitsuba 3 does not have {what} and will refuse the file"
                );
                said.push((plugin, message));
            }
        };
        for plugin in material.coatings.iter().flatten().map(Coating::plugin) {
            say(plugin, &format!("with a \"{plugin}\""), "such a plugin");
        }
        for bsdf in [Some(material.front), material.back].into_iter().flatten() {
            if !bsdf.is_of_mitsuba_3() {
                let (plugin, is_known) = (bsdf.plugin(), bsdf.info().is_of_mitsuba_3);
                let what = if is_known { "microfacets of Phong" } else { "such a plugin" };
                say(plugin, &format!("as \"{plugin}\""), what);
            }
        }
    }
    said.into_iter().map(|(_, message)| message).collect()
}
