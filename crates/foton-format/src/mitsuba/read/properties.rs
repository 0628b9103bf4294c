//! What stands inside a plugin's element: values by name, and nested plugins.
//!
//! Whoever reads a plugin takes from here what it knows; what nobody took is reported at the end, with the nearest
//! name that was asked for. References are followed here.

use std::collections::{BTreeSet, HashSet};

use foton_input::{quoted, shown};
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::Keyframes;
use foton_scene::parameter::{Kind, Parameter};

use crate::diagnostic::{Place, Report};
use crate::mitsuba::document::{Document, Element, NodeId};
use crate::mitsuba::names::{OBJECT_TAGS, SPECTRUM_PLUGINS, VALUE_TAGS, is_called};
use crate::mitsuba::read::attributes::{check_attributes, parse_attribute, report_tag};
use crate::mitsuba::read::ids::Ids;
use crate::mitsuba::read::{animation, transform, values};

/// The contents of one plugin's element.
pub(crate) struct Properties<'a> {
    document: &'a Document,
    /// The plugin's name, for messages.
    subject: &'a str,
    /// Where the plugin's element stands.
    pub(crate) place: Place,
    values: Vec<Value<'a>>,
    /// The names of all values.
    names: HashSet<&'a str>,
    objects: Vec<Object<'a>>,
    asked: Vec<&'static str>,
}

struct Value<'a> {
    name: &'a str,
    node: NodeId,
    element: &'a Element,
    taken: bool,
}

/// A nested plugin.
#[derive(Clone, Copy)]
pub(crate) struct Object<'a> {
    /// The plugin's element, here or elsewhere.
    pub(crate) node: NodeId,
    /// The plugin's element.
    pub(crate) element: &'a Element,
    /// Where it stands, or the reference to it.
    pub(crate) place: Place,
    name: &'a str,
    taken: bool,
}

impl Object<'_> {
    /// Whether it is a plugin of a spectrum.
    fn is_spectrum(&self) -> bool {
        is_texture(&self.element.name)
            && self.element.attribute("type").is_some_and(|t| SPECTRUM_PLUGINS.contains(&t.value.as_str()))
    }
}

/// A value with the place where it is written.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Located<T> {
    pub(crate) value: T,
    pub(crate) place: Place,
}

impl<'a> Properties<'a> {
    /// Sorts what stands inside `node`; `subject` names it in messages.
    pub(crate) fn of(
        document: &'a Document,
        ids: &Ids<'a>,
        node: NodeId,
        subject: &'a str,
        report: &mut Report,
    ) -> Self {
        let place = document.element(node).map_or_else(Place::default, |e| e.place);
        let mut properties = Self {
            document,
            subject,
            place,
            values: Vec::new(),
            names: HashSet::new(),
            objects: Vec::new(),
            asked: Vec::new(),
        };
        for (child, element) in document.elements_in(node) {
            properties.add(ids, child, element, report);
        }
        properties
    }

    fn add(&mut self, ids: &Ids<'a>, node: NodeId, element: &'a Element, report: &mut Report) {
        let tag = element.name.as_str();
        let name = element.attribute("name").map_or("", |a| a.value.as_str());
        // A spectrum with a type is a texture plugin in Mitsuba.
        let is_object =
            OBJECT_TAGS.contains(&tag) || (tag == "spectrum" && element.attribute("type").is_some());
        if is_object {
            check_attributes(element, &["type"], &["id", "name"], report);
            if element.attribute("type").is_some() {
                let place = element.place;
                self.objects.push(Object { node, element, place, name, taken: false });
            }
        } else if tag == "ref" {
            if let Some((node, target)) = ids.follow(element, report) {
                let place = element.value_place("id");
                self.objects.push(Object { node, element: target, place, name, taken: false });
            }
        } else if VALUE_TAGS.contains(&tag) {
            let complete = match tag {
                "transform" | "animation" => check_attributes(element, &["name"], &[], report),
                "spectrum" => check_attributes(element, &["name"], &["value", "filename", "intent"], report),
                // Intents are those of spectral renderers.
                "rgb" | "srgb" => check_attributes(element, &["name", "value"], &["intent"], report),
                "blackbody" => {
                    check_attributes(element, &["name", "temperature"], &["scale", "intent"], report)
                }
                "point" | "vector" if element.attribute("value").is_none() => {
                    check_attributes(element, &["name", "x", "y", "z"], &[], report)
                }
                _ => check_attributes(element, &["name", "value"], &[], report),
            };
            if let Some((_, inner)) = self.document.elements_in(node).next()
                && !["transform", "animation"].contains(&tag)
            {
                report.error(inner.place, format!("<{}> cannot stand inside <{tag}>", shown(&inner.name)));
            }
            if complete && !self.names.insert(name) {
                report
                    .error(element.place, format!("{} of \"{}\" is given twice", quoted(name), self.subject));
            } else if complete {
                self.values.push(Value { name, node, element, taken: false });
            }
        } else {
            report_tag(element, report);
        }
    }

    /// The element of a value, if it is there and of one of the tags.
    pub(crate) fn take(
        &mut self,
        name: &'static str,
        tags: &[&str],
        report: &mut Report,
    ) -> Option<(NodeId, &'a Element)> {
        self.asked.push(name);
        let is_texture = |o: &&mut Object<'_>| is_called(o.name, name) && is_texture(&o.element.name);
        if let Some(object) = self.objects.iter_mut().find(is_texture) {
            object.taken = true;
            let subject = self.subject;
            report.error(
                object.place,
                format!("a texture as \"{name}\" of \"{subject}\" is not supported yet"),
            );
            return None;
        }
        let exact = self.values.iter().position(|v| v.name == name);
        let index = exact.or_else(|| self.values.iter().position(|v| !v.taken && is_called(v.name, name)))?;
        let value = &mut self.values[index];
        value.taken = true;
        if exact.is_none() {
            let message = format!(
                "unknown property {} of \"{}\" is read as \"{name}\"",
                quoted(value.name),
                self.subject
            );
            report.warning(value.element.value_place("name"), message);
        }
        let tag = value.element.name.as_str();
        if !tags.contains(&tag) {
            let wanted = tags.first().copied().unwrap_or_default();
            let subject = self.subject;
            let message = format!("\"{name}\" of \"{subject}\" must be given as <{wanted}>, not <{tag}>");
            report.error(value.element.place, message);
            return None;
        }
        Some((value.node, value.element))
    }

    fn parsed<T>(
        &mut self,
        name: &'static str,
        tags: &[&str],
        parse: fn(&str) -> Result<T, String>,
        report: &mut Report,
    ) -> Option<Located<T>> {
        let (_, element) = self.take(name, tags, report)?;
        let attribute = element.attribute("value")?;
        let value = parse_attribute(attribute, parse, report)?;
        Some(Located { value, place: attribute.value_place })
    }

    /// A finite number.
    pub(crate) fn number(&mut self, name: &'static str, report: &mut Report) -> Option<Located<f64>> {
        self.parsed(name, &["float", "integer"], values::number, report)
    }

    /// A whole number.
    pub(crate) fn integer(&mut self, name: &'static str, report: &mut Report) -> Option<Located<i64>> {
        self.parsed(name, &["integer"], values::integer, report)
    }

    /// A truth value.
    pub(crate) fn boolean(&mut self, name: &'static str, report: &mut Report) -> Option<Located<bool>> {
        self.parsed(name, &["boolean"], values::boolean, report)
    }

    /// A text.
    pub(crate) fn string(&mut self, name: &'static str, report: &mut Report) -> Option<Located<String>> {
        self.parsed(name, &["string"], |text| Ok(text.to_owned()), report)
    }

    /// Whether the value is there at all, valid or not.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.values.iter().any(|v| is_called(v.name, name))
    }

    /// Whether the value is there, or a texture for it.
    pub(crate) fn states(&self, name: &str) -> bool {
        self.has(name) || self.objects.iter().any(|o| o.name == name && is_texture(&o.element.name))
    }

    /// Whether the value is there and written with one of these tags.
    pub(crate) fn is_written_as(&self, name: &str, tags: &[&str]) -> bool {
        self.values.iter().any(|v| is_called(v.name, name) && tags.contains(&v.element.name.as_str()))
    }

    /// Whether the value is there and written as a `<vector>` or `<point>`.
    pub(crate) fn is_vector(&self, name: &str) -> bool {
        let is_vector = |element: &Element| matches!(element.name.as_str(), "vector" | "point");
        self.values.iter().any(|v| is_called(v.name, name) && is_vector(v.element))
    }

    /// A point or a vector.
    pub(crate) fn point(&mut self, name: &'static str, report: &mut Report) -> Option<Located<DVec3>> {
        let (_, element) = self.take(name, &["point", "vector"], report)?;
        let place = element.attribute("value").map_or(element.place, |a| a.value_place);
        let value = transform::components(element, 0.0, report)?;
        Some(Located { value, place })
    }

    /// A transform that can be undone.
    pub(crate) fn transform(&mut self, name: &'static str, report: &mut Report) -> Option<Located<DAffine3>> {
        let (node, element) = self.take(name, &["transform"], report)?;
        let value = transform::read(self.document, node, report)?;
        Some(Located { value, place: element.place })
    }

    /// A transform that can be undone, with what it becomes where an `<animation>` says so. The transform is then its first.
    pub(crate) fn placement(
        &mut self,
        name: &'static str,
        report: &mut Report,
    ) -> Option<(Located<DAffine3>, Option<Keyframes>)> {
        let (node, element) = self.take(name, &["transform", "animation"], report)?;
        let place = element.place;
        if element.name == "transform" {
            let value = transform::read(self.document, node, report)?;
            return Some((Located { value, place }, None));
        }
        let keyframes = animation::read(self.document, node, report)?;
        Some((Located { value: keyframes.all()[0].1, place }, Some(keyframes)))
    }

    /// The texture that stands for a value.
    pub(crate) fn texture(&mut self, name: &'static str) -> Option<Object<'a>> {
        self.asked.push(name);
        let is_it =
            |o: &&mut Object<'_>| is_called(o.name, name) && is_texture(&o.element.name) && !o.is_spectrum();
        let object = self.objects.iter_mut().find(is_it)?;
        object.taken = true;
        Some(*object)
    }

    /// The plugin that stands for a value and is the same everywhere: a spectrum, in Mitsuba a texture as well.
    pub(crate) fn spectrum_plugin(&mut self, name: &str) -> Option<Object<'a>> {
        let object = self.objects.iter_mut().find(|o| is_called(o.name, name) && o.is_spectrum())?;
        object.taken = true;
        Some(*object)
    }

    /// The plugin's name, for messages.
    pub(crate) fn subject(&self) -> &'a str {
        self.subject
    }

    /// Nested plugins with that tag, references followed.
    pub(crate) fn nested(&mut self, tag: &str) -> Vec<Object<'a>> {
        let matching = self.objects.iter_mut().filter(|o| o.element.name == tag);
        matching
            .map(|o| {
                o.taken = true;
                *o
            })
            .collect()
    }

    /// Takes parameters that have no effect, and refuses those that are not supported.
    pub(crate) fn leave_out(&mut self, parameters: &[Parameter], report: &mut Report) {
        let of = |kind| parameters.iter().filter(move |p| p.kind == kind).map(|p| p.name);
        self.ignore(&of(Kind::Ignored).collect::<Vec<_>>());
        self.refuse(&of(Kind::Unsupported).collect::<Vec<_>>(), report);
    }

    /// Calls a value or a texture by another name, where nothing has that yet.
    pub(crate) fn rename(&mut self, old: &str, new: &'static str) {
        if self.states(new) {
            return;
        }
        self.values.iter_mut().filter(|v| is_called(v.name, old)).for_each(|v| v.name = new);
        self.objects.iter_mut().filter(|o| is_called(o.name, old)).for_each(|o| o.name = new);
    }

    /// Takes all that is left, not looked at.
    pub(crate) fn leave_rest(&mut self) {
        self.values.iter_mut().for_each(|v| v.taken = true);
        self.objects.iter_mut().for_each(|o| o.taken = true);
    }

    /// Values that change nothing in our images: taken, not looked at.
    pub(crate) fn ignore(&mut self, names: &[&'static str]) {
        let is_one = |value: &&mut Value<'_>| names.iter().any(|name| is_called(value.name, name));
        for value in self.values.iter_mut().filter(is_one) {
            value.taken = true;
        }
        self.asked.extend(names);
    }

    /// Values that would change the image: an error where they are given, unless they were taken and judged already.
    pub(crate) fn refuse(&mut self, names: &[&'static str], report: &mut Report) {
        let is_one = |value: &&mut Value<'_>| names.iter().any(|name| is_called(value.name, name));
        for value in self.values.iter_mut().filter(|v| !v.taken).filter(is_one) {
            value.taken = true;
            let message = format!("{} of \"{}\" is not supported yet", quoted(value.name), self.subject);
            report.error(value.element.place, message);
        }
        self.asked.extend(names);
    }

    /// Reports what was not taken.
    pub(crate) fn finish(self, report: &mut Report) {
        let subject = self.subject;
        for value in self.values.iter().filter(|v| !v.taken) {
            let hint = report.did_you_mean(value.name, self.asked.iter().copied());
            let place = value.element.value_place("name");
            report.warning(place, format!("unknown property {} of \"{subject}\"{hint}", quoted(value.name)));
            report.help(self.takes());
        }
        for object in self.objects.iter().filter(|o| !o.taken) {
            let (tag, place) = (object.element.name.as_str(), object.place);
            match tag {
                "medium" | "phase" | "volume" | "subsurface" => {
                    report.warning(
                        place,
                        format!("<{tag}> inside \"{subject}\" is left out: there are no media yet"),
                    );
                }
                "sampler" | "film" | "rfilter" | "integrator" => {
                    report.warning(place, format!("<{tag}> inside \"{subject}\" has no effect"));
                }
                _ => report.error(place, format!("<{tag}> inside \"{subject}\" is not supported yet")),
            }
        }
    }

    /// What the plugin takes.
    fn takes(&self) -> String {
        let names: BTreeSet<_> = self.asked.iter().copied().collect();
        let names: Vec<_> = names.into_iter().collect();
        match &names[..] {
            [] => format!("\"{}\" takes no parameters", self.subject),
            names => format!("\"{}\" takes {}", self.subject, names.join(", ")),
        }
    }

    /// Reports only those values not taken whose names are close to known ones.
    pub(crate) fn finish_leniently(self, report: &mut Report) {
        for value in self.values.iter().filter(|v| !v.taken) {
            let hint = report.did_you_mean(value.name, self.asked.iter().copied());
            if !hint.is_empty() {
                let place = value.element.value_place("name");
                let message =
                    format!("unknown property {} of \"{}\"{hint}", quoted(value.name), self.subject);
                report.warning(place, message);
            }
        }
    }
}

fn is_texture(tag: &str) -> bool {
    matches!(tag, "texture" | "spectrum")
}
