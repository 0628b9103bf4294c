//! Findings in a scene, before it is rendered.

use foton_input::quoted;
use foton_scene::Scene;

use super::{Finding, FindingKind};

/// A shape that is fewer steps of single precision across is worth a warning: its outline is off by a hundredth of its size.
const MIN_STEPS: f32 = 100.0;

/// What a scene as seen by a sensor has too small, too far away or hidden.
#[must_use]
pub fn of_scene(scene: &Scene, sensor: usize) -> Vec<Finding> {
    let mut findings = Vec::new();
    let census = scene.census();
    if census.degenerate_triangles > 0 {
        let text = format!("left out {} triangles without area", census.degenerate_triangles);
        findings.push(Finding::new(FindingKind::DegenerateTriangles, None, text));
    }
    for shape in scene.shapes().iter().filter(|s| s.steps_across < MIN_STEPS) {
        let text = format!(
            "{} is only {:.0} steps of single precision across, so small is it where it stands: its shape is rounded to those",
            quoted(&shape.name),
            shape.steps_across
        );
        findings.push(Finding::new(FindingKind::RoundedShape, Some(&shape.name), text));
    }
    for far in scene.far_things(sensor) {
        findings.push(Finding::new(FindingKind::FarAway, Some(&far.name), far.to_string()));
    }
    for pair in scene.hidden_shapes() {
        let [over, under] = pair.map(|shape| &scene.shapes()[shape as usize].name);
        let text = format!(
            "{} lies exactly in {}, which hides it there: what is opaque counts before masks, then the first in the file",
            quoted(under),
            quoted(over)
        );
        findings.push(Finding::new(FindingKind::HiddenShape, Some(under), text));
    }
    findings.extend(without_light(scene));
    findings
}

/// That nothing in a scene emits light, if so.
#[must_use]
pub fn without_light(scene: &Scene) -> Option<Finding> {
    let text = "nothing in the scene emits light: the image will be black";
    (scene.census().emitters == 0).then(|| Finding::new(FindingKind::NoEmitter, None, text))
}
