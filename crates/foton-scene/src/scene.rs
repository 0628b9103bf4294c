//! The scene as rays meet it. It does not change while it renders: an edit makes the next scene.

use std::sync::Arc;

use foton_math::glam::{Mat3, Vec2, Vec3};
use foton_math::{Aabb, Frame, Ray, Rgb};

use crate::accel::{Accel, Hit};
use crate::bsdf::{Coat, Scattering};
use crate::build::Patch;
use crate::census::Census;
use crate::coincident::Coincidences;
use crate::description::{Bsdf, Colour, Diffuse, Material};
use crate::discrete::Discrete;
use crate::emitter::{Ball, Emitter, Kind};
use crate::normalise::Normalisation;
use crate::primitive::Primitive;
use crate::sensor::Sensor;
use crate::surface::{Surface, locate};
use crate::texture::Sampler;

/// The side that a material does not describe.
const BLACK: Bsdf = Bsdf::Diffuse(Diffuse { reflectance: Colour::Constant(Rgb::BLACK) });

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

/// An immutable scene, in scene units (see [`Normalisation`]). What is large is shared by its clones.
#[derive(Clone)]
pub struct Scene {
    pub(crate) accel: Arc<Accel>,
    /// What each primitive belongs to, in the tree's order.
    pub(crate) parts: Arc<[Part]>,
    pub(crate) coincidences: Arc<Coincidences>,
    /// Unit vertex normals of each primitive in the tree's order; zeros where flat. Empty when the scene has none.
    pub(crate) vertex_normals: Arc<[[Vec3; 3]]>,
    /// Texture coordinates of each primitive's vertices in the tree's order. Empty when no material asks for them.
    pub(crate) vertex_uvs: Arc<[[Vec2; 3]]>,
    pub(crate) textures: Arc<[Sampler]>,
    pub(crate) shapes: Vec<Shape>,
    pub(crate) materials: Vec<Material>,
    /// Front and back of each material; empty when no coat is rough.
    pub(crate) coats: Vec<[Option<Coat>; 2]>,
    /// Colours of each shape's front and back where that is Lambertian and nothing else.
    pub(crate) lambertian: Vec<[Option<Colour>; 2]>,
    pub(crate) emitters: Arc<[Emitter]>,
    /// Indices of the emitters at infinity that paths meet by escaping.
    pub(crate) environments: Arc<[u32]>,
    /// Indices of the emitters that no path meets by chance.
    pub(crate) delta_emitters: Arc<[u32]>,
    pub(crate) emitter_choice: Discrete,
    /// Around what reflects or refracts into single directions, if that takes up clearly less than the scene.
    pub(crate) casters: Option<Ball>,
    pub(crate) sensors: Vec<Sensor>,
    pub(crate) normalisation: Normalisation,
    pub(crate) bounds: Aabb,
    pub(crate) max_depth: Option<u32>,
    pub(crate) census: Census,
    /// Bytes of textures and skies.
    pub(crate) picture_bytes: usize,
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

    /// What is the nearest on a ray, to be looked at by [`Scene::surface`].
    #[must_use]
    #[inline(always)]
    pub fn nearest_hit(&self, ray: Ray) -> Option<Hit> {
        self.accel.nearest(ray)
    }

    /// The point that a ray hits. Where surfaces lie in one another, on the one that counts: an emitter before what is opaque,
    /// that before what is clear, then the first in the file.
    #[must_use]
    #[inline(always)]
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let mut surface = self.surface_of(ray, hit.primitive, hit.barycentric, ray.at(hit.t));
        if !self.parts[hit.primitive as usize].coincides {
            return surface;
        }
        let share = self.coincidences.share(hit.primitive);
        if share.is_unsettled(ray.direction.dot(surface.normal) < 0.0) {
            self.settle(ray, &mut surface);
        } else {
            surface.error += surface.normal.abs() * self.coincidences.gap(surface.shape as usize);
        }
        surface
    }

    /// The point of a primitive that a ray meets, by its weights or about where on the ray it is.
    #[inline(always)]
    pub(crate) fn surface_of(
        &self,
        ray: &Ray,
        primitive: u32,
        barycentric: Vec2,
        approximate: Vec3,
    ) -> Surface {
        let i = primitive as usize;
        let (part, primitive) = (self.parts[i], &self.accel.primitives()[i]);
        let (position, error, normal) = match *primitive {
            Primitive::Triangle(corners) => self.accel.plane(i).locate_on(ray, corners, barycentric),
            _ => locate(primitive, barycentric, approximate),
        };
        let mut surface = Surface {
            position,
            error,
            normal,
            shading_normal: normal,
            curved: part.patch.curved
                || matches!(primitive, Primitive::Sphere { .. } | Primitive::Cylinder { .. }),
            shape: part.shape,
            patch: part.patch.key,
            primitive: i as u32,
            barycentric,
            interface: None,
        };
        if let Some([a, b, c]) = self.vertex_normals.get(i)
            && *a != Vec3::ZERO
        {
            let (v, w) = (barycentric.x, barycentric.y);
            let n = (*a * (1.0 - v - w) + *b * v + *c * w).normalize_or(normal);
            surface.shading_normal = if n.dot(normal) < 0.0 { -n } else { n };
            surface.curved = true;
        }
        surface
    }

    /// How the surface scatters light on the side of `outward` (whether the light's direction is on the normal's side), with
    /// its colours looked up. `None`: that side is black. A side without a BSDF takes all light that meets it, and where there is
    /// an opacity the rest passes it all the same.
    #[must_use]
    #[inline(always)]
    pub fn scattering(&self, surface: &Surface, outward: bool) -> Option<Scattering> {
        let material = self.material(surface.shape);
        let front = outward || material.front.transmits();
        let bsdf = match &material.back {
            _ if front => &material.front,
            Some(back) => back,
            None if material.opacity.is_some() => &BLACK,
            None => return None,
        };
        let coats = self.coats.get(self.shapes[surface.shape as usize].material as usize);
        let coat = coats.and_then(|c| c[usize::from(!front)]);
        if !self.census.textures {
            let constant = |c: Colour| if let Colour::Constant(c) = c { c } else { Rgb::BLACK };
            let opacity = material.opacity.map_or(1.0, |c| constant(c).mean());
            return Some(Scattering { bsdf: surface.between(*bsdf).map(constant), opacity, coat });
        }
        let mut known = None;
        let mut uv = || *known.get_or_insert_with(|| self.texture_coordinate(surface));
        let opacity = material.opacity.map_or(1.0, |c| match c {
            Colour::Constant(c) => c.mean(),
            Colour::Texture(t) => self.textures[t].scalar(uv()),
        });
        let colour = |c: Colour| match c {
            Colour::Constant(c) => c,
            Colour::Texture(t) => self.textures[t].colour(uv()),
        };
        Some(Scattering { bsdf: surface.between(*bsdf).map(colour), opacity: opacity.clamp(0.0, 1.0), coat })
    }

    /// The reflectance of a side that is Lambertian and nothing else, its colour looked up: what most photons meet, and with a
    /// fraction of what [`Scene::scattering`] costs. `None` for all others.
    #[must_use]
    #[inline(always)]
    pub fn lambertian(&self, surface: &Surface, outward: bool) -> Option<Rgb> {
        match self.lambertian[surface.shape as usize][usize::from(!outward)]? {
            Colour::Constant(c) => Some(c),
            Colour::Texture(t) => Some(self.textures[t].colour(self.texture_coordinate(surface))),
        }
    }

    /// The frame in which the surface's BSDF is stated, around `normal`: along texture coordinates where roughness differs
    /// along them.
    #[must_use]
    #[inline(always)]
    pub fn shading_frame(&self, surface: &Surface, normal: Vec3) -> Frame {
        let frame = Frame::from_normal(normal);
        if !self.census.anisotropy || !self.material(surface.shape).is_anisotropic() {
            return frame;
        }
        let along_u = self.direction_of_u(surface);
        match (along_u - normal * along_u.dot(normal)).try_normalize() {
            Some(tangent) => Frame { tangent, bitangent: normal.cross(tangent), normal },
            None => frame,
        }
    }

    /// Texture coordinate of a point, as Mitsuba 3 lays it on each kind of shape.
    fn texture_coordinate(&self, surface: &Surface) -> Vec2 {
        use std::f32::consts::PI;
        let turn = |a: f32| a - a.floor();
        let to_object = self.shapes[surface.shape as usize].to_object;
        match self.accel.primitives()[surface.primitive as usize] {
            Primitive::Triangle(_) => {
                let [a, b, c] = self.vertex_uvs[surface.primitive as usize];
                let (v, w) = (surface.barycentric.x, surface.barycentric.y);
                a * (1.0 - v - w) + b * v + c * w
            }
            Primitive::Sphere { centre, .. } => {
                let p = (to_object * (surface.position - centre)).normalize_or(Vec3::Z);
                Vec2::new(turn(p.y.atan2(p.x) / (2.0 * PI)), p.z.clamp(-1.0, 1.0).acos() / PI)
            }
            Primitive::Disc { centre, radius, .. } => {
                let p = to_object * (surface.position - centre);
                Vec2::new(p.x.hypot(p.y) / radius, turn(p.y.atan2(p.x) / (2.0 * PI)))
            }
            Primitive::Cylinder { from, axis, .. } => {
                let p = surface.position - from;
                let q = Frame::from_normal(axis.normalize()).to_local(p);
                Vec2::new(turn(q.y.atan2(q.x) / (2.0 * PI)), p.dot(axis) / axis.length_squared())
            }
        }
    }

    /// The direction in which u grows; any length.
    fn direction_of_u(&self, surface: &Surface) -> Vec3 {
        match self.accel.primitives()[surface.primitive as usize] {
            Primitive::Triangle([a, b, c]) => {
                let [ta, tb, tc] =
                    self.vertex_uvs.get(surface.primitive as usize).copied().unwrap_or_default();
                let (e, f, s, t) = (b - a, c - a, tb - ta, tc - ta);
                (e * t.y - f * s.y) * (s.x * t.y - s.y * t.x).signum()
            }
            Primitive::Sphere { centre, .. } | Primitive::Disc { centre, .. } => {
                let to_object = self.shapes[surface.shape as usize].to_object;
                let p = to_object * (surface.position - centre);
                to_object.transpose() * Vec3::new(-p.y, p.x, 0.0)
            }
            Primitive::Cylinder { axis, .. } => axis.cross(surface.normal),
        }
    }

    /// The shape of a primitive, by its index in the tree's order.
    pub(crate) fn shape_of(&self, primitive: usize) -> u32 {
        self.parts[primitive].shape
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

    /// Radiance that a surface emits towards `direction`.
    #[must_use]
    pub fn emitted(&self, surface: &Surface, direction: Vec3) -> Rgb {
        let Some(emitter) = self.shapes[surface.shape as usize].emitter else { return Rgb::BLACK };
        match &self.emitters[emitter as usize].kind {
            Kind::Area(area) if direction.dot(surface.normal) > 0.0 => area.radiance,
            _ => Rgb::BLACK,
        }
    }

    /// The density (sr⁻¹) with which choosing an emitter and a point of it leads from `position` to a point of a lamp; 0 where
    /// the surface emits nothing towards there.
    #[must_use]
    pub fn area_emitter_pdf(&self, surface: &Surface, position: Vec3) -> f32 {
        let Some(emitter) = self.shapes[surface.shape as usize].emitter else { return 0.0 };
        match &self.emitters[emitter as usize].kind {
            Kind::Area(area) => area.density(surface, position) * self.emitter_share(emitter as usize) as f32,
            _ => 0.0,
        }
    }

    /// Radiance that a ray which hits nothing sees along `direction`.
    #[must_use]
    pub fn escaped_radiance(&self, direction: Vec3) -> Rgb {
        if !self.census.environment {
            return Rgb::BLACK;
        }
        self.environments.iter().map(|&i| self.emitters[i as usize].escaped_radiance(direction)).sum()
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

    /// The chance that a photon starts from the emitter of that index.
    #[must_use]
    pub fn emitter_share(&self, index: usize) -> f64 {
        if self.emitter_choice.is_empty() { 0.0 } else { self.emitter_choice.probability(index) }
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
            + self.vertex_normals.len() * size_of::<[Vec3; 3]>()
            + self.vertex_uvs.len() * size_of::<[Vec2; 3]>()
            + self.picture_bytes
    }
}

#[cfg(test)]
#[path = "scene_tests.rs"]
mod tests;
