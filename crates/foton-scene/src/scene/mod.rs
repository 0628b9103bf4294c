//! The scene as rays meet it. It does not change while it renders: an edit makes the next scene.

mod fingerprint;
mod light;
mod lookup;
mod mixture;
mod motion;
mod parametrisation;
mod primitives;
mod relief;
mod scattering;
mod surface;

pub use lookup::Footprint;
pub(crate) use mixture::Mixtures;
pub(crate) use motion::Moving;
use std::sync::Arc;

use foton_math::glam::{Mat3, Vec2, Vec3};
use foton_math::{Aabb, Ray};

use crate::accel::{Accel, Hit};
use crate::bsdf::Coats;
use crate::build::{Patch, PlacedPatches};
use crate::census::Census;
use crate::coincident::Coincidences;
use crate::description::{Colour, Material};
use crate::discrete::Discrete;
use crate::emitter::{Ball, Emitter};
use crate::normalise::Normalisation;
use crate::sensor::Sensor;
use crate::surface::Surface;
use crate::texture::Sampler;

/// A surface's identity in a built scene.
#[derive(Clone, Debug)]
pub struct Shape {
    /// The name in the scene file.
    pub name: String,
    /// Index into the scene's materials.
    pub material: u32,
    /// Index into the scene's emitters, for an area emitter.
    pub emitter: Option<u32>,
    /// How many steps between neighbouring coordinates of single precision it is across, where it stands: few for a small thing
    /// far from the middle of a large scene.
    pub steps_across: f32,
    /// The box around it, in scene units.
    pub(crate) extent: Aabb,
    /// Scene to object space, turning only: texture coordinates of spheres, discs and tubes.
    pub(crate) to_object: Mat3,
}

/// What a primitive belongs to: together, since each hit asks for all of it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Part {
    /// Index of the shape.
    pub(crate) shape: u32,
    pub(crate) patch: Patch,
    /// Whether it lies in another's surface somewhere.
    pub(crate) coincides: bool,
}

/// What the primitives of an instance belong to, beside its shape.
#[derive(Clone, Debug, Default)]
pub(crate) struct Placing {
    pub(crate) patches: PlacedPatches,
    /// Whether any of them lies in another's surface somewhere.
    pub(crate) coincides: bool,
}

/// An immutable scene, in scene units (see [`Normalisation`]). What is large is shared by its clones.
#[derive(Clone)]
pub struct Scene {
    pub(crate) accel: Arc<Accel>,
    /// What each primitive belongs to, in the tree's order. This and what follows is of the scene's own primitives: those of instances
    /// come behind, and `primitives.rs` works out theirs.
    pub(crate) parts: Arc<[Part]>,
    /// By instance.
    pub(crate) placings: Arc<[Placing]>,
    pub(crate) coincidences: Arc<Coincidences>,
    /// Unit vertex normals of each primitive in the tree's order; zeros where flat. Empty when the scene has none.
    pub(crate) vertex_normals: Arc<[[Vec3; 3]]>,
    /// Texture coordinates of each primitive's vertices in the tree's order. Empty when no material asks for them.
    pub(crate) vertex_uvs: Arc<[[Vec2; 3]]>,
    pub(crate) textures: Arc<[Arc<Sampler>]>,
    /// Where each primitive stands in the order in which shapes state them. Empty where nothing asks for it.
    pub(crate) order: Arc<[u32]>,
    pub(crate) shapes: Vec<Shape>,
    pub(crate) materials: Vec<Material>,
    pub(crate) mixtures: Mixtures,
    /// Front and back of each material; empty when no coat is rough.
    pub(crate) coats: Vec<[Option<Coats>; 2]>,
    /// Colours of each shape's front and back where that is Lambertian and nothing else.
    pub(crate) lambertian: Vec<[Option<Colour>; 2]>,
    pub(crate) emitters: Arc<[Emitter]>,
    /// Indices of the emitters at infinity that paths meet by escaping.
    pub(crate) environments: Arc<[u32]>,
    /// Indices of the emitters that no path meets by chance.
    pub(crate) delta_emitters: Arc<[u32]>,
    pub(crate) emitter_choice: Discrete,
    /// Around what reflects or refracts into single directions, if that is clearly smaller than the scene.
    pub(crate) casters: Option<Ball>,
    pub(crate) sensors: Vec<Sensor>,
    pub(crate) normalisation: Normalisation,
    pub(crate) bounds: Aabb,
    pub(crate) max_depth: Option<u32>,
    pub(crate) census: Census,
    /// Bytes of textures and skies.
    pub(crate) picture_bytes: usize,
    /// `None` where nothing moves.
    pub(crate) moving: Option<Arc<Moving>>,
}

impl Scene {
    /// The nearest surface on a ray.
    #[must_use]
    #[inline(always)]
    pub fn nearest(&self, ray: Ray) -> Option<Surface> {
        self.accel.nearest(ray).map(|hit| self.surface(&ray, &hit))
    }

    /// Whether any surface, a transparent one too, lies in the ray's interval.
    #[must_use]
    pub fn occluded(&self, ray: Ray) -> bool {
        self.accel.occluded(ray)
    }

    /// The nearest hit on a ray, for [`Scene::surface`].
    #[must_use]
    #[inline(always)]
    pub fn nearest_hit(&self, ray: Ray) -> Option<Hit> {
        self.accel.nearest(ray)
    }

    /// The material of a shape.
    #[must_use]
    #[inline]
    pub fn material(&self, shape: u32) -> &Material {
        self.material_of(&self.shapes[shape as usize])
    }

    pub(crate) fn material_of(&self, shape: &Shape) -> &Material {
        &self.materials[shape.material as usize]
    }

    /// The materials that a shape's is blended of, itself first.
    pub(crate) fn materials_of(&self, shape: &Shape) -> impl Iterator<Item = &Material> {
        self.mixtures.materials(shape.material as usize).map(|i| &self.materials[i])
    }

    /// All materials, in the order of the description.
    #[must_use]
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// Indices of the emitters that shine from one point or in one direction.
    #[must_use]
    pub fn delta_emitters(&self) -> &[u32] {
        &self.delta_emitters
    }

    /// All emitters.
    #[must_use]
    pub fn emitters(&self) -> &[Emitter] {
        &self.emitters
    }

    /// All shapes, in the order of the description.
    #[must_use]
    pub fn shapes(&self) -> &[Shape] {
        &self.shapes
    }

    /// All sensors, in the order of the description; at least one.
    #[must_use]
    pub fn sensors(&self) -> &[Sensor] {
        &self.sensors
    }

    /// The map between world units and scene units.
    #[must_use]
    pub const fn normalisation(&self) -> &Normalisation {
        &self.normalisation
    }

    /// The box around all surfaces, in scene units.
    #[must_use]
    pub const fn bounds(&self) -> &Aabb {
        &self.bounds
    }

    /// The longest path that the scene asks for, in edges as Mitsuba counts them.
    #[must_use]
    pub const fn max_depth(&self) -> Option<u32> {
        self.max_depth
    }

    /// What the scene contains.
    #[must_use]
    pub const fn census(&self) -> &Census {
        &self.census
    }

    /// Bytes that the scene holds, pictures included.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.accel.bytes()
            + self.parts.len() * size_of::<Part>()
            + self.placings.len() * size_of::<Placing>()
            + self.vertex_normals.len() * size_of::<[Vec3; 3]>()
            + self.vertex_uvs.len() * size_of::<[Vec2; 3]>()
            + self.order.len() * size_of::<u32>()
            + self.picture_bytes
    }
}

#[cfg(test)]
mod tests;
