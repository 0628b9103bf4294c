//! Elements by their `id`, and references to them.
//!
//! As in Mitsuba 3, an id may be referred to before its element, from anywhere, and belongs to one element only. An
//! `<alias>` gives an element a second id.

use std::collections::{BTreeSet, HashMap};

use foton_input::quoted;

use crate::diagnostic::Report;
use crate::mitsuba::document::{Attribute, Document, Element, NodeId};
use crate::mitsuba::read::attributes::check_attributes;

/// All elements of a document that have an id.
pub(crate) struct Ids<'a> {
    elements: HashMap<&'a str, (NodeId, &'a Element)>,
}

impl<'a> Ids<'a> {
    /// Collects ids; an id used twice is an error.
    pub(crate) fn collect(document: &'a Document, report: &mut Report) -> Self {
        let mut elements: HashMap<&str, (NodeId, &Element)> = HashMap::new();
        let is_reference = |e: &Element| matches!(e.name.as_str(), "ref" | "alias");
        for (node, element) in document.elements().filter(|(_, e)| !is_reference(e)) {
            let Some(id) = element.attribute("id").filter(|id| !id.broken) else { continue };
            if let Some((_, first)) = elements.get(id.value.as_str()) {
                let line = report.line(first.place, id.value_place);
                report.error(id.value_place, format!("the id {} is taken since {line}", quoted(&id.value)));
            } else {
                elements.insert(&id.value, (node, element));
            }
        }
        let mut ids = Self { elements };
        for (_, alias) in document.elements().filter(|(_, e)| e.name == "alias") {
            ids.add_alias(alias, report);
        }
        ids
    }

    fn add_alias(&mut self, alias: &'a Element, report: &mut Report) {
        if !check_attributes(alias, &["id", "as"], &[], report) {
            return;
        }
        let (Some(id), Some(name)) = (alias.attribute("id"), alias.attribute("as")) else { return };
        if let Some((_, first)) = self.elements.get(name.value.as_str()) {
            let line = report.line(first.place, name.value_place);
            report.error(name.value_place, format!("the id {} is taken since {line}", quoted(&name.value)));
        } else if let Some(target) = self.find(id, report) {
            self.elements.insert(&name.value, target);
        }
    }

    /// The node of the element that a `<ref>` means, if there is one.
    pub(crate) fn target(&self, reference: &Element) -> Option<NodeId> {
        let (node, _) = self.elements.get(reference.attribute("id")?.value.as_str())?;
        Some(*node)
    }

    /// The element that a `<ref>` means.
    pub(crate) fn follow(&self, reference: &Element, report: &mut Report) -> Option<(NodeId, &'a Element)> {
        if !check_attributes(reference, &["id"], &["name"], report) {
            return None;
        }
        self.find(reference.attribute("id")?, report)
    }

    fn find(&self, id: &Attribute, report: &mut Report) -> Option<(NodeId, &'a Element)> {
        if id.broken {
            return None;
        }
        let found = self.elements.get(id.value.as_str()).copied();
        if found.is_none() {
            // In their order, so that of two that are as near always the same is named.
            let known = self.elements.keys().copied().filter(|_| self.elements.len() <= 1000);
            let known: BTreeSet<_> = known.collect();
            let hint = report.did_you_mean(&id.value, known);
            report.error(id.value_place, format!("unknown id {}{hint}", quoted(&id.value)));
        }
        found
    }
}
