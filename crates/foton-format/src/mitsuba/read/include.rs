//! `<include>`: the file's elements in its place; parameters replaced and old names renewed on the way.
//!
//! The result is one tree. Nodes of the scene's own file keep their ids; those of included files follow behind, and
//! their lines are counted on (see [`Report::include`]), so that every place still says in which file it is.

use std::path::{Path, PathBuf};

use foton_input::{shown, shown_path};

use crate::diagnostic::{Place, Report};
use crate::encoding::decoded;
use crate::files::Files;
use crate::limits::{Budget, Census, at_place};
use crate::mitsuba::comments::without_document_type;
use crate::mitsuba::document::{Attribute, Document, Element, NodeId};
use crate::mitsuba::names::{OBJECT_TAGS, VALUE_TAGS};
use crate::mitsuba::read::attributes::{check_attributes, parse_attribute};
use crate::mitsuba::read::substitute::Parameters;
use crate::{mitsuba::read::upgrade, mitsuba::read::values};

/// Includes inside includes; Mitsuba's bound is the same.
const DEEPEST: usize = 15;
/// All files that a scene may include: some that double at every level must not take for ever.
const MAX_FILES: usize = 1000;

/// The newest version of Mitsuba, by the first part of its number, whose names are known here.
const NEWEST: u32 = 3;

/// A scene with everything that it includes.
pub(crate) struct Expanded {
    pub(crate) document: Document,
    /// The first node of each stretch of included nodes, and the `<include>` in the scene's own file.
    stretches: Vec<(NodeId, NodeId)>,
}

impl Expanded {
    /// The node itself if it is of the scene's own file, or else the `<include>` there.
    pub(crate) fn origin(&self, node: NodeId) -> NodeId {
        let before = self.stretches.partition_point(|(first, _)| *first <= node);
        before.checked_sub(1).map_or(node, |i| self.stretches[i].1)
    }
}

/// Expands a scene; what cannot be included is reported.
pub(crate) fn expand(
    document: &Document,
    defines: &[(String, String)],
    files: &mut Files<'_>,
    report: &mut Report,
) -> Expanded {
    let expanded = Expanded { document: document.clone(), stretches: Vec::new() };
    let mut parameters = Parameters::new(defines);
    parameters.allow(document);
    let mut walk = Walk { expanded, parameters, files, report, open: Vec::new(), files_included: 0 };
    let root = document.root();
    walk.state_version(document, root);
    let old =
        walk.expanded.document.element(root).is_some_and(|e| is_old(e, &mut Report::new("", Path::new(""))));
    walk.element(root, old, None);
    walk.parameters.finish(walk.report);
    walk.expanded
}

/// Whether a root says that its file is of a version before 2.
fn is_old(root: &Element, report: &mut Report) -> bool {
    major_version(root, report).is_some_and(|major| major < 2)
}

/// The first part of the version that a root says its file is of. One that is newer than all that we know is read as the newest of
/// those, with a warning: what it has renamed since is then reported by its own name and place.
pub(crate) fn major_version(root: &Element, report: &mut Report) -> Option<u32> {
    let attribute = root.attribute("version")?;
    let major = parse_attribute(attribute, values::major_version, report)?;
    if major > NEWEST {
        let message = format!(
            "version {} is newer than {NEWEST}, the newest that foton knows, and the file is read as version {NEWEST}; \
             if it is one, write version=\"{NEWEST}.0.0\"",
            shown(attribute.value.trim())
        );
        report.warning(attribute.value_place, message);
    }
    Some(major)
}

struct Walk<'a, 'f> {
    expanded: Expanded,
    parameters: Parameters,
    files: &'a mut Files<'f>,
    report: &'a mut Report,
    /// Files being included, outermost first, each with its `<include>`.
    open: Vec<(PathBuf, NodeId)>,
    files_included: usize,
}

impl Walk<'_, '_> {
    /// `parent` is the plugin around it, `None` for a root.
    fn element(&mut self, node: NodeId, old: bool, parent: Option<&str>) {
        if self.files.cancel().is_requested() {
            return;
        }
        let Some(element) = self.expanded.document.element_mut(node) else { return };
        self.parameters.apply(element, self.report);
        if old {
            upgrade::element(element, parent.unwrap_or_default());
        }
        let plugin = element.attribute("type").map_or_else(String::new, |t| t.value.clone());
        let mut children = Vec::new();
        for child in std::mem::take(&mut element.children) {
            match self.expanded.document.element(child).map(|e| e.name.as_str()) {
                Some("include") => {
                    self.element(child, false, Some(&plugin));
                    children.extend(self.include(child));
                }
                Some("path") => {
                    self.element(child, false, Some(&plugin));
                    self.path(child, parent.is_none());
                }
                Some(_) => {
                    self.element(child, old, Some(&plugin));
                    children.push(child);
                }
                None => children.push(child),
            }
        }
        if let Some(element) = self.expanded.document.element_mut(node) {
            element.children = children;
        }
    }

    /// A folder to look for files in.
    fn path(&mut self, node: NodeId, at_top: bool) {
        let Some(element) = self.expanded.document.element(node) else { return };
        if !at_top {
            self.report.error(element.place, "<path> can only stand directly inside the scene");
        } else if check_attributes(element, &["value"], &[], self.report)
            && let Some(value) = element.attribute("value").filter(|v| !v.broken)
        {
            self.report.look_in(&value.value, element.place);
        }
    }

    /// The elements that an `<include>` stands for.
    fn include(&mut self, node: NodeId) -> Vec<NodeId> {
        let nothing = Vec::new();
        let Some(element) = self.expanded.document.element(node).cloned() else { return nothing };
        if !check_attributes(&element, &["filename"], &["name"], self.report) {
            return nothing;
        }
        let Some(filename) = element.attribute("filename").filter(|f| !f.broken) else { return nothing };
        let place = filename.value_place;
        if self.open.len() >= DEEPEST {
            self.report.error(place, format!("files are included deeper than {DEEPEST} levels"));
            return nothing;
        }
        if self.files_included >= MAX_FILES {
            self.report.error(place, format!("more than {MAX_FILES} files are included"));
            return nothing;
        }
        self.files_included += 1;
        let Some((path, bytes)) = self.files.read(&filename.value, place, self.report) else {
            return nothing;
        };
        if self.open.iter().any(|(open, _)| *open == path) {
            self.report.error(place, format!("{} includes itself", shown_path(&path)));
            return nothing;
        }
        let Some((root, old)) = self.parse(&path, bytes, place, node) else { return nothing };
        self.open.push((path, node));
        self.element(root, old, None);
        self.open.pop();
        let Some(root_element) = self.expanded.document.element_mut(root) else { return nothing };
        if root_element.name == "scene" {
            return std::mem::take(&mut root_element.children);
        }
        root_element.attributes.retain(|a| a.name != "version");
        if let Some(name) = element.attribute("name") {
            root_element.attributes.retain(|a| a.name != "name");
            root_element.attributes.push(name.clone());
        }
        vec![root]
    }

    /// Adds the nodes of a file; its root, and whether it is an old one.
    fn parse(
        &mut self,
        path: &Path,
        bytes: Vec<u8>,
        place: Place,
        include: NodeId,
    ) -> Option<(NodeId, bool)> {
        let (file, in_words) = (path.to_string_lossy(), shown_path(path));
        let Ok(text) = decoded(bytes) else {
            self.report.error(place, format!("cannot read {in_words}: the text is not UTF-8"));
            return None;
        };
        let text = text.as_str();
        // Nothing is said of what stands in a file that is none of scenes: its words are nobody's business.
        if !begins_as_scene(text) {
            self.report
                .error(place, format!("cannot read {in_words}: it does not begin as a part of a scene does"));
            return None;
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        let lines_before = self.report.include(&file, folder, text, place);
        let document = parse(text, &mut self.files.budget).map_err(|(mut place, message)| {
            place.line = place.line.saturating_add(lines_before);
            self.report.error(place, message);
        });
        let document = document.ok()?;
        let version = version_by_words(&document);
        self.parameters.allow(&document);
        let outermost = self.open.first().map_or(include, |(_, include)| *include);
        let root = self.expanded.document.append(document, lines_before);
        let Some((first, root)) = root else {
            self.report.error(place, "the scene has more nodes than can be numbered");
            return None;
        };
        self.expanded.stretches.push((first, outermost));
        self.state(version, root);
        let element = self.expanded.document.element(root)?;
        Some((root, is_old(element, self.report)))
    }

    /// Puts a version into a root that states none.
    fn state_version(&mut self, document: &Document, root: NodeId) {
        if document.element(root).is_some_and(|element| element.name == "scene") {
            self.state(version_by_words(document), root);
        }
    }

    fn state(&mut self, version: &str, root: NodeId) {
        let Some(element) = self.expanded.document.element_mut(root) else { return };
        if element.attribute("version").is_some() {
            return;
        }
        let place = element.place;
        element.attributes.push(Attribute {
            name: "version".to_owned(),
            value: version.to_owned(),
            place,
            value_place: place,
            broken: false,
        });
        let message = format!(
            "this file states no version: by its words it is read as one of version {version}; if it is another, say so with \
             version=\"…\""
        );
        self.report.warning(place, message);
    }
}

/// The version that a file is of by its words: those of versions before 2 have capitals inside.
fn version_by_words(document: &Document) -> &'static str {
    let is_old = |element: &Element| {
        let named = element.attribute("name").map_or("", |name| name.value.as_str());
        let has_capital = named.starts_with(|c: char| c.is_ascii_lowercase())
            && named.bytes().any(|b| b.is_ascii_uppercase())
            && !named.contains('_');
        has_capital && element.name != "default" || element.name == "lookAt"
    };
    let old = document.elements().any(|(_, element)| is_old(element));
    if old { "0.6.0" } else { "3.0.0" }
}

/// Parses a text of XML whose size is known to be bearable.
pub(crate) fn parse(text: &str, budget: &mut Budget) -> Result<Document, (Place, String)> {
    let text = &without_document_type(text);
    let census = Census::of(text).map_err(|(offset, message)| (at_place(text, offset), message))?;
    budget.take(census.memory()).map_err(|message| (Place::default(), message))?;
    Document::parse(text)
}

/// Whether the first element of a text is one that a scene has, by its tag alone.
pub(crate) fn begins_as_scene(text: &str) -> bool {
    let mut rest = text.trim_start();
    while let Some((_, close)) =
        [("<?", "?>"), ("<!--", "-->")].iter().find(|(open, _)| rest.starts_with(open))
    {
        let Some(end) = rest.find(close) else { return false };
        rest = rest[end + close.len()..].trim_start();
    }
    // A document type is refused by its own name.
    let Some(rest) = rest.strip_prefix('<').filter(|rest| !rest.starts_with("!DOCTYPE")) else {
        return rest.starts_with("<!DOCTYPE");
    };
    let tag = &rest[..rest.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(rest.len())];
    tag == "scene" || OBJECT_TAGS.contains(&tag) || VALUE_TAGS.contains(&tag)
}
