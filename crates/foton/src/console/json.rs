//! What `--json` says of findings, emitters and the ledger.

use foton_format::Diagnostic;
use foton_integrator::{Ledger, NotFinite, Render};
use serde_json::{Value, json};

/// A value that was not finite, and where.
pub(super) fn not_finite(place: &NotFinite) -> Value {
    let [shape, material] = place.surface.clone().map_or([None, None], |names| names.map(Some));
    json!({
        "event": "not_finite", "pass": place.pass, "quantity": place.quantity.name(), "light": place.light,
        "shape": shape, "material": material, "position": place.position.to_array(),
    })
}

/// A finding with its place in a file.
pub(super) fn located(event: &str, d: &Diagnostic) -> Value {
    json!({ "event": event, "message": d.message, "file": d.file, "line": d.line, "column": d.column })
}

/// What each emitter's photons were good for.
pub(super) fn lights_json(render: &Render) -> Value {
    let lights = render.scene().emitters().iter().zip(render.light_use());
    lights
        .map(|(emitter, light)| {
            json!({
                "name": emitter.name, "photons": light.emitted, "reached": light.reached,
                "hit_rate": light.hit_rate(),
            })
        })
        .collect()
}

/// The ledger in watts: per photon, and back from scene units, in which areas carry the squared scale.
pub(super) fn ledger_json(ledger: &Ledger, photons: u64, scale: f64) -> Value {
    let watts = |sum: f64| sum / (photons.max(1) as f64 * scale * scale);
    json!({
        "emitted": watts(ledger.emitted),
        "absorbed": watts(ledger.absorbed),
        "escaped": watts(ledger.escaped),
        "roulette": watts(ledger.roulette),
        "truncated": watts(ledger.truncated),
        "shading_normals": watts(ledger.shading_normals),
        "shading_normals_gain": watts(ledger.shading_gain),
        "lost": watts(ledger.lost),
        "dropped_photons": ledger.dropped,
        "imbalance": ledger.imbalance(),
    })
}
