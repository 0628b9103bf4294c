//! What photons are aimed at: balls around what focuses light, and in a wide scene around what is seen. A share of the photons
//! goes there and the rest as the emitter shines; all ways to get a line are weighed together, so the light is the same.

use std::f32::consts::PI;
use std::sync::Arc;

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Frame, warp};

/// From a point, balls that are nearer than this many of their radii are not aimed at: most light goes there anyway.
const NEAREST: f32 = 2.0;

/// A ball that light is aimed at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ball {
    pub(crate) centre: Vec3,
    pub(crate) radius: f32,
}

/// A ball and the share of photons that is aimed at it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Target {
    pub(crate) ball: Ball,
    pub(crate) share: f32,
}

/// All balls that an emitter aims at. Their shares sum to less than 1.
#[derive(Clone, Debug, Default)]
pub(crate) struct Aim(Arc<[Target]>);

impl Ball {
    /// Area of its shadow.
    pub(super) fn cross_section(&self) -> f32 {
        PI * self.radius * self.radius
    }

    /// Whether a line through `point` along the unit `direction` meets it.
    fn is_met(&self, point: Vec3, direction: Vec3) -> bool {
        let d = point - self.centre;
        (d - direction * d.dot(direction)).length_squared() <= self.radius * self.radius
    }

    /// Direction to the centre and 1 − cos of the cone under which it is seen; `None` from too near.
    fn seen_from(&self, point: Vec3) -> Option<(Vec3, f32)> {
        let d = self.centre - point;
        let distance = d.length();
        let far = distance > NEAREST * self.radius && distance.is_finite();
        far.then(|| one_minus_cos_of_cone(self.radius, distance)).flatten().map(|cone| (d / distance, cone))
    }
}

impl Aim {
    pub(crate) fn new(targets: Vec<Target>) -> Self {
        Self(targets.into())
    }

    /// Whether there is nothing to aim at.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// A start before `scene` for parallel light along `direction`, and its density per unit area across it. What is not aimed
    /// at a target is aimed at the whole scene.
    pub(super) fn parallel(&self, scene: &Ball, direction: Vec3, u_part: f32, u: Vec2) -> (Vec3, f32) {
        let (mut chosen, mut left) = (None, u_part);
        for (i, target) in self.0.iter().enumerate() {
            if left < target.share {
                chosen = Some(i);
                break;
            }
            left -= target.share;
        }
        let ball = chosen.map_or(scene, |i| &self.0[i].ball);
        let disc = warp::square_to_disc(u) * ball.radius;
        let frame = Frame::from_normal(direction);
        let through = ball.centre + frame.tangent * disc.x + frame.bitangent * disc.y;
        let before = (through - scene.centre).dot(direction) + scene.radius;
        // The ball that was aimed at is met whatever rounding says at its rim: no line has density zero.
        let density = |b: &Ball, aimed_at: bool| {
            if aimed_at || b.is_met(through, direction) { 1.0 / b.cross_section() } else { 0.0 }
        };
        let rest = 1.0 - self.0.iter().map(|t| t.share).sum::<f32>();
        let mut pdf = rest * density(scene, chosen.is_none());
        for (i, target) in self.0.iter().enumerate() {
            pdf += target.share * density(&target.ball, chosen == Some(i));
        }
        (through - direction * before, pdf)
    }

    /// A direction for light from a point, and its density (sr⁻¹), where `own` chooses directions of `own_density` as the emitter
    /// shines.
    pub(super) fn divergent(
        &self,
        point: Vec3,
        u: Vec2,
        own: impl Fn(Vec2) -> Vec3,
        own_density: impl Fn(Vec3) -> f32,
    ) -> (Vec3, f32) {
        let seen = || self.0.iter().filter_map(|t| Some((t.share, t.ball.seen_from(point)?)));
        let (mut chosen, mut left, mut rest) = (None, u.x, 1.0);
        for (share, (axis, cone)) in seen() {
            rest -= share;
            if chosen.is_none() && left < share {
                let local = warp::square_to_cone(Vec2::new(left / share, u.y), cone);
                chosen = Some(Frame::from_normal(axis).to_outer(local));
            } else if chosen.is_none() {
                left -= share;
            }
        }
        let direction = chosen.unwrap_or_else(|| own(Vec2::new((left / rest).min(1.0 - f32::EPSILON), u.y)));
        let aimed = seen().map(|(share, (axis, cone))| {
            // 1 − cos of the angle to the axis, by a form that does not cancel.
            let within = 0.5 * (direction - axis).length_squared() <= cone * (1.0 + 1e-5);
            if within { share * warp::square_to_cone_pdf(cone) } else { 0.0 }
        });
        (direction, rest * own_density(direction) + aimed.sum::<f32>())
    }
}

/// 1 − cos of the cone under which a sphere is seen from a distance to its centre, by a form that does not cancel; `None` from
/// inside.
pub(super) fn one_minus_cos_of_cone(radius: f32, distance: f32) -> Option<f32> {
    let sine = radius / distance;
    (sine < 1.0).then(|| sine * sine / (1.0 + (1.0 - sine * sine).sqrt()))
}
