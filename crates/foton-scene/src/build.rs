//! From a description to a scene: into scene units, into one list of primitives, into a tree.

use std::sync::Arc;

use foton_math::glam::{DAffine3, DMat3, DVec3, Mat3, Vec2, Vec3};
use foton_math::{Aabb, Frame, Rgb};
use thiserror::Error;

use crate::accel::Accel;
use crate::census::Census;
use crate::description::{
    Bsdf, Colour, EmitterDescription, EmitterKind, Geometry, Material, Mesh, SceneDescription,
    SensorDescription, ShapeDescription,
};
use crate::discrete::Discrete;
use crate::emitter::{Area, Ball, Emitter, Kind, Reach, Spot};
use crate::environment::Environment;
use crate::normalise::Normalisation;
use crate::primitive::{Primitive, triangle_normal};
use crate::scene::{Scene, Shape};
use crate::sensor::Sensor;
use crate::texture::Sampler;

/// Share of photons spread evenly over emitters, whatever their power (δ of theory's many lights).
const DEFENSIVE_SHARE: f64 = 0.1;

/// How far a transform's axes may be from equal length and right angles and still keep a sphere round.
const ROUNDNESS: f64 = 1e-4;

/// Why a description makes no scene. Names are those of the scene file.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum BuildError {
    /// There is nothing to look through.
    #[error("the scene has no sensor")]
    NoSensor,
    /// A camera's numbers make no image.
    #[error("sensor \"{0}\": its field of view, size or transform makes no image")]
    BadSensor(String),
    /// A coordinate, or what an emitter emits, is NaN or infinite.
    #[error("\"{0}\" has a coordinate or an emission that is not finite")]
    NotFinite(String),
    /// A transform flattens the shape.
    #[error("shape \"{0}\": its transform cannot be inverted")]
    Singular(String),
    /// A transform makes a sphere or a disc something else.
    #[error("shape \"{0}\": a sphere, a disc or a tube can only be turned, moved and scaled evenly")]
    NotRound(String),
    /// A triangle names a vertex that is not there, or normals do not match positions.
    #[error("shape \"{0}\" has a triangle or normals that do not fit its vertices")]
    BadMesh(String),
    /// A shape names a material that is not there.
    #[error("shape \"{0}\" names a material that is not there")]
    NoMaterial(String),
    /// A material or an environment names a texture that is not there, or one without pixels.
    #[error("\"{0}\" names a texture that is not there or has no pixels")]
    NoTexture(String),
    /// More primitives than indices.
    #[error("the scene has more than 2^31 primitives")]
    TooLarge,
}

/// Vertex normals this close to a triangle's own (within 0.03°) say that it is flat.
const FLAT_COSINE: f32 = 1.0 - 1e-7;

/// Primitives of a scene as they are gathered, before the tree orders them.
#[derive(Default)]
struct Gathered {
    primitives: Vec<Primitive>,
    shape_of: Vec<u32>,
    vertex_normals: Vec<[Vec3; 3]>,
    vertex_uvs: Vec<[Vec2; 3]>,
    census: Census,
}

impl Scene {
    /// Builds the scene that rays meet.
    ///
    /// # Errors
    /// When a shape or sensor of the description makes no sense; see [`BuildError`].
    pub fn build(description: &SceneDescription) -> Result<Self, BuildError> {
        check_sensors(&description.sensors)?;
        check_environments(description)?;
        let (min, max) = world_bounds(description)?;
        let normalisation = Normalisation::for_bounds(min, max);
        let mut gathered = Gathered::default();
        for material in &description.materials {
            check_textures(material, description)?;
            gathered.census.textures |= material.colours().any(|c| matches!(c, Colour::Texture(_)));
            gathered.census.anisotropy |=
                material.bsdfs().filter_map(Bsdf::roughness).any(|r| r.alpha_u != r.alpha_v);
        }
        let mut shapes = Vec::new();
        let mut emitters = Vec::new();
        let mut casters = Aabb::EMPTY;
        for (i, shape) in description.shapes.iter().enumerate() {
            let first = gathered.primitives.len();
            gathered.add(i as u32, shape, &normalisation)?;
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
                let area = area_emitter(i as u32, radiance, &gathered.primitives[first..]);
                emitters.push(Emitter { name: shape.name.clone(), kind: Kind::Area(area) });
                emitters.len() as u32 - 1
            });
            shapes.push(Shape {
                name: shape.name.clone(),
                material: shape.material as u32,
                emitter,
                to_object: orientation(&shape.to_world),
            });
        }
        let bounds = gathered.primitives.iter().fold(Aabb::EMPTY, |b, p| b.union(p.bounds()));
        let bounds = if bounds.is_empty() { Aabb::around(Vec3::ZERO, 1.0) } else { bounds };
        let reach = reach(&bounds, &casters);
        emitters.extend(description.emitters.iter().map(|e| unattached_emitter(e, &normalisation, reach)));
        if let Some(bad) = emitters.iter().find(|e| !e.is_finite()) {
            return Err(BuildError::NotFinite(bad.name.clone()));
        }
        let mut scene = gathered.into_scene(normalisation, bounds);
        scene.shapes = shapes;
        scene.textures = description.textures.iter().map(Sampler::new).collect();
        scene.materials.clone_from(&description.materials);
        scene.max_depth = description.max_depth;
        scene.sensors = description.sensors.iter().map(|s| Sensor::new(s, &normalisation)).collect();
        scene.census.environment = emitters.iter().any(|e| e.is_environment() && !e.power().is_black());
        scene.emitter_choice = emitter_choice(&emitters);
        scene.census.emitters = emitters.iter().filter(|e| !e.power().is_black()).count() as u64;
        scene.emitters = emitters.into();
        Ok(scene)
    }

    /// The same scene seen by other sensors, as [`Scene::build`] would make it: surfaces and emitters are shared.
    ///
    /// # Errors
    /// When a sensor makes no sense; see [`BuildError`].
    pub fn with_sensors(&self, sensors: &[SensorDescription]) -> Result<Self, BuildError> {
        check_sensors(sensors)?;
        let sensors = sensors.iter().map(|s| Sensor::new(s, &self.normalisation)).collect();
        Ok(Self { sensors, ..self.clone() })
    }
}

impl Material {
    fn bsdfs(&self) -> impl Iterator<Item = &Bsdf> {
        [Some(&self.front), self.back.as_ref()].into_iter().flatten()
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
            self.kept_gloss |= bsdf.keeps() && !matches!(bsdf, Bsdf::Diffuse { .. });
        }
    }
}

fn check_environments(description: &SceneDescription) -> Result<(), BuildError> {
    let unsound = |e: &&EmitterDescription| match &e.kind {
        EmitterKind::Environment { bitmap, .. } => !bitmap.is_sound(),
        _ => false,
    };
    description.emitters.iter().find(unsound).map_or(Ok(()), |e| Err(BuildError::NoTexture(e.name.clone())))
}

fn check_textures(material: &Material, description: &SceneDescription) -> Result<(), BuildError> {
    use crate::description::TextureKind::Bitmap;
    for colour in material.colours() {
        let Colour::Texture(index) = colour else { continue };
        let good = match description.textures.get(index).map(|t| &t.kind) {
            Some(Bitmap { bitmap, .. }) => bitmap.is_sound(),
            Some(_) => true,
            None => false,
        };
        if !good {
            return Err(BuildError::NoTexture(material.name.clone()));
        }
    }
    Ok(())
}

/// Scene to object space, turning only.
fn orientation(to_world: &DAffine3) -> Mat3 {
    let m = to_world.matrix3;
    let turn = DMat3::from_cols(m.x_axis.normalize(), m.y_axis.normalize(), m.z_axis.normalize());
    turn.transpose().as_mat3()
}

/// Balls for light from infinity; casters apart only where that saves most of the photons.
fn reach(scene: &Aabb, casters: &Aabb) -> Reach {
    // A margin keeps the start of every path off the outermost surface.
    let ball = |b: &Aabb| Ball { centre: b.centre(), radius: b.radius() * 1.01 };
    let scene_ball = ball(scene);
    let casters = (!casters.is_empty()).then(|| ball(casters)).filter(|c| c.radius < 0.5 * scene_ball.radius);
    Reach { scene: scene_ball, casters }
}

fn check_sensors(sensors: &[SensorDescription]) -> Result<(), BuildError> {
    if sensors.is_empty() {
        return Err(BuildError::NoSensor);
    }
    for s in sensors {
        let determinant = s.to_world.matrix3.determinant();
        let good = s.fov_degrees > 0.0
            && s.fov_degrees < 180.0
            && s.width > 0
            && s.height > 0
            && determinant.is_finite()
            && determinant != 0.0
            && s.to_world.translation.is_finite();
        if !good {
            return Err(BuildError::BadSensor(s.name.clone()));
        }
    }
    Ok(())
}

/// The corners of all surfaces in world units; the origin where there are none.
fn world_bounds(description: &SceneDescription) -> Result<(DVec3, DVec3), BuildError> {
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for shape in &description.shapes {
        let mut finite = true;
        let mut add = |p: DVec3| {
            finite &= p.is_finite();
            min = min.min(p);
            max = max.max(p);
        };
        match &shape.geometry {
            Geometry::Mesh(mesh) => {
                mesh.positions.iter().for_each(|&p| add(shape.to_world.transform_point3(p)));
            }
            Geometry::Sphere { centre, radius } => {
                let c = shape.to_world.transform_point3(*centre);
                let r = radius * shape.to_world.matrix3.x_axis.length();
                add(c - r);
                add(c + r);
            }
            Geometry::Disc => {
                let c = shape.to_world.translation;
                let r = shape.to_world.matrix3.x_axis.length();
                add(c - r);
                add(c + r);
            }
            Geometry::Cylinder { from, to, radius } => {
                let r = radius * shape.to_world.matrix3.x_axis.length();
                for end in [from, to].map(|&p| shape.to_world.transform_point3(p)) {
                    add(end - r);
                    add(end + r);
                }
            }
        }
        if !finite {
            return Err(BuildError::NotFinite(shape.name.clone()));
        }
    }
    if min.cmpgt(max).any() { Ok((DVec3::ZERO, DVec3::ZERO)) } else { Ok((min, max)) }
}

impl Gathered {
    fn add(
        &mut self,
        index: u32,
        shape: &ShapeDescription,
        to_scene: &Normalisation,
    ) -> Result<(), BuildError> {
        match &shape.geometry {
            Geometry::Mesh(mesh) => self.add_mesh(index, shape, mesh, to_scene),
            Geometry::Sphere { centre, radius } => {
                let scale = even_scale(&shape.to_world, &[0, 1, 2], &shape.name)?;
                let centre = to_scene.point(shape.to_world.transform_point3(*centre));
                let radius = to_scene.length(radius * scale);
                if radius > 0.0 {
                    self.census.spheres += 1;
                    self.push(index, Primitive::Sphere { centre, radius, inward: shape.flip_normals }, None);
                }
                Ok(())
            }
            Geometry::Disc => {
                let scale = even_scale(&shape.to_world, &[0, 1], &shape.name)?;
                let m = shape.to_world.matrix3;
                // The inverse transpose takes +z to the cross product of the other axes, whatever the handedness.
                let side = if (m.determinant() < 0.0) == shape.flip_normals { 1.0 } else { -1.0 };
                let normal = (m.x_axis.cross(m.y_axis) * side).normalize().as_vec3();
                let centre = to_scene.point(shape.to_world.translation);
                let radius = to_scene.length(scale);
                if radius > 0.0 && normal.is_finite() {
                    self.census.discs += 1;
                    self.push(index, Primitive::Disc { centre, normal, radius }, None);
                }
                Ok(())
            }
            Geometry::Cylinder { from, to, radius } => {
                let scale = even_scale(&shape.to_world, &[0, 1, 2], &shape.name)?;
                let [from, to] = [from, to].map(|&p| to_scene.point(shape.to_world.transform_point3(p)));
                let radius = to_scene.length(radius * scale);
                if radius > 0.0 && from != to {
                    self.census.tubes += 1;
                    let radius = if shape.flip_normals { -radius } else { radius };
                    self.push(index, Primitive::Tube { from, axis: to - from, radius }, None);
                }
                Ok(())
            }
        }
    }

    fn add_mesh(
        &mut self,
        index: u32,
        shape: &ShapeDescription,
        mesh: &Mesh,
        to_scene: &Normalisation,
    ) -> Result<(), BuildError> {
        let smooth = !mesh.normals.is_empty();
        let textured = self.census.textures || self.census.anisotropy;
        let has_uvs = !mesh.texture_coordinates.is_empty();
        let fits = |n: usize, there: bool| !there || n == mesh.positions.len();
        if !fits(mesh.normals.len(), smooth) || !fits(mesh.texture_coordinates.len(), has_uvs) {
            return Err(BuildError::BadMesh(shape.name.clone()));
        }
        let mirrored = shape.to_world.matrix3.determinant() < 0.0;
        let positions: Vec<Vec3> =
            mesh.positions.iter().map(|&p| to_scene.point(shape.to_world.transform_point3(p))).collect();
        let normals = smooth.then(|| world_normals(shape, mesh)).transpose()?;
        for triangle in &mesh.triangles {
            if triangle.iter().any(|&i| i as usize >= positions.len()) {
                return Err(BuildError::BadMesh(shape.name.clone()));
            }
            let [a, mut b, mut c] = *triangle;
            // A mirroring transform turns the winding around; so does flipping.
            if mirrored != shape.flip_normals {
                (b, c) = (c, b);
            }
            let corners = |[a, b, c]: [u32; 3]| [a, b, c].map(|i| positions[i as usize]);
            let Some(flat) = triangle_normal(corners([a, b, c])) else {
                self.census.degenerate_triangles += 1;
                continue;
            };
            let mut at_vertices = None;
            if let Some(normals) = &normals {
                let [na, nb, nc] = [a, b, c].map(|i| normals[i as usize]);
                if (na + nb + nc).dot(flat) < 0.0 {
                    (b, c) = (c, b);
                }
                let usable = [na, nb, nc].iter().all(|n| *n != Vec3::ZERO);
                let flat = [na, nb, nc].iter().all(|n| n.dot(flat).abs() > FLAT_COSINE);
                at_vertices = (usable && !flat).then(|| [a, b, c].map(|i| normals[i as usize]));
            }
            self.census.triangles += 1;
            self.push(index, Primitive::Triangle(corners([a, b, c])), at_vertices);
            if let Some(uvs) = self.vertex_uvs.last_mut().filter(|_| textured && has_uvs) {
                *uvs = [a, b, c].map(|i| mesh.texture_coordinates[i as usize].as_vec2());
            }
        }
        Ok(())
    }

    fn push(&mut self, shape: u32, primitive: Primitive, normals: Option<[Vec3; 3]>) {
        self.primitives.push(primitive);
        self.shape_of.push(shape);
        self.vertex_normals.push(normals.unwrap_or_default());
        self.vertex_uvs.extend((self.census.textures || self.census.anisotropy).then_some([Vec2::ZERO; 3]));
    }

    fn into_scene(self, normalisation: Normalisation, bounds: Aabb) -> Scene {
        let (accel, order) = Accel::build(&self.primitives);
        let smooth = self.vertex_normals.iter().any(|n| n[0] != Vec3::ZERO);
        let ordered = order.iter().map(|&i| i as usize);
        Scene {
            shape_of: ordered.clone().map(|i| self.shape_of[i]).collect(),
            vertex_uvs: ordered.clone().filter_map(|i| self.vertex_uvs.get(i).copied()).collect(),
            textures: Arc::default(),
            vertex_normals: if smooth {
                ordered.map(|i| self.vertex_normals[i]).collect()
            } else {
                Arc::default()
            },
            accel: Arc::new(accel),
            shapes: Vec::new(),
            materials: Vec::new(),
            emitters: Arc::default(),
            emitter_choice: Discrete::default(),
            sensors: Vec::new(),
            normalisation,
            bounds,
            max_depth: None,
            census: self.census,
        }
    }
}

/// Unit vertex normals in world space; zero where a normal has no direction.
fn world_normals(shape: &ShapeDescription, mesh: &Mesh) -> Result<Vec<Vec3>, BuildError> {
    let inverse = shape.to_world.matrix3.inverse();
    if !inverse.is_finite() {
        return Err(BuildError::Singular(shape.name.clone()));
    }
    let m: DMat3 = inverse.transpose() * if shape.flip_normals { -1.0 } else { 1.0 };
    Ok(mesh.normals.iter().map(|&n| (m * n).normalize_or_zero().as_vec3()).collect())
}

/// The factor by which the transform scales the given axes, if it keeps them of one length and perpendicular.
fn even_scale(to_world: &DAffine3, axes: &[usize], name: &str) -> Result<f64, BuildError> {
    let scale = to_world.matrix3.x_axis.length();
    for (n, &i) in axes.iter().enumerate() {
        let v = to_world.matrix3.col(i);
        let even = (v.length() / scale - 1.0).abs() < ROUNDNESS;
        let square =
            axes[..n].iter().all(|&j| v.dot(to_world.matrix3.col(j)).abs() < ROUNDNESS * scale * scale);
        if !(even && square) {
            return Err(BuildError::NotRound(name.to_owned()));
        }
    }
    Ok(scale)
}

fn area_emitter(shape: u32, radiance: Rgb, primitives: &[Primitive]) -> Area {
    let areas = || primitives.iter().map(Primitive::area);
    Area {
        radiance,
        primitives: primitives.to_vec(),
        by_area: Discrete::new(areas().map(f64::from)),
        area: areas().sum(),
        shape,
    }
}

fn unattached_emitter(description: &EmitterDescription, to_scene: &Normalisation, reach: Reach) -> Emitter {
    // Irradiance is intensity over squared distance, so intensity grows with the square of the scale.
    let scale2 = (to_scene.scale() * to_scene.scale()) as f32;
    let kind = match &description.kind {
        EmitterKind::Point { position, intensity } => {
            Kind::Point { position: to_scene.point(*position), intensity: *intensity * scale2 }
        }
        EmitterKind::Spot { to_world, intensity, cutoff_degrees, beam_degrees } => {
            let axis = to_world.matrix3.z_axis.normalize().as_vec3();
            Kind::Spot(Spot {
                position: to_scene.point(to_world.translation),
                frame: Frame::from_normal(axis),
                intensity: *intensity * scale2,
                cutoff: cutoff_degrees.to_radians() as f32,
                beam: beam_degrees.min(*cutoff_degrees).to_radians() as f32,
            })
        }
        EmitterKind::Constant { radiance } => Kind::Constant { radiance: *radiance, reach },
        EmitterKind::Directional { direction, irradiance } => Kind::Directional {
            direction: direction.normalize_or(DVec3::NEG_Z).as_vec3(),
            irradiance: *irradiance,
            reach,
        },
        EmitterKind::Environment { to_world, bitmap, scale } => {
            let to_world = orientation(to_world).transpose();
            Kind::Environment { map: Box::new(Environment::new(bitmap.clone(), *scale, to_world)), reach }
        }
    };
    Emitter { name: description.name.clone(), kind }
}

/// p = (1 − δ) Φ/ΣΦ + δ/n over those that emit at all.
fn emitter_choice(emitters: &[Emitter]) -> Discrete {
    let power = |e: &Emitter| f64::from(e.power().mean());
    let total: f64 = emitters.iter().map(power).sum();
    let count = emitters.iter().filter(|e| power(e) > 0.0).count() as f64;
    Discrete::new(
        emitters.iter().map(power).map(|p| {
            if p > 0.0 { (1.0 - DEFENSIVE_SHARE) * p / total + DEFENSIVE_SHARE / count } else { 0.0 }
        }),
    )
}
