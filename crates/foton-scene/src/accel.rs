//! Rays against many primitives: obvhs's compressed eight-wide tree behind two questions, nearest hit and any hit.
//!
//! obvhs cuts node tests off below an absolute distance of 1e-4, so scenes are scaled to a half-size of about 2^11 before
//! they come here; its boxes are padded so that the watertight triangle test behind them stays watertight.

use foton_math::glam::Vec2;
use foton_math::{Aabb, Ray};
use obvhs::BvhBuildParams;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh;
use obvhs::ray::{Ray as TreeRay, RayHit};

use crate::primitive::{Primitive, ShearedRay};

/// Boxes grow by this share of the scene's half-size on each side: the node test's own rounding errors, with a margin.
const PADDING: f32 = 1e-6;

/// A tree over primitives.
pub(crate) struct Accel {
    tree: Option<CwBvh>,
    primitives: Vec<Primitive>,
}

/// The nearest thing on a ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit {
    /// Distance in scene units.
    pub(crate) t: f32,
    /// Index of the primitive, in the tree's order.
    pub(crate) primitive: u32,
    /// Weights of a triangle's second and third vertex; zero for other primitives.
    pub(crate) barycentric: Vec2,
}

struct Padded(Aabb);

impl obvhs::Boundable for Padded {
    fn aabb(&self) -> obvhs::aabb::Aabb {
        obvhs::aabb::Aabb { min: self.0.min.into(), max: self.0.max.into() }
    }
}

impl Accel {
    /// Builds the tree. Returns it with `order`, where `order[i]` is the old index of primitive `i`.
    pub(crate) fn build(primitives: &[Primitive]) -> (Self, Vec<u32>) {
        if primitives.is_empty() {
            return (Self { tree: None, primitives: Vec::new() }, Vec::new());
        }
        let bounds = primitives.iter().fold(Aabb::EMPTY, |b, p| b.union(p.bounds()));
        let padding = bounds.size().max_element() * 0.5 * PADDING;
        let boxes: Vec<Padded> = primitives
            .iter()
            .map(|p| {
                let b = p.bounds();
                Padded(Aabb { min: b.min - padding, max: b.max + padding })
            })
            .collect();
        let mut tree = build_cwbvh(&boxes, BvhBuildParams::medium_build(), &mut Default::default());
        let order = std::mem::take(&mut tree.primitive_indices);
        let primitives = order.iter().map(|&i| primitives[i as usize]).collect();
        (Self { tree: Some(tree), primitives }, order)
    }

    /// The nearest hit in the ray's interval.
    pub(crate) fn nearest(&self, ray: Ray) -> Option<Hit> {
        let tree = self.tree.as_ref()?;
        let sheared = ShearedRay::new(ray);
        let mut nearest: Option<Hit> = None;
        tree.ray_traverse(tree_ray(&ray), &mut RayHit::none(), |_, i| {
            let Some(hit) = sheared.hit(&self.primitives[i]) else { return f32::INFINITY };
            if nearest.is_none_or(|n| hit.t < n.t) {
                nearest = Some(Hit { t: hit.t, primitive: i as u32, barycentric: hit.barycentric });
            }
            hit.t
        });
        nearest
    }

    /// Whether anything lies in the ray's interval.
    pub(crate) fn occluded(&self, ray: Ray) -> bool {
        let Some(tree) = &self.tree else { return false };
        let sheared = ShearedRay::new(ray);
        !tree.ray_traverse_miss(tree_ray(&ray), |_, i| {
            sheared.hit(&self.primitives[i]).map_or(f32::INFINITY, |h| h.t)
        })
    }

    /// The primitives in the tree's order.
    pub(crate) fn primitives(&self) -> &[Primitive] {
        &self.primitives
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        let tree = self.tree.as_ref().map_or(0, |t| t.nodes.len() * size_of_val(&t.nodes[0]));
        tree + self.primitives.len() * size_of::<Primitive>()
    }
}

fn tree_ray(ray: &Ray) -> TreeRay {
    // Adding zero makes −0 a +0: obvhs takes the two for different sides of a box and would miss it.
    TreeRay::new(ray.origin.into(), (ray.direction + 0.0).into(), ray.t_min, ray.t_max)
}
