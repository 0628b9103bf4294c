//! Which shapes share a mesh, and the trees over the meshes that they share.
//!
//! Shapes that have one mesh in common, the same `Arc`, stand in the scene as instances of one tree where that saves enough: a tree below
//! a tree costs rays time. Emitters are left out, since their surfaces are sampled triangle by triangle.

use std::collections::HashMap;
use std::sync::{Arc, OnceLock};

use foton_math::glam::{DAffine3, DVec3, Vec3};
use foton_math::{Cancelled, Rgb};
use rayon::prelude::*;

use super::error::BuildError;
use super::extent::Extent;
use super::gather::check_mesh;
use super::gauge::{BuildOptions, Instancing};
use super::patches::{self, Patches};
use crate::accel::{Accel, Instance, MeshTree, PADDING, padding_for};
use crate::description::{Colour, Geometry, Mesh, SceneDescription, ShapeDescription};
use crate::normalise::Normalisation;
use crate::placement::{Placed, Placement};
use crate::primitive::Primitive;
use crate::scene::Scene;

/// Triangles that instances keep out of the scene, at the least: fewer are built in a moment, and rays are faster without instances.
const WORTHWHILE: usize = 1 << 16;

/// The meshes of which several shapes would be instances, with the indices of those.
pub(super) fn shared_meshes(
    description: &SceneDescription,
    options: Instancing,
) -> Vec<(&Arc<Mesh>, Vec<usize>)> {
    if options == Instancing::Never {
        return Vec::new();
    }
    let mut shapes_of: HashMap<*const Mesh, Vec<usize>> = HashMap::new();
    let mut first = Vec::new();
    for (i, shape) in description.shapes.iter().enumerate() {
        let Geometry::Mesh(mesh) = &shape.geometry else { continue };
        if mesh.triangles.is_empty() || emits(shape) || description.hidden.shapes.contains(&i) {
            continue;
        }
        let shapes = shapes_of.entry(Arc::as_ptr(mesh)).or_insert_with(|| {
            first.push(mesh);
            Vec::new()
        });
        shapes.push(i);
    }
    let is_worthwhile = |mesh: &Mesh, shapes: &[usize]| {
        let saved = (shapes.len() - 1) * mesh.triangles.len();
        shapes.len() > 1 && (saved >= WORTHWHILE || options == Instancing::Always)
    };
    let with_shapes =
        first.into_iter().filter_map(|mesh| Some((mesh, shapes_of.remove(&Arc::as_ptr(mesh))?)));
    with_shapes.filter(|(mesh, shapes)| is_worthwhile(mesh, shapes)).collect()
}

fn emits(shape: &ShapeDescription) -> bool {
    shape.radiance.is_some_and(|radiance| radiance != Colour::Constant(Rgb::BLACK))
}

/// The instances of a scene.
#[derive(Default)]
pub(super) struct Instances {
    /// By index of the shape.
    of: HashMap<usize, Instance>,
}

impl Instances {
    /// Builds the trees of meshes that shapes share, but for those that are known.
    pub(super) fn new(
        description: &SceneDescription,
        to_scene: &Normalisation,
        known: &Known<'_>,
        options: &BuildOptions<'_>,
    ) -> Result<Self, BuildError> {
        let shared = shared_meshes(description, options.instancing);
        if shared.is_empty() {
            return Ok(Self::default());
        }
        let extents = Extents::of(&shared, known);
        let all = shared.into_par_iter().map(|(mesh, shapes)| {
            check_mesh(&description.shapes[shapes[0]], mesh)?;
            let to_boxes = known.to_boxes(mesh).unwrap_or_else(|| extents.to_boxes(mesh));
            let place = |&i: &usize| {
                let placement = Placement::new(&description.shapes[i], to_scene);
                let padding = padding_for(&placement, &to_boxes, Normalisation::HALF_SIZE as f32 * PADDING)?;
                Some((i, placement, padding))
            };
            let placed: Vec<_> = shapes.iter().filter_map(place).collect();
            let Some(padding) = placed.iter().map(|(.., padding)| *padding).reduce(f32::max) else {
                return Ok(Vec::new());
            };
            let tree = match known.tree(mesh, padding) {
                Some(tree) => Some(Arc::clone(tree)),
                None => tree_over(mesh, to_boxes, padding, options)?.map(Arc::new),
            };
            let Some(tree) = tree else { return Ok(Vec::new()) };
            let instance = |(i, placement, _): (usize, Placement, f32)| {
                let corners = extents.of_shape(i, &description.shapes[i])?;
                Some((i, Instance::new(i as u32, &tree, placement, corners)?))
            };
            Ok(placed.into_par_iter().filter_map(instance).collect())
        });
        let all: Vec<Vec<(usize, Instance)>> = all.collect::<Result<_, BuildError>>()?;
        Ok(Self { of: all.into_iter().flatten().collect() })
    }

    /// Takes out that of a shape.
    pub(super) fn take(&mut self, shape: usize) -> Option<Instance> {
        self.of.remove(&shape)
    }
}

/// What a scene that was built before knows of meshes that shapes share.
#[derive(Default)]
pub(super) struct Known<'a> {
    /// By mesh.
    trees: HashMap<usize, &'a Arc<MeshTree>>,
    /// By index of the shape.
    instances: HashMap<usize, &'a Instance>,
}

impl<'a> Known<'a> {
    pub(super) fn of(scene: &'a Scene) -> Self {
        let trees = scene.accel.mesh_trees().map(|tree| (Arc::as_ptr(&tree.mesh) as usize, tree));
        let instances = scene.accel.instances().iter().map(|i| (i.shape as usize, i));
        Self { trees: trees.collect(), instances: instances.collect() }
    }

    fn to_boxes(&self, mesh: &Arc<Mesh>) -> Option<Normalisation> {
        Some(self.trees.get(&(Arc::as_ptr(mesh) as usize))?.to_boxes)
    }

    fn tree(&self, mesh: &Arc<Mesh>, padding: f32) -> Option<&'a Arc<MeshTree>> {
        self.trees.get(&(Arc::as_ptr(mesh) as usize)).copied().filter(|tree| tree.padding == padding)
    }

    /// The corners in the world of a shape that stands where it stood.
    fn corners(&self, index: usize, mesh: &Arc<Mesh>, to_world: &DAffine3) -> Option<(DVec3, DVec3)> {
        let instance = self.instances.get(&index)?;
        let is_same = Arc::ptr_eq(&instance.tree.mesh, mesh) && instance.placement.to_world() == to_world;
        is_same.then_some(instance.corners)
    }
}

/// How far shapes reach that share a mesh.
pub(super) struct Extents<'a> {
    known: &'a Known<'a>,
    /// By mesh; made where one is asked for.
    of: HashMap<usize, OnceLock<Extent>>,
}

impl<'a> Extents<'a> {
    pub(super) fn of(shared: &[(&Arc<Mesh>, Vec<usize>)], known: &'a Known<'a>) -> Self {
        let of = shared.iter().map(|(mesh, _)| (Arc::as_ptr(mesh) as usize, OnceLock::new()));
        Self { known, of: of.collect() }
    }

    /// The corners in the world of a shape with one of those meshes.
    pub(super) fn of_shape(&self, index: usize, shape: &ShapeDescription) -> Option<(DVec3, DVec3)> {
        let Geometry::Mesh(mesh) = &shape.geometry else { return None };
        let of = self.of.get(&(Arc::as_ptr(mesh) as usize))?;
        let known = self.known.corners(index, mesh, &shape.to_world);
        known.or_else(|| Some(of.get_or_init(|| Extent::new(mesh)).under(&shape.to_world)))
    }

    /// The space of a mesh's boxes.
    fn to_boxes(&self, mesh: &Arc<Mesh>) -> Normalisation {
        let of = self.of.get(&(Arc::as_ptr(mesh) as usize));
        let (min, max) =
            of.map_or_else(|| Extent::new(mesh).bounds(), |of| of.get_or_init(|| Extent::new(mesh)).bounds());
        Normalisation::for_bounds(min, max)
    }
}

/// The tree over a mesh; `None` if none of its triangles has an area.
fn tree_over(
    mesh: &Arc<Mesh>,
    to_boxes: Normalisation,
    padding: f32,
    options: &BuildOptions<'_>,
) -> Result<Option<MeshTree>, Cancelled> {
    // Several are built at a time: none says how far it is.
    let options = &BuildOptions { cancel: options.cancel.clone(), ..BuildOptions::default() };
    let own = Placement::of_mesh(&to_boxes);
    let positions: Vec<Vec3> = mesh.positions.iter().map(|&p| own.point(p)).collect();
    let normals: Vec<Vec3> = mesh.normals.iter().map(|&n| own.normal(n)).collect();
    let (mut primitives, mut numbers) = (Vec::new(), Vec::new());
    for (i, &vertices) in mesh.triangles.iter().enumerate() {
        options.cancel.check_at(i)?;
        let normal = (!normals.is_empty()).then_some(|i: u32| normals[i as usize]);
        let placed = own.oriented(vertices, |i| positions[i as usize], normal);
        if let Some(Placed { corners, .. }) = placed.filter(|_| mesh.has_area(vertices)) {
            primitives.push(Primitive::Triangle(corners));
            numbers.push(i as u32);
        }
    }
    drop((positions, normals));
    if primitives.is_empty() {
        return Ok(None);
    }
    let (accel, order) = Accel::build_padded(&primitives, Vec::new(), padding, options)?;
    drop(primitives);
    let Patches { own, free, .. } = patches::find(&accel, |_| true, options)?;
    let triangles = order.into_iter().map(|i| numbers[i as usize]).collect();
    Ok(Some(accel.into_mesh_tree(mesh, triangles, (own, free), (to_boxes, padding))))
}
