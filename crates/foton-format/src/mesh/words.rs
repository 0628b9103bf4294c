//! The words of text files of lines (OBJ, MTL, STL), each with its place, and the numbers among them.
//!
//! Lines end in `\n`, with a `\r` before it or not; in a file without any `\n` they end in `\r`.

pub(crate) use foton_input::shown_bytes as shown;
use foton_math::Cancelled;
use foton_math::glam::{DVec2, DVec3};

use crate::diagnostic::Place;
use crate::watch::Watch;

/// What is wrong, and where.
pub(crate) type Problem = (Place, String);

/// What stands for the problem that reading was cancelled, until the one who opened the file sees that.
pub(crate) fn unread(cancelled: Cancelled) -> Problem {
    (Place::default(), cancelled.to_string())
}

/// The three finite numbers after a keyword; more are ignored.
pub(crate) fn vector<'a>(keyword: Word<'a>, words: &mut Words<'a>) -> Result<DVec3, Problem> {
    let numbers = three(keyword, words)?;
    if let Some((word, _)) = numbers.iter().find(|(_, number)| !number.is_finite()) {
        return Err((word.place, format!("\"{}\" is not a finite number", shown(word.text))));
    }
    Ok(DVec3::from_array(numbers.map(|(_, number)| number)))
}

/// The three numbers after a keyword.
fn three<'a>(keyword: Word<'a>, words: &mut Words<'a>) -> Result<[(Word<'a>, f64); 3], Problem> {
    let mut numbers = [(keyword, 0.0); 3];
    for (count, slot) in numbers.iter_mut().enumerate() {
        let Some(word) = words.next() else {
            let name = shown(keyword.text);
            return Err((keyword.place, format!("\"{name}\" needs three numbers, not {count}")));
        };
        *slot = (word, number(word)?);
    }
    Ok(numbers)
}

/// The three numbers of a direction, or `None` where one of them is not finite, as exporters write where they had none.
pub(crate) fn direction<'a>(keyword: Word<'a>, words: &mut Words<'a>) -> Result<Option<DVec3>, Problem> {
    let v = three(keyword, words)?.map(|(_, number)| number);
    Ok(Some(DVec3::from_array(v)).filter(|v| v.is_finite()))
}

/// The one or two numbers of a texture coordinate, the second 0 if it is missing; `None` where one is not finite.
pub(crate) fn texture_coordinate(keyword: Word<'_>, words: &mut Words<'_>) -> Result<Option<DVec2>, Problem> {
    let missing = || (keyword.place, "\"vt\" needs two numbers, not 0".to_owned());
    let u = number(words.next().ok_or_else(missing)?)?;
    let v = words.next().map_or(Ok(0.0), number)?;
    Ok(Some(DVec2::new(u, v)).filter(|uv| uv.is_finite()))
}

fn number(word: Word<'_>) -> Result<f64, Problem> {
    parsed(word.text).ok_or_else(|| (word.place, format!("\"{}\" is not a number", shown(word.text))))
}

/// A number, also one that is none or infinite in the words of any C library: `nan`, `-nan(ind)`, `1.#QNAN`.
pub(crate) fn parsed(text: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(text).ok()?;
    let no_number = || {
        let unsigned = text.strip_prefix(['-', '+']).unwrap_or(text).to_ascii_lowercase();
        let [named, numbered] = ["nan(", "1.#"].map(|start| unsigned.starts_with(start));
        (named || numbered).then_some(f64::NAN)
    };
    text.parse().ok().or_else(no_number)
}

/// The bytes of a text without the mark of its encoding that may stand before it.
pub(crate) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes)
}

/// A word and its place.
#[derive(Clone, Copy)]
pub(crate) struct Word<'a> {
    pub(crate) text: &'a [u8],
    pub(crate) place: Place,
}

/// Bytes that are read between two questions whether reading goes on.
const BYTES_UNASKED: usize = 1 << 16;

/// The words of each line. Comments are skipped, and a backslash at the end of a line continues it. Once cancelled the file seems to
/// end, and whoever opened it does not look at what was found.
pub(crate) struct Words<'a> {
    bytes: &'a [u8],
    watch: Watch<'a>,
    /// From where on it is to be asked again.
    asks_at: usize,
    at: usize,
    line: u32,
    line_start: usize,
    line_end: u8,
    started: bool,
}

impl<'a> Words<'a> {
    pub(crate) fn new(bytes: &'a [u8], watch: impl Into<Watch<'a>>) -> Self {
        let watch = watch.into();
        let bytes = without_mark(bytes);
        let line_end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
        Self { bytes, watch, asks_at: 0, at: 0, line: 1, line_start: 0, line_end, started: false }
    }

    /// Goes to the end of the file once cancelled.
    fn ask(&mut self) {
        if self.at >= self.asks_at {
            self.asks_at = self.at + BYTES_UNASKED;
            self.watch.at(self.at as f64 / self.bytes.len().max(1) as f64);
            if self.watch.is_requested() {
                self.bytes = &self.bytes[..self.at.min(self.bytes.len())];
            }
        }
    }

    /// Goes to the beginning of the next line; whether there is one.
    pub(crate) fn next_line(&mut self) -> bool {
        if self.started {
            while self.next().is_some() {}
            self.at += 1;
            self.line += 1;
            self.line_start = self.at;
        }
        self.started = true;
        self.ask();
        self.at < self.bytes.len()
    }

    /// The next word of this line.
    pub(crate) fn next(&mut self) -> Option<Word<'a>> {
        self.ask();
        loop {
            match *self.bytes.get(self.at)? {
                b if b == self.line_end => return None,
                b'#' => self.at += self.to_line_end(),
                b'\\' if self.continuation() > 0 => {
                    self.at += self.continuation();
                    self.line += 1;
                    self.line_start = self.at;
                }
                b if b.is_ascii_whitespace() => self.at += 1,
                _ => break,
            }
        }
        let start = self.at;
        while let Some(&b) = self.bytes.get(self.at) {
            if b.is_ascii_whitespace() || (b == b'\\' && self.continuation() > 0) {
                break;
            }
            self.at += 1;
        }
        let column = u32::try_from(start - self.line_start + 1).unwrap_or(0);
        Some(Word { text: &self.bytes[start..self.at], place: Place { line: self.line, column } })
    }

    /// What is left of this line as one text, white space around it removed.
    pub(crate) fn rest_of_line(&mut self) -> String {
        let (rest, length) = (&self.bytes[self.at..], self.to_line_end());
        self.at += length;
        String::from_utf8_lossy(&rest[..length]).trim().to_owned()
    }

    /// How many bytes of this line are left.
    fn to_line_end(&self) -> usize {
        let rest = &self.bytes[self.at..];
        rest.iter().position(|&b| b == self.line_end).unwrap_or(rest.len())
    }

    /// The length of a backslash with the end of line after it, or 0.
    fn continuation(&self) -> usize {
        match &self.bytes[self.at + 1..] {
            [b'\r', b'\n', ..] => 3,
            [b, ..] if *b == self.line_end => 2,
            _ => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use foton_math::Cancel;

    use super::*;

    fn lines(text: &str) -> Vec<(u32, String)> {
        let cancel = Cancel::default();
        let (mut words, mut found) = (Words::new(text.as_bytes(), &cancel), Vec::new());
        while words.next_line() {
            while let Some(word) = words.next() {
                found.push((word.place.line, shown(word.text)));
            }
        }
        found
    }

    #[test]
    fn lines_end_alike_on_every_system() {
        let wanted: Vec<_> = [(1, "a"), (1, "b"), (3, "c")].map(|(n, w)| (n, w.to_owned())).to_vec();
        for end in ["\n", "\r\n", "\r"] {
            assert_eq!(lines(&["a b", "# none", "c"].join(end)), wanted, "{end:?}");
        }
        assert_eq!(lines("a \\\rb\r\rc"), [(1, "a"), (2, "b"), (4, "c")].map(|(n, w)| (n, w.to_owned())));
    }

    #[test]
    fn numbers_that_are_none_are_known_in_the_words_of_every_library() {
        for text in [
            "nan",
            "-nan",
            "NaN",
            "nan(ind)",
            "-nan(ind)",
            "-nan(snan)",
            "1.#QNAN",
            "-1.#IND00",
            "1.#INF",
            "inf",
        ] {
            assert!(parsed(text.as_bytes()).is_some_and(|n| !n.is_finite()), "{text}");
        }
        for text in ["", "none", "1.#", "1#", "nan1", "1,5"] {
            assert!(parsed(text.as_bytes()).is_none_or(f64::is_nan), "{text}");
        }
        assert_eq!([&b"-1.5e0"[..], b"7"].map(parsed), [Some(-1.5), Some(7.0)]);
    }
}
