//! A mesh that several shapes share, where one of them stands.
//!
//! Rays meet boxes in the mesh's space and triangles in the scene's: each corner is transformed and rounded as that of a mesh that is in
//! the scene by itself. So a hit has the same distance, to the bit, and whatever follows from it goes by scene units alone.

use std::sync::Arc;

use foton_math::glam::{DAffine3, DMat3, DVec3};
use foton_math::{Aabb, Ray};

use super::mesh_tree::MeshTree;
use super::node::{BoxRay, Child, QUAD, Target};
use super::stack::{Best, Place, Stack, descend, slot_of};
use crate::normalise::Normalisation;
use crate::placement::{Placed, Placement};
use crate::primitive::{Primitive, ShearedRay};

/// One placing of a tree.
pub(crate) struct Instance {
    /// Index of the shape.
    pub(crate) shape: u32,
    pub(crate) tree: Arc<MeshTree>,
    pub(crate) placement: Placement,
    /// The box around it in the scene.
    pub(crate) bounds: Aabb,
    /// Its corners in the world.
    pub(crate) corners: (DVec3, DVec3),
    /// The index of its first primitive.
    pub(super) first: u32,
    /// Scene units to those of the tree's boxes.
    to_boxes: DAffine3,
}

impl Instance {
    /// `None` where a transform cannot be inverted. `corners` are those of the box around its triangles in the world.
    pub(crate) fn new(
        shape: u32,
        tree: &Arc<MeshTree>,
        placement: Placement,
        corners: (DVec3, DVec3),
    ) -> Option<Self> {
        let to_boxes = scene_to_boxes(&placement, &tree.to_boxes)?;
        let [min, max] = [corners.0, corners.1].map(|corner| placement.to_scene().point(corner));
        let (tree, bounds) = (Arc::clone(tree), Aabb { min, max });
        Some(Self { shape, tree, placement, bounds, corners, first: 0, to_boxes })
    }

    /// How many triangles it has.
    pub(crate) fn len(&self) -> usize {
        self.tree.triangles.len()
    }

    /// The index of one of its triangles among all primitives.
    pub(crate) fn index(&self, triangle: usize) -> u32 {
        self.first + triangle as u32
    }

    /// A triangle in the scene, by its place in the tree.
    pub(crate) fn placed(&self, triangle: usize) -> Placed {
        let mesh = &self.tree.mesh;
        let vertices = mesh.triangles[self.tree.triangles[triangle] as usize];
        // What has no area in single precision is met by no ray.
        self.placement.triangle(mesh, vertices).unwrap_or_else(|| {
            let corners = vertices.map(|i| self.placement.point(mesh.positions[i as usize]));
            Placed { vertices, corners, normals: None }
        })
    }

    /// The same as a primitive.
    pub(crate) fn primitive(&self, triangle: usize) -> Primitive {
        Primitive::Triangle(self.placed(triangle).corners)
    }

    /// A ray among the boxes; distances along it stay the same.
    fn box_ray(&self, ray: &Ray) -> BoxRay {
        let origin = self.to_boxes.transform_point3(ray.origin.as_dvec3()).as_vec3();
        let direction = self.to_boxes.transform_vector3(ray.direction.as_dvec3()).as_vec3();
        BoxRay::new(&Ray { origin, direction, ..*ray })
    }

    /// Looks for a hit that is nearer than the best one so far.
    #[inline(never)]
    pub(super) fn nearest(&self, ray: &ShearedRay, best: &mut Best) {
        let boxes = self.box_ray(ray.ray());
        let mut stack = Stack::new();
        let mut next = Some(Place { t: 0.0, child: Child::node(0) });
        while let Some(place) = next {
            next = None;
            match place.child.target() {
                Target::Node(node) => {
                    let node = &self.tree.nodes[node];
                    let (near, entered) = node.enter(&boxes, best.t);
                    next = descend(node, &near, entered, &mut stack);
                }
                Target::Quad(index) => {
                    let quad = self.tree.quads[index].placed(&self.placement);
                    let (mut met, unsure) = quad.met(ray);
                    while met != 0 {
                        let lane = met.trailing_zeros();
                        met &= met - 1;
                        let corners = quad.triangle(lane);
                        if let Some(t) = ray.hit_plane_of(&corners, best.t)
                            && best.is_beaten_by(t)
                            && (unsure >> lane & 1 == 0 || ray.meets(&corners))
                        {
                            *best = Best { t, primitive: self.first + quad.first + lane, triangle: None };
                        }
                    }
                }
                Target::Other(_) | Target::Instance(_) => {}
            }
            while next.is_none() {
                let Some(place) = stack.pop() else { break };
                next = (place.t <= best.t).then_some(place);
            }
        }
    }

    /// Whether a triangle lies in the ray's interval.
    #[inline(never)]
    pub(super) fn occludes(&self, ray: &ShearedRay) -> bool {
        let (boxes, t_max) = (self.box_ray(ray.ray()), ray.ray().t_max);
        let mut stack = Stack::new();
        stack.push(Place { t: 0.0, child: Child::node(0) });
        while let Some(place) = stack.pop() {
            match place.child.target() {
                Target::Node(node) => {
                    let node = &self.tree.nodes[node];
                    let (_, mut entered) = node.enter(&boxes, t_max);
                    while entered != 0 {
                        stack.push(Place { t: 0.0, child: node.children[slot_of(entered)] });
                        entered &= entered - 1;
                    }
                }
                Target::Quad(index) => {
                    let quad = self.tree.quads[index].placed(&self.placement);
                    let (met, unsure) = quad.met(ray);
                    let is_hit = |lane: &u32| {
                        let corners = quad.triangle(*lane);
                        ray.hit_plane_of(&corners, t_max).is_some()
                            && (unsure >> lane & 1 == 0 || ray.meets(&corners))
                    };
                    if (0..QUAD as u32).filter(|lane| met >> lane & 1 != 0).any(|lane| is_hit(&lane)) {
                        return true;
                    }
                }
                Target::Other(_) | Target::Instance(_) => {}
            }
        }
        false
    }

    /// Calls `visit` with the number of each triangle in the tree whose leaf's box meets a box of the scene, until `left` were visited.
    pub(crate) fn for_each_near(&self, near: &Aabb, left: &mut usize, mut visit: impl FnMut(usize)) {
        let near = self.among_boxes(near);
        let mut stack = Stack::new();
        stack.push(Place { t: 0.0, child: Child::node(0) });
        while let Some(place) = stack.pop().filter(|_| *left > 0) {
            match place.child.target() {
                Target::Node(node) => {
                    let node = &self.tree.nodes[node];
                    let mut met = node.near(&near);
                    while met != 0 {
                        stack.push(Place { t: 0.0, child: node.children[slot_of(met)] });
                        met &= met - 1;
                    }
                }
                Target::Quad(quad) => {
                    let quad = &self.tree.quads[quad];
                    for triangle in quad.triangles() {
                        *left = left.saturating_sub(1);
                        visit(triangle);
                    }
                }
                Target::Other(_) | Target::Instance(_) => {}
            }
        }
    }

    /// The box around a box of the scene, among those of the tree.
    fn among_boxes(&self, near: &Aabb) -> Aabb {
        let m = self.to_boxes.matrix3;
        let rows = DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs());
        let centre = self.to_boxes.transform_point3(near.min.as_dvec3() * 0.5 + near.max.as_dvec3() * 0.5);
        let half = rows * ((near.max.as_dvec3() - near.min.as_dvec3()) * 0.5);
        Aabb { min: (centre - half).as_vec3(), max: (centre + half).as_vec3() }
    }
}

/// Scene units to those of a tree's boxes.
fn scene_to_boxes(placement: &Placement, boxes: &Normalisation) -> Option<DAffine3> {
    let to_scene = placement.to_scene().to_affine() * *placement.to_world() * boxes.to_affine().inverse();
    let to_boxes = to_scene.inverse();
    to_boxes.is_finite().then_some(to_boxes)
}

/// By how much boxes in the space of `boxes` must be larger than what is in them, for a shape that stands in the scene as `placement` says:
/// by `padding` in scene units. `None` where its transform cannot be inverted, or stretches so much that boxes would be of no use.
pub(crate) fn padding_for(placement: &Placement, boxes: &Normalisation, padding: f32) -> Option<f32> {
    /// Boxes that grow by a larger share of a mesh's half-size slow rays down.
    const MOST: f64 = 0.01 * Normalisation::HALF_SIZE;
    let m = scene_to_boxes(placement, boxes)?.matrix3;
    // No vector grows by more than this.
    let most = (m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()).sqrt();
    let needed = f64::from(padding) * most;
    // A power of two: trees serve again where a shape is turned or moved a little.
    (needed < MOST).then(|| needed.max(f64::from(padding)).log2().ceil().exp2() as f32)
}
