//! Values of a JSON file with the paths at which they stand, such as `materials[3].alphaCutoff`, and what is said of them.
//!
//! A value of the wrong kind is an error at its path, and reads as if it were not there. `null` is not there, either.

use std::fmt::Display;

use serde_json::Value;

use crate::diagnostic::{Place, Report};

/// Bytes that a parsed file takes at most for each of its own, for each object and for each value.
const BYTES_PER_BYTE: u64 = 2;
const BYTES_PER_OBJECT: u64 = 700;
const BYTES_PER_VALUE: u64 = 100;

/// Memory that a text takes once it is parsed, at most: counted without telling strings from the rest.
pub(super) fn memory(text: &[u8]) -> u64 {
    let count = |wanted: &[u8]| text.iter().filter(|b| wanted.contains(b)).count() as u64;
    count(b"{") * BYTES_PER_OBJECT + count(b",[:") * BYTES_PER_VALUE + text.len() as u64 * BYTES_PER_BYTE
}

/// A value of the file, and where it stands.
#[derive(Clone)]
pub(super) struct At<'a> {
    value: &'a Value,
    path: String,
}

impl<'a> At<'a> {
    /// The file itself.
    pub(super) fn root(value: &'a Value) -> Self {
        Self { value, path: String::new() }
    }

    /// Where it stands.
    pub(super) fn path(&self) -> &str {
        &self.path
    }

    /// Says that something is wrong with it.
    pub(super) fn error(&self, report: &mut Report, message: impl Display) {
        report.error(Place::default(), self.said(message));
    }

    /// Warns of something about it.
    pub(super) fn warn(&self, report: &mut Report, message: impl Display) {
        report.warning(Place::default(), self.said(message));
    }

    /// A finding with the path before it.
    pub(super) fn said(&self, message: impl Display) -> String {
        if self.path.is_empty() { message.to_string() } else { format!("{}: {message}", self.path) }
    }

    /// What stands there under a name.
    pub(super) fn get(&self, key: &str) -> Option<Self> {
        let value = self.value.get(key).filter(|value| !value.is_null())?;
        let path = if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) };
        Some(Self { value, path })
    }

    /// The item of that number of a list.
    pub(super) fn item(&self, index: usize) -> Option<Self> {
        let value = self.value.get(index)?;
        Some(Self { value, path: format!("{}[{index}]", self.path) })
    }

    /// How many items the list of that name has.
    pub(super) fn count(&self, key: &str) -> usize {
        self.value.get(key).and_then(Value::as_array).map_or(0, Vec::len)
    }

    /// The items of the list of that name, which need not be there.
    pub(super) fn items(&self, key: &str, report: &mut Report) -> Vec<Self> {
        let Some(list) = self.get(key) else { return Vec::new() };
        match list.value.as_array() {
            Some(items) => (0..items.len()).filter_map(|i| list.item(i)).collect(),
            None => {
                list.error(report, "must be a list");
                Vec::new()
            }
        }
    }

    /// What an extension says there.
    pub(super) fn extension(&self, name: &str) -> Option<Self> {
        self.get("extensions")?.get(name)
    }

    /// A value that a function takes, or an error that says what it must be.
    fn value<T>(
        &self,
        key: &str,
        what: &str,
        report: &mut Report,
        take: impl Fn(&'a Value) -> Option<T>,
    ) -> Option<T> {
        let there = self.get(key)?;
        let taken = take(there.value);
        if taken.is_none() {
            there.error(report, format!("must be {what}"));
        }
        taken
    }

    /// A number.
    pub(super) fn number(&self, key: &str, report: &mut Report) -> Option<f64> {
        self.value(key, "a number", report, finite)
    }

    /// A number between two, or a default where there is none.
    pub(super) fn number_in(
        &self,
        key: &str,
        (min, max): (f64, f64),
        default: f64,
        report: &mut Report,
    ) -> f64 {
        let Some(number) = self.number(key, report) else { return default };
        let cut = number.clamp(min, max);
        if cut != number
            && let Some(there) = self.get(key)
        {
            let range = if max.is_finite() {
                format!("must lie between {min} and {max}")
            } else {
                format!("must be at least {min}")
            };
            there.warn(report, format!("{range}, {cut} is taken for {number}"));
        }
        cut
    }

    /// So many numbers.
    pub(super) fn numbers<const N: usize>(&self, key: &str, report: &mut Report) -> Option<[f64; N]> {
        self.value(key, &format!("a list of {N} numbers"), report, |value| {
            let numbers: Option<Vec<f64>> = value.as_array()?.iter().map(finite).collect();
            numbers?.try_into().ok()
        })
    }

    /// Numbers, as many as there are.
    pub(super) fn any_numbers(&self, key: &str, report: &mut Report) -> Option<Vec<f64>> {
        self.value(key, "a list of numbers", report, |value| value.as_array()?.iter().map(finite).collect())
    }

    /// A count, an offset or the number of something.
    pub(super) fn index(&self, key: &str, report: &mut Report) -> Option<usize> {
        self.value(key, "a whole number from 0", report, whole)
    }

    /// The numbers of things.
    pub(super) fn indices(&self, key: &str, report: &mut Report) -> Vec<usize> {
        let list = self.value(key, "a list of whole numbers from 0", report, |value| {
            value.as_array()?.iter().map(whole).collect::<Option<Vec<_>>>()
        });
        list.unwrap_or_default()
    }

    /// A text.
    pub(super) fn text(&self, key: &str, report: &mut Report) -> Option<&'a str> {
        self.value(key, "a text", report, Value::as_str)
    }

    /// True or false; false where it is not there.
    pub(super) fn is(&self, key: &str, report: &mut Report) -> bool {
        self.value(key, "true or false", report, Value::as_bool).unwrap_or(false)
    }

    /// Whether it is the word `false`.
    pub(super) fn is_false(&self) -> bool {
        self.value.as_bool() == Some(false)
    }

    /// The text that the value itself is.
    pub(super) fn as_text(&self) -> Option<&'a str> {
        self.value.as_str()
    }

    /// The thing of the list `list` of the file whose number stands here under a name; an error where there is none.
    pub(super) fn named(
        &self,
        key: &str,
        list: &str,
        root: &Self,
        report: &mut Report,
    ) -> Option<(usize, Self)> {
        let index = self.index(key, report)?;
        let found = root.get(list).and_then(|all| all.item(index));
        if found.is_none() {
            let count = root.count(list);
            let message = format!("there is no {list}[{index}]: the file has {count} of them");
            self.get(key).unwrap_or_else(|| self.clone()).error(report, message);
        }
        Some((index, found?))
    }
}

fn finite(value: &Value) -> Option<f64> {
    value.as_f64().filter(|number| number.is_finite())
}

/// A whole number; exporters in JavaScript write `3.0` as well.
fn whole(value: &Value) -> Option<usize> {
    let number = value.as_u64().or_else(|| {
        let number = value.as_f64()?;
        (number >= 0.0 && number.fract() == 0.0 && number < 9e15).then_some(number as u64)
    })?;
    usize::try_from(number).ok()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn values_are_read_and_faults_are_named_by_their_path() {
        let value = serde_json::json!({
            "a": [{"n": 1.5, "i": 3.0, "v": [1, 2], "t": "x", "nothing": null}, {"n": "1", "v": [1], "i": -1}],
        });
        let mut report = Report::new("f.gltf", Path::new(""));
        let root = At::root(&value);
        let items = root.items("a", &mut report);
        let good = &items[0];
        assert_eq!((good.number("n", &mut report), good.index("i", &mut report)), (Some(1.5), Some(3)));
        assert_eq!(good.numbers("v", &mut report), Some([1.0, 2.0]));
        assert_eq!((good.text("t", &mut report), good.number("nothing", &mut report)), (Some("x"), None));
        let bad = &items[1];
        assert_eq!((bad.number("n", &mut report), bad.index("i", &mut report)), (None, None));
        assert_eq!(bad.numbers::<2>("v", &mut report), None);
        assert!(good.named("i", "a", &root, &mut report).is_none());
        let said = report.finish().unwrap_err().to_string();
        let lines = [
            "f.gltf: a[1].n: must be a number",
            "f.gltf: a[1].i: must be a whole number from 0",
            "f.gltf: a[1].v: must be a list of 2 numbers",
            "f.gltf: a[0].i: there is no a[3]: the file has 2 of them",
        ];
        assert_eq!(said.lines().collect::<Vec<_>>(), lines);
    }
}
