//! How mesh files are read, and what shapes want of them.

use foton_scene::description::Mesh;

use crate::mesh::words::Problem;

/// How a mesh file is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Format {
    /// Wavefront OBJ.
    Obj,
    /// PLY.
    Ply,
    /// STL, which only we read.
    Stl,
    /// The mesh of that number, from 0, in a file of Mitsuba's.
    Serialized(u32),
}

/// What a shape says about its mesh file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Wanted {
    /// How it is read.
    pub(crate) format: Format,
    /// Flat faces, whatever the file says.
    pub(crate) face_normals: bool,
    /// Texture coordinates with v → 1 − v.
    pub(crate) flip_v: bool,
}

/// A mesh and what was mended in it, or the first problem of a file.
pub(crate) type Parsed = Result<(Mesh, Vec<Problem>), Problem>;
