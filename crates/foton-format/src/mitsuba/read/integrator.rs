//! `<integrator>`: any will do. What it says about path lengths counts, and what photon mapping can use is suggested.

use crate::mitsuba::document::NodeId;
use crate::mitsuba::read::properties::{Located, Properties};
use crate::mitsuba::read::reader::Reader;
use crate::suggested::Suggested;

impl Reader<'_> {
    /// The innermost integrator counts where they nest.
    pub(crate) fn integrator(&mut self, node: NodeId) {
        let mut p = self.properties(node, "integrator");
        if let Some(depth) = p.integer("max_depth", &mut self.report) {
            match u32::try_from(depth.value) {
                Ok(bound) => self.description.max_depth = Some(bound),
                Err(_) if depth.value == -1 => self.description.max_depth = None,
                Err(_) => {
                    self.report.error(depth.place, "\"max_depth\" must be -1 (no bound), 0 or more");
                }
            }
        }
        if let Some(hide) = p.boolean("hide_emitters", &mut self.report).filter(|hide| hide.value) {
            self.report.warning(hide.place, "\"hide_emitters\" is not supported, emitters stay visible");
        }
        let plugin = self.document.element(node).and_then(|e| e.attribute("type"));
        if plugin.is_some_and(|t| matches!(t.value.as_str(), "sppm" | "ppm")) {
            self.suggestions(&mut p);
        }
        p.ignore(&["rr_depth"]);
        for inner in p.nested("integrator").into_iter().filter(|inner| inner.node > node) {
            self.integrator(inner.node);
        }
        p.finish_leniently(&mut self.report);
    }

    fn suggestions(&mut self, p: &mut Properties<'_>) {
        let photons_per_pass = self.count(p, "photon_count", false);
        let passes = self.count(p, "max_passes", true);
        let radius = p.number("initial_radius", &mut self.report);
        if let Some(radius) = radius.filter(|r| r.value < 0.0) {
            self.report
                .error(radius.place, "\"initial_radius\" must be above zero, or zero for a good guess");
        }
        let alpha = p.number("alpha", &mut self.report);
        if let Some(alpha) = alpha.filter(|a| !(a.value > 0.0 && a.value <= 1.0)) {
            self.report.error(alpha.place, "\"alpha\" must be above 0 and at most 1");
        }
        self.suggested = Suggested {
            photons_per_pass,
            radius: radius.map(|r| r.value).filter(|r| *r > 0.0),
            alpha: alpha.map(|a| a.value),
            passes,
        };
    }

    /// A whole number from 1; −1 says that there is none where that is allowed.
    fn count(&mut self, p: &mut Properties<'_>, name: &'static str, unbounded: bool) -> Option<u32> {
        let Located { value, place } = p.integer(name, &mut self.report)?;
        match u32::try_from(value) {
            Ok(count @ 1..) => return Some(count),
            Err(_) if value == -1 && unbounded => {}
            _ => self.report.error(place, format!("\"{name}\" must lie between 1 and {}", u32::MAX)),
        }
        None
    }
}
