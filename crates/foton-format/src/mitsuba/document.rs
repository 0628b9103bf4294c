//! The tree of an XML file, owned, with the place of everything: elements, attributes, text and comments.
//!
//! It knows nothing about scenes. It is kept beside the scene so that an edited scene can be written back together
//! with what was not understood. Entities and document type definitions are refused, so no file can unfold.

use foton_input::{quoted, shown};

use crate::diagnostic::Place;
use crate::mitsuba::comments::mended;

/// Elements nested deeper than this are refused; Mitsuba's own scenes stay below ten.
pub const MAX_DEPTH: usize = 64;

/// A node of a [`Document`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeId(u32);

/// An XML file as a tree.
#[derive(Clone, Debug)]
pub struct Document {
    nodes: Vec<Node>,
    top: Vec<NodeId>,
    root: NodeId,
}

/// What a node is.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// `<name …>…</name>`.
    Element(Element),
    /// Characters between tags, white space included.
    Text(String),
    /// `<!--…-->`.
    Comment(String),
    /// `<?target value?>`.
    Instruction {
        /// Whom it is for.
        target: String,
        /// What it says.
        value: Option<String>,
    },
}

impl Node {
    /// What stands in an element that is hidden.
    pub(crate) fn hidden_mark() -> Self {
        Self::Instruction { target: "foton".to_owned(), value: Some("hidden".to_owned()) }
    }

    pub(crate) fn is_hidden_mark(&self) -> bool {
        let Self::Instruction { target, value } = self else { return false };
        target == "foton" && value.as_deref().map(str::trim) == Some("hidden")
    }
}

/// An element.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// The tag.
    pub name: String,
    /// Attributes in the order of the file.
    pub attributes: Vec<Attribute>,
    /// Nodes inside, in the order of the file.
    pub children: Vec<NodeId>,
    /// Where its `<` stands.
    pub place: Place,
}

/// An attribute.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribute {
    /// Name.
    pub name: String,
    /// Value with character references resolved.
    pub value: String,
    /// Where the name begins.
    pub place: Place,
    /// Where the value begins, after the quote.
    pub value_place: Place,
    /// Whether a parameter in the value is unknown, so that the value means nothing.
    pub(crate) broken: bool,
}

impl Element {
    /// The attribute of that name.
    #[must_use]
    pub fn attribute(&self, name: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|a| a.name == name)
    }

    /// Where the value of an attribute begins, or else the element.
    #[must_use]
    pub fn value_place(&self, attribute: &str) -> Place {
        self.attribute(attribute).map_or(self.place, |a| a.value_place)
    }
}

impl Document {
    /// Reads a tree from text.
    ///
    /// # Errors
    /// The place and a message where the text is not well-formed, declares a document type, or nests deeper than
    /// [`MAX_DEPTH`].
    pub fn parse(text: &str) -> Result<Self, (Place, String)> {
        let mended = mended(text);
        let tree = roxmltree::Document::parse(&mended).map_err(|e| syntax_error(text, &e))?;
        let mut places = Places::new(text);
        let mut document = Self { nodes: Vec::new(), top: Vec::new(), root: NodeId(0) };
        // Elements whose end is still ahead, outermost first.
        let mut open: Vec<(roxmltree::NodeId, NodeId)> = Vec::new();
        for source in tree.root().descendants().skip(1) {
            let parent = source.parent().map(|p| p.id());
            while open.last().is_some_and(|(id, _)| Some(*id) != parent) {
                open.pop();
            }
            let id = NodeId(u32::try_from(document.nodes.len()).map_err(|_| too_large())?);
            let node = match convert(source, &mut places) {
                // As it was written.
                Node::Comment(_) => Node::Comment(comment(&text[source.range()])),
                node => node,
            };
            match open.last() {
                Some(&(_, above)) => document.children_mut(above).push(id),
                None => document.top.push(id),
            }
            if let Node::Element(element) = &node {
                if open.is_empty() {
                    document.root = id;
                }
                if open.len() >= MAX_DEPTH {
                    return Err((
                        element.place,
                        format!("elements are nested deeper than {MAX_DEPTH} levels"),
                    ));
                }
                open.push((source.id(), id));
            }
            document.nodes.push(node);
        }
        Ok(document)
    }

    /// The outermost element.
    #[must_use]
    pub fn root(&self) -> NodeId {
        self.root
    }

    /// The root element and the comments and instructions around it, in the order of the file.
    #[must_use]
    pub fn top(&self) -> &[NodeId] {
        &self.top
    }

    /// A node.
    ///
    /// # Panics
    /// If the id is of another, larger document.
    #[must_use]
    pub fn node(&self, id: NodeId) -> &Node {
        &self.nodes[id.0 as usize]
    }

    /// A node, if it is an element.
    #[must_use]
    pub fn element(&self, id: NodeId) -> Option<&Element> {
        match self.nodes.get(id.0 as usize) {
            Some(Node::Element(element)) => Some(element),
            _ => None,
        }
    }

    /// The elements directly inside an element.
    pub fn elements_in(&self, id: NodeId) -> impl Iterator<Item = (NodeId, &Element)> {
        let children = self.element(id).map_or(&[][..], |e| &e.children);
        children.iter().filter_map(|&child| Some((child, self.element(child)?)))
    }

    /// Whether an editor has hidden what the element stands for: it says `<?foton hidden?>`.
    pub(crate) fn is_hidden(&self, id: NodeId) -> bool {
        let children = self.element(id).map_or(&[][..], |e| &e.children);
        children.iter().any(|child| self.node(*child).is_hidden_mark())
    }

    /// All elements in the order of the file.
    pub(crate) fn elements(&self) -> impl Iterator<Item = (NodeId, &Element)> {
        (0u32..).zip(&self.nodes).filter_map(|(i, node)| match node {
            Node::Element(element) => Some((NodeId(i), element)),
            _ => None,
        })
    }

    pub(crate) fn element_mut(&mut self, id: NodeId) -> Option<&mut Element> {
        match self.nodes.get_mut(id.0 as usize) {
            Some(Node::Element(element)) => Some(element),
            _ => None,
        }
    }

    /// Adds a node in no element; `None` if there are too many.
    pub(crate) fn push(&mut self, node: Node) -> Option<NodeId> {
        let id = NodeId(u32::try_from(self.nodes.len()).ok()?);
        self.nodes.push(node);
        Some(id)
    }

    /// Adds the nodes of another document behind all others, in no element, their lines counted on from
    /// `lines_before`. The first of them and the root; `None` if there are too many.
    pub(crate) fn append(&mut self, other: Self, lines_before: u32) -> Option<(NodeId, NodeId)> {
        let shift = u32::try_from(self.nodes.len()).ok()?;
        shift.checked_add(u32::try_from(other.nodes.len()).ok()?)?;
        let moved = |id: NodeId| NodeId(id.0 + shift);
        for mut node in other.nodes {
            if let Node::Element(element) = &mut node {
                element.children.iter_mut().for_each(|child| *child = moved(*child));
                let places = element.attributes.iter_mut().flat_map(|a| [&mut a.place, &mut a.value_place]);
                for place in places.chain([&mut element.place]) {
                    place.line = place.line.saturating_add(lines_before);
                }
            }
            self.nodes.push(node);
        }
        Some((NodeId(shift), moved(other.root)))
    }

    fn children_mut(&mut self, id: NodeId) -> &mut Vec<NodeId> {
        match &mut self.nodes[id.0 as usize] {
            Node::Element(element) => &mut element.children,
            _ => &mut self.top,
        }
    }
}

fn convert(source: roxmltree::Node<'_, '_>, places: &mut Places<'_>) -> Node {
    let text = || source.text().unwrap_or_default().to_owned();
    if source.is_comment() {
        return Node::Comment(text());
    }
    if let Some(pi) = source.pi() {
        return Node::Instruction { target: pi.target.to_owned(), value: pi.value.map(str::to_owned) };
    }
    if !source.is_element() {
        return Node::Text(text());
    }
    let place = places.at(source.range().start);
    let attributes = source
        .attributes()
        .map(|a| Attribute {
            name: a.name().to_owned(),
            value: a.value().to_owned(),
            place: places.at(a.range().start),
            value_place: places.at(a.range_value().start),
            broken: false,
        })
        .collect();
    Node::Element(Element {
        name: source.tag_name().name().to_owned(),
        attributes,
        children: Vec::new(),
        place,
    })
}

/// What stands in a comment.
fn comment(text: &str) -> String {
    text.strip_prefix("<!--").and_then(|text| text.strip_suffix("-->")).unwrap_or_default().to_owned()
}

fn too_large() -> (Place, String) {
    (Place::default(), "the file has more nodes than can be numbered".to_owned())
}

fn syntax_error(text: &str, error: &roxmltree::Error) -> (Place, String) {
    use roxmltree::Error;
    match error {
        Error::DtdDetected => {
            let offset = text.find("<!DOCTYPE").unwrap_or(0);
            (Places::new(text).at(offset), "document type definitions are not read".to_owned())
        }
        Error::UnclosedRootNode | Error::UnexpectedEndOfStream => {
            (Places::new(text).at(text.len()), "the file ends inside an element".to_owned())
        }
        _ => {
            let pos = error.pos();
            let message = match error {
                Error::DuplicatedNamespace(name, _) => {
                    format!("the name space {} is there already", quoted(name))
                }
                Error::UnknownNamespace(name, _) => format!("the name space {} is not known", quoted(name)),
                Error::UnexpectedCloseTag(expected, actual, _) => {
                    format!("expected '{}' tag, not '{}'", shown(expected), shown(actual))
                }
                Error::UnknownEntityReference(name, _) => {
                    format!("unknown entity reference {}", quoted(name))
                }
                Error::DuplicatedAttribute(name, _) => {
                    format!("the attribute {} is there already", quoted(name))
                }
                other => other.to_string(),
            };
            let message = message.strip_suffix(&format!(" at {pos}")).unwrap_or(&message);
            (Place { line: pos.row, column: pos.col }, format!("not well-formed XML: {message}"))
        }
    }
}

/// Turns byte offsets that mostly grow into places, reading the text once.
struct Places<'a> {
    text: &'a str,
    offset: usize,
    place: Place,
}

impl<'a> Places<'a> {
    fn new(text: &'a str) -> Self {
        Self { text, offset: 0, place: Place { line: 1, column: 1 } }
    }

    fn at(&mut self, offset: usize) -> Place {
        if offset < self.offset {
            *self = Self::new(self.text);
        }
        for c in self.text.get(self.offset..offset).unwrap_or_default().chars() {
            if c == '\n' {
                self.place = Place { line: self.place.line + 1, column: 1 };
            } else {
                self.place.column += 1;
            }
        }
        self.offset = offset;
        self.place
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_in_a_file_keeps_its_order_and_place() {
        let text = "<!-- é first -->\n<scene version='3.0.0'>\n  <!-- é --><a  b='c'/>tail</scene>";
        let document = Document::parse(text).unwrap();
        assert_eq!(document.top().len(), 2);
        let root = document.element(document.root()).unwrap();
        assert_eq!((root.name.as_str(), root.place), ("scene", Place { line: 2, column: 1 }));
        let kinds: Vec<_> = root.children.iter().map(|&id| document.node(id).clone()).collect();
        assert_eq!(kinds[0], Node::Text("\n  ".to_owned()));
        assert_eq!(kinds[1], Node::Comment(" é ".to_owned()));
        let Node::Element(a) = &kinds[2] else { panic!("{kinds:?}") };
        assert_eq!(a.place, Place { line: 3, column: 13 });
        assert_eq!(a.attributes[0].place, Place { line: 3, column: 17 });
        assert_eq!(a.attributes[0].value_place, Place { line: 3, column: 20 });
        assert_eq!(kinds[3], Node::Text("tail".to_owned()));
    }

    #[test]
    fn comments_that_hold_hyphens_stay_as_they_are_and_move_nothing() {
        let text = "<!-- a -- b --->\n<scene><!----><!-- <!-- é --<a/>----> <b/></scene>";
        let document = Document::parse(text).unwrap();
        assert_eq!(document.node(document.top()[0]), &Node::Comment(" a -- b -".to_owned()));
        let root = document.element(document.root()).unwrap();
        assert_eq!(document.node(root.children[0]), &Node::Comment(String::new()));
        assert_eq!(document.node(root.children[1]), &Node::Comment(" <!-- é --<a/>--".to_owned()));
        let (_, b) = document.elements_in(document.root()).next().unwrap();
        assert_eq!((b.name.as_str(), b.place), ("b", Place { line: 2, column: 39 }));
    }

    #[test]
    fn a_document_type_is_refused() {
        let bomb = "\n<!DOCTYPE a [<!ENTITY b 'cc'>]><a>&b;</a>";
        let (place, message) = Document::parse(bomb).unwrap_err();
        assert_eq!((place.line, place.column), (2, 1));
        assert_eq!(message, "document type definitions are not read");
    }

    #[test]
    fn deep_nesting_is_an_error_and_not_a_crash() {
        for depth in [MAX_DEPTH, MAX_DEPTH + 1, 200_000] {
            let text = "<a>".repeat(depth) + &"</a>".repeat(depth);
            assert_eq!(Document::parse(&text).is_ok(), depth <= MAX_DEPTH, "{depth}");
        }
    }

    #[test]
    fn an_unfinished_file_is_reported_at_its_end() {
        let (place, message) = Document::parse("<scene>\n <a/>\n").unwrap_err();
        assert_eq!((place.line, place.column), (3, 1));
        assert_eq!(message, "the file ends inside an element");
    }

    #[test]
    fn one_long_line_is_read_in_linear_time() {
        let text = format!("<scene>{}</scene>", "<a b='1'/>".repeat(200_000));
        let document = Document::parse(&text).unwrap();
        assert_eq!(document.elements().count(), 200_001);
    }
}
