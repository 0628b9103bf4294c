//! From a description to a scene: into scene units, into one list of primitives, into a tree.

mod checks;
mod emitters;
mod error;
mod extent;
mod gather;
mod gauge;
mod instances;
mod materials;
mod memory;
mod orientation;
mod patches;
mod textures;

use std::sync::Arc;

use foton_math::glam::{DVec3, Vec3};
use foton_math::{Aabb, Rgb};

use crate::accel::Instance;
use crate::coincident::Coincidences;
use crate::description::{Colour, Material, SceneDescription, SensorDescription, ShapeDescription};
use crate::emitter::{Aim, Area, Emitter, Kind};
use crate::normalise::Normalisation;
use crate::primitive::Primitive;
use crate::scene::{Mixtures, Moving, Part, Placing, Scene, Shape};
use crate::sensor::Sensor;
use crate::texture::{Sampler, samplers};
use checks::{
    check_described_emitters, check_emitters, check_material, check_radiance, check_sensors, shape_bounds,
    world_bounds,
};
use emitters::{ball, emitter_choice, unattached_emitter};
pub use error::BuildError;
use gather::Gathered;
pub(crate) use gauge::Gauge;
pub use gauge::{BuildOptions, BuildStep, Instancing, Tell};
use instances::{Instances, Known};
use orientation::orientation;
use patches::Patches;
pub(crate) use patches::{Patch, PlacedPatches};
use textures::{Textures, check_attributes};

impl Scene {
    /// Builds the scene that rays meet.
    ///
    /// # Errors
    /// When a shape or sensor of the description makes no sense; see [`BuildError`].
    pub fn build(description: &SceneDescription) -> Result<Self, BuildError> {
        Self::build_with(description, &BuildOptions::default())
    }

    /// Builds the scene as the options say.
    ///
    /// # Errors
    /// As [`Scene::build`], and when cancelled.
    pub fn build_with(
        description: &SceneDescription,
        options: &BuildOptions<'_>,
    ) -> Result<Self, BuildError> {
        Self::build_knowing(description, &Known::default(), options)
    }

    /// The scene of a description that was edited since this one was built, as [`Scene::build_with`] makes it. Trees over meshes that
    /// several shapes share are not built again.
    ///
    /// # Errors
    /// As [`Scene::build_with`].
    pub fn rebuild(
        &self,
        description: &SceneDescription,
        options: &BuildOptions<'_>,
    ) -> Result<Self, BuildError> {
        Self::build_knowing(description, &Known::of(self), options)
    }

    fn build_knowing(
        description: &SceneDescription,
        known: &Known<'_>,
        options: &BuildOptions<'_>,
    ) -> Result<Self, BuildError> {
        if description.motion.is_still() {
            return Self::build_still(description, world_bounds(description, known)?, known, options);
        }
        let mut bounds = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for time in description.motion.times() {
            let (min, max) = world_bounds(&description.at(time), known)?;
            bounds = (bounds.0.min(min), bounds.1.max(max));
        }
        // Whoever does not ask for another time sees what the first camera's shutter sees first.
        let [open, _] = description.motion.shutter(0);
        let scene = Self::build_still(&description.at(open), bounds, known, options)?;
        let moving = Moving { description: description.clone(), bounds };
        Ok(Self { moving: Some(Arc::new(moving)), ..scene })
    }

    /// The scene of a description in which nothing moves, with the scene units of this one, of which something does.
    pub(crate) fn build_at_another_time(
        &self,
        description: &SceneDescription,
        bounds: (DVec3, DVec3),
        options: &BuildOptions<'_>,
    ) -> Result<Self, BuildError> {
        Self::build_still(description, bounds, &Known::of(self), options)
    }

    /// The same of a description in which nothing moves; all that ever is lies between `min` and `max`.
    fn build_still(
        description: &SceneDescription,
        (min, max): (DVec3, DVec3),
        known: &Known<'_>,
        options: &BuildOptions<'_>,
    ) -> Result<Self, BuildError> {
        options.cancel.check()?;
        let normalisation = Normalisation::for_bounds(min, max);
        check_sensors(&description.sensors, &normalisation)?;
        let mixtures = Mixtures::new(&description.materials)?;
        let mut instances = Instances::new(description, &normalisation, known, options)?;
        let gauge = options.step(BuildStep::Shapes, description.primitives());
        let mut gathered = Gathered::new(options.forced.clone(), &description.textures);
        check_surfaces(description, &mut gathered)?;
        let (shapes, emitters) = (Vec::new(), Vec::new());
        // Attributes of meshes come later: nothing here asks for their values.
        let samplers_so_far = samplers(&description.textures, &vec![None; description.textures.len()]);
        let of = (&mixtures, &*samplers_so_far);
        let mut parts = Parts { gathered, of, shapes, emitters, casters: Aabb::EMPTY, instances: Vec::new() };
        for (i, shape) in description.shapes.iter().enumerate() {
            let instance = instances.take(i);
            parts.add((i as u32, shape), instance, description, &normalisation, &gauge)?;
        }
        let Parts { mut gathered, shapes, mut emitters, casters, instances, .. } = parts;
        let boxes =
            gathered.primitives.iter().map(Primitive::bounds).chain(instances.iter().map(|i| i.bounds));
        let bounds = boxes.fold(Aabb::EMPTY, Aabb::union);
        let bounds = if bounds.is_empty() { Aabb::around(Vec3::ZERO, 1.0) } else { bounds };
        let attributes = gathered.attributes();
        let samplers = samplers(&description.textures, &attributes);
        let patterned = gathered.add_patterns(&mut emitters, description, &samplers);
        let scene_ball = ball(&bounds);
        let casters =
            (!casters.is_empty()).then(|| ball(&casters)).filter(|c| c.radius < 0.5 * scene_ball.radius);
        let at = (scene_ball, casters);
        let surfaces = emitters.len();
        emitters.extend(
            description.emitters.iter().map(|e| unattached_emitter(e, &normalisation, &samplers, at)),
        );
        check_emitters(&emitters, description, &normalisation)?;
        let mut index = 0..;
        let is_hidden = |i: usize| i >= surfaces && description.hidden.emitters.contains(&(i - surfaces));
        emitters.retain(|_| !index.next().is_some_and(is_hidden));
        let mut scene = gathered.into_scene(instances, normalisation, bounds, options)?;
        scene.shapes = shapes;
        if attributes.iter().all(Option::is_none) && !patterned {
            scene.order = Arc::default();
        }
        scene.textures = samplers;
        scene.materials.clone_from(&description.materials);
        scene.mixtures = mixtures;
        scene.max_depth = description.max_depth;
        let attribute_bytes: usize = attributes.iter().flatten().map(|a| a.bytes()).sum();
        scene.picture_bytes = description.picture_bytes() + attribute_bytes;
        scene.sensors = description.sensors.iter().map(|s| Sensor::new(s, &normalisation)).collect();
        scene.casters = casters;
        scene.settle_surfaces(&mut emitters, options)?;
        scene.enter_emitters(emitters);
        Ok(scene)
    }

    /// What surfaces are by each other: their patches, and where they lie in one another.
    fn settle_surfaces(
        &mut self,
        emitters: &mut [Emitter],
        options: &BuildOptions<'_>,
    ) -> Result<(), BuildError> {
        if self.census.rough_coats {
            self.coats = self.materials.iter().map(|m| m.coats(&self.textures)).collect();
        }
        self.lambertian =
            self.shapes.iter().map(|s| self.materials[s.material as usize].lambertian()).collect();
        let spreads: Vec<bool> =
            self.shapes.iter().map(|s| self.materials_of(s).any(Material::spreads)).collect();
        let stores = |i: u32| match (self.parts.get(i as usize), self.accel.placed(i)) {
            (Some(part), _) => spreads[part.shape as usize],
            (None, placed) => placed.is_some_and(|(i, _)| spreads[self.accel.instances()[i].shape as usize]),
        };
        let Patches { own: patches, placed, .. } = patches::find(&self.accel, stores, options)?;
        let coincidences = Coincidences::find(self, options)?;
        for (i, (part, patch)) in Arc::make_mut(&mut self.parts).iter_mut().zip(patches).enumerate() {
            *part = Part { patch, coincides: coincidences.share(i).any, ..*part };
        }
        let placing = |(i, patches)| Placing { patches, coincides: coincidences.has_instance(i) };
        self.placings = placed.into_iter().enumerate().map(placing).collect();
        self.coincidences = Arc::new(coincidences);
        for emitter in emitters {
            if let Kind::Area(area) = &mut emitter.kind {
                area.gap = self.coincidences.gap(area.shape as usize);
                area.pattern.iter_mut().for_each(|pattern| pattern.set_order(&self.order));
            }
        }
        Ok(())
    }

    /// Enters all emitters, and how photons are shared among them.
    fn enter_emitters(&mut self, emitters: Vec<Emitter>) {
        let which = |is_it: &dyn Fn(&Emitter) -> bool| {
            (0u32..).zip(&emitters).filter(|(_, e)| is_it(e)).map(|(i, _)| i).collect()
        };
        self.delta_emitters = which(&Emitter::is_delta);
        self.environments = which(&|e| e.is_environment() && !e.power().is_black());
        self.census.delta_emitters |= !self.delta_emitters.is_empty();
        self.census.area_emitters |= emitters.iter().any(Emitter::is_area);
        self.census.environment |= !self.environments.is_empty();
        self.census.emitters = emitters.iter().filter(|e| !e.power().is_black()).count() as u64;
        self.emitter_choice = emitter_choice(&emitters);
        self.emitters = emitters.into();
    }

    /// The same scene seen by other sensors, as [`Scene::build`] would make it: surfaces and emitters are shared.
    ///
    /// # Errors
    /// When a sensor makes no sense; see [`BuildError`].
    pub fn with_sensors(&self, sensors: &[SensorDescription]) -> Result<Self, BuildError> {
        check_sensors(sensors, &self.normalisation)?;
        let moving = self.moving_with(sensors);
        let sensors = sensors.iter().map(|s| Sensor::new(s, &self.normalisation)).collect();
        Ok(Self { sensors, moving, ..self.clone() })
    }
}

/// Where a shape is of which no primitive is left: all of its points may be one in scene units.
fn place_of(shape: &ShapeDescription, to_scene: &Normalisation) -> Aabb {
    let (min, max) = shape_bounds(shape);
    if min.cmpgt(max).any() {
        Aabb::EMPTY
    } else {
        Aabb::EMPTY.with(to_scene.point(min)).with(to_scene.point(max))
    }
}

/// Whether materials and lamps are such as surfaces can have; notes what they ask for.
fn check_surfaces(description: &SceneDescription, gathered: &mut Gathered) -> Result<(), BuildError> {
    let textures = Textures::check(&description.textures)?;
    for material in &description.materials {
        check_material(material, &textures)?;
        gathered.census.textures |= material.textures().next().is_some();
        gathered.census.anisotropy |= material.is_anisotropic();
    }
    for shape in &description.shapes {
        gathered.census.textures |= check_radiance(shape, &textures)?;
    }
    check_described_emitters(description, &textures)?;
    Ok(())
}

/// How many steps between neighbouring single-precision coordinates a box is across, along its longest side; infinite for
/// nothing.
fn steps_across(extent: &Aabb) -> f32 {
    let farthest = extent.min.abs().max(extent.max.abs()).max_element();
    if extent.is_empty() || farthest == 0.0 {
        return f32::INFINITY;
    }
    let step = f32::EPSILON * farthest.log2().floor().exp2();
    extent.size().max_element() / step
}

/// What shapes bring to a scene.
struct Parts<'a> {
    gathered: Gathered,
    /// What materials are blended of, and textures.
    of: (&'a Mixtures, &'a [Arc<Sampler>]),
    shapes: Vec<Shape>,
    emitters: Vec<Emitter>,
    /// A box around what throws caustics.
    casters: Aabb,
    /// Meshes that several shapes share.
    instances: Vec<Instance>,
}

impl Parts<'_> {
    fn add(
        &mut self,
        (index, shape): (u32, &ShapeDescription),
        instance: Option<Instance>,
        description: &SceneDescription,
        normalisation: &Normalisation,
        gauge: &Gauge<'_>,
    ) -> Result<(), BuildError> {
        let Self { gathered, of: (mixtures, textures), shapes, emitters, casters, instances } = self;
        let first = gathered.primitives.len();
        let is_hidden = description.hidden.shapes.contains(&(index as usize));
        if shape.material >= description.materials.len() {
            return Err(BuildError::NoMaterial(shape.name.clone()));
        }
        let mut materials = mixtures.materials(shape.material).map(|i| &description.materials[i]);
        if !is_hidden {
            match &instance {
                Some(instance) => gathered.add_instance(index, shape, instance)?,
                None => gathered.add(index, shape, normalisation, gauge)?,
            }
            let radiance =
                if let Some(Colour::Texture(texture)) = shape.radiance { Some(texture) } else { None };
            let mut textures = materials.clone().flat_map(Material::textures).chain(radiance);
            textures.try_for_each(|texture| check_attributes(texture, shape, description))?;
        }
        gauge.add(gathered.primitives.len() - first)?;
        gathered.check_count()?;
        let is_smooth = instance.as_ref().map(|instance| !instance.tree.mesh.normals.is_empty());
        let smooth = is_smooth.unwrap_or_else(|| gathered.is_smooth_from(first));
        if !is_hidden {
            materials.clone().for_each(|material| gathered.census.count(material, textures, smooth));
        }
        let primitives = &gathered.primitives[first..];
        let around = |b: Aabb| primitives.iter().map(Primitive::bounds).fold(b, Aabb::union);
        let extent = instance.as_ref().map_or_else(|| around(Aabb::EMPTY), |instance| instance.bounds);
        if materials.any(|material| material.casts(textures)) {
            *casters = casters.union(extent);
        }
        let shines = |radiance: &Colour| *radiance != Colour::Constant(Rgb::BLACK) && !is_hidden;
        let emitter = shape.radiance.filter(shines).map(|radiance| {
            let radiance = if let Colour::Constant(c) = radiance { c } else { Rgb::BLACK };
            let kind = Kind::Area(Area::new(index, radiance, primitives));
            emitters.push(Emitter { name: shape.name.clone(), kind, aim: Aim::default() });
            emitters.len() as u32 - 1
        });
        instances.extend(instance);
        shapes.push(Shape {
            name: shape.name.clone(),
            steps_across: steps_across(&extent),
            extent: if extent.is_empty() { place_of(shape, normalisation) } else { extent },
            material: shape.material as u32,
            emitter,
            to_object: orientation(&shape.to_world),
        });
        Ok(())
    }
}
