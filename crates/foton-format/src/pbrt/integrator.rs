//! The directive `Integrator`: how long paths may be, and what a photon mapper asks for.

use foton_input::quoted;

use super::parameters::Parameters;
use super::reader::Reader;
use crate::spelling::did_you_mean;
use crate::suggested::Suggested;

/// Integrators of both versions.
const INTEGRATORS: [&str; 15] = [
    "path",
    "volpath",
    "sppm",
    "bdpt",
    "mlt",
    "directlighting",
    "whitted",
    "ao",
    "ambientocclusion",
    "simplepath",
    "simplevolpath",
    "lightpath",
    "randomwalk",
    "photonmap",
    "function",
];

/// pbrt's default of `maxdepth`.
const MAX_DEPTH: i64 = 5;
/// The share of new photons that a hit point keeps in pbrt.
const ALPHA: f64 = 2.0 / 3.0;

impl Reader<'_> {
    pub(crate) fn integrator(&mut self, p: &Parameters) {
        if !INTEGRATORS.contains(&p.plugin.as_str()) {
            let hint = did_you_mean(&p.plugin, INTEGRATORS);
            self.report.warning(p.place, format!("unknown integrator {}{hint}", quoted(&p.plugin)));
            p.ignore_rest();
            return;
        }
        let depth = p.integer("maxdepth", &mut self.report).map_or(MAX_DEPTH, |d| d.value.clamp(0, 100_000));
        // A bounce more has an edge more; a photon mapper's paths have as many again from the light.
        let edges = if p.plugin == "sppm" { 2 * depth } else { depth + 1 };
        self.description.max_depth = u32::try_from(edges.max(1)).ok();
        if p.plugin == "sppm" {
            let iterations = if p.has("numiterations") { "numiterations" } else { "iterations" };
            let report = &mut self.report;
            let count = |found: Option<crate::mitsuba::read::properties::Located<i64>>| {
                found.and_then(|n| u32::try_from(n.value).ok()).filter(|n| *n > 0)
            };
            self.suggested = Suggested {
                photons_per_pass: count(p.integer("photonsperiteration", report)),
                radius: Some(p.above_zero("radius", 1.0, report)),
                alpha: Some(ALPHA),
                passes: count(p.integer(iterations, report))
                    .or((self.version == super::version::Version::Three).then_some(64)),
            };
            p.ignore(&["imagewritefrequency", "seed"]);
            p.finish(&mut self.report);
        }
        // What is left of other integrators is about sampling.
        p.ignore_rest();
    }
}
