//! pbrt's scenes, of versions 3 and 4, to descriptions.
//!
//! A file is a list of directives that change a state (`state.rs`) and use it: `directives.rs` goes through them, and a file for each kind
//! says what they mean. A material or a texture becomes one of the description when a shape has it. What has no counterpart is made of what
//! is nearest, with a warning at its place; docs/pbrt.md lists that.

mod baked;
mod blocks;
mod camera;
mod colour_space;
mod colours;
mod directives;
mod environment;
mod integrator;
mod lights;
mod lobes;
mod made;
mod materials;
mod media;
mod meshes;
mod names;
mod new_materials;
mod old_materials;
mod packed;
mod parameters;
mod pictures;
mod place;
mod reader;
mod round;
mod shapes;
mod state;
mod statements;
mod subdivision;
mod substances;
mod substitutes;
mod texture;
mod textures;
mod tokens;
mod transforms;
mod version;
mod waiting;

use std::path::Path;

use foton_input::shown;

use crate::diagnostic::{OpenError, Place, Report};
use crate::encoding::decoded;
use crate::files::Files;
use crate::hash::Fnv1a;
use crate::limits::Budget;
use crate::opened::{ForeignScene, Opened, Origin};
use crate::options::{Options, ReadFile};
use reader::Reader;
use version::Version;

/// Whether a file is one of pbrt, by its name: `.pbrt` or `.pbrt.gz`.
pub(crate) fn is_named(path: &Path) -> bool {
    let is =
        |path: &Path, extension: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension));
    is(path, "pbrt") || is(path, "gz") && path.file_stem().is_some_and(|stem| is(Path::new(stem), "pbrt"))
}

/// Opens a file of pbrt.
pub(crate) fn open(path: &Path, files: &ReadFile<'_>, options: &Options) -> Result<Opened, OpenError> {
    let name = path.to_string_lossy();
    let mut report = Report::new(&name, path.parent().unwrap_or(Path::new("")));
    for (name, value) in &options.defines {
        let define = format!("{name}={value}");
        report.error(Place::default(), format!("-D {}: a file of pbrt has no parameters", shown(&define)));
    }
    let bytes = match files(path) {
        Ok(bytes) => bytes,
        Err(error) => {
            options.cancel.check()?;
            return Err(report.fail(Place::default(), format!("cannot be read: {error}")));
        }
    };
    let mut hash = Fnv1a::default();
    hash.add(&bytes);
    let mut budget = Budget::new(options.memory);
    let text = packed::unpacked(bytes, &mut budget, &options.cancel).and_then(|bytes| {
        budget.take(bytes.len() as u64 * blocks::BYTES_PER_TEXT_BYTE)?;
        decoded(bytes).map_err(|line| format!("line {line} is not UTF-8"))
    });
    let text = match text {
        Ok(text) => text,
        Err(message) => {
            options.cancel.check()?;
            return Err(report.fail(Place::default(), format!("cannot be read: {message}")));
        }
    };
    report.main_text(&text, directives::begins_as_scene(&text));
    let mut reader =
        Reader::new(Version::of(&text, &options.cancel), Files::new(files, options, budget), report);
    reader.text(&text, 0);
    reader.check_closed();
    reader.sensor();
    options.cancel.check()?;
    let Reader { report, files, description, suggested, places, .. } = reader;
    let warnings = report.finish()?;
    hash.add(&files.hash.finish().to_le_bytes());
    Ok(Opened {
        description,
        origin: Origin::Foreign(ForeignScene { kind: "a pbrt scene", places }),
        path: Some(path.to_owned()),
        files: Vec::new(),
        options: options.without_cancel(),
        suggested,
        warnings,
        source_hash: hash.finish(),
    })
}
