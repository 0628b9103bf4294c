//! Elements by their `id`, and references to them.
//!
//! As in Mitsuba 3, an id may be referred to before its element, from anywhere, and belongs to one element only.

use std::collections::HashMap;

use crate::diagnostic::Report;
use crate::document::{Document, Element, NodeId};
use crate::names::did_you_mean;
use crate::properties::check_attributes;

/// All elements of a document that have an id.
pub(crate) struct Ids<'a> {
    elements: HashMap<&'a str, (NodeId, &'a Element)>,
}

impl<'a> Ids<'a> {
    /// Collects ids; an id used twice is an error.
    pub(crate) fn collect(document: &'a Document, report: &mut Report) -> Self {
        let mut elements: HashMap<&str, (NodeId, &Element)> = HashMap::new();
        for (node, element) in document.elements().filter(|(_, e)| e.name != "ref") {
            let Some(id) = element.attribute("id").filter(|id| !id.broken) else { continue };
            if let Some((_, first)) = elements.get(id.value.as_str()) {
                let line = first.place.line;
                report.error(id.value_place, format!("the id \"{}\" is taken since line {line}", id.value));
            } else {
                elements.insert(&id.value, (node, element));
            }
        }
        Self { elements }
    }

    /// The element that a `<ref>` means.
    pub(crate) fn follow(&self, reference: &Element, report: &mut Report) -> Option<(NodeId, &'a Element)> {
        if !check_attributes(reference, &["id"], &["name"], report) {
            return None;
        }
        let id = reference.attribute("id").filter(|id| !id.broken)?;
        let found = self.elements.get(id.value.as_str()).copied();
        if found.is_none() {
            // A library of materials that is not there at all must not take minutes to report.
            let known = self.elements.keys().copied().filter(|_| self.elements.len() <= 1000);
            let mut known: Vec<_> = known.collect();
            known.sort_unstable();
            let hint = did_you_mean(&id.value, known);
            report.error(id.value_place, format!("unknown id \"{}\"{hint}", id.value));
        }
        found
    }
}
