//! Polygon files (PLY), text or binary, to a mesh: positions, normals, texture coordinates and faces as fans.
//!
//! Elements and properties of other names are read over, lists too. A count in the header is believed only as far as
//! the bytes after it can hold it, so that no file makes us allocate more than a small multiple of its size. Normals
//! are those of the file; where it has none, [`crate::meshes`] computes them.

mod header;
mod numbers;

use foton_math::glam::{DAffine3, DVec2, DVec3};
use foton_scene::description::Mesh;

use crate::meshes::smooth_normals;
use crate::obj::Problem;
use header::{Element, Encoding, Header, Kind, Property};
use numbers::{Binary, Numbers, Text};

/// Reads a file.
///
/// # Errors
/// The first problem, with its line in a text file and with its byte in the message for a binary one.
pub(crate) fn parse(bytes: &[u8]) -> Result<Mesh, Problem> {
    let header = Header::parse(bytes)?;
    let body = &bytes[header.length..];
    match header.encoding {
        Encoding::Ascii => read(&header, Text::new(body, header.lines + 1)),
        Encoding::LittleEndian => read(&header, Binary::<false>::new(body, header.length)),
        Encoding::BigEndian => read(&header, Binary::<true>::new(body, header.length)),
    }
}

fn read(header: &Header, mut numbers: impl Numbers) -> Result<Mesh, Problem> {
    let mut mesh = Mesh::default();
    for element in header.elements.iter().filter(|e| !e.properties.is_empty()) {
        let least = element.properties.iter().map(|p| numbers.least_bytes(p.kind)).sum::<u64>();
        // The last line of a text file may lack its end.
        if element.count.saturating_mul(least) > numbers.bytes_left() as u64 + 1 {
            let message = format!("the file is too short for {} × {}", element.count, element.name);
            return Err(numbers.problem(message));
        }
        match element.name.as_str() {
            "vertex" => vertices(element, &mut numbers, &mut mesh)?,
            "face" => faces(element, header.vertices, &mut numbers, &mut mesh)?,
            _ => skip(element, &mut numbers)?,
        }
    }
    mend_normals(&mut mesh);
    Ok(mesh)
}

/// Computes normals that a file states as zero or not as numbers; those of a vertex without faces often are.
pub(crate) fn mend_normals(mesh: &mut Mesh) {
    let is_bad = |n: &DVec3| n.try_normalize().is_none();
    if mesh.normals.iter().any(is_bad) {
        let smooth = smooth_normals(&mesh.positions, &mesh.triangles, &DAffine3::IDENTITY);
        for (normal, smooth) in mesh.normals.iter_mut().zip(smooth) {
            if is_bad(normal) {
                *normal = smooth;
            }
        }
    }
}

fn skip(element: &Element, numbers: &mut impl Numbers) -> Result<(), Problem> {
    for _ in 0..element.count {
        for property in &element.properties {
            skip_value(property, numbers)?;
        }
        numbers.end_element();
    }
    Ok(())
}

fn skip_value(property: &Property, numbers: &mut impl Numbers) -> Result<(), Problem> {
    match property.kind {
        Kind::Scalar(number) => numbers.next(number).map(|_| ()),
        Kind::List { count, item } => {
            for _ in 0..length(numbers.next(count)?, numbers)? {
                numbers.next(item)?;
            }
            Ok(())
        }
    }
}

/// The length of a list; more items than bytes are left run into the end of the file.
fn length(count: f64, numbers: &impl Numbers) -> Result<u64, Problem> {
    whole(count).ok_or_else(|| numbers.problem(format!("{count} is not the length of a list")))
}

/// A number that counts, if it does; all types of a file but 64-bit floats fit.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range is checked")]
fn whole(number: f64) -> Option<u64> {
    ((0.0..=4_294_967_295.0).contains(&number) && number.fract() == 0.0).then_some(number as u64)
}

/// Where each number of a vertex goes: x, y, z, then its normal, then u and v.
const ROLES: [&[&str]; 8] =
    [&["x"], &["y"], &["z"], &["nx"], &["ny"], &["nz"], &["u", "s", "texture_u"], &["v", "t", "texture_v"]];

fn vertices(element: &Element, numbers: &mut impl Numbers, mesh: &mut Mesh) -> Result<(), Problem> {
    let role = |p: &Property| ROLES.iter().position(|names| names.contains(&p.name.as_str()));
    let roles: Vec<Option<usize>> = element.properties.iter().map(role).collect();
    let has = |range: std::ops::Range<usize>| range.into_iter().all(|r| roles.contains(&Some(r)));
    let (has_normals, has_uv) = (has(3..6), has(6..8));
    let count = usize::try_from(element.count).unwrap_or(0);
    mesh.positions.reserve(count);
    mesh.normals.reserve(if has_normals { count } else { 0 });
    mesh.texture_coordinates.reserve(if has_uv { count } else { 0 });
    for _ in 0..element.count {
        let mut v = [0.0; 8];
        for (property, role) in element.properties.iter().zip(&roles) {
            match (property.kind, role) {
                (Kind::Scalar(kind), Some(role)) => v[*role] = numbers.next(kind)?,
                _ => skip_value(property, numbers)?,
            }
        }
        let [x, y, z, nx, ny, nz, s, t] = v;
        let position = DVec3::new(x, y, z);
        if !position.is_finite() {
            return Err(numbers.problem(format!("the position {x} {y} {z} is not finite")));
        }
        mesh.positions.push(position);
        if has_normals {
            mesh.normals.push(DVec3::new(nx, ny, nz));
        }
        if has_uv {
            let uv = DVec2::new(s, t);
            if !uv.is_finite() {
                return Err(numbers.problem(format!("the texture coordinate {s} {t} is not finite")));
            }
            mesh.texture_coordinates.push(uv);
        }
        numbers.end_element();
    }
    Ok(())
}

fn faces(
    element: &Element,
    vertices: u64,
    numbers: &mut impl Numbers,
    mesh: &mut Mesh,
) -> Result<(), Problem> {
    mesh.triangles.reserve(usize::try_from(element.count).unwrap_or(0));
    for _ in 0..element.count {
        for property in &element.properties {
            match property.kind {
                Kind::List { count, item } if property.is_corners() => {
                    let corners = length(numbers.next(count)?, numbers)?;
                    fan(corners, vertices, || numbers.next(item), &mut mesh.triangles)
                        .map_err(|e| e.unwrap_or_else(|message| numbers.problem(message)))?;
                }
                _ => skip_value(property, numbers)?,
            }
        }
        numbers.end_element();
    }
    Ok(())
}

/// Adds the triangles of a face. An error is one of reading, or a message about what was read.
#[allow(clippy::cast_possible_truncation, reason = "an index is below the count of vertices, which fits")]
fn fan(
    corners: u64,
    vertices: u64,
    mut next: impl FnMut() -> Result<f64, Problem>,
    triangles: &mut Vec<[u32; 3]>,
) -> Result<(), Result<Problem, String>> {
    if corners < 3 {
        return Err(Err(format!("a face needs three corners, not {corners}")));
    }
    let mut corner = || {
        let number = next().map_err(Ok)?;
        let index = whole(number).filter(|&i| i < vertices);
        index
            .map(|i| i as u32)
            .ok_or_else(|| Err(format!("there is no vertex {number}, the file has {vertices}")))
    };
    let (first, mut last) = (corner()?, corner()?);
    for _ in 2..corners {
        let next = corner()?;
        triangles.push([first, last, next]);
        last = next;
    }
    Ok(())
}
