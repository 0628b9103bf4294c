//! STL files, text or binary, to a mesh of flat triangles.
//!
//! Nothing is welded: every triangle has three vertices of its own. The stated normals are not read, since files that
//! state zero are many; the winding says where outside is, as the format demands.

use foton_math::glam::DVec3;
use foton_scene::description::Mesh;

use crate::diagnostic::Place;
use crate::obj::{Problem, Words, shown, vector};

/// What stands before the triangles of a binary file: 80 bytes of anything, and their number.
const HEADER: usize = 84;
/// A triangle of a binary file: normal, three corners, and two bytes of anything.
const TRIANGLE: usize = 50;

/// Reads a file. A binary one is known by its length, since its header may well begin with `solid`.
///
/// # Errors
/// The first problem, with its line in a text file and with its byte in the message for a binary one.
pub(crate) fn parse(bytes: &[u8]) -> Result<Mesh, Problem> {
    let stated = bytes[..bytes.len().min(HEADER)].last_chunk::<4>().filter(|_| bytes.len() >= HEADER);
    let triangles = stated.map_or(0, |n| u32::from_le_bytes(*n) as usize);
    let length = triangles.saturating_mul(TRIANGLE).saturating_add(HEADER);
    let is_text = bytes.trim_ascii_start().starts_with(b"solid") && length != bytes.len();
    let mesh = if is_text { text(bytes)? } else { binary(bytes, triangles, length)? };
    if mesh.triangles.is_empty() {
        return Err((Place::default(), "the file has no triangles".to_owned()));
    }
    Ok(mesh)
}

fn binary(bytes: &[u8], triangles: usize, length: usize) -> Result<Mesh, Problem> {
    if bytes.len() < length.max(HEADER) {
        let message = format!("the file is too short for {triangles} triangles, or no STL file");
        return Err((Place::default(), message));
    }
    let mut positions = Vec::with_capacity(3 * triangles);
    for (i, triangle) in bytes[HEADER..length].chunks_exact(TRIANGLE).enumerate() {
        for corner in triangle[12..48].chunks_exact(12) {
            let axis = |i: usize| {
                let bytes = corner[4 * i..].first_chunk().copied().unwrap_or_default();
                f64::from(f32::from_le_bytes(bytes))
            };
            positions.push(DVec3::new(axis(0), axis(1), axis(2)));
        }
        if positions[3 * i..].iter().any(|p| !p.is_finite()) {
            let message = format!("byte {}: a triangle's corner is not finite", HEADER + TRIANGLE * i);
            return Err((Place::default(), message));
        }
    }
    Ok(flat(positions))
}

fn text(bytes: &[u8]) -> Result<Mesh, Problem> {
    let mut positions = Vec::new();
    let mut words = Words::new(bytes);
    let mut corners = 0;
    while words.next_line() {
        let Some(keyword) = words.next() else { continue };
        match &keyword.text.to_ascii_lowercase()[..] {
            b"vertex" => {
                positions.push(vector(keyword, &mut words)?);
                corners += 1;
            }
            b"endloop" | b"endfacet" if corners % 3 != 0 => {
                return Err((keyword.place, format!("a facet has three corners, not {corners}")));
            }
            b"solid" | b"endsolid" | b"facet" | b"outer" | b"endloop" | b"endfacet" => corners = 0,
            other => return Err((keyword.place, format!("\"{}\" is not understood", shown(other)))),
        }
    }
    if positions.len() % 3 != 0 {
        return Err((Place::default(), "the file ends inside a facet".to_owned()));
    }
    Ok(flat(positions))
}

/// Three vertices for each triangle.
fn flat(positions: Vec<DVec3>) -> Mesh {
    let count = u32::try_from(positions.len() / 3).unwrap_or(u32::MAX / 3);
    let triangles = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Mesh { positions, triangles, ..Mesh::default() }
}
