//! The layers of the workspace: which crate may use which, and what the inner ones must never touch.
//!
//! Reads the manifests and sources themselves. Why each rule holds stands in ARCHITECTURE.md.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use toml::{Table, Value};

/// The allowed edges. Dependencies for tests and builds obey them as well.
const LAYERS: &[(&str, &[&str])] = &[
    ("foton-math", &[]),
    ("foton-input", &[]),
    ("foton-scene", &["foton-input", "foton-math"]),
    ("foton-film", &["foton-input", "foton-math"]),
    ("foton-format", &["foton-input", "foton-math", "foton-scene", "foton-film"]),
    ("foton-transport", &["foton-input", "foton-math", "foton-scene"]),
    ("foton-integrator", &["foton-input", "foton-math", "foton-scene", "foton-film", "foton-transport"]),
    ("foton-edit", &["foton-input", "foton-math", "foton-scene"]),
    (
        "foton-session",
        &["foton-input", "foton-math", "foton-scene", "foton-edit", "foton-integrator", "foton-film"],
    ),
    ("foton-preview", &["foton-input", "foton-math", "foton-film", "foton-edit", "foton-session"]),
    ("foton-measure", &["foton-input", "foton-math", "foton-scene", "foton-film", "foton-integrator"]),
    (
        "foton",
        &[
            "foton-input",
            "foton-math",
            "foton-scene",
            "foton-film",
            "foton-format",
            "foton-integrator",
            "foton-session",
            "foton-preview",
            "foton-measure",
        ],
    ),
];

/// Developer tools: they may use everything, and nothing may use them.
const TOOLS: &[&str] = &["xtask", "foton-tests"];

/// Packages that belong to one crate alone.
const OWNED: &[(&str, &str)] = &[
    ("roxmltree", "foton-format"),
    ("exr", "foton-film"),
    ("png", "foton-film"),
    ("clap", "foton"),
    ("indicatif", "foton"),
    ("ctrlc", "foton"),
    ("signal-hook", "foton"),
    ("egui", "foton-preview"),
    ("egui-wgpu", "foton-preview"),
    ("egui-winit", "foton-preview"),
    ("egui_plot", "foton-preview"),
    ("wgpu", "foton-preview"),
    ("winit", "foton-preview"),
];

/// These compute and nothing else: no files, no clocks, no network.
const PURE: &[&str] = &["foton-edit", "foton-integrator", "foton-scene", "foton-transport"];

#[test]
fn crates_depend_on_lower_layers_only() {
    let mut faults = Vec::new();
    for package in packages() {
        let Some(allowed) = allowed(&package.name) else { continue };
        let ours = package.dependencies.iter().filter(|name| is_ours(name));
        for name in ours.filter(|name| !allowed.contains(&name.as_str())) {
            faults.push(format!("{} must not depend on {name}", package.name));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn every_crate_has_a_layer() {
    for package in packages() {
        let known = TOOLS.contains(&package.name.as_str()) || allowed(&package.name).is_some();
        assert!(known, "{} is not in LAYERS: decide what it may depend on", package.name);
    }
}

#[test]
fn packages_with_one_owner_are_used_by_it_alone() {
    let mut faults = Vec::new();
    for package in packages().iter().filter(|package| !TOOLS.contains(&package.name.as_str())) {
        for (dependency, owner) in OWNED {
            if package.dependencies.contains(*dependency) && package.name != *owner {
                faults.push(format!("{} must not depend on {dependency}: it is {owner}'s", package.name));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn the_core_knows_no_files_clocks_or_network() {
    let mut faults = Vec::new();
    for name in PURE {
        for path in sources(&root().join("crates").join(name).join("src")) {
            let text = read(&path);
            let code = text.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with("//"));
            for (number, line) in code {
                if let Some(what) = impurity(line) {
                    faults.push(format!("{}:{}: {what}", path.display(), number + 1));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn impurities_are_recognised() {
    assert_eq!(impurity("    let file = std::fs::File::open(path)?;"), Some("fs"));
    assert_eq!(impurity("use std::{fmt, time};"), Some("time"));
    assert_eq!(impurity("    let started = Instant::now();"), Some("Instant"));
    assert_eq!(impurity("    let time = shutter.lerp(u); // Instantiate, Instance"), None);
}

/// The file, clock or network that a line of code names.
fn impurity(line: &str) -> Option<&'static str> {
    let words = || line.split(|c: char| !c.is_alphanumeric() && c != '_');
    let names = |module: &str| {
        line.contains(&format!("std::{module}"))
            || line.contains("std::{") && words().any(|word| word == module)
    };
    let clocks = ["Instant", "SystemTime"].into_iter().find(|clock| words().any(|word| word == *clock));
    ["fs", "time", "net"].into_iter().find(|module| names(module)).or(clocks)
}

/// What the tests need of a manifest.
struct Package {
    name: String,
    /// Of every kind and for every platform, under their real names.
    dependencies: BTreeSet<String>,
}

/// All members of the workspace.
fn packages() -> Vec<Package> {
    let workspace = manifest(&root());
    let shared = workspace["workspace"]["dependencies"].as_table().expect("a table of shared dependencies");
    let mut folders = vec![root().join("tests")];
    folders.extend(subfolders(&root().join("crates")));
    let packages: Vec<Package> = folders.iter().map(|folder| package(&manifest(folder), shared)).collect();
    assert!(packages.len() > TOOLS.len(), "no crates found below {}", root().display());
    packages
}

/// One manifest.
fn package(manifest: &Table, shared: &Table) -> Package {
    let mut dependencies = BTreeSet::new();
    let platforms = manifest.get("target").and_then(Value::as_table);
    let places = platforms.into_iter().flat_map(Table::values).filter_map(Value::as_table);
    for place in places.chain([manifest]) {
        for kind in ["dependencies", "dev-dependencies", "build-dependencies"] {
            let table = place.get(kind).and_then(Value::as_table);
            dependencies
                .extend(table.into_iter().flatten().map(|(key, value)| real_name(key, value, shared)));
        }
    }
    let name = manifest["package"]["name"].as_str().expect("a package has a name").to_owned();
    Package { name, dependencies }
}

/// The package behind a key: `package = "…"` renames it, here or in the workspace's table.
fn real_name(key: &str, value: &Value, shared: &Table) -> String {
    let renamed = |value: &Value| value.get("package").and_then(Value::as_str).map(str::to_owned);
    renamed(value).or_else(|| shared.get(key).and_then(renamed)).unwrap_or_else(|| key.to_owned())
}

fn allowed(name: &str) -> Option<&'static [&'static str]> {
    LAYERS.iter().find(|(layer, _)| *layer == name).map(|(_, allowed)| *allowed)
}

fn is_ours(name: &str) -> bool {
    name.starts_with("foton") || TOOLS.contains(&name)
}

fn manifest(folder: &Path) -> Table {
    let path = folder.join("Cargo.toml");
    read(&path).parse().unwrap_or_else(|cause| panic!("{}: {cause}", path.display()))
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ lies in the root").to_path_buf()
}

fn subfolders(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|cause| panic!("{}: {cause}", folder.display()));
    entries.map(|entry| entry.expect("a readable folder").path()).filter(|path| path.is_dir()).collect()
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|cause| panic!("{}: {cause}", folder.display()));
    let files = entries.map(|entry| entry.expect("a readable folder").path()).filter(|path| path.is_file());
    files.chain(subfolders(folder).iter().flat_map(|inner| sources(inner))).collect()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|cause| panic!("{}: {cause}", path.display()))
}
