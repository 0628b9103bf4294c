//! A log of what was drawn and when, one JSON object a line: for measuring, and for scripts that drive the window.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use foton_film::{WriteError, create_log};
use foton_session::engine::{Frame, Picture};
use serde_json::{Value, json};

use crate::state::State;

/// How every line begins.
const BEGINS: &str = "{\"event\":\"";

pub(super) struct FrameLog {
    file: BufWriter<File>,
    start: Instant,
    places: Value,
}

impl FrameLog {
    /// Begins a log; only one of before is replaced.
    pub(super) fn create(path: &Path) -> Result<Self, WriteError> {
        let file = BufWriter::new(create_log(path, BEGINS)?);
        Ok(Self { file, start: Instant::now(), places: Value::Null })
    }

    /// A line; a disk that is full ends the log, not the render.
    fn line(&mut self, value: &Value) {
        let _ = writeln!(self.file, "{value}");
        let _ = self.file.flush();
    }

    fn now(&self) -> f64 {
        self.start.elapsed().as_secs_f64() * 1e3
    }

    /// What the adapter is.
    pub(super) fn adapter(&mut self, name: &str, is_software: bool) {
        let at = self.now();
        self.line(&json!({ "event": "adapter", "ms": at, "name": name, "software": is_software }));
    }

    /// A frame on the screen: how long it took to make, and how long after the first input that it answers.
    pub(super) fn drawn(&mut self, state: &State, took: Duration, since_input: Option<Duration>) {
        let at = self.now();
        let milliseconds = |d: Duration| d.as_secs_f64() * 1e3;
        let mut line = json!({
            "event": "drawn",
            "ms": at,
            "took_ms": milliseconds(took),
            "input_ms": since_input.map(milliseconds),
        });
        if let Some(frame) = &state.frame {
            line["frame"] = describe(frame);
        }
        self.line(&line);
        let places: serde_json::Map<String, Value> = state
            .places
            .iter()
            .map(|(name, r)| (name.clone().into_owned(), json!([r.min.x, r.min.y, r.width(), r.height()])))
            .collect();
        let places = Value::Object(places);
        if places != self.places {
            self.line(&json!({ "event": "places", "ms": at, "places": places }));
            self.places = places;
        }
    }

    /// A message to the person.
    pub(super) fn message(&mut self, is_error: bool, text: &str) {
        let at = self.now();
        self.line(&json!({ "event": if is_error { "error" } else { "notice" }, "ms": at, "message": text }));
    }

    /// The window was asked to close.
    pub(super) fn closing(&mut self) {
        let at = self.now();
        self.line(&json!({ "event": "closing", "ms": at }));
    }
}

fn describe(frame: &Frame) -> Value {
    let n = &frame.stats;
    let mut line = json!({
        "number": frame.number,
        "render": frame.render,
        "pictured": frame.pictured,
        "activity": format!("{:?}", frame.activity).to_lowercase(),
        "pass": n.passes,
        "photons": n.photons,
        "seconds": n.elapsed.as_secs_f64(),
        "photons_per_s": n.photons_per_s,
        "alpha": frame.settings.ppm.alpha.get(),
        "photons_per_pass": frame.settings.ppm.photons_per_pass,
        "size": frame.size,
        "picture": frame.picture.as_ref().map(Picture::size),
        "bytes": n.bytes,
        "kept_bytes": frame.kept_bytes,
        "scene": frame.scene.name,
        "edited": frame.scene.is_edited,
        "shapes": frame.scene.shapes,
    });
    if let Some(probe) = &frame.probe {
        line["probe"] = json!({
            "pixel": probe.pixel,
            "radiance": [probe.radiance.r, probe.radiance.g, probe.radiance.b],
            "surface": probe.surface.as_ref().map(|names| [&names.shape, &names.material]),
        });
    }
    if let Some(selection) = &frame.selection {
        line["chosen"] = json!(selection.inspection.title);
        line["material"] = json!(selection.inspection.material.as_ref().map(|material| &material.name));
    }
    line
}
