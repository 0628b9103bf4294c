//! Meshes: the primitives that are triangles, each with the vertices that these use and the material of its own.
//!
//! Without normals faces are flat, as the format says. Tangents are not read: a normal map goes by the texture coordinates of each
//! triangle, and those where they are mirrored become a part of their own, with the map turned upside down.

use std::rc::Rc;
use std::sync::Arc;

use foton_math::Rgb;

use super::accessor::Source;
use super::json::At;
use super::materials::{COLOURS, OPACITIES};
use super::pose::{Movers, Pose};
use super::reader::{Painted, Part, Reader};
use super::vertices::{TRIANGLE, VERTEX, Vertices, triangles, used};
use crate::mesh::normals;

/// Modes of primitives that are triangles, and those that are none.
const TRIANGLES: usize = 4;
const MODES: std::ops::RangeInclusive<usize> = 4..=6;

impl<'a> Reader<'a> {
    /// The parts of a primitive; none where it has no triangles, or where something is wrong with it, which is said.
    pub(super) fn parts_of(&mut self, primitive: &At<'a>, pose: &Pose) -> Vec<Part> {
        self.read_parts(primitive, pose).unwrap_or_default()
    }

    fn read_parts(&mut self, primitive: &At<'a>, pose: &Pose) -> Option<Vec<Part>> {
        let mode = primitive.index("mode", &mut self.report).unwrap_or(TRIANGLES);
        if mode < TRIANGLES {
            self.notice("points and lines are left out: they have no surface", primitive);
            return None;
        }
        if !MODES.contains(&mode) {
            primitive.error(&mut self.report, format!("there is no mode {mode}"));
            return None;
        }
        let (root, buffers) = (self.root.clone(), Rc::clone(&self.buffers));
        let source = Source { root: &root, buffers: &buffers };
        let material = match primitive.get("material") {
            Some(_) => Some(primitive.named("material", "materials", &root, &mut self.report)?.0),
            None => None,
        };
        let vertices = self.vertices(primitive, material, pose, &source)?;
        let corners = self.corners(primitive, mode, &vertices, &source)?;
        let painted = self.painted(primitive, material, &vertices, &corners);
        let splits = self.has_relief(material);
        let split = if splits { vertices.by_side(corners) } else { [corners, Vec::new()] };
        let mut parts = Vec::new();
        for (triangles, mirrored) in split.into_iter().zip([false, true]) {
            if !triangles.is_empty() {
                let painted = Painted { mirrored, ..painted };
                parts.push(self.part(primitive, material, painted, &vertices, triangles)?);
            }
        }
        Some(parts)
    }

    /// What the vertices of a primitive have.
    fn vertices<'b>(
        &mut self,
        primitive: &At<'a>,
        material: Option<usize>,
        pose: &'b Pose,
        source: &Source<'a, 'b>,
    ) -> Option<Vertices<'b>> {
        let set = self.set_of_material(material);
        let report = &mut self.report;
        let Some(attributes) = primitive.get("attributes") else {
            primitive.error(report, "needs \"attributes\"");
            return None;
        };
        let Some(positions) = source.of_vertices(&attributes, "POSITION", (3, 0), report)? else {
            attributes.error(report, "needs a \"POSITION\"");
            return None;
        };
        let count = positions.count;
        let normals = source.of_vertices(&attributes, "NORMAL", (3, count), report)?;
        let coordinates = source.of_vertices(&attributes, &format!("TEXCOORD_{set}"), (2, count), report)?;
        let colours = source.of_vertices(&attributes, "COLOR_0", (3, count), report)?;
        let movers = Movers::of(primitive, pose, source, count, report)?;
        if coordinates.is_none() && self.has_textures(material) {
            self.notice("has no texture coordinates for the textures of its material", primitive);
        }
        Some(Vertices { positions, normals, coordinates, colours, movers })
    }

    /// The triangles of a primitive, by the numbers of its vertices.
    fn corners(
        &mut self,
        primitive: &At<'a>,
        mode: usize,
        vertices: &Vertices<'_>,
        source: &Source<'a, '_>,
    ) -> Option<Vec<[u32; 3]>> {
        let count = vertices.positions.count;
        let indices = match primitive.get("indices") {
            Some(at) => {
                let indices = source.accessor(primitive, "indices", &mut self.report)?;
                if !indices.is_of_indices() {
                    at.error(&mut self.report, "must be unsigned whole numbers, one each");
                    return None;
                }
                Some(indices)
            }
            None => None,
        };
        let corners = indices.as_ref().map_or(count, |indices| indices.count);
        let each = if mode == TRIANGLES { 3 } else { 1 };
        if let Err(message) = self.files.budget.check((corners / each) as u64 * TRIANGLE) {
            primitive.error(&mut self.report, message);
            return None;
        }
        let corner = |i: usize| indices.as_ref().map_or(i as u32, |indices| indices.index(i));
        let triangles = triangles(mode, corners, corner, self.files.cancel());
        if let Some(beyond) = triangles.iter().flatten().find(|i| **i as usize >= count) {
            let message = format!("a triangle has vertex {beyond}, and there are {count}, from 0");
            primitive.get("indices").unwrap_or_else(|| primitive.clone()).error(&mut self.report, message);
            return None;
        }
        if triangles.is_empty() {
            self.notice("has no triangles", primitive);
        }
        Some(triangles)
    }

    /// What the colours of vertices add to the material.
    fn painted(
        &mut self,
        primitive: &At<'a>,
        material: Option<usize>,
        vertices: &Vertices<'_>,
        triangles: &[[u32; 3]],
    ) -> Painted {
        let nothing = Painted::default();
        if vertices.colours.is_none() {
            return nothing;
        }
        if let Some(shared) = vertices.shared_colour(triangles) {
            let shared = Some(shared).filter(|shared| *shared != [1.0; 4]);
            return Painted { shared: shared.map(|shared| shared.map(f32::to_bits)), ..nothing };
        }
        let (colours, opacities) = self.takes_colours(material);
        if !colours {
            self.notice("colours that differ from vertex to vertex are left out over a texture", primitive);
        }
        Painted { colours, opacities, ..nothing }
    }

    /// Some triangles of a primitive with their vertices.
    fn part(
        &mut self,
        primitive: &At<'a>,
        material: Option<usize>,
        painted: Painted,
        vertices: &Vertices<'_>,
        mut triangles: Vec<[u32; 3]>,
    ) -> Option<Part> {
        let used = used(&mut triangles);
        let takes = used.len() as u64 * VERTEX + triangles.len() as u64 * TRIANGLE;
        if let Err(message) = self.files.budget.take(takes) {
            primitive.error(&mut self.report, message);
            return None;
        }
        let cancel = self.files.cancel();
        let mut mesh = match vertices.mesh(&used, triangles, cancel) {
            Ok(mesh) => mesh,
            Err(vertex) => {
                primitive.error(&mut self.report, format!("the position of vertex {vertex} is no number"));
                return None;
            }
        };
        if cancel.is_requested() {
            return None;
        }
        for (_, message) in normals::mend(&mut mesh, cancel) {
            primitive.warn(&mut self.report, message);
        }
        if painted.colours {
            let (factor, _) = self.base_factor(material);
            let colour = |[r, g, b, _]: [f32; 4]| (Rgb::new(r, g, b) * factor).to_array();
            mesh.attributes.push(vertices.attribute(COLOURS, &used, colour));
        }
        if painted.opacities {
            let opacity = self.vertex_opacity(material);
            mesh.attributes.push(vertices.attribute(OPACITIES, &used, |c| [opacity(c[3])]));
        }
        Some(Part { mesh: Arc::new(mesh), surface: self.surface(material, painted) })
    }
}
