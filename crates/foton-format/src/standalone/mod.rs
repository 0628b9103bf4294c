//! A mesh file as a whole scene: what it lacks is added (`studio`), and a warning says so.
//!
//! OBJ, PLY and OFF models stand on the xz plane with +z towards the viewer; STL models on the xy plane with −y there, as
//! printers and the programs that make these files have it.

mod parts;
mod shapes;
mod studio;

use std::path::Path;

use foton_input::shown;
use foton_math::glam::{DAffine3, DVec3};
use foton_scene::description::SceneDescription;

use crate::diagnostic::{Diagnostic, OpenError, Place, Report};
use crate::hash::Fnv1a;
use crate::limits::Budget;
use crate::mesh::normals;
use crate::mesh::obj::Obj;
use crate::mesh::off;
use crate::mesh::ply;
use crate::mesh::stl;
use crate::mesh::wanted::{Format, Wanted};
use crate::mesh::words::Problem;
use crate::opened::{ForeignScene, Opened, Origin};
use crate::options::{BYTES_PER_BYTE, Options, ReadFile};
use crate::suggested::Suggested;
use crate::watch::Watch;
use shapes::{Library, add_shape};
pub(crate) use studio::{Axes, complete};

/// A kind of mesh file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    Obj,
    Ply,
    Stl,
    Off,
}

impl Kind {
    /// The kind that a file's extension says.
    pub(crate) fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_ascii_lowercase().to_str()? {
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            "stl" => Some(Self::Stl),
            "off" => Some(Self::Off),
            _ => None,
        }
    }

    fn axes(self) -> Axes {
        match self {
            Self::Obj | Self::Ply | Self::Off => Axes::Y_UP,
            Self::Stl => Axes { right: DVec3::X, up: DVec3::Z, front: DVec3::NEG_Y },
        }
    }
}

/// Opens a mesh file as a scene.
pub(crate) fn open(
    path: &Path,
    kind: Kind,
    files: &ReadFile<'_>,
    options: &Options,
) -> Result<Opened, OpenError> {
    let name = path.to_string_lossy();
    let mut report = Report::new(&name, path.parent().unwrap_or(Path::new("")));
    for (name, value) in &options.defines {
        report.error(
            Place::default(),
            format!("-D {}: a mesh file has no parameters", shown(&format!("{name}={value}"))),
        );
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
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut budget = Budget::new(options.memory);
    let mut library = |name: &str| {
        let (path, bytes) = [name.to_owned(), name.replace('\\', "/")].into_iter().find_map(|name| {
            let path = folder.join(name);
            match files(&path) {
                Err(error) if is_absent(&error) => None,
                Err(error) => Some((path, Err(error.to_string()))),
                Ok(bytes) => Some((path, budget.take(bytes.len() as u64 * BYTES_PER_BYTE).map(|()| bytes))),
            }
        })?;
        if let Ok(bytes) = &bytes {
            hash.add(bytes);
        }
        Some((path.to_string_lossy().into_owned(), bytes))
    };
    let read = read(&bytes, kind, &mut library, &mut report, Watch::new(&options.cancel, &options.progress));
    options.cancel.check()?;
    let description = match read {
        Ok(description) => description,
        Err(problems) => {
            problems.into_iter().for_each(|(place, message)| report.error(place, message));
            SceneDescription::default()
        }
    };
    let warnings: Vec<Diagnostic> = report.finish()?;
    Ok(Opened {
        description,
        origin: Origin::Foreign(ForeignScene::new("a mesh file")),
        path: Some(path.to_owned()),
        files: Vec::new(),
        options: options.without_cancel(),
        suggested: Suggested::default(),
        warnings,
        source_hash: hash.finish(),
    })
}

/// The shapes of a mesh file, with their materials and textures, and nothing that it lacks.
pub(crate) fn shapes_alone(mut description: SceneDescription) -> SceneDescription {
    while description.shapes.last().is_some_and(|s| studio::ADDED.contains(&s.name.as_str())) {
        description.shapes.pop();
    }
    SceneDescription { sensors: Vec::new(), emitters: Vec::new(), ..description }
}

/// Whether a name stands for nothing: a word that is none, or one too long to be one.
fn is_absent(error: &std::io::Error) -> bool {
    use std::io::ErrorKind::{InvalidFilename, InvalidInput, NotADirectory, NotFound};
    matches!(error.kind(), NotFound | NotADirectory | InvalidFilename | InvalidInput)
}

fn read(
    bytes: &[u8],
    kind: Kind,
    library: &mut Library<'_>,
    report: &mut Report,
    watch: Watch<'_>,
) -> Result<SceneDescription, Vec<Problem>> {
    let cancel = watch.cancel();
    let mut scene = SceneDescription::default();
    match kind {
        Kind::Obj => {
            let mut obj = Obj::parse(bytes, watch)?;
            warn(std::mem::take(&mut obj.warnings), report);
            parts::add_obj(&obj, library, report, &mut scene, cancel);
        }
        Kind::Ply => {
            let wanted = Wanted { format: Format::Ply, face_normals: false, flip_v: false };
            let (mesh, warnings) = ply::parse(bytes, watch).map_err(|problem| vec![problem])?;
            warn(warnings, report);
            let mesh = normals::finished(&mesh, wanted, &DAffine3::IDENTITY, cancel);
            add_shape("mesh", mesh, None, &mut scene);
        }
        Kind::Stl => {
            let (mesh, warnings) = stl::parse(bytes, cancel).map_err(|problem| vec![problem])?;
            warn(warnings, report);
            add_shape("mesh", mesh, None, &mut scene);
        }
        Kind::Off => {
            let (mesh, warnings) = off::parse(bytes, watch).map_err(|problem| vec![problem])?;
            warn(warnings, report);
            add_shape("mesh", mesh, None, &mut scene);
        }
    }
    complete(&mut scene, kind.axes(), "a mesh file", report)
        .map_err(|message| vec![(Place::default(), message)])?;
    Ok(scene)
}

fn warn(warnings: Vec<Problem>, report: &mut Report) {
    warnings.into_iter().for_each(|(place, message)| report.warning(place, message));
}
