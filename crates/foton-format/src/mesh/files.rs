//! Mesh files of a scene: each is read once, and becomes vertices that triangles share.
//!
//! Mitsuba 3.9 was asked what it makes of an OBJ file, and this follows it:
//! - Corners with the same position, texture coordinate and normal share a vertex. Normals of the file are kept.
//! - Without normals, smooth ones are computed: the mean of the adjoining faces' unit normals, weighted by the angle
//!   at the vertex, *after* `to_world`; so they follow the winding in the world. A texture seam is a
//!   crease, since corners on it do not share a vertex. Where the mean vanishes it is the x axis.
//! - `face_normals` drops all normals.
//! - Texture coordinates of an OBJ file are turned upside down (`flip_tex_coords`), so that v begins at a bitmap's top.
//!
//! In a file with normals for some corners only, Mitsuba leaves the others undefined; here they are computed.

use std::cell::Cell;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

use foton_math::glam::{DAffine3, DMat3, DVec2, DVec3};
use foton_scene::description::Mesh;

use crate::diagnostic::Report;
use crate::files::Files;
use crate::limits::Budget;
use crate::mesh::normals::{build, finished};
use crate::mesh::obj::Obj;
use crate::mesh::wanted::{Format, Parsed, Wanted};
use crate::mesh::{ply, serialized, stl};
use crate::mitsuba::read::properties::Located;
use crate::watch::Watch;

/// What a file holds.
enum Contents {
    Obj(Obj),
    Mesh(Mesh),
}

/// What a file holds, once it is read.
struct Read {
    contents: Contents,
    /// Whether a mesh was made of it.
    has_mesh: Cell<bool>,
}

/// A file as it lies there.
struct Source {
    path: PathBuf,
    bytes: Vec<u8>,
}

impl Contents {
    /// Bytes of a mesh of that, at most.
    fn mesh_bytes(&self) -> u64 {
        const VERTEX: usize = size_of::<DVec3>() * 2 + size_of::<DVec2>();
        let (vertices, triangles) = match self {
            // Corners share vertices as a rule; there are as many at most.
            Self::Obj(obj) => {
                (obj.positions.len().max(obj.normals.len()).max(obj.textures.len()), obj.triangles.len())
            }
            Self::Mesh(mesh) => (mesh.positions.len(), mesh.triangles.len()),
        };
        (vertices * VERTEX + triangles * size_of::<[u32; 3]>()) as u64
    }
}

/// The bits of a transform without its translation, of which computed normals depend; zeros where nothing does, ones for all that turn
/// and scale evenly: the normals go along with those.
type Linear = [u64; 9];

/// How far, in shares of its largest number, a transform may be from one that turns and scales evenly.
const UNEVEN: f64 = 1e-12;

/// Whether a transform only turns, moves and scales evenly, and mirrors nothing.
fn is_even(to_world: &DAffine3) -> bool {
    let m = to_world.matrix3;
    let scale = m.determinant().cbrt();
    let product = m.transpose() * m - DMat3::from_diagonal(DVec3::splat(scale * scale));
    let largest = product.to_cols_array().into_iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    scale > 0.0 && largest <= UNEVEN * scale * scale
}

/// The mesh files read so far.
#[derive(Default)]
pub(crate) struct Meshes {
    /// What each file holds; `None` if it could not be read, which was reported.
    read: HashMap<(PathBuf, Format), Option<Rc<Read>>>,
    /// The last file of several meshes: those come one after the other.
    several: Option<(PathBuf, Rc<Source>)>,
    /// Meshes by what they depend on.
    built: HashMap<(PathBuf, Wanted, Linear), Arc<Mesh>>,
}

impl Meshes {
    /// The mesh of a file.
    pub(crate) fn read(
        &mut self,
        filename: &Located<String>,
        wanted: Wanted,
        to_world: &DAffine3,
        files: &mut Files<'_>,
        report: &mut Report,
    ) -> Option<Arc<Mesh>> {
        let path = Files::key(&filename.value, filename.place, report);
        let linear = to_world.matrix3.to_cols_array().map(f64::to_bits);
        let of_this = if is_even(to_world) { [1; 9] } else { linear };
        let keys = [Linear::default(), of_this].map(|linear| (path.clone(), wanted, linear));
        if let Some(mesh) = keys.iter().find_map(|key| self.built.get(key)) {
            return Some(Arc::clone(mesh));
        }
        let read = match self.read.get(&(path.clone(), wanted.format)) {
            Some(known) => known.clone(),
            None => {
                let read = self.read_file(filename, &path, wanted.format, files, report);
                self.read.entry((path, wanted.format)).or_insert(read.map(Rc::new)).clone()
            }
        };
        let read = read?;
        let Read { contents, has_mesh } = &*read;
        // The first is part of what reading a file takes; for others a small file may stand many times.
        if has_mesh.replace(true)
            && let Err(message) = files.budget.take(contents.mesh_bytes())
        {
            report.error(filename.place, format!("cannot make one more mesh of this file: {message}"));
            return None;
        }
        let (mesh, depends_on_transform) = match contents {
            Contents::Obj(obj) => {
                let smooth = !wanted.face_normals && obj.triangles.iter().flatten().any(|c| c.normal == 0);
                (build(obj, wanted, to_world, files.cancel()), smooth)
            }
            Contents::Mesh(mesh) => {
                let smooth = !wanted.face_normals && mesh.normals.is_empty();
                (finished(mesh, wanted, to_world, files.cancel()), smooth)
            }
        };
        let mesh = Arc::new(mesh);
        let [for_all, for_this] = keys;
        self.built.insert(if depends_on_transform { for_this } else { for_all }, Arc::clone(&mesh));
        Some(mesh)
    }

    fn read_file(
        &mut self,
        filename: &Located<String>,
        key: &Path,
        format: Format,
        files: &mut Files<'_>,
        report: &mut Report,
    ) -> Option<Read> {
        let last = self.several.as_ref().filter(|(known, _)| known == key);
        let file = match last {
            Some((_, file)) => Rc::clone(file),
            None => {
                let instead = "the shape is left out";
                let read = files.read_or_do_without(&filename.value, filename.place, instead, report)?;
                let (path, bytes) = read.ok()?;
                Rc::new(Source { path, bytes })
            }
        };
        if matches!(format, Format::Serialized(_)) {
            self.several = Some((key.to_owned(), Rc::clone(&file)));
        }
        let watch = files.watch();
        let contents = parse(&file.path, &file.bytes, format, (&mut files.budget, watch), report)?;
        Some(Read { contents, has_mesh: Cell::new(false) })
    }
}

fn parse(
    path: &Path,
    bytes: &[u8],
    format: Format,
    (budget, watch): (&mut Budget, Watch<'_>),
    report: &mut Report,
) -> Option<Contents> {
    let one = |parsed: Parsed| match parsed {
        Ok((mesh, warnings)) => Ok((Contents::Mesh(mesh), warnings)),
        Err(problem) => Err(vec![problem]),
    };
    let contents = match format {
        Format::Obj => Obj::parse(bytes, watch).map(|mut obj| {
            let warnings = std::mem::take(&mut obj.warnings);
            (Contents::Obj(obj), warnings)
        }),
        Format::Ply => one(ply::parse(bytes, watch)),
        Format::Stl => one(stl::parse(bytes, watch.cancel())),
        Format::Serialized(number) => one(serialized::parse(bytes, number, budget, watch.cancel())),
    };
    let file = path.to_string_lossy();
    match contents {
        Ok((contents, warnings)) => {
            warnings.into_iter().for_each(|(place, message)| report.warning_in(&file, place, message));
            Some(contents)
        }
        Err(problems) => {
            problems.into_iter().for_each(|(place, message)| report.error_in(&file, place, message));
            None
        }
    }
}
