//! Shapes of a model, and their materials.

use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{DAffine2, DAffine3};
use foton_scene::description::{
    Bsdf, Colour, Diffuse, Geometry, Material, Mesh, SceneDescription, ShapeDescription, Texture, TextureKind,
};

use crate::mesh::mtl;

/// Finds a file of materials: its path, and its contents or why it cannot be read.
pub(super) type Library<'a> = dyn FnMut(&str) -> Option<(String, Result<Vec<u8>, String>)> + 'a;

/// Colours that a mesh may have of its vertices or faces.
const COLOURS: [&str; 2] = ["vertex_color", "face_color"];

/// Dull, from both sides: grey, or of the colours that the mesh has.
fn dull(name: &str, mesh: &Mesh, scene: &mut SceneDescription) -> Material {
    let found = mesh.attributes.iter().find(|a| a.channels == 3 && COLOURS.contains(&a.name.as_str()));
    let reflectance = match found {
        Some(colours) => {
            let name = colours.name.clone();
            let known = scene.textures.iter().position(|t| t.name == name);
            Colour::Texture(known.unwrap_or_else(|| {
                let kind = TextureKind::Attribute { name: name.clone(), scale: 1.0, most: 1.0 };
                scene.textures.push(Texture { name, to_uv: DAffine2::IDENTITY, kind });
                scene.textures.len() - 1
            }))
        }
        None => Rgb::splat(0.5).into(),
    };
    let front = Bsdf::Diffuse(Diffuse { reflectance });
    Material { name: name.to_owned(), front, back: Some(front), ..Material::default() }
}

pub(super) fn add_shape(name: &str, mesh: Mesh, known: Option<&mtl::Entry>, scene: &mut SceneDescription) {
    let material = match known {
        Some(entry) => entry.material.clone(),
        None => dull(name, &mesh, scene),
    };
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
