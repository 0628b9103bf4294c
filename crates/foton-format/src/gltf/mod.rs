//! glTF 2.0, as text with files beside it (`.gltf`) and in one file (`.glb`), to a description.
//!
//! - One unit is a metre, +y is up. What the file lacks is added as for mesh files, and a warning says so: a camera, or a light.
//! - Problems name the file and the path of the value in it: `materials[3].alphaMode`. All that can be found in one go are.
//! - What is not here: animations, media (absorption becomes a tint), points and lines, meshes packed by Draco or meshopt.
//!
//! The files of this folder from the bottom up: `json` and `container` take a file apart, `buffers` and `accessor` read its numbers,
//! `vertices` and `pose` make triangles of them, `textures`, `bsdfs` and `materials` say how these look, `meshes`, `cameras` and
//! `lights` make parts of a description, and `nodes` puts them in their places.
//!
//! Sources: the specification of glTF 2.0 and of its extensions, by the Khronos Group `[GLTF]`.

mod accessor;
mod bsdfs;
mod buffers;
mod cameras;
mod container;
mod extensions;
mod json;
mod lights;
mod materials;
mod meshes;
mod nodes;
mod pose;
mod reader;
mod textures;
mod vertices;
mod wanted;

use std::path::Path;
use std::rc::Rc;

use foton_input::{quoted, shown};
use foton_scene::description::SceneDescription;
use serde_json::Value;

use crate::diagnostic::{OpenError, Place, Report};
use crate::files::Files;
use crate::limits::Budget;
use crate::opened::{ForeignScene, Opened, Origin};
use crate::options::{BYTES_PER_BYTE, Options, ReadFile};
use crate::standalone::{self, Axes};
use crate::suggested::Suggested;
use buffers::Buffers;
use container::Parts;
use json::At;
use reader::{Made, Reader};

/// The only parameter of a file: how many lumens are a watt.
const LUMENS_PER_WATT: &str = "lumens_per_watt";

/// The luminous efficacy of light of 555 nm, which Blender goes by for light of all colours.
const LUMENS: f64 = 683.0;

/// Whether the name of a file is that of a glTF file.
pub(crate) fn is_named(path: &Path) -> bool {
    let extension = path.extension().map(|extension| extension.to_ascii_lowercase());
    extension.is_some_and(|extension| extension == "gltf" || extension == "glb")
}

/// Opens a glTF file.
pub(crate) fn open(path: &Path, files: &ReadFile<'_>, options: &Options) -> Result<Opened, OpenError> {
    let mut report = Report::new(&path.to_string_lossy(), path.parent().unwrap_or(Path::new("")));
    let bytes = match files(path) {
        Ok(bytes) => bytes,
        Err(error) => {
            options.cancel.check()?;
            return Err(report.fail(Place::default(), format!("cannot be read: {error}")));
        }
    };
    let lumens = lumens_per_watt(options, &mut report);
    let mut budget = Budget::new(options.memory);
    let taken = budget.take((bytes.len() as u64).saturating_mul(BYTES_PER_BYTE));
    let parts = taken.and_then(|()| Parts::of(&bytes));
    let parts = match parts.and_then(|parts| budget.take(json::memory(parts.json)).map(|()| parts)) {
        Ok(parts) => parts,
        Err(message) => return Err(report.fail(Place::default(), message)),
    };
    let json: Value = match serde_json::from_slice(parts.json) {
        Ok(json) => json,
        Err(error) => return Err(malformed(report, &parts, &error)),
    };
    let root = At::root(&json);
    let mut files = Files::new(files, options, budget);
    files.hash.add(&bytes);
    for (name, value) in &options.defines {
        files.hash.add(name.as_bytes());
        files.hash.add(value.as_bytes());
    }
    let mut description = SceneDescription::default();
    let mut hash = files.hash;
    if is_version_2(&root, &mut report) && extensions::check(&root, &mut report) {
        let buffers = Rc::new(Buffers::read(&root, parts.binary, &mut files, &mut report));
        let (watts_per_lumen, made) = (1.0 / lumens, Made::default());
        let mut reader = Reader { root, buffers, files, report, description, watts_per_lumen, made };
        reader.nodes();
        options.cancel.check()?;
        reader.finish(options, lumens);
        hash = reader.files.hash;
        (description, report) = (reader.description, reader.report);
    }
    let warnings = report.finish()?;
    Ok(Opened {
        description,
        origin: Origin::Foreign(ForeignScene::new("a glTF file")),
        path: Some(path.to_owned()),
        files: Vec::new(),
        options: options.without_cancel(),
        suggested: Suggested::default(),
        warnings,
        source_hash: hash.finish(),
    })
}

impl Reader<'_> {
    /// Adds what the file lacks, and says what was left out.
    fn finish(&mut self, options: &Options, lumens: f64) {
        self.say_notices();
        if self.root.count("animations") > 0 {
            self.say("animations are left out: everything is shown as it stands in the file");
        }
        if self.root.extension("KHR_materials_variants").is_some() {
            self.say("variants of materials are left out: each part has its first material");
        }
        let is_default = options.defines.iter().all(|(name, _)| name != LUMENS_PER_WATT);
        if !self.description.emitters.is_empty() && is_default {
            self.say(&format!("candela and lux of lights are divided by {lumens} lm/W, as Blender does"));
            self.report.help(format!("-D {LUMENS_PER_WATT}=1 takes them as W/sr and W/m² as they stand"));
        }
        if let Err(message) =
            standalone::complete(&mut self.description, Axes::Y_UP, "the file", &mut self.report)
        {
            self.report.error(Place::default(), message);
        }
    }

    fn say(&mut self, message: &str) {
        self.report.warning(Place::default(), message);
    }
}

/// By what candela and lux are divided.
fn lumens_per_watt(options: &Options, report: &mut Report) -> f64 {
    let mut lumens = LUMENS;
    for (name, value) in &options.defines {
        let number = value.parse::<f64>().ok().filter(|n| n.is_finite() && *n > 0.0);
        match (name.as_str(), number) {
            (LUMENS_PER_WATT, Some(number)) => lumens = number,
            (LUMENS_PER_WATT, None) => {
                let message = format!("-D {LUMENS_PER_WATT}: {} is not a number above 0", quoted(value));
                report.error(Place::default(), message);
            }
            _ => {
                let define = shown(&format!("{name}={value}"));
                let message = format!("-D {define}: a glTF file has no parameter but \"{LUMENS_PER_WATT}\"");
                report.error(Place::default(), message);
            }
        }
    }
    lumens
}

/// The error of a text that is no JSON, with its line where the file is a text.
fn malformed(mut report: Report, parts: &Parts<'_>, error: &serde_json::Error) -> OpenError {
    let text = error.to_string();
    let what = text.split(" at line ").next().unwrap_or_default().to_owned();
    let (Ok(json), None) = (std::str::from_utf8(parts.json), parts.binary) else {
        let message =
            format!("the description (JSON) is not well-formed, in its line {}: {what}", error.line());
        return report.fail(Place::default(), message);
    };
    report.main_text(json, true);
    let number = |n: usize| u32::try_from(n).unwrap_or(0);
    let place = Place { line: number(error.line()), column: number(error.column()) };
    report.fail(place, format!("the JSON is not well-formed: {what}"))
}

/// Whether a file is of glTF 2.0; an error where it is not.
fn is_version_2(root: &At<'_>, report: &mut Report) -> bool {
    let Some(asset) = root.get("asset") else {
        root.error(report, "the file is no glTF 2.0 file: it has no \"asset\" with a \"version\"");
        return false;
    };
    let version = asset.text("version", report).unwrap_or_default();
    let least = asset.text("minVersion", report).unwrap_or(version);
    let is_read = |version: &str| version == "2" || version.starts_with("2.");
    if is_read(version) && matches!(least, "2" | "2.0" | "2.1") {
        return true;
    }
    asset.error(report, format!("version {} of glTF is not read, only 2.0", quoted(least)));
    false
}
