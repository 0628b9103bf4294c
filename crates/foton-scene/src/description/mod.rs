//! A scene as a person or a file states it: world units, double precision, nothing derived.
//!
//! An editor changes a description and builds the next [`Scene`](crate::Scene) from it. Meanings follow Mitsuba 3, so
//! that one file renders alike in both. Nothing is validated here: building a scene does that.

mod emitter;
mod hidden;
mod material;
mod motion;
mod sensor;
mod shape;
mod texture;

pub use crate::bitmap::{Bitmap, Smaller, Wrap};
pub use crate::bsdf::{
    Bsdf, Coating, Conductor, Dielectric, Diffuse, DiffuseTransmitter, MicrofacetDistribution, Microfacets,
    Mirror, Null, Phong, Plastic, Principled, PrincipledThin, RoughDiffuse, ThinDielectric, Ward,
};
pub use emitter::{EmitterDescription, EmitterKind, projected_half};
pub use hidden::Hidden;
pub use material::{Blend, Material, Relief, ReliefKind};
pub use motion::{Keyframes, Motion};
pub use sensor::{Crop, Filter, FovAxis, Lens, Projection, SensorDescription};
pub use shape::{Attribute, Geometry, Mesh, ShapeDescription};
pub use texture::{Amount, Colour, Number, Texture, TextureKind};

/// Everything that a scene consists of.
#[derive(Clone, Debug, Default)]
pub struct SceneDescription {
    /// Cameras; the first is used unless another is asked for by name.
    pub sensors: Vec<SensorDescription>,
    /// Materials, referred to by index.
    pub materials: Vec<Material>,
    /// Textures, referred to by index.
    pub textures: Vec<Texture>,
    /// Surfaces, in the order of the file. The index is the shape's identity in every output.
    pub shapes: Vec<ShapeDescription>,
    /// Emitters that are not surfaces.
    pub emitters: Vec<EmitterDescription>,
    /// The longest path in edges, as Mitsuba counts them (1: emitters seen directly, 2: one bounce); `None`: no bound.
    pub max_depth: Option<u32>,
    /// What is left out of the scene.
    pub hidden: Hidden,
    /// What moves.
    pub motion: Motion,
}

impl SceneDescription {
    /// Whether a material, by its index, is blended with others and is no shape's own.
    #[must_use]
    pub fn is_component(&self, material: usize) -> bool {
        let mut blends = self.materials.iter().flat_map(|m| &m.mixture);
        blends.any(|blend| blend.material == material) && self.shapes.iter().all(|s| s.material != material)
    }
}
