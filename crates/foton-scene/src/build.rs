//! From a description to a scene: into scene units, into one list of primitives, into a tree.

mod checks;
mod emitters;
mod gather;
mod gauge;
mod memory;
mod patches;

use std::sync::Arc;

use foton_input::quoted;
use foton_math::glam::{DAffine3, DMat3, Mat3, Vec3};
use foton_math::{Aabb, Cancelled};
use thiserror::Error;

use crate::bsdf::Coat;
use crate::census::Census;
use crate::coincident::Coincidences;
use crate::description::{Bsdf, Colour, Material, SceneDescription, SensorDescription, ShapeDescription};
use crate::emitter::{Aim, Area, Emitter, Kind};
use crate::normalise::Normalisation;
use crate::scene::{Part, Scene, Shape};
use crate::sensor::Sensor;
use crate::texture::Sampler;
use checks::{
    check_described_emitters, check_emitters, check_material, check_sensors, check_textures, shape_bounds,
    world_bounds,
};
use emitters::{ball, emitter_choice, unattached_emitter};
use gather::Gathered;
pub(crate) use gauge::Gauge;
pub use gauge::{BuildOptions, BuildStep, Tell};
pub(crate) use patches::Patch;

/// Why a description makes no scene. Names are those of the scene file.
#[derive(Debug, Error, PartialEq)]
pub enum BuildError {
    /// There is nothing to look through.
    #[error("the scene has no sensor")]
    NoSensor,
    /// A camera's numbers make no image.
    #[error("sensor {}: its field of view, size or transform makes no image", quoted(.0))]
    BadSensor(String),
    /// A coordinate, or what an emitter emits, is NaN or infinite.
    #[error("{} has a coordinate or an emission that is not finite", quoted(.0))]
    NotFinite(String),
    /// Light whose power, or that of its photons, single precision does not hold.
    #[error(
        "{} emits more than single precision holds: of its {emission:.1e}, this scene can take up to about {most:.0e}. \
         Divide the emission of all lights by one number: the image is darker by that, and otherwise the same",
        quoted(name)
    )]
    TooBright {
        /// The emitter.
        name: String,
        /// The largest component of what it emits, in the unit of the file.
        emission: f64,
        /// What it may emit.
        most: f64,
    },
    /// Light so weak in so large a scene that single precision does not hold it.
    #[error(
        "{} emits less than single precision holds in so large a scene: of its {emission:.1e}, at least {least:.0e} \
         is needed. Multiply the emission of all lights by one number, or give the scene in a larger unit",
        quoted(name)
    )]
    TooDim {
        /// The emitter.
        name: String,
        /// The largest component of what it emits, in the unit of the file.
        emission: f64,
        /// What it must emit.
        least: f64,
    },
    /// A light or camera whose distance single precision does not hold.
    #[error(
        "{} is {times:.0e} times as far away as the scene is large, and single precision holds no such distance: bring it \
         nearer. For light from far away there is the \"directional\" emitter",
        quoted(name)
    )]
    TooFar {
        /// The emitter or sensor.
        name: String,
        /// Its distance in half-sizes of the scene.
        times: f64,
    },
    /// A transform flattens the shape.
    #[error("shape {}: its transform cannot be inverted", quoted(.0))]
    Singular(String),
    /// A transform makes a sphere, a disc or the cone of a spot something else.
    #[error("{}: a sphere, a disc, a tube or a spot can only be turned, moved and scaled evenly", quoted(.0))]
    NotRound(String),
    /// A triangle names a vertex that is not there, or normals do not match positions.
    #[error("shape {} has a triangle or normals that do not fit its vertices", quoted(.0))]
    BadMesh(String),
    /// A shape names a material that is not there.
    #[error("shape {} names a material that is not there", quoted(.0))]
    NoMaterial(String),
    /// A material or an environment names a texture that is not there, or one without pixels.
    #[error("{} names a texture that is not there or has no pixels", quoted(.0))]
    NoTexture(String),
    /// A colour of a texture is no share of light, or its transform is not finite.
    #[error(
        "texture {} has colours that are not numbers from 0 to 1, or a transform that is not finite", quoted(.0))]
    BadTexture(String),
    /// A material's number is one that no surface has.
    #[error(
        "material {} has a share of light that is not a number from 0 to 1, or an index of refraction or a roughness that \
         is not a number above zero", quoted(.0))]
    BadMaterial(String),
    /// More primitives than indices.
    #[error("the scene has more than 2^31 primitives")]
    TooLarge,
    /// Someone asked to stop: nothing is wrong with the description.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl BuildError {
    /// The part of the scene that it is about, by its name.
    #[must_use]
    pub fn part(&self) -> Option<&str> {
        match self {
            Self::NoSensor | Self::TooLarge | Self::Cancelled(_) => None,
            Self::BadSensor(name)
            | Self::NotFinite(name)
            | Self::TooBright { name, .. }
            | Self::TooDim { name, .. }
            | Self::TooFar { name, .. }
            | Self::Singular(name)
            | Self::NotRound(name)
            | Self::BadMesh(name)
            | Self::NoMaterial(name)
            | Self::NoTexture(name)
            | Self::BadTexture(name)
            | Self::BadMaterial(name) => Some(name),
        }
    }
}

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
        options.cancel.check()?;
        check_described_emitters(description)?;
        check_textures(description)?;
        let (min, max) = world_bounds(description)?;
        let normalisation = Normalisation::for_bounds(min, max);
        check_sensors(&description.sensors, &normalisation)?;
        let gauge = options.step(BuildStep::Shapes, description.primitives());
        let mut gathered = Gathered::new(options.forced);
        for material in &description.materials {
            check_material(material, description)?;
            gathered.census.textures |= material.colours().any(|c| matches!(c, Colour::Texture(_)));
            gathered.census.anisotropy |= material.is_anisotropic();
        }
        let mut shapes = Vec::new();
        let mut emitters = Vec::new();
        let mut casters = Aabb::EMPTY;
        for (i, shape) in description.shapes.iter().enumerate() {
            let first = gathered.primitives.len();
            gathered.add(i as u32, shape, &normalisation, &gauge)?;
            gauge.add(gathered.primitives.len() - first)?;
            if gathered.primitives.len() > i32::MAX as usize {
                return Err(BuildError::TooLarge);
            }
            let material = description.materials.get(shape.material);
            let material = material.ok_or_else(|| BuildError::NoMaterial(shape.name.clone()))?;
            let smooth = gathered.vertex_normals[first..].iter().any(|n| n[0] != Vec3::ZERO);
            gathered.census.count(material, smooth);
            if material.bsdfs().any(Bsdf::follows) {
                casters = gathered.primitives[first..].iter().fold(casters, |b, p| b.union(p.bounds()));
            }
            let emitter = shape.radiance.filter(|r| !r.is_black()).map(|radiance| {
                let area = Area::new(i as u32, radiance, &gathered.primitives[first..]);
                emitters.push(Emitter {
                    name: shape.name.clone(),
                    kind: Kind::Area(area),
                    aim: Aim::default(),
                });
                emitters.len() as u32 - 1
            });
            let extent = gathered.primitives[first..].iter().fold(Aabb::EMPTY, |b, p| b.union(p.bounds()));
            shapes.push(Shape {
                name: shape.name.clone(),
                steps_across: steps_across(&extent),
                extent: if extent.is_empty() { place_of(shape, &normalisation) } else { extent },
                material: shape.material as u32,
                emitter,
                to_object: orientation(&shape.to_world),
            });
        }
        let bounds = gathered.primitives.iter().fold(Aabb::EMPTY, |b, p| b.union(p.bounds()));
        let bounds = if bounds.is_empty() { Aabb::around(Vec3::ZERO, 1.0) } else { bounds };
        let scene_ball = ball(&bounds);
        let casters =
            (!casters.is_empty()).then(|| ball(&casters)).filter(|c| c.radius < 0.5 * scene_ball.radius);
        let at = (scene_ball, casters);
        emitters.extend(description.emitters.iter().map(|e| unattached_emitter(e, &normalisation, at)));
        check_emitters(&emitters, description, &normalisation)?;
        let mut scene = gathered.into_scene(normalisation, bounds, options)?;
        scene.shapes = shapes;
        scene.textures = description.textures.iter().map(Sampler::new).collect();
        scene.materials.clone_from(&description.materials);
        if scene.census.rough_coats {
            scene.coats = scene.materials.iter().map(Material::coats).collect();
        }
        scene.lambertian =
            scene.shapes.iter().map(|s| scene.materials[s.material as usize].lambertian()).collect();
        let keeps: Vec<bool> = scene
            .shapes
            .iter()
            .map(|s| scene.material_of(s).bsdfs().any(|b| b.keeps() || b.roughness().is_some()))
            .collect();
        let patches = patches::find(&scene.accel, |i| keeps[scene.shape_of(i) as usize], options)?;
        let coincidences = Coincidences::find(&scene, options)?;
        for (i, (part, patch)) in Arc::make_mut(&mut scene.parts).iter_mut().zip(patches).enumerate() {
            *part = Part { patch, coincides: coincidences.share(i as u32).any, ..*part };
        }
        scene.coincidences = Arc::new(coincidences);
        for emitter in &mut emitters {
            if let Kind::Area(area) = &mut emitter.kind {
                area.gap = scene.coincidences.gap(area.shape as usize);
            }
        }
        scene.max_depth = description.max_depth;
        scene.picture_bytes = description.picture_bytes();
        scene.sensors = description.sensors.iter().map(|s| Sensor::new(s, &normalisation)).collect();
        let which = |is_it: &dyn Fn(&Emitter) -> bool| {
            (0u32..).zip(&emitters).filter(|(_, e)| is_it(e)).map(|(i, _)| i).collect()
        };
        scene.without_extent = which(&Emitter::is_without_extent);
        scene.environments = which(&|e| e.is_environment() && !e.power().is_black());
        scene.census.lights_without_extent |= !scene.without_extent.is_empty();
        scene.census.lamps |= emitters.iter().any(Emitter::is_lamp);
        scene.census.environment |= !scene.environments.is_empty();
        scene.emitter_choice = emitter_choice(&emitters);
        scene.census.emitters = emitters.iter().filter(|e| !e.power().is_black()).count() as u64;
        scene.casters = casters;
        scene.emitters = emitters.into();
        Ok(scene)
    }

    /// The same scene seen by other sensors, as [`Scene::build`] would make it: surfaces and emitters are shared.
    ///
    /// # Errors
    /// When a sensor makes no sense; see [`BuildError`].
    pub fn with_sensors(&self, sensors: &[SensorDescription]) -> Result<Self, BuildError> {
        check_sensors(sensors, &self.normalisation)?;
        let sensors = sensors.iter().map(|s| Sensor::new(s, &self.normalisation)).collect();
        Ok(Self { sensors, ..self.clone() })
    }
}

impl Material {
    fn bsdfs(&self) -> impl Iterator<Item = &Bsdf> {
        [Some(&self.front), self.back.as_ref()].into_iter().flatten()
    }

    /// Whether its roughness differs along u and v.
    pub(crate) fn is_anisotropic(&self) -> bool {
        self.bsdfs().filter_map(Bsdf::roughness).any(|r| r.alpha_u != r.alpha_v)
    }

    /// The colours of its sides where they are Lambertian and nothing else.
    fn lambertian(&self) -> [Option<Colour>; 2] {
        let colour = |bsdf: Option<&Bsdf>| match bsdf {
            Some(Bsdf::Diffuse { reflectance }) if self.opacity.is_none() => Some(*reflectance),
            _ => None,
        };
        let back = if self.front.transmits() { Some(&self.front) } else { self.back.as_ref() };
        [colour(Some(&self.front)), colour(back)]
    }

    /// The rough coats of its sides.
    fn coats(&self) -> [Option<Coat>; 2] {
        let front = Coat::of(&self.front);
        let same = self.back == Some(self.front);
        [front, if same { front } else { self.back.as_ref().and_then(Coat::of) }]
    }

    /// All colours that it looks up.
    fn colours(&self) -> impl Iterator<Item = Colour> {
        let mut colours: Vec<Colour> = self.opacity.into_iter().collect();
        for bsdf in self.bsdfs() {
            let _ = bsdf.map(|c| colours.push(c));
        }
        colours.into_iter()
    }
}

impl Census {
    /// Notes what a material with or without interpolated normals asks for.
    fn count(&mut self, material: &Material, smooth: bool) {
        for bsdf in material.bsdfs() {
            self.shading_normals |= bsdf.keeps() && smooth;
            self.followed |= bsdf.follows() || material.opacity.is_some();
            self.refraction |= bsdf.transmits();
            self.narrow_gloss |= bsdf.follows() && bsdf.roughness().is_some();
            self.single_directions |=
                bsdf.follows() && bsdf.roughness().is_none() && !matches!(bsdf, Bsdf::Null);
            self.straight |=
                material.opacity.is_some() || matches!(bsdf, Bsdf::Null | Bsdf::ThinDielectric { .. });
            self.rough_coats |= matches!(bsdf, Bsdf::Plastic { roughness: Some(_), .. });
            self.kept_gloss |= bsdf.keeps() && !matches!(bsdf, Bsdf::Diffuse { .. });
        }
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

/// Scene to object space, turning only.
fn orientation(to_world: &DAffine3) -> Mat3 {
    let m = to_world.matrix3;
    let turn = DMat3::from_cols(m.x_axis.normalize(), m.y_axis.normalize(), m.z_axis.normalize());
    turn.transpose().as_mat3()
}
