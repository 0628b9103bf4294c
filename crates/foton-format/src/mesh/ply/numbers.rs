//! The numbers after a PLY header, one by one: as words of a text, or as bytes in either order.

use foton_math::Cancel;

use super::header::{Kind, Number};
use crate::diagnostic::Place;
use crate::mesh::words::{Problem, parsed, shown, unread};
use crate::watch::Watch;

/// A way to store numbers.
pub(super) trait Numbers {
    /// The next number.
    fn next(&mut self, kind: Number) -> Result<f64, Problem>;
    /// Goes behind the element whose numbers were read.
    fn end_element(&mut self);
    /// The fewest bytes that a property takes.
    fn least_bytes(&self, kind: Kind) -> u64;
    /// Bytes not read yet.
    fn bytes_left(&self) -> usize;
    /// A problem with what was just read.
    fn problem(&self, message: String) -> Problem;
}

/// Numbers as text; an element is a line, and more words at its end are ignored.
pub(super) struct Text<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u32,
    line_end: u8,
}

impl<'a> Text<'a> {
    pub(super) fn new(bytes: &'a [u8], line_end: u8, line: u32) -> Self {
        let mut text = Self { bytes, at: 0, line, line_end };
        text.skip_empty_lines();
        text
    }

    fn skip_empty_lines(&mut self) {
        while let Some(b) = self.bytes.get(self.at).filter(|b| b.is_ascii_whitespace()) {
            self.line += u32::from(*b == self.line_end);
            self.at += 1;
        }
    }
}

impl Numbers for Text<'_> {
    fn next(&mut self, _: Number) -> Result<f64, Problem> {
        while self.bytes.get(self.at).is_some_and(|&b| b.is_ascii_whitespace() && b != self.line_end) {
            self.at += 1;
        }
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.at += end;
        let word = &rest[..end];
        if word.is_empty() {
            let what = if rest.is_empty() { "file" } else { "line" };
            return Err(self.problem(format!("the {what} ends where a number is needed")));
        }
        // Indices are most of a file.
        if word.len() <= 15 && word.iter().all(u8::is_ascii_digit) {
            return Ok(word.iter().fold(0.0, |n, &digit| n * 10.0 + f64::from(digit - b'0')));
        }
        parsed(word).ok_or_else(|| self.problem(format!("\"{}\" is not a number", shown(word))))
    }

    fn end_element(&mut self) {
        let rest = &self.bytes[self.at..];
        self.at += rest.iter().position(|&b| b == self.line_end).unwrap_or(rest.len());
        self.skip_empty_lines();
    }

    fn least_bytes(&self, _: Kind) -> u64 {
        2
    }

    fn bytes_left(&self) -> usize {
        self.bytes.len() - self.at
    }

    fn problem(&self, message: String) -> Problem {
        (Place { line: self.line, column: 0 }, message)
    }
}

/// Numbers as bytes without gaps.
pub(super) struct Binary<'a, const BIG_ENDIAN: bool> {
    bytes: &'a [u8],
    at: usize,
    /// Bytes of the file before these.
    before: usize,
}

impl<'a, const BIG_ENDIAN: bool> Binary<'a, BIG_ENDIAN> {
    pub(super) fn new(bytes: &'a [u8], before: usize) -> Self {
        Self { bytes, at: 0, before }
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], Problem> {
        let Some(found) = self.bytes[self.at..].first_chunk::<N>() else {
            return Err(self.problem("the file ends where a number is needed".to_owned()));
        };
        self.at += N;
        let mut array = *found;
        if BIG_ENDIAN {
            array.reverse();
        }
        Ok(array)
    }
}

impl<const BIG_ENDIAN: bool> Numbers for Binary<'_, BIG_ENDIAN> {
    fn next(&mut self, kind: Number) -> Result<f64, Problem> {
        Ok(match kind {
            Number::I8 => f64::from(i8::from_le_bytes(self.array()?)),
            Number::U8 => f64::from(u8::from_le_bytes(self.array()?)),
            Number::I16 => f64::from(i16::from_le_bytes(self.array()?)),
            Number::U16 => f64::from(u16::from_le_bytes(self.array()?)),
            Number::I32 => f64::from(i32::from_le_bytes(self.array()?)),
            Number::U32 => f64::from(u32::from_le_bytes(self.array()?)),
            Number::F32 => f64::from(f32::from_le_bytes(self.array()?)),
            Number::F64 => f64::from_le_bytes(self.array()?),
        })
    }

    fn end_element(&mut self) {}

    fn least_bytes(&self, kind: Kind) -> u64 {
        let (Kind::Scalar(number) | Kind::List { count: number, .. }) = kind;
        number.size() as u64
    }

    fn bytes_left(&self) -> usize {
        self.bytes.len() - self.at
    }

    fn problem(&self, message: String) -> Problem {
        (Place::default(), format!("byte {}: {message}", self.before + self.at))
    }
}

/// Numbers that end in a problem once reading is cancelled, and tell how far it is.
pub(super) struct Cancellable<'a, N> {
    pub(super) numbers: N,
    pub(super) watch: Watch<'a>,
    /// Bytes of all of them.
    pub(super) bytes: usize,
    /// Numbers until it is asked again.
    pub(super) left: usize,
}

impl<N: Numbers> Numbers for Cancellable<'_, N> {
    fn next(&mut self, kind: Number) -> Result<f64, Problem> {
        if self.left == 0 {
            self.watch.check().map_err(unread)?;
            self.watch.at(1.0 - self.numbers.bytes_left() as f64 / self.bytes.max(1) as f64);
            self.left = Cancel::EVERY;
        }
        self.left -= 1;
        self.numbers.next(kind)
    }

    fn end_element(&mut self) {
        self.numbers.end_element();
    }

    fn least_bytes(&self, kind: Kind) -> u64 {
        self.numbers.least_bytes(kind)
    }

    fn bytes_left(&self) -> usize {
        self.numbers.bytes_left()
    }

    fn problem(&self, message: String) -> Problem {
        self.numbers.problem(message)
    }
}
