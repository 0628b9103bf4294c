//! What is wrong with a scene file, and where: every finding names its file, line and column.
//!
//! No rendering of source excerpts and no colours; the binary prints these as they are.

use std::fmt;
use std::path::{Path, PathBuf};

use foton_input::{printable, shown_path};
use foton_math::Cancelled;

use crate::spelling::did_you_mean;

/// More errors, or warnings, than these are only counted.
const MAX_FINDINGS: usize = 1000;

/// So many times a nearest name is looked for among those of a file, which may be many and long.
const MAX_HINTS: u32 = 50;

/// A file looks for others in so many folders, and in those of the files that include it.
const MAX_FOLDERS: usize = 64;

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
/// Displays as `room.xml:12:8: unknown bsdf "dielectrc", did you mean "dielectric"?`, in one line, everything escaped that is not
/// printable.
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
        let Self { line, column, .. } = self;
        let (file, message) = (shown_path(Path::new(&self.file)), printable(&self.message));
        match (line, column) {
            (0, _) => write!(f, "{file}: {message}"),
            (_, 0) => write!(f, "{file}:{line}: {message}"),
            _ => write!(f, "{file}:{line}:{column}: {message}"),
        }
    }
}

/// Why a scene could not be opened. Displays the errors, one a line.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// Everything found in one go, in the order of the file: at least one error; warnings are among them.
    #[error("{}", errors_by_line(.0))]
    Faults(Vec<Diagnostic>),
    /// Someone asked to stop: nothing is said of the file.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl OpenError {
    /// What is wrong with the file; nothing where reading was cancelled.
    #[must_use]
    pub fn diagnostics(&self) -> &[Diagnostic] {
        match self {
            Self::Faults(diagnostics) => diagnostics,
            Self::Cancelled(_) => &[],
        }
    }
}

fn errors_by_line(diagnostics: &[Diagnostic]) -> String {
    let errors = diagnostics.iter().filter(|d| d.severity == Severity::Error);
    errors.map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

/// A scene file, or one that it includes.
struct Source {
    /// As the caller or the scene named it.
    file: String,
    /// Where it is.
    folder: PathBuf,
    /// Where the files that it names are looked for, the best place first.
    folders: Vec<PathBuf>,
    /// How many lines come before it: lines of included files are counted on behind those of all files before.
    lines_before: u32,
    /// How many lines it has.
    lines: u32,
}

/// Collects findings about a scene file and the files that it names.
pub(crate) struct Report {
    sources: Vec<Source>,
    diagnostics: Vec<Diagnostic>,
    /// How many errors and warnings there are, listed or not.
    errors: usize,
    warnings: usize,
    hints: u32,
}

impl Report {
    /// For a scene called `file`, which looks for files in `folder`.
    pub(crate) fn new(file: &str, folder: &Path) -> Self {
        let folders = vec![folder.to_owned()];
        let main =
            Source { file: file.to_owned(), folder: folder.to_owned(), folders, lines_before: 0, lines: 0 };
        Self { sources: vec![main], diagnostics: Vec::new(), errors: 0, warnings: 0, hints: 0 }
    }

    /// Says how long the scene's own text is, before anything is included.
    pub(crate) fn main_text(&mut self, text: &str) {
        self.sources[0].lines = lines(text);
    }

    /// Adds a file that is included at `place`. The number of lines to add to places in it.
    pub(crate) fn include(&mut self, file: &str, folder: &Path, text: &str, place: Place) -> u32 {
        let lines_before = self.sources.last().map_or(0, |s| s.lines_before.saturating_add(s.lines));
        let mut folders = self.folders(place).to_vec();
        folders.insert(0, folder.to_owned());
        let (file, folder) = (file.to_owned(), folder.to_owned());
        self.sources.push(Source { file, folder, folders, lines_before, lines: lines(text) });
        lines_before
    }

    /// Where files that are named at `place` are looked for, the best place first.
    pub(crate) fn folders(&self, place: Place) -> &[PathBuf] {
        &self.source(place).folders
    }

    /// Looks in `folder` before all others, for files named in the file of `place`; from that file's own folder, as Mitsuba 3.
    /// An error where that are too many.
    pub(crate) fn look_in(&mut self, folder: &str, place: Place) {
        let index = self.source_index(place);
        if self.sources[index].folders.len() >= MAX_FOLDERS {
            return self.error(place, format!("files are looked for in {MAX_FOLDERS} folders already"));
        }
        let folder = self.sources[index].folder.join(folder);
        self.sources[index].folders.insert(0, folder);
    }

    fn source_index(&self, place: Place) -> usize {
        self.sources.partition_point(|s| s.lines_before < place.line).saturating_sub(1)
    }

    fn source(&self, place: Place) -> &Source {
        &self.sources[self.source_index(place)]
    }

    /// `line 3`, with the name of the file unless `seen_from` is in it.
    pub(crate) fn line(&self, place: Place, seen_from: Place) -> String {
        let source = self.source(place);
        let line = place.line - source.lines_before;
        if self.source_index(seen_from) == self.source_index(place) {
            format!("line {line}")
        } else {
            format!("line {line} of {}", shown_path(Path::new(&source.file)))
        }
    }

    pub(crate) fn error(&mut self, place: Place, message: impl Into<String>) {
        self.push_here(Severity::Error, place, message.into());
    }

    pub(crate) fn warning(&mut self, place: Place, message: impl Into<String>) {
        self.push_here(Severity::Warning, place, message.into());
    }

    /// A warning, unless the same was said before.
    pub(crate) fn warn_once(&mut self, place: Place, message: String) {
        if !self.diagnostics.iter().any(|d| d.message == message) {
            self.warning(place, message);
        }
    }

    /// An error in another file than the scene's own.
    pub(crate) fn error_in(&mut self, file: &str, place: Place, message: impl Into<String>) {
        self.push(Severity::Error, file.to_owned(), place, message.into());
    }

    /// A warning about another file than the scene's own.
    pub(crate) fn warning_in(&mut self, file: &str, place: Place, message: impl Into<String>) {
        self.push(Severity::Warning, file.to_owned(), place, message.into());
    }

    fn push_here(&mut self, severity: Severity, mut place: Place, message: String) {
        let source = self.source(place);
        place.line -= source.lines_before;
        self.push(severity, source.file.clone(), place, message);
    }

    /// Whether there are so many errors that looking for more is of no use.
    pub(crate) fn is_full(&self) -> bool {
        self.errors >= MAX_FINDINGS
    }

    /// [`did_you_mean`] with names of the file; nothing once that was asked for often.
    pub(crate) fn did_you_mean<'a>(
        &mut self,
        name: &str,
        known: impl IntoIterator<Item = &'a str>,
    ) -> String {
        self.hints += 1;
        if self.hints > MAX_HINTS { String::new() } else { did_you_mean(name, known) }
    }

    fn push(&mut self, severity: Severity, file: String, Place { line, column }: Place, message: String) {
        let count = match severity {
            Severity::Error => &mut self.errors,
            Severity::Warning => &mut self.warnings,
        };
        *count += 1;
        if *count > MAX_FINDINGS {
            return;
        }
        self.diagnostics.push(Diagnostic { severity, file, line, column, message });
    }

    /// How many errors and warnings are not listed.
    fn unlisted(&self) -> [(Severity, usize, &'static str); 2] {
        let beyond = |count: usize| count.saturating_sub(MAX_FINDINGS);
        [
            (Severity::Error, beyond(self.errors), "errors"),
            (Severity::Warning, beyond(self.warnings), "warnings"),
        ]
    }

    /// Ends with a problem that leaves nothing to go on with.
    pub(crate) fn fail(mut self, place: Place, message: impl Into<String>) -> OpenError {
        self.error(place, message);
        OpenError::Faults(self.diagnostics)
    }

    /// The findings by place, those about the scene file first; the error if there is one among them.
    pub(crate) fn finish(mut self) -> Result<Vec<Diagnostic>, OpenError> {
        let (has_errors, unlisted) = (self.errors > 0, self.unlisted());
        let main = self.sources.swap_remove(0).file;
        self.diagnostics.sort_by(|a, b| {
            let key = |d: &Diagnostic| (d.file != main, d.line, d.column);
            key(a).0.cmp(&key(b).0).then_with(|| a.file.cmp(&b.file)).then_with(|| key(a).cmp(&key(b)))
        });
        let more = unlisted.map(|(severity, n, what)| {
            (n > 0).then(|| Diagnostic {
                severity,
                file: main.clone(),
                line: 0,
                column: 0,
                message: format!("{n} more {what}"),
            })
        });
        self.diagnostics.extend(more.into_iter().flatten());
        if has_errors { Err(OpenError::Faults(self.diagnostics)) } else { Ok(self.diagnostics) }
    }
}

/// Lines of a text, the last one counted even if it is empty.
fn lines(text: &str) -> u32 {
    u32::try_from(text.matches('\n').count() + 1).unwrap_or(u32::MAX)
}
