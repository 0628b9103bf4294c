//! Text of an XML file: indented elements, escaped attributes, and numbers that read back to the same bits.

use std::fmt::Write;

use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::Keyframes;

/// An XML file being written.
pub(super) struct Xml {
    text: String,
    depth: usize,
}

impl Xml {
    pub(super) fn new() -> Self {
        Self { text: String::new(), depth: 0 }
    }

    pub(super) fn finish(self) -> String {
        self.text
    }

    fn tag(&mut self, name: &str, attributes: &[(&str, &str)], end: &str) {
        self.text.extend(std::iter::repeat_n("    ", self.depth));
        self.text.push('<');
        self.text.push_str(name);
        for (attribute, value) in attributes {
            // Parameters are meant where values are ours, and never in names.
            let is_name = matches!(*attribute, "id" | "filename");
            let _ = write!(self.text, " {attribute}=\"{}\"", escaped(value, is_name));
        }
        self.text.push_str(end);
        self.text.push('\n');
    }

    /// `<name …>`
    pub(super) fn open(&mut self, name: &str, attributes: &[(&str, &str)]) {
        self.tag(name, attributes, ">");
        self.depth += 1;
    }

    /// `</name>`
    pub(super) fn close(&mut self, name: &str) {
        self.depth -= 1;
        self.text.extend(std::iter::repeat_n("    ", self.depth));
        let _ = writeln!(self.text, "</{name}>");
    }

    /// `<name …/>`
    pub(super) fn leaf(&mut self, name: &str, attributes: &[(&str, &str)]) {
        self.tag(name, attributes, "/>");
    }

    /// `<?foton hidden?>`
    pub(super) fn hidden(&mut self) {
        self.text.extend(std::iter::repeat_n("    ", self.depth));
        self.text.push_str("<?foton hidden?>\n");
    }

    /// `<tag name="…" value="…"/>`
    pub(super) fn value(&mut self, tag: &str, name: &str, value: &str) {
        self.leaf(tag, &[("name", name), ("value", value)]);
    }

    /// `<tag type="…">` with values of tag, name and value inside.
    pub(super) fn plugin(&mut self, tag: &str, plugin: &str, values: &[(&str, &str, &str)]) {
        self.open(tag, &[("type", plugin)]);
        for (tag, name, value) in values {
            self.value(tag, name, value);
        }
        self.close(tag);
    }

    /// A transform, or what it becomes by keyframes.
    pub(super) fn placement(&mut self, name: &str, transform: &DAffine3, keyframes: Option<&Keyframes>) {
        let Some(keyframes) = keyframes else { return self.transform(name, transform) };
        self.open("animation", &[("name", name)]);
        for (time, _) in keyframes.all() {
            self.open("transform", &[("time", &number(*time))]);
            self.leaf("matrix", &[("value", &matrix(&keyframes.carried(*transform, *time)))]);
            self.close("transform");
        }
        self.close("animation");
    }

    /// A transform as its matrix, row by row; nothing for the identity.
    pub(super) fn transform(&mut self, name: &str, transform: &DAffine3) {
        if *transform == DAffine3::IDENTITY {
            return;
        }
        self.open("transform", &[("name", name)]);
        self.leaf("matrix", &[("value", &matrix(transform))]);
        self.close("transform");
    }
}

fn escaped(value: &str, is_name: bool) -> String {
    let mut text = String::with_capacity(value.len());
    for c in value.chars() {
        match c {
            '&' => text.push_str("&amp;"),
            '<' => text.push_str("&lt;"),
            '>' => text.push_str("&gt;"),
            '"' => text.push_str("&quot;"),
            '$' if is_name => text.push_str("\\$"),
            // White space other than the space would come back as one, other control characters not at all.
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => text.push('_'),
            c => text.push(c),
        }
    }
    text
}

/// The shortest text that reads back to the same number.
pub(crate) fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-5..1e15).contains(&size) { value.to_string() } else { format!("{value:e}") }
}

/// The shortest text that reads back to the same number, also by way of double precision.
#[allow(clippy::cast_possible_truncation, reason = "it is what a reader of double precision does")]
pub(crate) fn single(value: f32) -> String {
    let size = value.abs();
    let short =
        if size == 0.0 || (1e-5..1e9).contains(&size) { value.to_string() } else { format!("{value:e}") };
    let back = short.parse::<f64>().map(|wide| wide as f32);
    if back == Ok(value) { short } else { number(f64::from(value)) }
}

/// The rows of a transform.
pub(crate) fn matrix(transform: &DAffine3) -> String {
    let rows = transform.matrix3.transpose();
    let row = |axis: DVec3, shift: f64| format!("{} {}", vector(axis), number(shift));
    let t = transform.translation;
    [row(rows.x_axis, t.x), row(rows.y_axis, t.y), row(rows.z_axis, t.z), "0 0 0 1".to_owned()].join("  ")
}

/// Three numbers.
pub(crate) fn vector(v: DVec3) -> String {
    v.to_array().map(number).join(" ")
}

/// Three numbers of single precision.
pub(crate) fn colour(c: Rgb) -> String {
    c.to_array().map(single).join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_back_to_the_same_bits() {
        let mut state = 1_u64;
        for _ in 0..100_000 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let wide = f64::from_bits(state);
            if wide.is_finite() {
                assert_eq!(number(wide).parse::<f64>().unwrap().to_bits(), wide.to_bits());
            }
            let narrow = f32::from_bits((state >> 32) as u32);
            if narrow.is_finite() {
                assert_eq!((single(narrow).parse::<f64>().unwrap() as f32).to_bits(), narrow.to_bits());
            }
        }
        assert_eq!([number(0.1), number(-2.0), number(1e300), single(0.63)], ["0.1", "-2", "1e300", "0.63"]);
    }

    #[test]
    fn names_cannot_break_out_of_their_attribute() {
        let mut xml = Xml::new();
        xml.leaf("ref", &[("id", "a\"<b>&$c\n")]);
        assert_eq!(xml.finish(), "<ref id=\"a&quot;&lt;b&gt;&amp;\\$c_\"/>\n");
    }
}
