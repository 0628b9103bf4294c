//! Which parts of a scene something uses: what is wrong with the others changes no image.

use std::collections::HashSet;

use crate::diagnostic::Place;
use crate::mitsuba::document::{Document, NodeId};
use crate::mitsuba::read::ids::Ids;

/// Tags of what has an effect only where something refers to it.
const REFERRED: [&str; 6] = ["bsdf", "texture", "spectrum", "medium", "phase", "volume"];

/// Where each part of the scene begins, and whether it has an effect of its own or something that has one refers to it, maybe by
/// way of others. All parts of a scene without shapes count: it is one that others include.
pub(crate) fn parts(document: &Document, ids: &Ids<'_>) -> Vec<(Place, bool)> {
    let parts: Vec<_> = document.elements_in(document.root()).collect();
    let is_fragment = parts.iter().all(|(_, e)| e.name != "shape");
    let mut open: Vec<NodeId> =
        parts.iter().filter(|(_, e)| !REFERRED.contains(&e.name.as_str())).map(|(node, _)| *node).collect();
    let mut used: HashSet<NodeId> = open.iter().copied().collect();
    while let Some(node) = open.pop() {
        for (child, element) in document.elements_in(node) {
            let target = (element.name == "ref").then(|| ids.target(element)).flatten();
            for next in [Some(child), target].into_iter().flatten() {
                if used.insert(next) {
                    open.push(next);
                }
            }
        }
    }
    parts.iter().map(|(node, element)| (element.place, is_fragment || used.contains(node))).collect()
}
