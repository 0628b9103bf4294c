//! Which shapes share a mesh, and the trees over the meshes that they share.
//!
//! Shapes that have one mesh in common, the same `Arc`, stand in the scene as instances of one tree where that saves enough: a tree below
//! a tree costs rays time. Emitters are left out, since their surfaces are sampled triangle by triangle.

use std::collections::HashMap;
use std::sync::Arc;

use foton_math::glam::Vec3;
use foton_math::{Aabb, Cancelled, Rgb};
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

/// Triangles that instances keep out of the scene, at the least: fewer are built in a moment, and rays are faster without instances.
const WORTHWHILE: usize = 1 << 16;

/// Meshes by where they lie in memory.
type Pointer = *const Mesh;

/// The meshes of which several shapes would be instances, with the indices of those.
pub(super) fn shared_meshes(description: &SceneDescription, options: Instancing) -> Vec<(&Arc<Mesh>, Vec<usize>)> {
    if options == Instancing::Never {
        return Vec::new();
    }
    let mut shapes_of: HashMap<Pointer, Vec<usize>> = HashMap::new();
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
    let with_shapes = first.into_iter().filter_map(|mesh| Some((mesh, shapes_of.remove(&Arc::as_ptr(mesh))?)));
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
    /// Builds the trees of meshes that shapes share, but for those that are `known`.
    pub(super) fn new(
        description: &SceneDescription,
        to_scene: &Normalisation,
        known: &[Arc<MeshTree>],
        options: &BuildOptions<'_>,
    ) -> Result<Self, BuildError> {
        let shared = shared_meshes(description, options.instancing);
        if shared.is_empty() {
            return Ok(Self::default());
        }
        let key = |mesh: &Arc<Mesh>, padding: f32| (Arc::as_ptr(mesh) as usize, padding.to_bits());
        let known: HashMap<_, _> = known.iter().map(|tree| (key(&tree.mesh, tree.padding), tree)).collect();
        let all = shared.into_par_iter().map(|(mesh, shapes)| {
            check_mesh(&description.shapes[shapes[0]], mesh)?;
            let extent = Extent::new(mesh);
            let (min, max) = extent.bounds();
            let to_boxes = Normalisation::for_bounds(min, max);
            let place = |&i: &usize| {
                let placement = Placement::new(&description.shapes[i], to_scene);
                let padding = padding_for(&placement, &to_boxes, Normalisation::HALF_SIZE as f32 * PADDING)?;
                Some((i, placement, padding))
            };
            let placed: Vec<_> = shapes.iter().filter_map(place).collect();
            let Some(padding) = placed.iter().map(|(.., padding)| *padding).reduce(f32::max) else {
                return Ok(Vec::new());
            };
            let tree = match known.get(&key(mesh, padding)) {
                Some(&tree) => Some(Arc::clone(tree)),
                None => tree_over(mesh, to_boxes, padding, options)?.map(Arc::new),
            };
            let Some(tree) = tree else { return Ok(Vec::new()) };
            let instance = |(i, placement, _): (usize, Placement, f32)| {
                let (min, max) = extent.under(placement.to_world());
                let bounds = Aabb { min: to_scene.point(min), max: to_scene.point(max) };
                Some((i, Instance::new(i as u32, &tree, placement, bounds)?))
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
