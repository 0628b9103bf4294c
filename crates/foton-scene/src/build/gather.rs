//! Shapes to one list of primitives in scene units.

use std::sync::Arc;

use foton_math::glam::{DAffine3, DMat3, Vec2, Vec3};
use foton_math::{Aabb, Cancelled};

use super::error::BuildError;
use super::gauge::{BuildOptions, Gauge};
use super::orientation::orientation;
use crate::accel::Accel;
use crate::attributes::Attributes;
use crate::census::Census;
use crate::description::{
    Attribute, Colour, Geometry, Mesh, SceneDescription, ShapeDescription, Texture, TextureKind,
};
use crate::discrete::Discrete;
use crate::emitter::{Emitter, Kind, Pattern};
use crate::normalise::Normalisation;
use crate::plane::triangle_normal;
use crate::primitive::Primitive;
use crate::scene::{Mixtures, Part, Scene};
use crate::texture::Sampler;

/// How far a transform's axes may be from equal length and right angles and still keep a sphere round.
const ROUNDNESS: f64 = 1e-4;

/// Vertex normals this close to a triangle's own (within 0.03°) say that it is flat.
const FLAT_COSINE: f32 = 1.0 - 1e-7;

/// Primitives of a scene as they are gathered, before the tree orders them.
#[derive(Default)]
pub(super) struct Gathered {
    pub(super) primitives: Vec<Primitive>,
    shape_of: Vec<u32>,
    pub(super) vertex_normals: Vec<[Vec3; 3]>,
    vertex_uvs: Vec<[Vec2; 3]>,
    pub(super) census: Census,
    /// By texture, the attribute of meshes that it shows.
    attributes: Vec<Option<(String, Attributes)>>,
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
        check_lengths(shape, mesh)?;
        if !mesh.texture_coordinates.iter().all(|uv| uv.is_finite()) {
            return Err(BuildError::NotFinite(shape.name.clone()));
        }
        let mirrored = shape.to_world.matrix3.determinant() < 0.0;
        let positions: Vec<Vec3> =
            mesh.positions.iter().map(|&p| to_scene.point(shape.to_world.transform_point3(p))).collect();
        let normals = smooth.then(|| world_normals(shape, mesh)).transpose()?;
        let mut corners_kept = Vec::new();
        for (i, triangle) in mesh.triangles.iter().enumerate() {
            gauge.check_at(i)?;
            if triangle.iter().any(|&i| i as usize >= positions.len()) {
                return Err(BuildError::BadMesh(shape.name.clone()));
            }
            let [a, mut b, mut c] = *triangle;
            // A mirroring transform turns the winding around; so does flipping.
            if mirrored != shape.flip_normals {
                (b, c) = (c, b);
            }
            let corners = |[a, b, c]: [u32; 3]| [a, b, c].map(|i| positions[i as usize]);
            let flat = triangle_normal(corners([a, b, c])).filter(|_| mesh.has_area(*triangle));
            let Some(flat) = flat else {
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
            corners_kept.extend((!mesh.attributes.is_empty()).then_some(([a, b, c], i as u32)));
        }
        self.keep_attributes(index, mesh, &corners_kept);
        Ok(())
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
        normalisation: Normalisation,
        bounds: Aabb,
        options: &BuildOptions<'_>,
    ) -> Result<Scene, Cancelled> {
        let (accel, order) = Accel::build(&self.primitives, options)?;
        let smooth = self.vertex_normals.iter().any(|n| n[0] != Vec3::ZERO);
        let ordered = order.iter().map(|&i| i as usize);
        Ok(Scene {
            order: order.iter().copied().collect(),
            coincidences: Arc::default(),
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

/// Whether a mesh has as much of everything as it has vertices, or triangles.
fn check_lengths(shape: &ShapeDescription, mesh: &Mesh) -> Result<(), BuildError> {
    let vertices = mesh.positions.len();
    let fits = |n: usize| n == 0 || n == vertices;
    let is_sound = |a: &Attribute| {
        let things = if a.is_of_faces() { mesh.triangles.len() } else { vertices };
        matches!(a.channels, 1 | 3) && a.values.len() == things * a.channels
    };
    if !(fits(mesh.normals.len())
        && fits(mesh.texture_coordinates.len())
        && mesh.attributes.iter().all(is_sound))
    {
        return Err(BuildError::BadMesh(shape.name.clone()));
    }
    if mesh.attributes.iter().any(|a| !a.values.iter().all(|v| v.is_finite())) {
        return Err(BuildError::NotFinite(shape.name.clone()));
    }
    Ok(())
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
