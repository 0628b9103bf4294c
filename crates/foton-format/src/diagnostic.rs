//! What is wrong with a scene file, and where: every finding names its file, line and column.
//!
//! No rendering of source excerpts and no colours; the binary prints these as they are.

use std::fmt;

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The scene renders, but not all that the file says has an effect.
    Warning,
    /// The scene cannot be rendered as the file says.
    Error,
}

/// A line and column of a text, both from 1; columns count characters. Zero says that it is not known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// Line, from 1.
    pub line: u32,
    /// Column in characters, from 1.
    pub column: u32,
}

/// One finding about a file.
///
/// Displays as `room.xml:12:8: unknown bsdf "dielectrc", did you mean "dielectric"?`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// The file as the caller or the scene named it.
    pub file: String,
    /// Line, from 1; 0: the finding is about the whole file.
    pub line: u32,
    /// Column in characters, from 1; 0: the finding is about the whole line.
    pub column: u32,
    /// What is wrong, without the place.
    pub message: String,
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, line, column, message, .. } = self;
        match (line, column) {
            (0, _) => write!(f, "{file}: {message}"),
            (_, 0) => write!(f, "{file}:{line}: {message}"),
            _ => write!(f, "{file}:{line}:{column}: {message}"),
        }
    }
}

/// Why a scene could not be opened: everything found in one go, in the order of the file.
///
/// Displays the errors, one a line.
#[derive(Debug, thiserror::Error)]
#[error("{}", errors_by_line(diagnostics))]
pub struct OpenError {
    /// All findings, at least one of them an error; warnings are among them.
    pub diagnostics: Vec<Diagnostic>,
}

fn errors_by_line(diagnostics: &[Diagnostic]) -> String {
    let errors = diagnostics.iter().filter(|d| d.severity == Severity::Error);
    errors.map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

/// Collects findings about a scene file and the files that it names.
pub(crate) struct Report {
    file: String,
    diagnostics: Vec<Diagnostic>,
}

impl Report {
    pub(crate) fn new(file: &str) -> Self {
        Self { file: file.to_owned(), diagnostics: Vec::new() }
    }

    pub(crate) fn error(&mut self, place: Place, message: impl Into<String>) {
        self.push(Severity::Error, self.file.clone(), place, message.into());
    }

    pub(crate) fn warning(&mut self, place: Place, message: impl Into<String>) {
        self.push(Severity::Warning, self.file.clone(), place, message.into());
    }

    /// An error in another file than the scene's own.
    pub(crate) fn error_in(&mut self, file: &str, place: Place, message: impl Into<String>) {
        self.push(Severity::Error, file.to_owned(), place, message.into());
    }

    fn push(&mut self, severity: Severity, file: String, Place { line, column }: Place, message: String) {
        self.diagnostics.push(Diagnostic { severity, file, line, column, message });
    }

    /// Ends with a problem that leaves nothing to go on with.
    pub(crate) fn fail(mut self, place: Place, message: impl Into<String>) -> OpenError {
        self.error(place, message);
        OpenError { diagnostics: self.diagnostics }
    }

    /// The findings by place, those about the scene file first; the error if there is one among them.
    pub(crate) fn finish(mut self) -> Result<Vec<Diagnostic>, OpenError> {
        let main = self.file;
        self.diagnostics.sort_by(|a, b| {
            let key = |d: &Diagnostic| (d.file != main, d.line, d.column);
            key(a).0.cmp(&key(b).0).then_with(|| a.file.cmp(&b.file)).then_with(|| key(a).cmp(&key(b)))
        });
        if self.diagnostics.iter().any(|d| d.severity == Severity::Error) {
            Err(OpenError { diagnostics: self.diagnostics })
        } else {
            Ok(self.diagnostics)
        }
    }
}
