//! STL files, text or binary, to a mesh of flat triangles.
//!
//! Nothing is welded: every triangle has three vertices of its own. The stated normals are not read, since files that
//! state zero are many; the winding says where outside is, as the format demands. A number of triangles that was never
//! filled in is counted anew.

use foton_math::Cancel;
use foton_math::glam::DVec3;
use foton_scene::description::Mesh;

use crate::diagnostic::Place;
use crate::mesh::wanted::Parsed;
use crate::mesh::words::{Problem, Words, shown, unread, vector, without_mark};

/// What stands before the triangles of a binary file: 80 bytes of anything, and their number.
const HEADER: usize = 84;
/// A triangle of a binary file: normal, three corners, and two bytes of anything.
const TRIANGLE: usize = 50;
/// A number of triangles that stands for none that is known.
const UNKNOWN: usize = u32::MAX as usize;
/// How much of a file is looked at to tell text from bytes.
const START: usize = 1024;

/// Reads a file. A binary one whose header begins with `solid` is known by its length, or by bytes that no text has.
///
/// # Errors
/// The first problem, with its line in a text file and with its byte in the message for a binary one.
pub(crate) fn parse(bytes: &[u8], cancel: &Cancel) -> Parsed {
    let stated = bytes[..bytes.len().min(HEADER)].last_chunk::<4>().filter(|_| bytes.len() >= HEADER);
    let stated = stated.map_or(0, |n| u32::from_le_bytes(*n) as usize);
    let room = bytes.len().saturating_sub(HEADER);
    let fits = stated > 0 && stated <= room / TRIANGLE;
    // What a program leaves that does not know the number when it begins and does not come back to it.
    let is_unstated = matches!(stated, 0 | UNKNOWN) && room > 0 && room.is_multiple_of(TRIANGLE);
    let is_exact = fits && stated * TRIANGLE == room;
    let is_binary =
        is_exact || (is_unstated || fits) && has_bytes_of_no_text(&bytes[..bytes.len().min(START)]);
    let mut warnings = Vec::new();
    let mesh = if says_solid(bytes) && !is_binary {
        text(bytes, cancel)?
    } else if is_unstated {
        let triangles = room / TRIANGLE;
        let message =
            format!("the file says that it has {stated} triangles: all {triangles} that are there are read");
        warnings.push((Place::default(), message));
        binary(bytes, triangles, cancel)?
    } else if bytes.len() < HEADER || stated > room / TRIANGLE {
        let message = "the file is too short for the triangles that it states, or no STL file";
        return Err((Place::default(), message.to_owned()));
    } else {
        let beyond = room - stated * TRIANGLE;
        if beyond >= TRIANGLE {
            let message = format!(
                "the file has {stated} triangles, as it says: {beyond} bytes behind them are not read"
            );
            warnings.push((Place::default(), message));
        }
        binary(bytes, stated, cancel)?
    };
    if mesh.triangles.is_empty() {
        return Err((Place::default(), "the file has no triangles".to_owned()));
    }
    Ok((mesh, warnings))
}

/// Whether a file begins as text does.
fn says_solid(bytes: &[u8]) -> bool {
    let word = without_mark(bytes).trim_ascii_start().split(u8::is_ascii_whitespace).next();
    word.is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
}

fn has_bytes_of_no_text(bytes: &[u8]) -> bool {
    bytes.iter().any(|b| b.is_ascii_control() && !b.is_ascii_whitespace())
}

fn binary(bytes: &[u8], triangles: usize, cancel: &Cancel) -> Result<Mesh, Problem> {
    let length = HEADER + triangles * TRIANGLE;
    let mut positions = Vec::with_capacity(3 * triangles);
    for (i, triangle) in bytes[HEADER..length].chunks_exact(TRIANGLE).enumerate() {
        cancel.check_at(i).map_err(unread)?;
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

fn text(bytes: &[u8], cancel: &Cancel) -> Result<Mesh, Problem> {
    let mut positions = Vec::new();
    let mut words = Words::new(bytes, cancel);
    let mut corners = 0;
    while words.next_line() {
        let Some(keyword) = words.next() else { continue };
        match &keyword.text.to_ascii_lowercase()[..] {
            b"vertex" => {
                positions.push(vector(keyword, &mut words)?);
                corners += 1;
            }
            b"endloop" | b"endfacet" | b"end" if corners % 3 != 0 => {
                return Err((keyword.place, format!("a facet has three corners, not {corners}")));
            }
            b"solid" | b"endsolid" | b"facet" | b"outer" | b"endloop" | b"endfacet" | b"end" => corners = 0,
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
