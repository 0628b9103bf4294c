//! The scene as rays meet it. It does not change while it renders: an edit makes the next scene.

use foton_math::glam::Vec3;
use foton_math::{Aabb, Ray, Rgb};

use crate::accel::{Accel, Hit};
use crate::census::Census;
use crate::description::{Bsdf, Material};
use crate::discrete::Discrete;
use crate::emitter::{Emitter, Kind};
use crate::normalise::Normalisation;
use crate::sensor::Sensor;
use crate::surface::{Surface, locate};

/// A surface's identity in a built scene.
#[derive(Clone, Debug)]
pub struct Shape {
    /// The name in the scene file.
    pub name: String,
    /// Index into the scene's materials.
    pub material: u32,
    /// Index into the scene's emitters, for an area emitter.
    pub emitter: Option<u32>,
}

/// An immutable scene, in scene units (see [`Normalisation`]).
pub struct Scene {
    pub(crate) accel: Accel,
    /// Shape of each primitive, in the tree's order.
    pub(crate) shape_of: Vec<u32>,
    /// Unit vertex normals of each primitive in the tree's order; zeros where flat. Empty when the scene has none.
    pub(crate) vertex_normals: Vec<[Vec3; 3]>,
    pub(crate) shapes: Vec<Shape>,
    pub(crate) materials: Vec<Material>,
    pub(crate) emitters: Vec<Emitter>,
    pub(crate) emitter_choice: Discrete,
    pub(crate) sensors: Vec<Sensor>,
    pub(crate) normalisation: Normalisation,
    pub(crate) bounds: Aabb,
    pub(crate) max_depth: Option<u32>,
    pub(crate) census: Census,
}

impl Scene {
    /// The nearest surface on a ray.
    #[must_use]
    pub fn nearest(&self, ray: Ray) -> Option<Surface> {
        self.accel.nearest(ray).map(|hit| self.surface(&ray, &hit))
    }

    /// Whether any surface, a transparent one too, lies in the ray's interval.
    #[must_use]
    pub fn occluded(&self, ray: Ray) -> bool {
        self.accel.occluded(ray)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let i = hit.primitive as usize;
        let primitive = &self.accel.primitives()[i];
        let (position, error, normal) = locate(primitive, hit.barycentric, ray.at(hit.t));
        let mut surface = Surface {
            position,
            error,
            normal,
            shading_normal: normal,
            curved: matches!(primitive, crate::primitive::Primitive::Sphere { .. }),
            shape: self.shape_of[i],
        };
        if let Some([a, b, c]) = self.vertex_normals.get(i)
            && *a != Vec3::ZERO
        {
            let (v, w) = (hit.barycentric.x, hit.barycentric.y);
            let n = (*a * (1.0 - v - w) + *b * v + *c * w).normalize_or(normal);
            surface.shading_normal = if n.dot(normal) < 0.0 { -n } else { n };
            surface.curved = true;
        }
        surface
    }

    /// The BSDF that light meets on the side of `outward` (whether the light's direction is on the normal's side).
    /// `None`: that side is black.
    #[must_use]
    pub fn bsdf(&self, shape: u32, outward: bool) -> Option<&Bsdf> {
        let material = self.material(shape);
        if outward || material.front.transmits() { Some(&material.front) } else { material.back.as_ref() }
    }

    /// The material of a shape.
    #[must_use]
    pub fn material(&self, shape: u32) -> &Material {
        &self.materials[self.shapes[shape as usize].material as usize]
    }

    /// Radiance that a surface emits towards `direction`.
    #[must_use]
    pub fn emitted(&self, surface: &Surface, direction: Vec3) -> Rgb {
        let Some(emitter) = self.shapes[surface.shape as usize].emitter else { return Rgb::BLACK };
        match &self.emitters[emitter as usize].kind {
            Kind::Area(area) if direction.dot(surface.normal) > 0.0 => area.radiance,
            _ => Rgb::BLACK,
        }
    }

    /// Radiance that arrives from infinity against a ray that hits nothing.
    #[must_use]
    pub fn escaped_radiance(&self) -> Rgb {
        if !self.census.environment {
            return Rgb::BLACK;
        }
        self.emitters.iter().map(Emitter::escaped_radiance).sum()
    }

    /// Chooses an emitter by `u` in [0, 1): in proportion to power, with a defensive share for each. Returns its index and
    /// the chance of it; `None` when nothing emits.
    #[must_use]
    pub fn choose_emitter(&self, u: f64) -> Option<(usize, f64)> {
        if self.emitter_choice.is_empty() {
            return None;
        }
        let i = self.emitter_choice.choose(u);
        Some((i, self.emitter_choice.probability(i)))
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

    /// Bytes that the scene holds.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.accel.bytes()
            + self.shape_of.len() * size_of::<u32>()
            + self.vertex_normals.len() * size_of::<[Vec3; 3]>()
    }
}
