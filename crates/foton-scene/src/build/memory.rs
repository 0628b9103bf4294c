//! What a description holds and what building a scene of it takes, known before it is built.

use std::collections::HashSet;
use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{DVec2, DVec3};

use super::gauge::Instancing;
use super::instances::shared_meshes;
use crate::accel::Instance;
use crate::description::{Bitmap, EmitterKind, Geometry, Mesh, SceneDescription, TextureKind};
use crate::scene::Shape;

/// Bytes for each primitive while the tree is built: the primitive twice, its box, both trees and the table of cuts between them.
/// Measured from outside on meshes of 2·10⁵ to 10⁶ triangles: 400 to 410.
const BYTES_PER_PRIMITIVE: usize = 432;

/// Bytes for each instance while the tree is built: itself, its shape, its box and the nodes above it.
const BYTES_PER_INSTANCE: usize = size_of::<Instance>() + size_of::<Shape>() + BYTES_PER_PRIMITIVE;

impl SceneDescription {
    /// Bytes held, meshes and pictures that are shared once.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let mut meshes = HashSet::new();
        let meshes = self.shapes.iter().filter_map(|shape| match &shape.geometry {
            Geometry::Mesh(mesh) => meshes.insert(Arc::as_ptr(mesh)).then(|| mesh.bytes()),
            _ => None,
        });
        meshes.sum::<usize>() + self.picture_bytes()
    }

    /// Bytes held at most while [`Scene::build`](crate::Scene::build) makes a scene of it, its own included.
    #[must_use]
    pub fn build_bytes(&self) -> usize {
        let shared = shared_meshes(self, Instancing::default());
        let of_instances: usize =
            shared.iter().map(|(mesh, shapes)| mesh.triangles.len() * shapes.len()).sum();
        let trees: usize = shared.iter().map(|(mesh, _)| mesh.triangles.len()).sum();
        let instances: usize = shared.iter().map(|(_, shapes)| shapes.len()).sum();
        self.bytes()
            + (self.primitives() - of_instances + trees) * BYTES_PER_PRIMITIVE
            + instances * BYTES_PER_INSTANCE
    }

    /// Primitives that a build works through: those of a mesh that is built once for many shapes once.
    #[must_use]
    pub fn primitives_to_build(&self) -> usize {
        let shared = shared_meshes(self, Instancing::default());
        let saved: usize =
            shared.iter().map(|(mesh, shapes)| mesh.triangles.len() * (shapes.len() - 1)).sum();
        self.primitives() - saved
    }

    /// Triangles, those without area too, and other surfaces.
    #[must_use]
    pub fn primitives(&self) -> usize {
        let primitives = self.shapes.iter().map(|shape| match &shape.geometry {
            Geometry::Mesh(mesh) => mesh.triangles.len(),
            _ => 1,
        });
        primitives.sum()
    }

    /// Bytes of pictures, those that are shared once.
    pub(super) fn picture_bytes(&self) -> usize {
        let textures = self.textures.iter().filter_map(|texture| match &texture.kind {
            TextureKind::Bitmap { bitmap, .. } => Some(bitmap),
            TextureKind::Checkerboard { .. } | TextureKind::Attribute { .. } => None,
        });
        let skies = self.emitters.iter().filter_map(|emitter| match &emitter.kind {
            EmitterKind::Environment { bitmap, .. } => Some(bitmap),
            _ => None,
        });
        // A sky has a table of chances beside each pixel, a texture smaller copies of itself.
        let tables: usize = skies.clone().map(|sky| sky.pixels.len() * size_of::<f64>()).sum();
        let mut copied = HashSet::new();
        let copies = textures.clone().filter(|bitmap| copied.insert(Arc::as_ptr(bitmap)));
        let copies: usize = copies.map(|bitmap| bitmap.pixels.len() * size_of::<Rgb>() / 3).sum();
        let mut seen = HashSet::new();
        let own = textures.chain(skies).filter(|bitmap| seen.insert(Arc::as_ptr(bitmap)));
        own.map(|bitmap: &Arc<Bitmap>| bitmap.pixels.len() * size_of::<Rgb>()).sum::<usize>()
            + tables
            + copies
    }
}

impl Mesh {
    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        (self.positions.len() + self.normals.len()) * size_of::<DVec3>()
            + self.texture_coordinates.len() * size_of::<DVec2>()
            + self.triangles.len() * size_of::<[u32; 3]>()
            + self.attributes.iter().map(|a| a.values.len() * size_of::<f32>()).sum::<usize>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use foton_math::glam::DAffine3;

    use crate::description::ShapeDescription;

    #[test]
    fn a_mesh_that_shapes_share_is_held_once_and_built_for_each() {
        let mesh = Arc::new(Mesh::cube());
        let shape = || ShapeDescription {
            name: "cube".into(),
            geometry: Geometry::Mesh(Arc::clone(&mesh)),
            to_world: DAffine3::IDENTITY,
            flip_normals: false,
            material: 0,
            radiance: None,
        };
        let one = SceneDescription { shapes: vec![shape()], ..SceneDescription::default() };
        let two = SceneDescription { shapes: vec![shape(), shape()], ..SceneDescription::default() };
        assert!(one.bytes() > 0 && one.bytes() == two.bytes());
        assert_eq!(two.build_bytes() - one.build_bytes(), mesh.triangles.len() * BYTES_PER_PRIMITIVE);
    }
}
