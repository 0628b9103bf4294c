//! `cargo xtask mutations`: takes protections out, one at a time, and sees whether the test that should notice does.
//!
//! The list is in `list`. It works on a copy of the tree in the target folder, whose first build takes some minutes, so that
//! nothing here is ever changed. Not part of `ci`.

mod list;
mod mutation;
mod targets;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use mutation::Mutation;

use crate::tools::{self, Trouble};

/// Takes out all protections whose description has one of `words`, divided by commas, in it; each test must pass before, and fail
/// after.
pub(crate) fn run(words: &str) -> Result<(), Trouble> {
    let chosen: Vec<&Mutation> =
        list::all().filter(|m| words.split(',').any(|word| m.what.contains(word))).collect();
    let tree = tools::target_dir().join("mutations");
    copy_to(&tree).map_err(|cause| Trouble::Failed(format!("{}: {cause}", tree.display())))?;
    let mut faults = 0;
    let tests: BTreeSet<(&str, &str)> = chosen.iter().map(|m| (m.target, m.test)).collect();
    for (target, test) in tests {
        if outcome(&tree, target, test) != Outcome::Passed {
            return Err(Trouble::Failed(format!("{test} does not pass as things are")));
        }
    }
    for mutation in &chosen {
        let path = tree.join(mutation.file);
        let whole = read(&path)?;
        write(&path, &mutation.applied_to(&whole)?)?;
        let outcome = outcome(&tree, mutation.target, mutation.test);
        write(&path, &whole)?;
        faults += usize::from(outcome != Outcome::Failed);
        let said = match outcome {
            Outcome::Failed => "noticed by",
            Outcome::Passed => "NOT NOTICED BY",
            Outcome::NotRun => "DOES NOT BUILD FOR",
        };
        println!("{}: {said} {}", mutation.what, mutation.test);
    }
    println!("{} taken out, {} noticed", chosen.len(), chosen.len() - faults);
    if faults > 0 { Err(Trouble::Failed(format!("{faults} were not"))) } else { Ok(()) }
}

#[derive(PartialEq, Eq)]
enum Outcome {
    Passed,
    Failed,
    /// It was not built, or there is no such test.
    NotRun,
}

fn outcome(tree: &Path, target: &str, test: &str) -> Outcome {
    let mut command = tools::cargo(&["test", "--locked", "--quiet"]);
    command.args(target.split(' ')).arg(test);
    let output = command.current_dir(tree).env("CARGO_TARGET_DIR", tree.join("target")).output();
    let said = output.map(|o| String::from_utf8_lossy(&o.stdout).into_owned()).unwrap_or_default();
    if said.lines().any(|line| line.starts_with("test result: FAILED")) {
        Outcome::Failed
    } else if said.contains("ok. 1 passed") {
        Outcome::Passed
    } else {
        Outcome::NotRun
    }
}

/// Copies what git knows or would add; files that are the same already keep their time, so that cargo does not build them again. What
/// the repository no longer has goes: a module that became a folder would otherwise be there twice.
fn copy_to(tree: &Path) -> std::io::Result<()> {
    let mut git = std::process::Command::new("git");
    git.args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"]).current_dir(tools::root());
    let names = git.output()?.stdout;
    let names = String::from_utf8_lossy(&names);
    let known: BTreeSet<PathBuf> = names.split_terminator('\0').map(|name| tree.join(name)).collect();
    if tree.exists() {
        remove_unknown(tree, &known, &tree.join("target"))?;
    }
    for name in names.split_terminator('\0') {
        let (from, to): (PathBuf, PathBuf) = (tools::root().join(name), tree.join(name));
        let Ok(bytes) = fs::read(&from) else { continue };
        if fs::read(&to).is_ok_and(|there| there == bytes) {
            continue;
        }
        fs::create_dir_all(to.parent().unwrap_or(tree))?;
        fs::write(to, bytes)?;
    }
    Ok(())
}

/// Removes all files under `folder` that are not `known`, except those of the folder `spared`.
fn remove_unknown(folder: &Path, known: &BTreeSet<PathBuf>, spared: &Path) -> std::io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path == spared {
            continue;
        }
        if path.is_dir() && !path.is_symlink() {
            remove_unknown(&path, known, spared)?;
        } else if !known.contains(&path) {
            fs::remove_file(&path)?;
        }
    }
    Ok(())
}

fn read(path: &Path) -> Result<String, Trouble> {
    fs::read_to_string(path).map_err(|cause| Trouble::Failed(format!("{}: {cause}", path.display())))
}

fn write(path: &Path, text: &str) -> Result<(), Trouble> {
    fs::write(path, text).map_err(|cause| Trouble::Failed(format!("{}: {cause}", path.display())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_protection_of_the_list_is_where_it_says() {
        for mutation in list::all() {
            let text = read(&tools::root().join(mutation.file)).expect("a file of the repository");
            let changed = mutation.applied_to(&text).expect("there once");
            assert_ne!(changed, text, "{}", mutation.what);
        }
        assert!(list::all().count() >= 10);
    }

    #[test]
    fn a_module_that_became_a_folder_is_not_left_in_the_copy() {
        let tree = tools::target_dir().join("mutations-copy-test");
        let _ = fs::remove_dir_all(&tree);
        for name in ["src/stage.rs", "src/stage/mod.rs", "target/built"] {
            fs::create_dir_all(tree.join(name).parent().expect("a folder")).expect("created");
            fs::write(tree.join(name), "").expect("written");
        }
        let known = BTreeSet::from([tree.join("src/stage/mod.rs")]);
        remove_unknown(&tree, &known, &tree.join("target")).expect("removed");
        let there = |name: &str| tree.join(name).exists();
        assert_eq!(
            [there("src/stage.rs"), there("src/stage/mod.rs"), there("target/built")],
            [false, true, true]
        );
        let _ = fs::remove_dir_all(&tree);
    }
}
