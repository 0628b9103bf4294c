//! A mesh as a binary PLY file, little-endian: single precision where that loses nothing, double elsewhere.

use std::io::{self, Write};

use foton_math::glam::{DVec2, DVec3};
use foton_scene::description::{Attribute, Mesh};

/// Whether two meshes are the same, number by number.
pub(crate) fn same(a: &Mesh, b: &Mesh) -> bool {
    a.triangles == b.triangles
        && a.positions == b.positions
        && a.normals == b.normals
        && a.texture_coordinates == b.texture_coordinates
        && a.attributes == b.attributes
}

/// Writes a mesh with a comment.
pub(crate) fn write_ply(mesh: &Mesh, comment: &str, out: &mut impl Write) -> io::Result<()> {
    let Mesh { positions, normals, texture_coordinates, triangles, .. } = mesh;
    let is_narrow = positions.iter().chain(normals).all(|v| v.to_array().into_iter().all(is_single))
        && texture_coordinates.iter().all(|v| v.to_array().into_iter().all(is_single));
    let kind = if is_narrow { "float" } else { "double" };
    writeln!(out, "ply\nformat binary_little_endian 1.0\ncomment {comment}")?;
    writeln!(out, "element vertex {}", positions.len())?;
    let mut names = vec!["x", "y", "z"];
    names.extend(if normals.is_empty() { &[][..] } else { &["nx", "ny", "nz"] });
    names.extend(if texture_coordinates.is_empty() { &[][..] } else { &["u", "v"] });
    for name in names {
        writeln!(out, "property {kind} {name}")?;
    }
    let of_vertices: Vec<&Attribute> = mesh.attributes.iter().filter(|a| !a.is_of_faces()).collect();
    let of_faces: Vec<&Attribute> = mesh.attributes.iter().filter(|a| a.is_of_faces()).collect();
    declare(&of_vertices, "vertex_", out)?;
    let index = if i32::try_from(positions.len()).is_ok() { "int" } else { "uint" };
    writeln!(out, "element face {}\nproperty list uchar {index} vertex_indices", triangles.len())?;
    declare(&of_faces, "face_", out)?;
    writeln!(out, "end_header")?;
    for (i, position) in positions.iter().enumerate() {
        let normal = normals.get(i).map(DVec3::to_array);
        let uv = texture_coordinates.get(i).map(DVec2::to_array);
        let normal = normal.as_ref().map_or(&[][..], |n| n);
        let uv = uv.as_ref().map_or(&[][..], |uv| uv);
        for value in position.to_array().iter().chain(normal).chain(uv) {
            write_number(*value, is_narrow, out)?;
        }
        write_attributes(&of_vertices, i, out)?;
    }
    for (i, triangle) in triangles.iter().enumerate() {
        out.write_all(&[3])?;
        for corner in triangle {
            out.write_all(&corner.to_le_bytes())?;
        }
        write_attributes(&of_faces, i, out)?;
    }
    Ok(())
}

/// Lines of the header for attributes whose names begin with a prefix.
fn declare(attributes: &[&Attribute], prefix: &str, out: &mut impl Write) -> io::Result<()> {
    for attribute in attributes {
        let name = attribute.name.strip_prefix(prefix).unwrap_or(&attribute.name);
        for channel in 0..attribute.channels {
            writeln!(out, "property float {name}_{channel}")?;
        }
    }
    Ok(())
}

fn write_attributes(attributes: &[&Attribute], index: usize, out: &mut impl Write) -> io::Result<()> {
    for attribute in attributes {
        let channels = attribute.channels;
        for value in &attribute.values[index * channels..(index + 1) * channels] {
            out.write_all(&value.to_le_bytes())?;
        }
    }
    Ok(())
}

#[allow(clippy::cast_possible_truncation, reason = "this asks whether it loses something")]
fn is_single(value: f64) -> bool {
    f64::from(value as f32).to_bits() == value.to_bits()
}

#[allow(clippy::cast_possible_truncation, reason = "only where it loses nothing")]
fn write_number(value: f64, is_narrow: bool, out: &mut impl Write) -> io::Result<()> {
    if is_narrow { out.write_all(&(value as f32).to_le_bytes()) } else { out.write_all(&value.to_le_bytes()) }
}
