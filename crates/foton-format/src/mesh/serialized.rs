//! Mitsuba's `.serialized` meshes, versions 3 and 4: several compressed meshes in a file, with their offsets at its end.
//!
//! Vertex colours are the attribute `vertex_color`. The flag for face normals has no effect, as in Mitsuba 3. What a stream claims to hold
//! is believed only as far as deflate can have packed it into the file, and memory grows with what really comes out.

use std::io::Read;
use std::sync::Arc;

use flate2::read::ZlibDecoder;
use foton_math::Cancel;
use foton_math::glam::{DVec2, DVec3};
use foton_scene::description::{Attribute, Mesh};

use crate::diagnostic::Place;
use crate::limits::Budget;
use crate::mesh::normals;
use crate::mesh::wanted::Parsed;

const MAGIC: u16 = 0x041c;
const HAS_NORMALS: u32 = 0x0001;
const HAS_TEXTURE_COORDINATES: u32 = 0x0002;
const HAS_COLOURS: u32 = 0x0008;
const DOUBLE_PRECISION: u32 = 0x2000;
/// Bytes that are unpacked between two questions whether reading goes on.
const BLOCK: u64 = 1 << 20;
/// Deflate packs at most this many bytes into one.
const DENSEST: u64 = 1032;

/// The longest name of a mesh.
const MAX_NAME: usize = 1 << 16;

const TOO_SHORT: &str = "the file is too short for what it claims to hold";

/// Reads the mesh with that number, from 0.
///
/// # Errors
/// The first problem of the file, or that it has not as many meshes.
pub(crate) fn parse(bytes: &[u8], shape_index: u32, budget: &mut Budget, cancel: &Cancel) -> Parsed {
    let mut mesh = mesh(bytes, shape_index, budget, cancel).map_err(|message| (Place::default(), message))?;
    let warnings = normals::mend(&mut mesh, cancel);
    Ok((mesh, warnings))
}

fn mesh(bytes: &[u8], shape_index: u32, budget: &mut Budget, cancel: &Cancel) -> Result<Mesh, String> {
    let version = version(bytes)?;
    let start = if shape_index == 0 { 0 } else { offset(bytes, version, shape_index)? };
    let part = usize::try_from(start).ok().and_then(|s| bytes.get(s..)).unwrap_or_default();
    let version = self::version(part).map_err(|message| format!("mesh {shape_index}: {message}"))?;
    let mut stream = Stream {
        most: (part.len() as u64).saturating_mul(DENSEST),
        decoder: ZlibDecoder::new(&part[4..]),
        is_double: false,
        cancel,
    };
    stream.mesh(version, budget)
}

/// The version in the header of a file or of a mesh in it.
fn version(bytes: &[u8]) -> Result<u16, String> {
    let word = |at: usize| bytes.get(at..)?.first_chunk().map(|b| u16::from_le_bytes(*b));
    match (word(0), word(2)) {
        (Some(MAGIC), Some(version @ (3 | 4))) => Ok(version),
        (Some(MAGIC), Some(version)) => Err(format!("version {version} is not read, only 3 and 4")),
        _ => Err("this is not a serialized mesh".to_owned()),
    }
}

/// Where a mesh begins: the file ends with all offsets, 8 bytes each (4 in version 3), and their number.
fn offset(bytes: &[u8], version: u16, shape_index: u32) -> Result<u64, String> {
    let too_short = || "the file ends inside its list of meshes".to_owned();
    let (rest, count) = bytes.split_last_chunk::<4>().ok_or_else(too_short)?;
    let count = u32::from_le_bytes(*count);
    if shape_index >= count {
        return Err(format!("there is no mesh {shape_index}, the file has {count}, counted from 0"));
    }
    let size = if version == 3 { 4 } else { 8 };
    let back = u64::from(count - shape_index) * size;
    let at = (rest.len() as u64).checked_sub(back).and_then(|at| usize::try_from(at).ok());
    let entry = at.and_then(|at| rest.get(at..)).ok_or_else(too_short)?;
    let offset = match version {
        3 => entry.first_chunk().map(|b| u64::from(u32::from_le_bytes(*b))),
        _ => entry.first_chunk().map(|b| u64::from_le_bytes(*b)),
    };
    offset.ok_or_else(too_short)
}

/// The compressed part of a mesh.
struct Stream<'a> {
    decoder: ZlibDecoder<&'a [u8]>,
    /// No stream of this length holds more bytes.
    most: u64,
    is_double: bool,
    cancel: &'a Cancel,
}

impl Stream<'_> {
    fn mesh(&mut self, version: u16, budget: &mut Budget) -> Result<Mesh, String> {
        let flags = u32::from_le_bytes(self.array()?);
        if version == 4 {
            let mut length = 0;
            while self.array::<1>()? != [0] {
                length += 1;
                if length > MAX_NAME {
                    return Err("the name of a mesh does not end".to_owned());
                }
            }
        }
        self.is_double = flags & DOUBLE_PRECISION != 0;
        let (vertices, faces) = (u64::from_le_bytes(self.array()?), u64::from_le_bytes(self.array()?));
        if vertices == 0 || faces == 0 {
            return Err("the mesh is empty".to_owned());
        }
        if vertices > u64::from(u32::MAX) {
            return Err("the mesh has more vertices than can be numbered".to_owned());
        }
        let has = |flag| flags & flag != 0;
        // What it claims, as far as the file can hold it; each part is there twice while it is unpacked.
        let [normals, textures, colours] =
            [HAS_NORMALS, HAS_TEXTURE_COORDINATES, HAS_COLOURS].map(|flag| u64::from(has(flag)));
        let each = 24 * (1 + normals + 3 * colours) + 16 * textures + 32;
        let takes = vertices.saturating_mul(each).saturating_add(faces.saturating_mul(24));
        if takes / 8 > self.most {
            return Err(TOO_SHORT.to_owned());
        }
        budget.take(takes)?;
        let positions: Vec<DVec3> = self.vectors(vertices)?;
        let normals = if has(HAS_NORMALS) { self.vectors(vertices)? } else { Vec::new() };
        let mut texture_coordinates = Vec::new();
        if has(HAS_TEXTURE_COORDINATES) {
            texture_coordinates = self.floats(vertices, 2)?.chunks_exact(2).map(DVec2::from_slice).collect();
        }
        let mut attributes = Vec::new();
        if has(HAS_COLOURS) {
            let values: Arc<[f32]> = self.floats(vertices, 3)?.into_iter().map(|c| c as f32).collect();
            if let Some(i) = values.iter().position(|c| !c.is_finite()) {
                return Err(format!("the colour of vertex {} is not finite", i / 3));
            }
            attributes.push(Attribute { name: "vertex_color".to_owned(), channels: 3, values });
        }
        if let Some(i) = positions.iter().position(|p| !p.is_finite()) {
            return Err(format!("the position of vertex {i} is not finite"));
        }
        let triangles = self.triangles(faces, vertices)?;
        Ok(Mesh { positions, normals, texture_coordinates, triangles, attributes })
    }

    fn vectors(&mut self, count: u64) -> Result<Vec<DVec3>, String> {
        Ok(self.floats(count, 3)?.chunks_exact(3).map(DVec3::from_slice).collect())
    }

    /// `count` times `each` numbers.
    fn floats(&mut self, count: u64, each: u64) -> Result<Vec<f64>, String> {
        let size = if self.is_double { 8 } else { 4 };
        let bytes = self.bytes(count.saturating_mul(each * size))?;
        Ok(if self.is_double {
            bytes.as_chunks().0.iter().map(|b| f64::from_le_bytes(*b)).collect()
        } else {
            bytes.as_chunks().0.iter().map(|b| f64::from(f32::from_le_bytes(*b))).collect()
        })
    }

    fn triangles(&mut self, faces: u64, vertices: u64) -> Result<Vec<[u32; 3]>, String> {
        let bytes = self.bytes(faces.saturating_mul(12))?;
        let index = |corner: usize, face: &[u8; 12]| {
            u32::from_le_bytes([0, 1, 2, 3].map(|byte| face[4 * corner + byte]))
        };
        let triangles: Vec<_> =
            bytes.as_chunks().0.iter().map(|face| [0, 1, 2].map(|i| index(i, face))).collect();
        match triangles.iter().flatten().find(|&&i| u64::from(i) >= vertices) {
            Some(i) => Err(format!("there is no vertex {i}, the mesh has {vertices}")),
            None => Ok(triangles),
        }
    }

    fn bytes(&mut self, count: u64) -> Result<Vec<u8>, String> {
        if count > self.most {
            return Err(TOO_SHORT.to_owned());
        }
        let mut bytes = Vec::new();
        while (bytes.len() as u64) < count {
            self.cancel.check().map_err(|cancelled| cancelled.to_string())?;
            let more = BLOCK.min(count - bytes.len() as u64);
            if self.decoder.by_ref().take(more).read_to_end(&mut bytes).map_err(broken)? == 0 {
                return Err("the mesh ends too early".to_owned());
            }
        }
        Ok(bytes)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let mut array = [0; N];
        self.decoder.read_exact(&mut array).map_err(broken)?;
        Ok(array)
    }
}

#[allow(clippy::needless_pass_by_value, reason = "it stands in map_err")]
fn broken(error: std::io::Error) -> String {
    format!("the compressed data is broken: {error}")
}
