//! `<animation>`: transforms at times, as in Mitsuba 0.6.

use foton_scene::description::Keyframes;

use crate::diagnostic::Report;
use crate::mitsuba::document::{Document, NodeId};
use crate::mitsuba::read::attributes::{check_attributes, parse_attribute};
use crate::mitsuba::read::{transform, values};

/// The keyframes inside an `<animation>`: transforms with a `time` each, in any order.
pub(crate) fn read(document: &Document, node: NodeId, report: &mut Report) -> Option<Keyframes> {
    let place = document.element(node).map_or_else(Default::default, |e| e.place);
    let mut keyframes = Vec::new();
    let mut is_sound = true;
    for (child, element) in document.elements_in(node) {
        if element.name != "transform" {
            report.error(element.place, "an <animation> holds <transform time=\"…\"> and nothing else");
            return None;
        }
        let time = check_attributes(element, &["time"], &[], report)
            .then(|| element.attribute("time"))
            .flatten()
            .and_then(|time| parse_attribute(time, values::number, report));
        let found = time.zip(transform::read(document, child, report));
        is_sound &= found.is_some();
        keyframes.extend(found);
    }
    if !is_sound {
        return None;
    }
    if keyframes.is_empty() {
        report.error(place, "an <animation> needs a <transform time=\"…\">");
        return None;
    }
    keyframes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let read = Keyframes::new(keyframes);
    if read.is_none() {
        report.error(
            place,
            "the transforms of an <animation> have times that differ, and neither shear nor mirror",
        );
    }
    read
}
