//! Changing a document in place, and its text.
//!
//! What is not changed keeps its order, comments and white space. Attributes come out in double quotes.

use std::fmt::Write;

use crate::diagnostic::Place;
use crate::mitsuba::document::{Attribute, Document, Element, Node, NodeId};
use crate::mitsuba::names::is_called;

/// Why a document cannot be changed as wanted.
pub(super) type Obstacle = String;

impl Document {
    /// An element in no other element.
    pub(super) fn build(
        &mut self,
        name: &str,
        attributes: &[(&str, &str)],
        children: Vec<NodeId>,
    ) -> Result<NodeId, Obstacle> {
        let place = Place::default();
        let attribute = |(name, value): &(&str, &str)| Attribute {
            name: (*name).to_owned(),
            value: (*value).to_owned(),
            place,
            value_place: place,
            broken: false,
        };
        let attributes = attributes.iter().map(attribute).collect();
        let element = Element { name: name.to_owned(), attributes, children, place };
        self.push(Node::Element(element)).ok_or_else(|| "the file has too many elements".to_owned())
    }

    /// Sets an attribute.
    pub(super) fn set_attribute(&mut self, node: NodeId, name: &str, value: &str) {
        let Some(element) = self.element_mut(node) else { return };
        if let Some(attribute) = element.attributes.iter_mut().find(|a| a.name == name) {
            value.clone_into(&mut attribute.value);
            return;
        }
        let place = Place::default();
        let (name, value) = (name.to_owned(), value.to_owned());
        element.attributes.push(Attribute { name, value, place, value_place: place, broken: false });
    }

    /// Puts a new element where the first matching one stands, and takes all matching ones away. Where there was none it
    /// comes last, on a line of its own if the others have theirs.
    pub(super) fn replace_child(
        &mut self,
        parent: NodeId,
        is_old: impl Fn(&Element) -> bool,
        new: Option<NodeId>,
    ) {
        let Some(children) = self.element(parent).map(|e| e.children.clone()) else { return };
        let mut kept = Vec::with_capacity(children.len() + 2);
        let mut new = new;
        for child in children {
            if !self.element(child).is_some_and(&is_old) {
                kept.push(child);
            } else if let Some(new) = new.take() {
                kept.push(new);
            } else if kept.last().is_some_and(|last| self.is_space(*last)) {
                kept.pop();
            }
        }
        if let Some(new) = new {
            let space = kept.first().copied().filter(|first| self.is_space(*first));
            let before_end = kept.last().filter(|last| kept.len() > 1 && self.is_space(**last)).is_some();
            let at = if before_end { kept.len() - 1 } else { kept.len() };
            kept.splice(at..at, space.into_iter().chain([new]));
        }
        if let Some(element) = self.element_mut(parent) {
            element.children = kept;
        }
    }

    /// Puts an element last, on a line of its own if the others have theirs.
    pub(super) fn append_child(&mut self, parent: NodeId, new: NodeId) {
        self.replace_child(parent, |_| false, Some(new));
    }

    /// Takes an element away, with the white space before it.
    pub(super) fn remove_element(&mut self, node: NodeId) {
        let Some(parent) = self.parent(node) else { return };
        let Some(mut children) = self.element(parent).map(|e| e.children.clone()) else { return };
        let Some(at) = children.iter().position(|child| *child == node) else { return };
        let begin = if at > 0 && self.is_space(children[at - 1]) { at - 1 } else { at };
        children.drain(begin..=at);
        if let Some(element) = self.element_mut(parent) {
            element.children = children;
        }
    }

    /// Marks an element as hidden, or takes the mark away.
    pub(super) fn set_hidden(&mut self, node: NodeId, hidden: bool) -> Result<(), Obstacle> {
        let Some(children) = self.element(node).map(|e| e.children.clone()) else { return Ok(()) };
        let mut kept: Vec<NodeId> =
            children.into_iter().filter(|child| !self.node(*child).is_hidden_mark()).collect();
        if hidden {
            let mark = self.push(Node::hidden_mark()).ok_or("the file has too many elements")?;
            kept.insert(0, mark);
        }
        if let Some(element) = self.element_mut(node) {
            element.children = kept;
        }
        Ok(())
    }

    /// An element from text, in no element, its lines indented anew.
    pub(super) fn build_text(&mut self, text: &str, indentation: &str) -> Result<NodeId, Obstacle> {
        let text = text.trim_end().replace('\n', &format!("\n{indentation}"));
        let element = Self::parse(&text).map_err(|(_, message)| message)?;
        let (_, root) = self.append(element, 0).ok_or("the file has too many elements")?;
        Ok(root)
    }

    /// Sets, or with `None` takes away, the value of that name.
    pub(super) fn set_value(
        &mut self,
        parent: NodeId,
        tag: &str,
        name: &str,
        value: Option<&str>,
    ) -> Result<(), Obstacle> {
        let new = value.map(|v| self.build(tag, &[("name", name), ("value", v)], Vec::new())).transpose()?;
        self.replace_child(parent, |e| e.attribute("name").is_some_and(|a| is_called(&a.value, name)), new);
        Ok(())
    }

    /// The white space before an element, from its line's beginning.
    pub(super) fn indentation(&self, parent: NodeId, child: NodeId) -> String {
        let Some(element) = self.element(parent) else { return String::new() };
        let at = element.children.iter().position(|c| *c == child).unwrap_or(0);
        let before = at.checked_sub(1).map(|i| self.node(element.children[i]));
        match before {
            Some(Node::Text(text)) => text.rsplit('\n').next().unwrap_or_default().to_owned(),
            _ => String::new(),
        }
    }

    /// The element around another one.
    pub(super) fn parent(&self, child: NodeId) -> Option<NodeId> {
        self.elements().find(|(_, e)| e.children.contains(&child)).map(|(node, _)| node)
    }

    /// The element that a `<ref>` means; none by way of an alias.
    pub(super) fn referred(&self, reference: &Element) -> Option<(NodeId, &Element)> {
        let id = &reference.attribute("id")?.value;
        let is_it = |e: &Element| {
            !matches!(e.name.as_str(), "ref" | "alias") && e.attribute("id").is_some_and(|a| a.value == *id)
        };
        self.elements().find(|(_, e)| is_it(e))
    }

    /// A copy of an element and all in it, without ids; its lines are indented anew, from one indentation to another.
    pub(super) fn copy(&mut self, node: NodeId, indentation: [&str; 2]) -> Result<NodeId, Obstacle> {
        let mut copy = self.node(node).clone();
        match &mut copy {
            Node::Element(element) => {
                if element.name != "ref" {
                    element.attributes.retain(|a| a.name != "id");
                }
                for child in &mut element.children {
                    *child = self.copy(*child, indentation)?;
                }
            }
            Node::Text(text) => {
                let [from, to] = indentation.map(|i| format!("\n{i}"));
                *text = text.replace(&from, &to);
            }
            _ => {}
        }
        self.push(copy).ok_or_else(|| "the file has too many elements".to_owned())
    }

    /// Whether it is white space between elements.
    pub(super) fn is_space(&self, node: NodeId) -> bool {
        matches!(self.node(node), Node::Text(text) if text.trim().is_empty())
    }

    /// The whole file as text.
    pub(super) fn text(&self) -> String {
        let mut text = String::new();
        for node in self.top() {
            self.write(*node, &mut text);
            text.push('\n');
        }
        text
    }

    fn write(&self, node: NodeId, out: &mut String) {
        // Writing to a string does not fail.
        let _ = match self.node(node) {
            Node::Text(text) => write!(out, "{}", escaped(text, false)),
            Node::Comment(comment) => write!(out, "<!--{comment}-->"),
            Node::Instruction { target, value: Some(value) } => write!(out, "<?{target} {value}?>"),
            Node::Instruction { target, value: None } => write!(out, "<?{target}?>"),
            Node::Element(element) => {
                let _ = write!(out, "<{}", element.name);
                for Attribute { name, value, .. } in &element.attributes {
                    let _ = write!(out, " {name}=\"{}\"", escaped(value, true));
                }
                out.push_str(if element.children.is_empty() { "/>" } else { ">" });
                for child in &element.children {
                    self.write(*child, out);
                }
                if element.children.is_empty() { Ok(()) } else { write!(out, "</{}>", element.name) }
            }
        };
    }
}

fn escaped(text: &str, in_attribute: bool) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' if in_attribute => out.push_str("&quot;"),
            // Plain ones would come back as spaces.
            '\n' | '\t' if in_attribute => drop(write!(out, "&#{};", u32::from(c))),
            '\r' => out.push_str("&#13;"),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    const XML: &str = "<?p q?>\n<!-- a -->\n<scene version=\"3.0.0\">\n    <a x=\"&lt;&quot;&#10;\">t &amp; u</a>\n    \
                       <!-- b -->\n    <c><float name=\"r\" value=\"1\"/></c>\n</scene>\n";

    #[test]
    fn an_unchanged_document_is_its_own_text() {
        assert_eq!(Document::parse(XML).unwrap().text(), XML);
    }

    #[test]
    fn elements_are_put_where_the_old_ones_stood_or_last() {
        let mut document = Document::parse(XML).unwrap();
        let root = document.root();
        let c = document.elements_in(root).nth(1).unwrap().0;
        document.set_value(c, "float", "r", Some("2")).unwrap();
        document.set_value(root, "float", "new", Some("3")).unwrap();
        document.replace_child(root, |e| e.name == "a", None);
        let wanted = "<?p q?>\n<!-- a -->\n<scene version=\"3.0.0\">\n    <!-- b -->\n    \
                      <c><float name=\"r\" value=\"2\"/></c>\n    <float name=\"new\" value=\"3\"/>\n</scene>\n";
        assert_eq!(document.text(), wanted);
    }
}
