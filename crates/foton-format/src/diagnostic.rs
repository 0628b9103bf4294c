//! What is wrong with a scene file, and where: every finding names its file, line and column.
//!
//! No colours and no layout; the binary and the window show these with the lines that they are about.

use std::collections::HashSet;
use std::fmt;
use std::path::{Path, PathBuf};

use foton_input::{printable, shown_path};
use foton_math::Cancelled;

use crate::excerpt::Excerpt;
use crate::spelling::did_you_mean;

/// More errors, or warnings, than these are only counted.
const MAX_FINDINGS: usize = 1000;

/// So many times a nearest name is looked for among those of a file, which may be many and long.
const MAX_HINTS: u32 = 50;

/// So many findings come with the lines that they are about.
const MAX_EXCERPTS: usize = 200;

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
    /// The line that it is about, if that stands in a scene file.
    pub excerpt: Option<Excerpt>,
    /// What to do about it, or what there is instead.
    pub help: Option<String>,
}

impl Diagnostic {
    /// A finding without an excerpt.
    pub(crate) fn new(
        severity: Severity,
        file: String,
        Place { line, column }: Place,
        message: String,
    ) -> Self {
        Self { severity, file, line, column, message, excerpt: None, help: None }
    }
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
    /// Its text, where that may be shown.
    text: Option<Box<str>>,
}

/// Collects findings about a scene file and the files that it names.
pub(crate) struct Report {
    sources: Vec<Source>,
    diagnostics: Vec<Diagnostic>,
    /// The source of each of these, if it is about a line of one.
    about: Vec<Option<usize>>,
    /// Where the parts of the scene begin, and whether something uses each of them.
    parts: Vec<(Place, bool)>,
    /// What was said already of what to do.
    helps: HashSet<String>,
    /// How many errors and warnings there are, listed or not.
    errors: usize,
    warnings: usize,
    hints: u32,
}

impl Report {
    /// For a scene called `file`, which looks for files in `folder`.
    pub(crate) fn new(file: &str, folder: &Path) -> Self {
        let folders = vec![folder.to_owned()];
        let (file, folder) = (file.to_owned(), folder.to_owned());
        let main = Source { file, folder, folders, lines_before: 0, lines: 0, text: None };
        Self {
            sources: vec![main],
            diagnostics: Vec::new(),
            about: Vec::new(),
            parts: Vec::new(),
            helps: HashSet::new(),
            errors: 0,
            warnings: 0,
            hints: 0,
        }
    }

    /// Says what the scene's own text is, before anything is included, and whether findings may show it.
    pub(crate) fn main_text(&mut self, text: &str, is_shown: bool) {
        self.sources[0].lines = lines(text);
        self.sources[0].text = is_shown.then(|| text.into());
    }

    /// Says where the parts of the scene begin, and whether something uses each: errors in the others are warnings.
    pub(crate) fn parts(&mut self, mut parts: Vec<(Place, bool)>) {
        parts.sort_unstable();
        self.parts = parts;
    }

    /// Whether a place is in a part that nothing uses.
    fn is_unused(&self, place: Place) -> bool {
        let part = self.parts.partition_point(|(begin, _)| *begin <= place).checked_sub(1);
        let part = part.map(|i| self.parts[i]);
        part.is_some_and(|(begin, used)| !used && self.source_index(begin) == self.source_index(place))
    }

    /// Adds a file that is included at `place`. The number of lines to add to places in it.
    pub(crate) fn include(&mut self, file: &str, folder: &Path, text: &str, place: Place) -> u32 {
        let lines_before = self.sources.last().map_or(0, |s| s.lines_before.saturating_add(s.lines));
        let mut folders = self.folders(place).to_vec();
        folders.insert(0, folder.to_owned());
        let (file, folder) = (file.to_owned(), folder.to_owned());
        let (lines, text) = (lines(text), Some(text.into()));
        self.sources.push(Source { file, folder, folders, lines_before, lines, text });
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

    /// The file of a place, and the place in it.
    pub(crate) fn in_file(&self, mut place: Place) -> (String, Place) {
        let source = self.source(place);
        place.line -= source.lines_before;
        (source.file.clone(), place)
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
        if self.is_unused(place) {
            return self.warning(place, format!("{} (nothing uses it)", message.into()));
        }
        self.push_here(Severity::Error, place, message.into());
    }

    /// Says what to do about the last finding, or what there is instead, unless that was said before.
    pub(crate) fn help(&mut self, help: impl Into<String>) {
        let help = help.into();
        if let Some(last) = self.diagnostics.last_mut()
            && self.helps.insert(help.clone())
        {
            last.help = Some(help);
        }
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
        self.push(Diagnostic::new(Severity::Error, file.to_owned(), place, message.into()), None);
    }

    /// A warning about another file than the scene's own.
    pub(crate) fn warning_in(&mut self, file: &str, place: Place, message: impl Into<String>) {
        self.push(Diagnostic::new(Severity::Warning, file.to_owned(), place, message.into()), None);
    }

    fn push_here(&mut self, severity: Severity, mut place: Place, message: String) {
        let index = self.source_index(place);
        let source = &self.sources[index];
        place.line -= source.lines_before;
        let is_about = (place.line > 0 && source.text.is_some()).then_some(index);
        self.push(Diagnostic::new(severity, source.file.clone(), place, message), is_about);
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

    fn push(&mut self, diagnostic: Diagnostic, is_about: Option<usize>) {
        let count = match diagnostic.severity {
            Severity::Error => &mut self.errors,
            Severity::Warning => &mut self.warnings,
        };
        *count += 1;
        if *count > MAX_FINDINGS {
            return;
        }
        self.diagnostics.push(diagnostic);
        self.about.push(is_about);
    }

    /// Gives the first findings the lines that they are about.
    fn excerpts(&mut self) {
        let mut wanted: Vec<(usize, u32, usize)> = self
            .about
            .iter()
            .zip(&self.diagnostics)
            .enumerate()
            .filter_map(|(i, (about, d))| Some(((*about)?, d.line, i)))
            .take(MAX_EXCERPTS)
            .collect();
        wanted.sort_unstable();
        for of_source in wanted.chunk_by(|a, b| a.0 == b.0) {
            let Some(text) = &self.sources[of_source[0].0].text else { continue };
            let mut lines = (1..).zip(text.split('\n'));
            let mut line = lines.next();
            for &(_, number, i) in of_source {
                while line.is_some_and(|(at, _)| at < number) {
                    line = lines.next();
                }
                let diagnostic = &mut self.diagnostics[i];
                diagnostic.excerpt = line.map(|(_, text)| Excerpt::of(text, diagnostic.column));
            }
        }
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
        self.excerpts();
        OpenError::Faults(self.diagnostics)
    }

    /// The findings by place, those about the scene file first; the error if there is one among them.
    pub(crate) fn finish(mut self) -> Result<Vec<Diagnostic>, OpenError> {
        self.excerpts();
        let (has_errors, unlisted) = (self.errors > 0, self.unlisted());
        let main = self.sources.swap_remove(0).file;
        self.diagnostics.sort_by(|a, b| {
            let key = |d: &Diagnostic| (d.file != main, d.line, d.column);
            key(a).0.cmp(&key(b).0).then_with(|| a.file.cmp(&b.file)).then_with(|| key(a).cmp(&key(b)))
        });
        let more = unlisted.map(|(severity, n, what)| {
            let message = || format!("{n} more {what}");
            (n > 0).then(|| Diagnostic::new(severity, main.clone(), Place::default(), message()))
        });
        self.diagnostics.extend(more.into_iter().flatten());
        if has_errors { Err(OpenError::Faults(self.diagnostics)) } else { Ok(self.diagnostics) }
    }
}

/// Lines of a text, the last one counted even if it is empty.
fn lines(text: &str) -> u32 {
    u32::try_from(text.matches('\n').count() + 1).unwrap_or(u32::MAX)
}
