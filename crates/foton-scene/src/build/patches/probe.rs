//! Probing beyond free edges for what lies flush with them.

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Aabb, Frame, Ray};

use super::side::{MIN_COSINE, Side};
use crate::accel::Accel;
use crate::primitive::{Primitive, ShearedRay};
use crate::surface::locate;

/// Edges are probed this far beyond them, in steps between neighbouring single-precision coordinates.
const PROBED_STEPS: f32 = 16.0;

/// The largest number of primitives that are tested near an edge.
const MAX_NEAR: usize = 32;

/// Two primitives of which one continues the other.
pub(super) struct Continuation {
    pub(super) primitive: u32,
    pub(super) other: u32,
    /// Whether their normals point to different sides.
    pub(super) turned: bool,
    /// The edge of the first, if it is a triangle.
    pub(super) side: u8,
}

/// What continues a primitive flush beyond its free edges. What does within its own mesh, if that is an instance's, is known.
pub(super) fn probed(
    accel: &Accel,
    index: u32,
    free: u8,
    stores: &(impl Fn(u32) -> bool + Sync),
) -> Vec<Continuation> {
    let mut found = Vec::new();
    let own = accel.placed(index).map(|(instance, _)| instance);
    let mut probe = |edge: Rim, side: usize| {
        if let Some((other, turned)) = edge.continued_in(accel, own, stores) {
            found.push(Continuation { primitive: index, other, turned, side: side as u8 });
        }
    };
    match accel.primitive(index) {
        Primitive::Triangle(corners) => {
            for side in (0..3).filter(|side| free >> side & 1 != 0) {
                let Some(edge) = Side::new(corners, side) else { continue };
                let [a, b] = edge.ends;
                let step = step_at(a.abs().max(b.abs()).max_element());
                // Of two edges that overlap one has an end within the other, or is within it.
                let inset = (2.0 * step / a.distance(b).max(f32::MIN_POSITIVE)).min(0.25);
                let (normal, outward) = (edge.normal.as_vec3(), -edge.inward.as_vec3());
                for share in [0.5, inset, 1.0 - inset] {
                    probe(Rim { point: a.lerp(b, share), outward, normal, step }, side);
                }
            }
        }
        Primitive::Cylinder { from, axis, radius } => {
            let Some(unit) = axis.try_normalize() else { return found };
            let frame = Frame::from_normal(unit);
            let step = step_at(from.abs().max((from + axis).abs()).max_element() + radius.abs());
            for (end, outward) in [(from, -unit), (from + axis, unit)] {
                for normal in [frame.tangent, frame.bitangent, -frame.tangent, -frame.bitangent] {
                    let turned = normal * 1f32.copysign(radius);
                    probe(Rim { point: end + normal * radius.abs(), outward, normal: turned, step }, 0);
                }
            }
        }
        Primitive::Sphere { .. } | Primitive::Disc { .. } => {}
    }
    found
}

/// How far beyond an edge it is probed where coordinates are as large as this.
fn step_at(largest_coordinate: f32) -> f32 {
    PROBED_STEPS * f32::EPSILON * largest_coordinate.max(f32::MIN_POSITIVE)
}

/// A point of a surface's edge.
struct Rim {
    point: Vec3,
    /// Unit direction along the surface and away from it.
    outward: Vec3,
    normal: Vec3,
    step: f32,
}

impl Rim {
    /// The primitive that lies flush beyond the edge, and whether its normal is turned. One that goes on below or above the
    /// surface itself, as the floor does under a card, does not continue it.
    fn continued_in(
        &self,
        accel: &Accel,
        own: Option<usize>,
        stores: &impl Fn(u32) -> bool,
    ) -> Option<(u32, bool)> {
        let Self { point, outward, normal, step } = *self;
        let height = 4.0 * step;
        let cosine_along = |origin: Vec3, direction: Vec3, but: Option<usize>| {
            let ray = Ray { origin, direction, t_min: 0.0, t_max: 2.0 * height };
            let sheared = ShearedRay::new(ray);
            let near = Aabb::EMPTY.with(origin).with(ray.at(ray.t_max));
            let mut nearest: Option<(f32, u32, f32)> = None;
            accel.for_each_near_of_others(&near, MAX_NEAR, but, |index| {
                let (index, primitive) = (index as u32, &accel.primitive(index as u32));
                let farthest = nearest.map_or(ray.t_max, |(t, ..)| t);
                let Some(t) = sheared.hit_other(primitive, farthest).filter(|_| stores(index)) else {
                    return;
                };
                let (_, _, other) = locate(primitive, Vec2::ZERO, ray.at(t));
                let cosine = normal.dot(other);
                if f64::from(cosine.abs()) > MIN_COSINE {
                    nearest = Some((t, index, cosine));
                }
            });
            nearest.map(|(_, index, cosine)| (index, cosine))
        };
        let (other, cosine) = cosine_along(point + outward * step + normal * height, -normal, own)?;
        let inside = point - outward * (2.0 * step);
        let overlaps = [normal, -normal]
            .into_iter()
            .any(|side| cosine_along(inside + side * (step / PROBED_STEPS), side, None).is_some());
        (!overlaps).then_some((other, cosine < 0.0))
    }
}
