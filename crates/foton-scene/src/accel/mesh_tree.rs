//! The tree over the triangles of a mesh that several shapes share, in a space of its own.
//!
//! Boxes are single precision and padded by what rounding may move a triangle in the scene: a triangle that a ray meets there lies in a
//! box that it meets here. Corners are double precision, so that they end up in the scene with the bits of a mesh that is there by itself.

use std::ops::Range;
use std::sync::Arc;

use foton_math::glam::DVec3;

use super::node::{Node, QUAD, Quad};
use crate::build::Patch;
use crate::description::Mesh;
use crate::normalise::Normalisation;
use crate::placement::Placement;

/// A tree over the triangles of a mesh.
pub(crate) struct MeshTree {
    pub(super) nodes: Vec<Node>,
    pub(super) quads: Vec<MeshQuad>,
    /// The mesh, which others share.
    pub(crate) mesh: Arc<Mesh>,
    /// Numbers of the mesh's triangles, in the tree's order.
    pub(crate) triangles: Vec<u32>,
    /// What continues what, in the tree's order.
    pub(crate) patches: Vec<Patch>,
    /// The largest number of a patch.
    pub(crate) patch_numbers: usize,
    /// Triangles with edges that nothing in the mesh continues, a bit for each edge.
    pub(crate) free: Vec<(u32, u8)>,
    /// From the mesh to the space of the boxes.
    pub(crate) to_boxes: Normalisation,
    /// By how much boxes are larger than what is in them.
    pub(crate) padding: f32,
}

impl MeshTree {
    /// Of nodes and quads over triangles that stand in the space of `to_boxes`.
    pub(super) fn new(
        (nodes, quads): (Vec<Node>, &[Quad]),
        mesh: &Arc<Mesh>,
        triangles: Vec<u32>,
        (patches, free): (Vec<Patch>, Vec<(u32, u8)>),
        (to_boxes, padding): (Normalisation, f32),
    ) -> Self {
        let corners = |&i: &u32| mesh.triangles[i as usize].map(|i| mesh.positions[i as usize]);
        let quads = quads.iter().map(|quad| {
            let first = quad.first as usize;
            MeshQuad::new(quad.first, triangles[first..first + quad.len()].iter().map(corners))
        });
        let (quads, mesh) = (quads.collect(), Arc::clone(mesh));
        let patch_numbers = patches.iter().map(|p| usize::from(p.key >> 1)).max().unwrap_or(1);
        Self { nodes, quads, mesh, triangles, patches, patch_numbers, free, to_boxes, padding }
    }

    /// Bytes held, those of the mesh too: the scene keeps it.
    pub(crate) fn bytes(&self) -> usize {
        self.mesh.bytes()
            + size_of_val(&self.nodes[..])
            + size_of_val(&self.quads[..])
            + size_of_val(&self.triangles[..])
            + size_of_val(&self.patches[..])
            + size_of_val(&self.free[..])
    }
}

/// Up to four triangles of a mesh side by side.
pub(super) struct MeshQuad {
    /// Vertex, axis, lane. NaN in empty lanes.
    vertices: [[[f64; QUAD]; 3]; 3],
    first: u32,
}

impl MeshQuad {
    fn new(first: u32, triangles: impl Iterator<Item = [DVec3; 3]>) -> Self {
        let mut vertices = [[[f64::NAN; QUAD]; 3]; 3];
        for (lane, triangle) in triangles.enumerate() {
            for (rows, vertex) in vertices.iter_mut().zip(triangle) {
                for (axis, row) in rows.iter_mut().enumerate() {
                    row[lane] = vertex[axis];
                }
            }
        }
        Self { vertices, first }
    }

    /// Places of its triangles in the tree.
    pub(super) fn triangles(&self) -> Range<usize> {
        let x = &self.vertices[0][0];
        let count = x.iter().take_while(|x| !x.is_nan()).count();
        self.first as usize..self.first as usize + count
    }

    /// The same triangles where they stand in the scene.
    #[inline(always)]
    pub(super) fn placed(&self, placement: &Placement) -> Quad {
        let [a, b, c] = &self.vertices;
        Quad { vertices: [a, b, c].map(|rows| placement.points(rows)), first: self.first }
    }
}
