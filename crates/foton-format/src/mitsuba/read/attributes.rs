//! Attributes of elements: which there are to be, and what they say.

use foton_input::{quoted, shown};

use crate::diagnostic::Report;
use crate::mitsuba::document::{Attribute, Element};
use crate::mitsuba::names::{OBJECT_TAGS, VALUE_TAGS};

/// Reports attributes that are unknown or missing; whether none was.
pub(crate) fn check_attributes(
    element: &Element,
    required: &[&'static str],
    optional: &[&'static str],
    report: &mut Report,
) -> bool {
    let tag = shown(&element.name);
    let known = || required.iter().chain(optional).copied();
    let mut complete = true;
    for attribute in element.attributes.iter().filter(|a| !known().any(|k| k == a.name)) {
        complete = false;
        let hint = report.did_you_mean(&attribute.name, known());
        report.error(
            attribute.place,
            format!("unknown attribute {} of <{tag}>{hint}", quoted(&attribute.name)),
        );
    }
    // One misspelt attribute is one problem.
    if complete && let Some(missing) = required.iter().find(|r| element.attribute(r).is_none()) {
        complete = false;
        report.error(element.place, format!("<{tag}> needs the attribute \"{missing}\""));
    }
    complete
}

/// The value of an attribute; broken ones are reported already.
pub(crate) fn parse_attribute<T>(
    attribute: &Attribute,
    parse: impl FnOnce(&str) -> Result<T, String>,
    report: &mut Report,
) -> Option<T> {
    if attribute.broken {
        return None;
    }
    parse(&attribute.value).map_err(|message| report.error(attribute.value_place, message)).ok()
}

/// Reports a tag that is neither a value nor a plugin, where it has no business.
pub(crate) fn report_tag(element: &Element, report: &mut Report) {
    let tag = element.name.as_str();
    match tag {
        "default" | "alias" => {}
        _ => {
            let known = VALUE_TAGS
                .iter()
                .chain(OBJECT_TAGS)
                .copied()
                .chain(["default", "ref", "include", "alias", "path"]);
            let hint = report.did_you_mean(tag, known);
            report.error(element.place, format!("unknown element <{}>{hint}", shown(tag)));
        }
    }
}
