//! Polygon files (PLY), text or binary, to a mesh: positions, normals, texture coordinates, faces and strips of triangles.
//!
//! Texture coordinates are those of vertices, or those that faces state for each corner (`texcoord`, as MeshLab writes
//! them): then vertices are split where those differ, and a seam is a crease unless the file has normals, as in OBJ files.
//! Colours and other numbers of vertices and faces become attributes (`attributes.rs`); what else there is is read over. A count in the header is believed only as far as
//! the bytes after it can hold it, so that no file makes us allocate more than a small multiple of its size. Normals
//! are those of the file; where it has none, [`crate::mesh::normals`] computes them.

mod attributes;
mod faces;
mod header;
mod numbers;
mod values;

use foton_input::shown;
use foton_math::glam::{DVec2, DVec3};
use foton_scene::description::Mesh;

use values::skip_value;

use crate::mesh::normals;
use crate::mesh::wanted::Parsed;
use crate::mesh::words::Problem;
use crate::watch::Watch;
use attributes::Attributes;
use faces::Faces;
use header::{Element, Encoding, Header, Kind, Property};
use numbers::{Binary, Cancellable, Numbers, Text};

/// Reads a file.
///
/// # Errors
/// The first problem, with its line in a text file and with its byte in the message for a binary one.
pub(crate) fn parse(bytes: &[u8], watch: Watch<'_>) -> Parsed {
    let header = Header::parse(bytes)?;
    let body = &bytes[header.length..];
    let (mesh, mut warnings) = match header.encoding {
        Encoding::Ascii => read(&header, Text::new(body, header.line_end, header.lines + 1), watch)?,
        Encoding::LittleEndian => read(&header, Binary::<false>::new(body, header.length), watch)?,
        Encoding::BigEndian => read(&header, Binary::<true>::new(body, header.length), watch)?,
    };
    let wrapped = header.wrapped.warning("line of the header goes", "lines of the header go", WRAPPED);
    warnings.extend(wrapped);
    Ok((mesh, warnings))
}

const WRAPPED: &str = "on with the one before";

fn read(header: &Header, numbers: impl Numbers, watch: Watch<'_>) -> Parsed {
    let (bytes, cancel) = (numbers.bytes_left(), watch.cancel());
    let mut numbers = Cancellable { numbers, watch, bytes, left: 0 };
    let mut mesh = Mesh::default();
    let (mut faces, mut attributes) = (Faces::new(header), Attributes::default());
    let fits = |element: &Element, numbers: &_| {
        let least = element.properties.iter().map(|p| Numbers::least_bytes(numbers, p.kind)).sum::<u64>();
        // The last line of a text file may lack its end.
        if element.count.saturating_mul(least) > Numbers::bytes_left(numbers) as u64 + 1 {
            let message = format!("the file is too short for {} × {}", element.count, shown(&element.name));
            return Err(Numbers::problem(numbers, message));
        }
        Ok(())
    };
    // Faces that come before the vertices go by their number.
    header.elements.iter().try_for_each(|element| fits(element, &numbers))?;
    for element in header.elements.iter().filter(|e| !e.properties.is_empty()) {
        fits(element, &numbers)?;
        match element.name.as_str() {
            "vertex" => attributes = vertices(element, &mut numbers, &mut mesh)?,
            "face" => faces.read(element, &mut numbers)?,
            "tristrips" => faces.read_strips(element, &mut numbers)?,
            _ => skip(element, &mut numbers)?,
        }
    }
    let mut warnings = faces.finish(&mut mesh, attributes, cancel)?;
    warnings.extend(normals::mend(&mut mesh, cancel));
    Ok((mesh, warnings))
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

/// Where each number of a vertex goes: x, y, z, then its normal, then u and v.
const ROLES: [&[&str]; 8] =
    [&["x"], &["y"], &["z"], &["nx"], &["ny"], &["nz"], &["u", "s", "texture_u"], &["v", "t", "texture_v"]];

/// Reads the vertices, and what else there is of them.
fn vertices(element: &Element, numbers: &mut impl Numbers, mesh: &mut Mesh) -> Result<Attributes, Problem> {
    let role = |p: &Property| ROLES.iter().position(|names| names.contains(&p.name.as_str()));
    let roles: Vec<Option<usize>> = element.properties.iter().map(role).collect();
    let has = |range: std::ops::Range<usize>| range.into_iter().all(|r| roles.contains(&Some(r)));
    let (has_normals, has_uv) = (has(3..6), has(6..8));
    let mut attributes = Attributes::of(element, "vertex", |p| role(p).is_some());
    let has_attributes = !attributes.is_empty();
    let count = usize::try_from(element.count).unwrap_or(0);
    mesh.positions.reserve(count);
    mesh.normals.reserve(if has_normals { count } else { 0 });
    mesh.texture_coordinates.reserve(if has_uv { count } else { 0 });
    for _ in 0..element.count {
        let mut v = [0.0; 8];
        if has_attributes {
            attributes.begin();
        }
        for (i, (property, role)) in element.properties.iter().zip(&roles).enumerate() {
            match (property.kind, role) {
                (Kind::Scalar(kind), Some(role)) => v[*role] = numbers.next(kind)?,
                (Kind::Scalar(kind), None) if has_attributes => attributes.set(i, numbers.next(kind)?),
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
            mesh.texture_coordinates.push(DVec2::new(s, t));
        }
        numbers.end_element();
    }
    Ok(attributes)
}
