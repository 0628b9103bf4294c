//! Parameters of a scene file: `<default>` elements, `-D name=value`, and `$name` in attributes.
//!
//! As in Mitsuba 3: a parameter is known after its `<default>`, or everywhere if it is given from outside, which
//! also overrules the default. Of two defaults the first holds. The longest known name after a `$` is meant, so `$r`
//! may be followed by other letters. `\$` is a plain dollar sign.

use std::collections::BTreeMap;
use std::ops::Bound;

use foton_input::{quoted, shown};

use crate::diagnostic::{Place, Report};
use crate::mitsuba::document::{Attribute, Document, Element};

/// How long the values of all attributes may become together: so much for any scene, and so many times as long as they were.
/// Values that name others twice, and so on, would double at every step.
const MAX_BYTES: usize = 8 << 20;
const MAX_TIMES: usize = 4;

/// Among more parameters than these the nearest name is not looked for.
const MAX_NAMES: usize = 1000;

/// A parameter.
struct Parameter {
    value: String,
    from_outside: bool,
    meant_by_file: bool,
}

/// All parameters known so far.
pub(crate) struct Parameters {
    /// By name, in their order: see [`Self::longest`].
    known: BTreeMap<String, Parameter>,
    /// Bytes that values with parameters in them may still fill.
    left: usize,
    /// Whether that was too little once, which is said only once.
    exhausted: bool,
}

impl Parameters {
    /// Those given from outside.
    pub(crate) fn new(defines: &[(String, String)]) -> Self {
        let given =
            |value: &String| Parameter { value: value.clone(), from_outside: true, meant_by_file: false };
        let known = defines.iter().map(|(name, value)| (name.clone(), given(value))).collect();
        Self { known, left: MAX_BYTES, exhausted: false }
    }

    /// Lets values become longer, for those of a document that is read.
    pub(crate) fn allow(&mut self, document: &Document) {
        let values = document.elements().flat_map(|(_, element)| &element.attributes);
        let bytes: usize = values.map(|attribute| attribute.value.len()).sum();
        self.left = self.left.saturating_add(MAX_TIMES.saturating_mul(bytes));
    }

    /// Replaces every `$name` in an element, and learns what a `<default>` says. To be called in the order of the
    /// file. Attributes with an unknown name are marked broken.
    pub(crate) fn apply(&mut self, element: &mut Element, report: &mut Report) {
        for attribute in element.attributes.iter_mut().filter(|a| a.value.contains('$')) {
            self.replace(attribute, report);
        }
        if element.name == "default" {
            self.add_default(element, report);
        }
    }

    /// Reports parameters from outside that the file has no use for.
    pub(crate) fn finish(&self, report: &mut Report) {
        let few = self.known.len() <= MAX_NAMES;
        let known =
            || self.known.iter().filter(|(_, p)| few && p.meant_by_file).map(|(name, _)| name.as_str());
        for (name, p) in self.known.iter().filter(|(_, p)| p.from_outside && !p.meant_by_file) {
            let hint = report.did_you_mean(name, known());
            let define = format!("{name}={}", p.value);
            report.error(
                Place::default(),
                format!("-D {}: the scene has no such parameter{hint}", shown(&define)),
            );
        }
    }

    fn add_default(&mut self, element: &Element, report: &mut Report) {
        let (Some(name), Some(value)) = (element.attribute("name"), element.attribute("value")) else {
            report.error(element.place, "<default> needs the attributes \"name\" and \"value\"");
            return;
        };
        if name.value.is_empty() {
            report.error(name.value_place, "a parameter needs a name");
        } else if let Some(known) = self.known.get_mut(&name.value) {
            known.meant_by_file = true;
        } else if !name.broken && !value.broken {
            let (name, value) = (name.value.clone(), value.value.clone());
            self.known.insert(name, Parameter { value, from_outside: false, meant_by_file: true });
        }
    }

    /// The length of the longest known name that a text begins with, and its parameter.
    fn longest(&mut self, text: &str) -> Option<(usize, &mut Parameter)> {
        // Of the names that come before a text or are it, those that it begins with are the last; where the very last is no such
        // name, no longer one than what it shares with the text is.
        let mut end = text.len();
        while end > 0 {
            let last = self.last_up_to(&text[..end])?;
            let same = last.char_indices().zip(text[..end].chars()).take_while(|((_, a), b)| a == b);
            let same = same.last().map_or(0, |((at, c), _)| at + c.len_utf8());
            if same == last.len() {
                break;
            }
            end = same;
        }
        if end == 0 {
            return None;
        }
        let name = self.last_up_to(&text[..end])?.to_owned();
        self.known.get_mut(&name).map(|p| (name.len(), p)).filter(|(length, _)| *length > 0)
    }

    /// The last name, in their order, that does not come after a text.
    fn last_up_to(&self, text: &str) -> Option<&str> {
        let range = (Bound::Unbounded, Bound::Included(text));
        self.known.range::<str, _>(range).next_back().map(|(name, _)| name.as_str())
    }

    fn replace(&mut self, attribute: &mut Attribute, report: &mut Report) {
        if self.exhausted {
            attribute.broken = true;
            return;
        }
        let (mut replaced, place) = (String::new(), attribute.value_place);
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
            let left = self.left;
            if let Some((length, parameter)) = self.longest(after) {
                parameter.meant_by_file = true;
                if replaced.len().saturating_add(parameter.value.len()) > left {
                    self.exhausted = true;
                    attribute.broken = true;
                    report.error(
                        place,
                        "with the parameters in them, the values of this scene become too long",
                    );
                    return;
                }
                replaced.push_str(&parameter.value);
                rest = &after[length..];
            } else {
                attribute.broken = true;
                let end = after.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(after.len());
                let (name, few) = (&after[..end], self.known.len() <= MAX_NAMES);
                let names = self.known.keys().filter(|_| few).map(String::as_str);
                let hint = report.did_you_mean(name, names).replacen('"', "\"$", 1);
                let hint = if hint.is_empty() {
                    format!(
                        ": give it a value by -D {}=VALUE, or by a <default> before this place",
                        shown(name)
                    )
                } else {
                    hint
                };
                let name = quoted(&format!("${name}"));
                report.error(place, format!("unknown parameter {name}{hint}"));
            }
        }
        replaced.push_str(rest);
        self.left = self.left.saturating_sub(replaced.len());
        attribute.value = replaced;
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::Options;
    use crate::files::Files;
    use crate::limits::Budget;
    use crate::mitsuba::read::include::expand;

    /// The `v` attribute of the last element, and the messages.
    fn last(xml: &str, defines: &[(&str, &str)]) -> (String, Vec<String>) {
        let mut report = Report::new("s", Path::new(""));
        let defines: Vec<_> = defines.iter().map(|(n, v)| ((*n).to_owned(), (*v).to_owned())).collect();
        let document = Document::parse(&format!("<scene>{xml}</scene>")).unwrap();
        let no_files = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
        let document = expand(
            &document,
            &defines,
            &mut Files::new(&no_files, &Options::default(), Budget::new(None)),
            &mut report,
        )
        .document;
        let value = document.elements().last().and_then(|(_, e)| e.attribute("v").map(|a| a.value.clone()));
        let messages = match report.finish() {
            Ok(all) => all,
            Err(e) => e.diagnostics().to_vec(),
        };
        // Versions are another matter.
        let others = messages.iter().map(ToString::to_string).filter(|m| !m.contains("states no version"));
        (value.unwrap_or_default(), others.collect())
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
        let said = "s:1:14: unknown parameter \"$size\": give it a value by -D size=VALUE, or by a <default> before this place";
        assert_eq!(last(xml, &[]).1, [said]);
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

    #[test]
    fn values_that_double_are_refused_where_they_become_too_long() {
        // Thirty lines of this would be a gigabyte.
        let doubling = (1..30).map(|i| format!("\n<default name='a{i}' value='$a{0}$a{0}'/>", i - 1));
        let xml = format!("<default name='a0' value='x'/>{}<a v='$a29'/>", doubling.collect::<String>());
        let said = "s:24:28: with the parameters in them, the values of this scene become too long";
        assert_eq!(last(&xml, &[]).1, [said]);
        // One that is used often is bounded as well.
        let long = "y".repeat(1 << 20);
        let often = format!("<b v='{}'/>\n<a v='$long'/>", "$long".repeat(8));
        assert_eq!(
            last(&often, &[("long", &long)]).1,
            ["s:2:7: with the parameters in them, the values of this scene become too long"]
        );
        assert_eq!(last(&format!("<a v='{}'/>", "$long".repeat(7)), &[("long", &long)]).0.len(), 7 << 20);
    }

    #[test]
    fn the_longest_name_is_found_among_many_that_begin_alike() {
        let names = ["a", "ab", "abcA", "abcd", "b", "ä", "äb"];
        let defaults: String = names.iter().map(|n| format!("<default name='{n}' value='({n})'/>")).collect();
        for (text, replaced) in [
            ("$a", "(a)"),
            ("$abc", "(ab)c"),
            ("$abcB", "(ab)cB"),
            ("$abcd", "(abcd)"),
            ("$abce", "(ab)ce"),
            ("$abcdx", "(abcd)x"),
            ("$bb", "(b)b"),
            ("$ä", "(ä)"),
            ("$äbö$äö", "(äb)ö(ä)ö"),
        ] {
            assert_eq!(
                last(&format!("{defaults}<a v='{text}'/>"), &[]),
                (replaced.to_owned(), vec![]),
                "{text}"
            );
        }
        assert_eq!(last(&format!("{defaults}<a v='$c'/>"), &[]).1.len(), 1);
    }

    #[test]
    fn very_many_parameters_are_read_in_linear_time() {
        let defaults = (0..200_000).map(|i| format!("<default name='p{i}' value='{i}'/><b v='$p{i}'/>"));
        assert_eq!(last(&format!("{}<a v='$p199999'/>", defaults.collect::<String>()), &[]).0, "199999");
    }
}
