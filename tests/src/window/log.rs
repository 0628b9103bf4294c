//! The log of a window, read while it is written.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::PathBuf;

use serde_json::Value;

/// Lines that are shown where something did not come.
const TAIL: usize = 5;

/// What was read so far.
pub struct Log {
    path: PathBuf,
    /// Bytes read, but for the beginning of a line in `rest`.
    read: u64,
    rest: Vec<u8>,
    lines: Vec<Value>,
    /// Lines that were looked at.
    seen: usize,
}

impl Log {
    pub(super) const fn new(path: PathBuf) -> Self {
        Self { path, read: 0, rest: Vec::new(), lines: Vec::new(), seen: 0 }
    }

    /// Reads what has come.
    fn refresh(&mut self) {
        let Ok(mut file) = File::open(&self.path) else { return };
        let mut bytes = Vec::new();
        let came = file.seek(SeekFrom::Start(self.read)).and_then(|_| file.read_to_end(&mut bytes));
        self.read += came.unwrap_or(0) as u64;
        self.rest.append(&mut bytes);
        while let Some(end) = self.rest.iter().position(|b| *b == b'\n') {
            let line: Vec<u8> = self.rest.drain(..=end).collect();
            self.lines.push(serde_json::from_slice(&line).expect("each line is an object"));
        }
    }

    /// The first line not looked at yet that is as it should be; those before it count as looked at.
    pub fn find<T>(&mut self, mut is_it: impl FnMut(&Value) -> Option<T>) -> Option<T> {
        self.refresh();
        while self.seen < self.lines.len() {
            self.seen += 1;
            if let Some(found) = is_it(&self.lines[self.seen - 1]) {
                return Some(found);
            }
        }
        None
    }

    /// What was said until now counts as looked at.
    pub fn skip(&mut self) {
        self.refresh();
        self.seen = self.lines.len();
    }

    /// Nothing counts as looked at.
    pub const fn rewind(&mut self) {
        self.seen = 0;
    }

    /// All lines.
    ///
    /// # Panics
    /// If a line is no JSON.
    pub fn lines(&mut self) -> &[Value] {
        self.refresh();
        &self.lines
    }

    /// Where a control is, as last said.
    pub fn place(&mut self, name: &str) -> Option<[f64; 4]> {
        self.refresh();
        let last = self.lines.iter().rev().find(|line| line["event"] == "places")?;
        let numbers = last["places"][name].as_array()?;
        let numbers: Vec<f64> = numbers.iter().filter_map(Value::as_f64).collect();
        numbers.try_into().ok()
    }

    /// Its end, in words.
    #[must_use]
    pub fn tail(&self) -> String {
        let lines = self.lines.iter().rev().take(TAIL).map(ToString::to_string);
        lines.collect::<Vec<_>>().join("\n")
    }
}
