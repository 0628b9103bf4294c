//! Shapes to one list of primitives in scene units.

use std::collections::HashMap;
use std::sync::Arc;

use foton_math::glam::{DAffine3, Vec2, Vec3};
use foton_math::{Aabb, Cancelled};

use super::error::BuildError;
use super::gauge::{BuildOptions, Gauge};
use super::orientation::orientation;
use crate::accel::{Accel, Instance};
use crate::attributes::Attributes;
use crate::census::Census;
use crate::description::{
    Attribute, Colour, Geometry, Mesh, SceneDescription, ShapeDescription, Texture, TextureKind,
};
use crate::discrete::Discrete;
use crate::emitter::{Emitter, Kind, Pattern};
use crate::normalise::Normalisation;
use crate::placement::{Placed, Placement};
use crate::primitive::Primitive;
use crate::scene::{Mixtures, Part, Scene};
use crate::texture::Sampler;

/// How far a transform's axes may be from equal length and right angles and still keep a sphere round.
const ROUNDNESS: f64 = 1e-4;

/// Primitives of a scene as they are gathered, before the tree orders them.
#[derive(Default)]
pub(super) struct Gathered {
    pub(super) primitives: Vec<Primitive>,
    shape_of: Vec<u32>,
    vertex_normals: Vec<[Vec3; 3]>,
    vertex_uvs: Vec<[Vec2; 3]>,
    pub(super) census: Census,
    /// By texture, the attribute of meshes that it shows.
    attributes: Vec<Option<(String, Attributes)>>,
    /// Primitives of instances.
    placed: usize,
    /// What triangles of meshes that shapes share take of an attribute at their corners, by mesh and name.
    shared_corners: HashMap<(usize, String), Arc<[[u32; 3]]>>,
}

impl Gathered {
    /// Nothing yet, but what `census` says is to be modelled.
    pub(super) fn new(census: Census, textures: &[Texture]) -> Self {
        let attribute = |texture: &Texture| match &texture.kind {
            TextureKind::Attribute { name, .. } => Some((name.clone(), Attributes::default())),
            _ => None,
        };
        Self { census, attributes: textures.iter().map(attribute).collect(), ..Self::default() }
    }

    /// The attributes of meshes that textures show.
    pub(super) fn attributes(&mut self) -> Vec<Option<Arc<Attributes>>> {
        std::mem::take(&mut self.attributes)
            .into_iter()
            .map(|a| a.map(|(_, values)| Arc::new(values)))
            .collect()
    }

    /// Keeps the attributes of a mesh that textures show. `corners` are the vertices of its triangles in the scene, with their number
    /// in the mesh.
    fn keep_attributes(&mut self, shape: u32, mesh: &Mesh, corners: &[([u32; 3], u32)]) {
        let first = (self.primitives.len() - corners.len()) as u32;
        for (name, kept) in self.attributes.iter_mut().flatten() {
            if let Some(attribute) = mesh.attributes.iter().find(|a| a.name == *name) {
                let corner = |&(vertices, face)| if attribute.is_of_faces() { [face; 3] } else { vertices };
                kept.add(shape, first, attribute, corners.iter().map(corner).collect());
            }
        }
    }

    pub(super) fn add(
        &mut self,
        index: u32,
        shape: &ShapeDescription,
        to_scene: &Normalisation,
        gauge: &Gauge<'_>,
    ) -> Result<(), BuildError> {
        match &shape.geometry {
            Geometry::Mesh(mesh) => self.add_mesh(index, shape, mesh, to_scene, gauge),
            Geometry::Sphere { centre, radius } => {
                let scale = even_scale(&shape.to_world, &[0, 1, 2], ROUNDNESS, &shape.name)?;
                let centre = to_scene.point(shape.to_world.transform_point3(*centre));
                let radius = to_scene.length(radius * scale);
                if radius > 0.0 {
                    self.census.spheres += 1;
                    self.push(index, Primitive::Sphere { centre, radius, inward: shape.flip_normals }, None);
                }
                Ok(())
            }
            Geometry::Disc => {
                let scale = even_scale(&shape.to_world, &[0, 1], ROUNDNESS, &shape.name)?;
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
                let scale = even_scale(&shape.to_world, &[0, 1, 2], ROUNDNESS, &shape.name)?;
                let [from, to] = [from, to].map(|&p| to_scene.point(shape.to_world.transform_point3(p)));
                let radius = to_scene.length(radius * scale);
                if radius > 0.0 && from != to {
                    self.census.cylinders += 1;
                    let radius = if shape.flip_normals { -radius } else { radius };
                    self.push(index, Primitive::Cylinder { from, axis: to - from, radius }, None);
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
        gauge: &Gauge<'_>,
    ) -> Result<(), BuildError> {
        let smooth = !mesh.normals.is_empty();
        let textured = self.census.textures || self.census.anisotropy;
        let has_uvs = !mesh.texture_coordinates.is_empty();
        check_mesh(shape, mesh)?;
        let placement = Placement::new(shape, to_scene);
        if smooth && !placement.can_be_inverted() {
            return Err(BuildError::Singular(shape.name.clone()));
        }
        let positions: Vec<Vec3> = mesh.positions.iter().map(|&p| placement.point(p)).collect();
        let normals: Vec<Vec3> = mesh.normals.iter().map(|&n| placement.normal(n)).collect();
        let mut corners_kept = Vec::new();
        for (i, &vertices) in mesh.triangles.iter().enumerate() {
            gauge.check_at(i)?;
            let normal = smooth.then_some(|i: u32| normals[i as usize]);
            let placed = placement.oriented(vertices, |i| positions[i as usize], normal);
            let Some(Placed { vertices, corners, normals }) = placed.filter(|_| mesh.has_area(vertices))
            else {
                self.census.degenerate_triangles += 1;
                continue;
            };
            self.census.triangles += 1;
            self.push(index, Primitive::Triangle(corners), normals);
            if let Some(uvs) = self.vertex_uvs.last_mut().filter(|_| textured && has_uvs) {
                *uvs = vertices.map(|i| mesh.texture_coordinates[i as usize].as_vec2());
            }
            corners_kept.extend((!mesh.attributes.is_empty()).then_some((vertices, i as u32)));
        }
        self.keep_attributes(index, mesh, &corners_kept);
        Ok(())
    }

    /// Adds a mesh that several shapes share, where one of them has it.
    pub(super) fn add_instance(
        &mut self,
        index: u32,
        shape: &ShapeDescription,
        instance: &Instance,
    ) -> Result<(), BuildError> {
        let mesh = &instance.tree.mesh;
        if !mesh.normals.is_empty() && !instance.placement.can_be_inverted() {
            return Err(BuildError::Singular(shape.name.clone()));
        }
        self.placed += instance.len();
        self.census.instances += 1;
        self.census.triangles += instance.len() as u64;
        self.census.degenerate_triangles += (mesh.triangles.len() - instance.len()) as u64;
        for (name, kept) in self.attributes.iter_mut().flatten() {
            if let Some(attribute) = mesh.attributes.iter().find(|a| a.name == *name) {
                let of_mesh = (Arc::as_ptr(mesh) as usize, name.clone());
                let corners = self.shared_corners.entry(of_mesh).or_insert_with(|| {
                    let numbered = mesh.triangles.iter().zip(0..);
                    numbered.map(|(&t, face)| if attribute.is_of_faces() { [face; 3] } else { t }).collect()
                });
                kept.add(index, 0, attribute, Arc::clone(corners));
            }
        }
        Ok(())
    }

    /// Whether there are as many primitives at most as indices.
    pub(super) fn check_count(&self) -> Result<(), BuildError> {
        let all = self.primitives.len() + self.placed;
        if self.primitives.len() > i32::MAX as usize || all >= u32::MAX as usize {
            return Err(BuildError::TooLarge);
        }
        Ok(())
    }

    /// Whether any primitive from one on has interpolated normals.
    pub(super) fn is_smooth_from(&self, first: usize) -> bool {
        self.vertex_normals[first..].iter().any(|n| n[0] != Vec3::ZERO)
    }

    fn push(&mut self, shape: u32, primitive: Primitive, normals: Option<[Vec3; 3]>) {
        self.primitives.push(primitive);
        self.shape_of.push(shape);
        self.vertex_normals.push(normals.unwrap_or_default());
        self.vertex_uvs.extend((self.census.textures || self.census.anisotropy).then_some([Vec2::ZERO; 3]));
    }

    /// Gives emitters the radiance of their texture; whether any has one.
    pub(super) fn add_patterns(
        &self,
        emitters: &mut [Emitter],
        description: &SceneDescription,
        samplers: &[Arc<Sampler>],
    ) -> bool {
        let mut any = false;
        for emitter in emitters {
            let Kind::Area(area) = &mut emitter.kind else { continue };
            let shape = &description.shapes[area.shape as usize];
            let Some(Colour::Texture(texture)) = shape.radiance else { continue };
            let first = self.shape_of.partition_point(|&of| of < area.shape);
            let all = first..first + area.primitives.len();
            let uvs = self.vertex_uvs.get(all).unwrap_or_default();
            let sampler = Arc::clone(&samplers[texture]);
            let to_object = orientation(&shape.to_world);
            let place = (area.shape, first as u32);
            let pattern = Pattern::new(sampler, &area.primitives, uvs, place, to_object);
            area.set_pattern(pattern);
            any = true;
        }
        any
    }

    pub(super) fn into_scene(
        self,
        instances: Vec<Instance>,
        normalisation: Normalisation,
        bounds: Aabb,
        options: &BuildOptions<'_>,
    ) -> Result<Scene, Cancelled> {
        let (accel, order) = Accel::build(&self.primitives, instances, options)?;
        let smooth = self.vertex_normals.iter().any(|n| n[0] != Vec3::ZERO);
        let ordered = order.iter().map(|&i| i as usize);
        Ok(Scene {
            order: order.iter().copied().collect(),
            coincidences: Arc::default(),
            placings: Arc::default(),
            parts: ordered.clone().map(|i| Part { shape: self.shape_of[i], ..Part::default() }).collect(),
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
            mixtures: Mixtures::default(),
            coats: Vec::new(),
            lambertian: Vec::new(),
            emitters: Arc::default(),
            environments: Arc::default(),
            delta_emitters: Arc::default(),
            emitter_choice: Discrete::default(),
            casters: None,
            sensors: Vec::new(),
            normalisation,
            bounds,
            max_depth: None,
            census: self.census,
            picture_bytes: 0,
            moving: None,
        })
    }
}

/// Whether a mesh has as much of everything as it has vertices, or triangles, and these have vertices that are there.
pub(super) fn check_mesh(shape: &ShapeDescription, mesh: &Mesh) -> Result<(), BuildError> {
    let vertices = mesh.positions.len();
    let fits = |n: usize| n == 0 || n == vertices;
    let is_sound = |a: &Attribute| {
        let things = if a.is_of_faces() { mesh.triangles.len() } else { vertices };
        matches!(a.channels, 1 | 3) && a.values.len() == things * a.channels
    };
    if !(fits(mesh.normals.len())
        && fits(mesh.texture_coordinates.len())
        && mesh.attributes.iter().all(is_sound)
        && mesh.triangles.iter().flatten().all(|&i| (i as usize) < vertices))
    {
        return Err(BuildError::BadMesh(shape.name.clone()));
    }
    let are_finite = mesh.texture_coordinates.iter().all(|uv| uv.is_finite());
    if !are_finite || mesh.attributes.iter().any(|a| !a.values.iter().all(|v| v.is_finite())) {
        return Err(BuildError::NotFinite(shape.name.clone()));
    }
    Ok(())
}

/// The factor by which the transform scales the given axes, if it keeps them of one length and perpendicular within
/// a share of that.
pub(super) fn even_scale(
    to_world: &DAffine3,
    axes: &[usize],
    within: f64,
    name: &str,
) -> Result<f64, BuildError> {
    let scale = to_world.matrix3.x_axis.length();
    for (n, &i) in axes.iter().enumerate() {
        let v = to_world.matrix3.col(i);
        let even = (v.length() / scale - 1.0).abs() < within;
        let square = axes[..n].iter().all(|&j| v.dot(to_world.matrix3.col(j)).abs() < within * scale * scale);
        if !(even && square) {
            return Err(BuildError::NotRound(name.to_owned()));
        }
    }
    Ok(scale)
}
