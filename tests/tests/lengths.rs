//! A file holds one idea and a function fits a screen: bounds on their lines, by rustfmt's layout.

use std::fs;
use std::path::{Path, PathBuf};

/// A file longer than this holds more than one idea.
const MAX_FILE_LINES: usize = 400;

/// A function longer than this, with its signature, is more than one step.
const MAX_FUNCTION_LINES: usize = 60;

const FOLDERS: [&str; 5] = ["crates", "shaders", "tests", "fuzz", "benches"];

#[test]
fn no_file_is_too_long() {
    let lengths = code_files().into_iter().map(|path| (text(&path).lines().count(), path));
    let faults = lengths.filter(|(lines, _)| *lines > MAX_FILE_LINES);
    none(faults.map(|(lines, path)| format!("{}: {lines} lines, of {MAX_FILE_LINES} at most", shown(&path))));
}

#[test]
fn no_function_is_too_long() {
    let rust = code_files().into_iter().filter(|path| path.extension().is_some_and(|e| e == "rs"));
    none(rust.flat_map(|path| {
        let long = functions(&text(&path)).into_iter().filter(|f| f.lines > MAX_FUNCTION_LINES);
        let fault = |f: Function| {
            let Function { name, line, lines } = f;
            format!("{}:{line}: {name} has {lines} lines, of {MAX_FUNCTION_LINES} at most", shown(&path))
        };
        long.map(fault).collect::<Vec<_>>()
    }));
}

#[test]
fn functions_are_recognised() {
    let code = "impl A {\n    pub(crate) const fn one(&self) -> u8 { 1 }\n\n    fn two(\n        &self,\n    ) -> u8\n    where\n        \
                Self: Sized,\n    {\n        fn three() {\n            if true {\n            }\n        }\n        2\n    }\n}\n\n\
                trait B {\n    fn four(&self);\n    fn five(\n        &self,\n    ) -> u8;\n    fn six(&self) {\n    }\n}\n";
    let found: Vec<_> = functions(code).into_iter().map(|f| (f.name, f.line, f.lines)).collect();
    let expected = [("one", 2, 1), ("two", 4, 12), ("three", 10, 4), ("six", 23, 2)];
    assert_eq!(found, expected.map(|(name, line, lines)| (name.to_owned(), line, lines)));
}

/// A function with a body.
struct Function {
    name: String,
    /// Of its signature, from 1.
    line: usize,
    lines: usize,
}

/// The functions of a file that rustfmt has laid out: the brace that closes a body stands below its signature.
fn functions(text: &str) -> Vec<Function> {
    let lines: Vec<&str> = text.lines().collect();
    let at = |i: usize| {
        let indent = lines[i].len() - lines[i].trim_start().len();
        let name = name_of_function(lines[i].trim_start())?;
        let end = i + lines[i..].iter().position(|line| ends_function(line, indent))?;
        let has_body = lines[end].ends_with('}');
        has_body.then(|| Function { name: name.to_owned(), line: i + 1, lines: end - i + 1 })
    };
    (0..lines.len()).filter_map(at).collect()
}

/// The name where a function's signature begins with this line.
fn name_of_function(line: &str) -> Option<&str> {
    let (before, after) = line.split_once("fn ")?;
    let is_qualifier = |word: &str| {
        matches!(
            word,
            "pub" | "pub(crate)" | "pub(super)" | "const" | "async" | "unsafe" | "extern" | "\"C\""
        )
    };
    let name = after.split(['(', '<']).next()?;
    before.split_whitespace().all(is_qualifier).then_some(name)
}

/// Whether a line ends a function whose signature is indented so far: its last brace, or the end of one without a body.
fn ends_function(line: &str, indent: usize) -> bool {
    let own = line.len() - line.trim_start().len();
    own == indent && (line.ends_with('}') || line.ends_with(';'))
}

/// All Rust and WGSL files of the project.
fn code_files() -> Vec<PathBuf> {
    let files = FOLDERS.iter().flat_map(|folder| files(&root().join(folder)));
    let is_code = |path: &PathBuf| path.extension().is_some_and(|e| e == "rs" || e == "wgsl");
    let code: Vec<PathBuf> = files.filter(is_code).collect();
    assert!(code.len() > 10, "code is not found below {}", root().display());
    code
}

/// All files below a folder, except what cargo has built there.
fn files(folder: &Path) -> Vec<PathBuf> {
    let paths =
        fs::read_dir(folder).into_iter().flatten().map(|entry| entry.expect("a readable folder").path());
    let paths = paths.filter(|path| !path.ends_with("target"));
    paths.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ lies in the root").to_path_buf()
}

fn shown(path: &Path) -> String {
    path.strip_prefix(root()).unwrap_or(path).display().to_string()
}

fn text(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|cause| panic!("{}: {cause}", path.display()))
}

/// Fails with all faults at once.
#[track_caller]
fn none(faults: impl Iterator<Item = String>) {
    let faults: Vec<String> = faults.collect();
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}
