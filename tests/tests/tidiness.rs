//! The house rules that a program can check: openings, lengths, leftovers, citations, lints, licences.
//!
//! Rules of taste are not here; they stand in ARCHITECTURE.md.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What must not be left in code. Split, so that this file does not contain it.
const LEFTOVERS: &[&str] = &[
    concat!("to", "do!"),
    concat!("unimple", "mented!"),
    concat!("#[ig", "nore"),
    concat!("TO", "DO"),
    concat!("FIX", "ME"),
];

const DOCUMENTS: &[&str] = &["README.md", "ARCHITECTURE.md", "CHANGELOG.md", "REFERENCES.md", "SECURITY.md"];

#[test]
fn every_file_opens_by_saying_what_it_is() {
    let opening = |path: &Path| if has_extension(path, "wgsl") { "//" } else { "//!" };
    let faults = code_files().into_iter().filter(|path| !read(path).starts_with(opening(path)));
    none(faults.map(|path| format!("{}: does not open with {}", shown(&path), opening(&path))));
}

#[test]
fn no_work_is_left_in_the_code() {
    none(every_line().filter_map(|line| {
        let found = LEFTOVERS.iter().find(|leftover| line.text.contains(**leftover))?;
        Some(format!("{}: {found}", line.place))
    }));
}

#[test]
fn every_citation_is_in_the_references() {
    let references = read(&root().join("REFERENCES.md"));
    none(every_line().filter(|line| line.text.trim_start().starts_with("//")).flat_map(|line| {
        let unknown = citations(&line.text).into_iter().filter(|key| !references.contains(key.as_str()));
        unknown.map(|key| format!("{}: [{key}] is not in REFERENCES.md", line.place)).collect::<Vec<_>>()
    }));
}

/// Everything but `foton-input` reads files through it. Exempt are tasks of developers and the system's own numbers.
#[test]
fn files_are_opened_in_one_place() {
    let opens = [concat!("fs::re", "ad("), concat!("fs::read_to", "_string("), concat!("File::op", "en(")];
    let exempt = [
        "crates/foton-input/",
        "crates/xtask/",
        // The system's own numbers.
        "crates/foton/src/memory.rs",
        "crates/foton/src/signals.rs",
        // Outputs: what is there already.
        "crates/foton-film/src/atomic/",
    ];
    let of_program = |place: &str| {
        place.starts_with("crates/")
            && place.contains("/src/")
            && !place.contains("/tests")
            && !exempt.iter().any(|e| place.starts_with(e))
    };
    let files = code_files().into_iter().filter(|path| of_program(&shown(path)));
    none(files.flat_map(|path| {
        let text = read(&path);
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        let lines = code.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with("//"));
        let faults = lines.filter(|(_, line)| opens.iter().any(|open| line.contains(open)));
        faults.map(|(i, line)| format!("{}:{}: {}", shown(&path), i + 1, line.trim())).collect::<Vec<_>>()
    }));
}

#[test]
fn citations_are_recognised() {
    assert_eq!(
        citations("/// As [PPM08], eq. 4; [`Ray`], [2], [HJJ10][SPPM09]."),
        ["PPM08", "HJJ10", "SPPM09"]
    );
}

#[test]
fn the_documents_exist() {
    none(
        DOCUMENTS.iter().filter(|name| !root().join(name).is_file()).map(|name| format!("{name} is missing")),
    );
}

#[test]
fn every_crate_obeys_the_lints_of_the_workspace() {
    let folders = crate_folders().into_iter().chain([root().join("tests")]);
    none(folders.map(|folder| folder.join("Cargo.toml")).filter_map(|path| {
        let manifest: toml::Table = read(&path).parse().expect("cargo has read it already");
        let inherited = manifest.get("lints").and_then(|lints| lints.get("workspace")?.as_bool());
        (inherited != Some(true)).then(|| format!("{}: lacks [lints] workspace = true", shown(&path)))
    }));
}

#[test]
fn the_architecture_names_every_crate() {
    let architecture = read(&root().join("ARCHITECTURE.md"));
    let names =
        crate_folders().into_iter().map(|folder| folder.file_name().unwrap().to_string_lossy().into_owned());
    none(
        names
            .filter(|name| !mentions(&architecture, name))
            .map(|name| format!("ARCHITECTURE.md: nothing of {name}")),
    );
}

#[test]
fn every_package_we_link_has_an_allowed_licence() {
    let rules: toml::Table = read(&root().join("deny.toml")).parse().expect("deny.toml is TOML");
    let allowed: Vec<&str> = rules["licenses"]["allow"]
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(toml::Value::as_str)
        .collect();
    let metadata = metadata();
    let packages = metadata["packages"].as_array().expect("a list of packages");
    none(packages.iter().filter_map(|package| {
        let licence = package["license"].as_str().unwrap_or("none given");
        (!permits(licence, &allowed)).then(|| format!("{}: {licence}", package["name"]))
    }));
}

#[test]
fn licence_expressions_are_understood() {
    let allowed = ["MIT", "Apache-2.0", "Unicode-3.0"];
    for good in [
        "MIT",
        "MIT OR GPL-3.0",
        "GPL-2.0/MIT",
        "(MIT OR GPL-3.0) AND Unicode-3.0",
        "Apache-2.0 WITH LLVM-exception",
    ] {
        assert!(permits(good, &allowed), "{good}");
    }
    for bad in
        ["GPL-3.0-only", "MIT AND GPL-3.0", "AGPL-3.0 OR GPL-3.0", "(MIT OR Apache-2.0) AND GPL-2.0", ""]
    {
        assert!(!permits(bad, &allowed), "{bad}");
    }
}

/// Whether an SPDX expression can be met with the allowed licences alone. `AND` binds more tightly than `OR`.
fn permits(expression: &str, allowed: &[&str]) -> bool {
    let spaced = expression.replace('(', " ( ").replace(')', " ) ").replace('/', " OR ");
    let mut words = spaced.split_whitespace().peekable();
    any_of(&mut words, allowed) && words.next().is_none()
}

type Words<'a> = std::iter::Peekable<std::str::SplitWhitespace<'a>>;

fn any_of(words: &mut Words<'_>, allowed: &[&str]) -> bool {
    let mut met = all_of(words, allowed);
    while words.next_if_eq(&"OR").is_some() {
        met |= all_of(words, allowed);
    }
    met
}

fn all_of(words: &mut Words<'_>, allowed: &[&str]) -> bool {
    let mut met = one(words, allowed);
    while words.next_if_eq(&"AND").is_some() {
        met &= one(words, allowed);
    }
    met
}

fn one(words: &mut Words<'_>, allowed: &[&str]) -> bool {
    if words.next_if_eq(&"(").is_some() {
        return any_of(words, allowed) & words.next_if_eq(&")").is_some();
    }
    let met = words.next().is_some_and(|licence| allowed.contains(&licence));
    // An exception only ever permits more.
    if words.next_if_eq(&"WITH").is_some() {
        words.next();
    }
    met
}

/// What cargo knows of the packages that are built on this platform.
fn metadata() -> serde_json::Value {
    let host = run(Command::new(env!("CARGO")).arg("-vV"));
    let host = host.lines().find_map(|line| line.strip_prefix("host: ")).expect("cargo names its host");
    let arguments = ["metadata", "--format-version", "1", "--offline", "--filter-platform", host];
    serde_json::from_str(&run(Command::new(env!("CARGO")).args(arguments).current_dir(root()))).expect("JSON")
}

fn run(command: &mut Command) -> String {
    let output = command.output().expect("cargo runs");
    assert!(output.status.success(), "{command:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// A line of Rust code and where it stands.
struct Line {
    place: String,
    text: String,
}

fn every_line() -> impl Iterator<Item = Line> {
    code_files().into_iter().filter(|path| has_extension(path, "rs")).flat_map(|path| {
        let text = read(&path);
        let lines = text.lines().enumerate();
        let numbered = lines
            .map(|(i, line)| Line { place: format!("{}:{}", shown(&path), i + 1), text: line.to_owned() });
        numbered.collect::<Vec<_>>()
    })
}

/// The keys in square brackets that look like a paper's: two to five capitals and the year.
fn citations(line: &str) -> Vec<String> {
    let bracketed = line.split('[').skip(1).filter_map(|rest| rest.split_once(']')).map(|(key, _)| key);
    let is_key = |key: &&str| {
        let letters = key.trim_end_matches(|c: char| c.is_ascii_digit());
        key.is_ascii()
            && key.len() == letters.len() + 2
            && (2..=5).contains(&letters.len())
            && letters.chars().all(|c| c.is_ascii_uppercase())
    };
    bracketed.filter(is_key).map(str::to_owned).collect()
}

/// Whether `text` holds `name` as a word of its own: `foton-math` does not mention `foton`.
fn mentions(text: &str, name: &str) -> bool {
    text.split(|c: char| !c.is_alphanumeric() && c != '-' && c != '_').any(|word| word == name)
}

/// All Rust and WGSL files of the project.
fn code_files() -> Vec<PathBuf> {
    let files = ["crates", "shaders", "tests"].iter().flat_map(|folder| files(&root().join(folder)));
    let code: Vec<PathBuf> =
        files.filter(|path| has_extension(path, "rs") || has_extension(path, "wgsl")).collect();
    assert!(code.len() > 10, "code is not found below {}", root().display());
    code
}

/// All files below a folder; none where it does not exist.
fn files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let paths = entries.map(|entry| entry.expect("a readable folder").path());
    paths.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}

fn crate_folders() -> Vec<PathBuf> {
    let entries = fs::read_dir(root().join("crates")).expect("crates/ is there");
    entries.map(|entry| entry.expect("a readable folder").path()).filter(|path| path.is_dir()).collect()
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ lies in the root").to_path_buf()
}

fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|found| found == extension)
}

fn shown(path: &Path) -> String {
    path.strip_prefix(root()).unwrap_or(path).display().to_string()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|cause| panic!("{}: {cause}", path.display()))
}

/// Fails with all faults at once.
#[track_caller]
fn none(faults: impl Iterator<Item = String>) {
    let faults: Vec<String> = faults.collect();
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}
