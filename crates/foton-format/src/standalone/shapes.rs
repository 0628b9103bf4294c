//! Shapes of a model, and their materials.

use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{DAffine2, DAffine3};
use foton_scene::description::{
    Bsdf, Colour, Diffuse, Geometry, Material, Mesh, SceneDescription, ShapeDescription, Texture, TextureKind,
};

use crate::mesh::mtl;
use crate::mesh::normals::VERTEX_COLOUR;

/// Finds a file of materials: its path, and its contents or why it cannot be read.
pub(super) type Library<'a> = dyn FnMut(&str) -> Option<(String, Result<Vec<u8>, String>)> + 'a;

/// Grey, from both sides.
pub(super) fn grey(name: &str) -> Material {
    let front = Bsdf::Diffuse(Diffuse { reflectance: Rgb::splat(0.5).into() });
    Material { name: name.to_owned(), front, back: Some(front), ..Material::default() }
}

/// Whether a mesh states colours of its vertices.
fn has_colours(mesh: &Mesh) -> bool {
    mesh.attributes.iter().any(|a| a.name == VERTEX_COLOUR && a.channels == 3)
}

/// In the colours of the mesh's vertices, from both sides.
fn painted(name: &str, scene: &mut SceneDescription) -> Material {
    let kind = TextureKind::Attribute { name: VERTEX_COLOUR.to_owned(), scale: 1.0, most: 1.0 };
    let known = scene.textures.iter().position(|t| t.name == VERTEX_COLOUR);
    let texture = known.unwrap_or_else(|| {
        let name = VERTEX_COLOUR.to_owned();
        scene.textures.push(Texture { name, to_uv: DAffine2::IDENTITY, kind });
        scene.textures.len() - 1
    });
    let front = Bsdf::Diffuse(Diffuse { reflectance: Colour::Texture(texture) });
    Material { front, back: Some(front), ..grey(name) }
}

pub(super) fn add_shape(name: &str, mesh: Mesh, known: Option<&mtl::Entry>, scene: &mut SceneDescription) {
    let material = known.map_or_else(
        || if has_colours(&mesh) { painted(name, scene) } else { grey(name) },
        |entry| entry.material.clone(),
    );
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
