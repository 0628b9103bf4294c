//! Shapes of a model, and their materials.

use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::DAffine3;
use foton_scene::description::{
    Bsdf, Colour, Diffuse, Geometry, Material, Mesh, SceneDescription, ShapeDescription,
};

use crate::mesh::mtl;

/// Finds a file of materials: its path, and its contents or why it cannot be read.
pub(super) type Library<'a> = dyn FnMut(&str) -> Option<(String, Result<Vec<u8>, String>)> + 'a;

/// Grey, from both sides.
pub(super) fn grey(name: &str) -> Material {
    let front = Bsdf::Diffuse(Diffuse { reflectance: Rgb::splat(0.5).into() });
    Material { name: name.to_owned(), front, back: Some(front), ..Material::default() }
}

pub(super) fn add_shape(name: &str, mesh: Mesh, known: Option<&mtl::Entry>, scene: &mut SceneDescription) {
    let material = known.map_or_else(|| grey(name), |entry| entry.material.clone());
    scene.materials.push(material);
    scene.shapes.push(ShapeDescription {
        name: name.to_owned(),
        geometry: Geometry::Mesh(Arc::new(mesh)),
        to_world: DAffine3::IDENTITY,
        flip_normals: false,
        material: scene.materials.len() - 1,
        radiance: known.and_then(|entry| entry.radiance.map(Colour::from)),
    });
}
