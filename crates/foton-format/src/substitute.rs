//! Parameters of a scene file: `<default>` elements, `-D name=value`, and `$name` in attributes.
//!
//! As in Mitsuba 3: a parameter is known after its `<default>`, or everywhere if it is given from outside, which
//! also overrules the default. Of two defaults the first holds. The longest known name after a `$` is meant, so `$r`
//! may be followed by other letters. `\$` is a plain dollar sign.

use crate::diagnostic::{Place, Report};
use crate::document::{Attribute, Element};
use crate::names::{did_you_mean, nearest};

/// A parameter with its value.
struct Parameter {
    name: String,
    value: String,
    from_outside: bool,
    meant_by_file: bool,
}

/// All parameters known so far.
pub(crate) struct Parameters(Vec<Parameter>);

impl Parameters {
    /// Those given from outside.
    pub(crate) fn new(defines: &[(String, String)]) -> Self {
        let mut parameters: Vec<Parameter> = Vec::new();
        for (name, value) in defines {
            parameters.retain(|p| p.name != *name);
            parameters.push(Parameter {
                name: name.clone(),
                value: value.clone(),
                from_outside: true,
                meant_by_file: false,
            });
        }
        Self(parameters)
    }

    /// Replaces every `$name` in an element, and learns what a `<default>` says. To be called in the order of the
    /// file. Attributes with an unknown name are marked broken.
    pub(crate) fn apply(&mut self, element: &mut Element, report: &mut Report) {
        for attribute in &mut element.attributes {
            replace(attribute, &mut self.0, report);
        }
        if element.name == "default" {
            add_default(element, &mut self.0, report);
        }
    }

    /// Reports parameters from outside that the file has no use for.
    pub(crate) fn finish(&self, report: &mut Report) {
        let known = || self.0.iter().filter(|p| p.meant_by_file).map(|p| p.name.as_str());
        for p in self.0.iter().filter(|p| p.from_outside && !p.meant_by_file) {
            let hint = did_you_mean(&p.name, known());
            report.error(
                Place::default(),
                format!("-D {}={}: the scene has no such parameter{hint}", p.name, p.value),
            );
        }
    }
}

fn add_default(element: &Element, parameters: &mut Vec<Parameter>, report: &mut Report) {
    let (Some(name), Some(value)) = (element.attribute("name"), element.attribute("value")) else {
        report.error(element.place, "<default> needs the attributes \"name\" and \"value\"");
        return;
    };
    if name.value.is_empty() {
        report.error(name.value_place, "a parameter needs a name");
    } else if let Some(known) = parameters.iter_mut().find(|p| p.name == name.value) {
        known.meant_by_file = true;
    } else if !name.broken && !value.broken {
        let (name, value) = (name.value.clone(), value.value.clone());
        parameters.push(Parameter { name, value, from_outside: false, meant_by_file: true });
    }
}

fn replace(attribute: &mut Attribute, parameters: &mut [Parameter], report: &mut Report) {
    if !attribute.value.contains('$') {
        return;
    }
    let mut replaced = String::new();
    let mut rest = attribute.value.as_str();
    while let Some(dollar) = rest.find('$') {
        let (before, after) = (&rest[..dollar], &rest[dollar + 1..]);
        rest = after;
        if let Some(before) = before.strip_suffix('\\') {
            replaced.push_str(before);
            replaced.push('$');
            continue;
        }
        replaced.push_str(before);
        let meant = parameters
            .iter_mut()
            .filter(|p| !p.name.is_empty() && after.starts_with(&p.name))
            .max_by_key(|p| p.name.len());
        if let Some(parameter) = meant {
            parameter.meant_by_file = true;
            replaced.push_str(&parameter.value);
            rest = &after[parameter.name.len()..];
        } else {
            attribute.broken = true;
            let end = after.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(after.len());
            let name = &after[..end];
            let near = nearest(name, parameters.iter().map(|p| p.name.as_str()));
            let hint = near.map_or_else(String::new, |near| format!(", did you mean \"${near}\"?"));
            report.error(attribute.value_place, format!("unknown parameter \"${name}\"{hint}"));
        }
    }
    replaced.push_str(rest);
    attribute.value = replaced;
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use foton_math::Cancel;

    use super::*;
    use crate::document::Document;
    use crate::files::Files;
    use crate::include::expand;

    /// The `v` attribute of the last element, and the messages.
    fn last(xml: &str, defines: &[(&str, &str)]) -> (String, Vec<String>) {
        let mut report = Report::new("s", Path::new(""));
        let defines: Vec<_> = defines.iter().map(|(n, v)| ((*n).to_owned(), (*v).to_owned())).collect();
        let document = Document::parse(&format!("<scene>{xml}</scene>")).unwrap();
        let no_files = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
        let document =
            expand(&document, &defines, &mut Files::new(&no_files, &Cancel::default()), &mut report).document;
        let value = document.elements().last().and_then(|(_, e)| e.attribute("v").map(|a| a.value.clone()));
        let messages = match report.finish() {
            Ok(all) => all,
            Err(e) => e.diagnostics().to_vec(),
        };
        (value.unwrap_or_default(), messages.iter().map(ToString::to_string).collect())
    }

    #[test]
    fn a_define_overrules_a_default_and_the_first_default_holds() {
        let xml = "<default name='r' value='1'/><default name='r' value='2'/><a v='$r'/>";
        assert_eq!(last(xml, &[]), ("1".to_owned(), vec![]));
        assert_eq!(last(xml, &[("r", "7"), ("r", "8")]), ("8".to_owned(), vec![]));
    }

    #[test]
    fn the_longest_known_name_is_meant_and_an_escaped_dollar_stays() {
        let xml = "<default name='r' value='1'/><default name='rr' value='$r$r'/><a v='$rrx-\\$r-$r'/>";
        assert_eq!(last(xml, &[]), ("11x-$r-1".to_owned(), vec![]));
    }

    #[test]
    fn a_default_counts_only_after_its_place_but_a_define_everywhere() {
        let xml = "<a v='$size'/><default name='size' value='1'/>";
        assert_eq!(last(xml, &[]).1, ["s:1:14: unknown parameter \"$size\""]);
        assert_eq!(last("<a v='$size'/>", &[("size", "3")]), ("3".to_owned(), vec![]));
    }

    #[test]
    fn a_define_that_nothing_uses_is_an_error_with_the_nearest_name() {
        let xml = "<default name='width' value='1'/>";
        assert_eq!(
            last(xml, &[("widht", "2")]).1,
            ["s: -D widht=2: the scene has no such parameter, did you mean \"width\"?"]
        );
    }
}
