//! Mesh files: their readers, and what shapes make of them.

pub(crate) mod files;
pub(crate) mod mtl;
pub(crate) mod normals;
pub(crate) mod obj;
pub(crate) mod off;
pub(crate) mod ply;
pub(crate) mod polygons;
pub(crate) mod serialized;
pub(crate) mod stl;
pub(crate) mod tally;
pub(crate) mod vertices;
pub(crate) mod wanted;
pub(crate) mod words;
