//! No circles between the files of a crate: of any two files at most one knows the other, directly or by way of others.
//!
//! Imports are read as text: `crate::…` and `super::…` paths, outside tests and comments. A name that a module passes on with
//! `pub use` counts as imported from where it is defined. `mod` lines are no imports.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

#[test]
fn files_of_a_crate_import_each_other_without_circles() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("in the workspace").join("crates");
    let mut faults = Vec::new();
    for entry in fs::read_dir(crates).expect("there are crates") {
        let folder = entry.expect("readable").path();
        let sources = Sources::of(&folder.join("src"));
        for circle in circles(&sources.imports()) {
            let name = folder.file_name().expect("a name").to_string_lossy().into_owned();
            faults.push(format!("{name}: {}", circle.join(", ")));
        }
    }
    assert!(faults.is_empty(), "these files import each other in a circle:\n{}", faults.join("\n"));
}

#[test]
fn circles_are_recognised() {
    let of = |files: &[(&str, &str)]| {
        let modules = files.iter().map(|(m, text)| ((*m).to_owned(), code(text))).collect();
        circles(&Sources { modules }.imports())
    };
    let two = [("", "mod a; mod b;"), ("a", "use crate::b::B;"), ("b", "fn f(x: super::a::A) {}")];
    assert_eq!(of(&two), [["a", "b"]]);
    assert!(
        of(&[two[0], two[1], ("b", "// use super::a::A;\n#[cfg(test)]\nmod tests {\nuse crate::a::A; }")])
            .is_empty()
    );
    // A name that is passed on is its child's; a method of a type may stand in a file that the type's own does not know.
    let passed_on = [
        ("m", "mod a; mod b; pub use a::A; pub(crate) use b::{B as C};"),
        ("m::a", "use super::b::B;"),
        ("m::b", ""),
        ("n", "use crate::m::{A, C};"),
    ];
    assert!(of(&passed_on).is_empty());
    assert_eq!(
        of(&[passed_on[0], ("m::a", "use super::C;"), ("m::b", "use crate::m::A;")]),
        [["m::a", "m::b"]]
    );
    assert_eq!(
        of(&[("", ""), ("a", "use crate::{b, c};"), ("b", ""), ("c", "use crate::{a::{self, X}};")]),
        [["a", "c"]]
    );
}

/// The code of a crate by module: `""` for its root, `"a::b"` for `a/b.rs` or `a/b/mod.rs`.
struct Sources {
    modules: BTreeMap<String, String>,
}

impl Sources {
    fn of(folder: &Path) -> Self {
        let mut modules = BTreeMap::new();
        let mut left: Vec<PathBuf> = vec![folder.to_owned()];
        while let Some(path) = left.pop() {
            if path.is_dir() {
                left.extend(fs::read_dir(&path).expect("readable").map(|e| e.expect("readable").path()));
                continue;
            }
            let within = path.strip_prefix(folder).expect("inside").with_extension("");
            let mut parts: Vec<String> = within.iter().map(|p| p.to_string_lossy().into_owned()).collect();
            let is_test = parts.iter().any(|p| p == "tests" || p.ends_with("_tests"));
            if path.extension().is_none_or(|e| e != "rs") || is_test {
                continue;
            }
            if parts.last().is_some_and(|last| ["mod", "lib", "main"].contains(&last.as_str())) {
                parts.pop();
            }
            modules.insert(parts.join("::"), code(&fs::read_to_string(&path).expect("text")));
        }
        Self { modules }
    }

    /// Which modules each module imports from.
    fn imports(&self) -> BTreeMap<String, BTreeSet<String>> {
        let import = |(module, text): (&String, &String)| {
            let paths =
                paths(text, &["crate", "super"]).into_iter().filter_map(|path| self.absolute(module, &path));
            let within: Vec<String> =
                module.split("::").filter(|p| !p.is_empty()).map(str::to_owned).collect();
            let own = |path: Vec<String>| within.iter().cloned().chain(path).collect();
            let children = self.children(module);
            let children = paths_of_children(text, &children).into_iter().map(own);
            let found =
                paths.chain(children).filter_map(|path| self.home(&path, 0)).filter(|home| home != module);
            (module.clone(), found.collect())
        };
        self.modules.iter().map(import).collect()
    }

    /// Names of the files below a module.
    fn children(&self, module: &str) -> Vec<&str> {
        let below = |other: &'_ String| -> Option<usize> {
            let (parent, _) = other.rsplit_once("::").unwrap_or(("", other));
            (parent == module && !other.is_empty())
                .then(|| if parent.is_empty() { 0 } else { parent.len() + 2 })
        };
        self.modules.keys().filter_map(|other| below(other).map(|at| &other[at..])).collect()
    }

    /// A path from the root of the crate.
    fn absolute(&self, module: &str, path: &[String]) -> Option<Vec<String>> {
        let mut at: Vec<String> = module.split("::").filter(|p| !p.is_empty()).map(str::to_owned).collect();
        let mut rest = path;
        match rest.first()?.as_str() {
            "crate" => at.clear(),
            "super" => {}
            _ => return None,
        }
        while let Some((first, others)) = rest.split_first() {
            match first.as_str() {
                "crate" | "self" => {}
                "super" => drop(at.pop()),
                _ => break,
            }
            rest = others;
        }
        at.extend(rest.iter().cloned());
        Some(at)
    }

    /// The module that defines what a path names, as far as modules are files.
    fn home(&self, path: &[String], depth: usize) -> Option<String> {
        let found = (0..=path.len()).rev().find(|&n| self.modules.contains_key(&path[..n].join("::")))?;
        let module = path[..found].join("::");
        // What is named by its module alone is looked for in that module.
        let Some(name) = path.get(found).filter(|_| depth < 8) else { return Some(module) };
        for (passed_on, from) in passed_on(&self.modules[&module]) {
            if passed_on == *name {
                let from: Vec<String> = match from[0].as_str() {
                    "crate" | "super" => self.absolute(&module, &from)?,
                    _ => path[..found].iter().cloned().chain(from).collect(),
                };
                return self.home(&from, depth + 1).or(Some(module));
            }
        }
        Some(module)
    }
}

/// A file without its comments and without what stands behind its first test.
fn code(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    // A module for tests stands last.
    let is_for_tests = |two: &[&str]| {
        two[0].starts_with("#[cfg(")
            && two[0].contains("test")
            && two[1].contains("mod ")
            && two[1].ends_with('{')
    };
    let end = lines.windows(2).position(is_for_tests).unwrap_or(lines.len());
    lines[..end].iter().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// The paths that begin with one of these, with those of braces one by one.
fn paths(text: &str, roots: &[&str]) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    for root in roots {
        for (at, _) in text.match_indices(&format!("{root}::")) {
            let before = text[..at].chars().next_back().unwrap_or(' ');
            if !(before.is_alphanumeric() || before == '_' || before == ':') {
                tree(&text[at..], &[], &mut found);
            }
        }
    }
    found
}

/// What a module uses of the files below it. To pass a name on is not to use it.
fn paths_of_children(text: &str, children: &[&str]) -> Vec<Vec<String>> {
    let statements = text.split_inclusive(';');
    let passes_on = |statement: &str| {
        let begin = statement.trim_start();
        let begin = begin.rsplit("]\n").next().unwrap_or(begin).trim_start();
        begin.starts_with("pub use ") || begin.starts_with("pub(") && begin.contains(") use ")
    };
    statements
        .filter(|statement| !passes_on(statement))
        .flat_map(|statement| paths(statement, children))
        .collect()
}

/// What a module passes on: names, and where they come from.
fn passed_on(text: &str) -> Vec<(String, Vec<String>)> {
    let mut found = Vec::new();
    for (at, _) in text.match_indices("pub") {
        let rest = &text[at + 3..];
        let rest =
            if rest.starts_with('(') { rest.split_once(')').map_or("", |(_, rest)| rest) } else { rest };
        if let Some(rest) = rest.strip_prefix(" use ") {
            let mut paths = Vec::new();
            tree(rest, &[], &mut paths);
            for path in paths {
                let (name, from) = match path.iter().position(|p| p.starts_with(" as ")) {
                    Some(at) => (path[at][4..].to_owned(), path[..at].to_vec()),
                    None => (path.last().cloned().unwrap_or_default(), path),
                };
                found.push((name, from));
            }
        }
    }
    found
}

/// Reads a path, or a tree of paths in braces; returns the rest of the text.
fn tree<'a>(text: &'a str, before: &[String], found: &mut Vec<Vec<String>>) -> &'a str {
    let mut path = before.to_vec();
    let mut rest = text.trim_start();
    loop {
        if let Some(inside) = rest.strip_prefix('{') {
            let mut inside = inside;
            loop {
                inside = inside.trim_start_matches([',', ' ', '\n']);
                if let Some(after) = inside.strip_prefix('}') {
                    return after;
                }
                let after = tree(inside, &path, found);
                if after.len() == inside.len() {
                    return after;
                }
                inside = after;
            }
        }
        let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_' || c == '*')).unwrap_or(rest.len());
        if end == 0 {
            break;
        }
        path.push(rest[..end].to_owned());
        rest = &rest[end..];
        match rest.strip_prefix("::") {
            Some(after) => rest = after,
            None => break,
        }
    }
    if let Some(after) = rest.strip_prefix(" as ") {
        let end = after.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(after.len());
        path.push(format!(" as {}", &after[..end]));
        rest = &after[end..];
    }
    found.push(path);
    rest
}

/// The circles: modules that import each other, directly or not, each list in order.
fn circles(imports: &BTreeMap<String, BTreeSet<String>>) -> Vec<Vec<String>> {
    let reached = |from: &String| {
        let (mut seen, mut left) = (BTreeSet::new(), vec![from]);
        while let Some(module) = left.pop() {
            for next in imports.get(module).into_iter().flatten() {
                if seen.insert(next) {
                    left.push(next);
                }
            }
        }
        seen
    };
    let reach: BTreeMap<&String, BTreeSet<&String>> = imports.keys().map(|m| (m, reached(m))).collect();
    let mut circles = BTreeSet::new();
    for (module, seen) in &reach {
        let circle: Vec<String> = seen
            .iter()
            .filter(|other| reach.get(**other).is_some_and(|back| back.contains(*module)))
            .map(|m| (*m).clone())
            .collect();
        if circle.len() > 1 {
            circles.insert(circle);
        }
    }
    circles.into_iter().collect()
}
