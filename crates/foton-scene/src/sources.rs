//! Where photons start: how often at each emitter, and what they are aimed at.
//!
//! In most scenes photons are distributed as the emitters shine. In a *wide* one, where what is seen is a small part of all (a ring
//! on a ground of kilometres, a room under a far emitter), nearly all photons would land where no eye path ends. There they are
//! aimed at nested balls that contain growing shares of what is seen, and beyond that grow until they are as large as the scene:
//! near and far parts of a ground each get their photons, and what is not seen but lights what is gets some of moderate power.

use std::sync::Arc;

use foton_math::glam::{Vec2, Vec3};

use crate::discrete::Discrete;
use crate::emitter::{Aim, Ball, Constant, Directional, Emission, Emitter, Environment, Kind, Target};
use crate::scene::Scene;

/// A scene is wide if its radius is this many times that of the ball with most of what is seen.
const WIDE: f32 = 16.0;

/// Shares of the points seen that each ball contains.
const SEEN: [f32; 5] = [0.75, 1.0 - 1.0 / 16.0, 1.0 - 1.0 / 64.0, 1.0 - 1.0 / 256.0, 1.0];

/// The ball that decides whether a scene is wide and which share of an emitter's power arrives.
const DECISIVE_BALL: usize = 1;

/// A ball is left out unless it is smaller than the next larger one by this factor.
const LARGER: f32 = 1.5;

/// Shares of the photons that are aimed at what is seen, at what focuses light, and beyond; the others go as their emitter shines.
const AT_SEEN: f32 = 0.7;
const AT_CASTERS: f32 = 0.1;
const BEYOND: f32 = 0.1;

/// The smallest weight of a ball of what is seen.
const MIN_WEIGHT: f32 = 0.02;

/// Beyond what is seen each ball is this many times as large as the last.
const GROWTH: f32 = 4.0;

/// Balls are larger than what they must contain by this factor.
const MARGIN: f32 = 1.1;

/// In a wide scene emitters are chosen by the power that arrives; this share of the probability goes by power alone, and as much is
/// uniform.
const DEFENSIVE_SHARE: f64 = 0.1;

/// How many numbers in [0, 1) decide where a photon starts from its emitter.
pub const PRIMARY_NUMBERS: usize = 5;

/// Those numbers: which part of a mesh or which ball that is aimed at, then the position's two and the direction's two.
pub type PrimaryNumbers = [f32; PRIMARY_NUMBERS];

/// Emitters as photons leave them.
#[derive(Clone, Debug)]
pub struct Sources {
    emitters: Arc<[Emitter]>,
    choice: Discrete,
    /// The aim of all of them, instead of each emitter's own.
    aim: Option<Aim>,
    /// Whether the direction's primary numbers alone decide directions, where emitters have a way for that.
    by_direction: bool,
}

impl Scene {
    /// Where photons start, for an eye that sees these points, about which photons count within a radius each (scene units).
    #[must_use]
    pub fn sources(&self, points: &[(Vec3, f32)]) -> Sources {
        let as_they_shine = Sources {
            emitters: Arc::clone(&self.emitters),
            choice: self.emitter_choice.clone(),
            aim: None,
            by_direction: false,
        };
        let Some(balls) = balls_around(points) else { return as_they_shine };
        let decisive = balls[DECISIVE_BALL];
        if self.emitter_choice.is_empty() || decisive.radius * WIDE > self.bounds.radius() {
            return as_they_shine;
        }
        let aim = Aim::new(targets(&balls, self.casters, self.bounds.radius()));
        let arriving =
            self.emitters.iter().map(|e| f64::from(e.power().mean()) * f64::from(arrives(e, &decisive)));
        let arriving = Discrete::new(arriving);
        let count = self.emitters.iter().filter(|e| !e.power().is_black()).count() as f64;
        let choice = Discrete::new(self.emitters.iter().enumerate().map(|(i, e)| {
            let even = if e.power().is_black() { 0.0 } else { 1.0 / count };
            let arriving = if arriving.is_empty() { even } else { arriving.probability(i) };
            (1.0 - 2.0 * DEFENSIVE_SHARE) * arriving
                + DEFENSIVE_SHARE * self.emitter_choice.probability(i)
                + DEFENSIVE_SHARE * even
        }));
        Sources { choice, aim: Some(aim), ..as_they_shine }
    }
}

impl Sources {
    /// The same light, but spheres give their direction's primary numbers to directions in space, whatever point of them light leaves: what
    /// is found of those numbers then holds for the whole emitter. Balls that an emitter of that kind aims at are not aimed at.
    #[must_use]
    pub fn by_direction(self) -> Self {
        Self { by_direction: true, ..self }
    }

    /// Starts a photon from the emitter of that index by its primary numbers in [0, 1), as [`Emitter::emit`].
    #[must_use]
    #[inline]
    pub fn emit(&self, index: usize, u: PrimaryNumbers) -> Emission {
        let emitter = &self.emitters[index];
        let [part, x, y, across, along] = u;
        let (position, direction) = (Vec2::new(x, y), Vec2::new(across, along));
        if self.by_direction
            && let Some(emission) = emitter.emit_by_direction(position, direction)
        {
            return emission;
        }
        emitter.emit_aimed(self.aim.as_ref().unwrap_or(&emitter.aim), part, position, direction)
    }

    /// Which primary numbers make a difference to the photons of that emitter.
    #[must_use]
    pub fn uses(&self, index: usize) -> [bool; PRIMARY_NUMBERS] {
        let emitter = &self.emitters[index];
        let (parts, position, direction) = emitter.uses();
        let is_aimed = !self.aim.as_ref().unwrap_or(&emitter.aim).is_empty();
        let part = parts || emitter.is_at_infinity() && is_aimed;
        [part, position, position, direction, direction]
    }

    /// The chance of each emitter that can be chosen, with its index.
    pub fn choices(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let all = if self.choice.is_empty() { 0 } else { self.emitters.len() };
        (0..all).map(|i| (i, self.choice.probability(i))).filter(|&(_, chance)| chance > 0.0)
    }

    /// Whether photons are aimed at what is seen.
    #[must_use]
    pub const fn is_aimed(&self) -> bool {
        self.aim.is_some()
    }
}

/// Balls around the middle of the points that contain the shares [`SEEN`] of them; `None` without points.
fn balls_around(points: &[(Vec3, f32)]) -> Option<[Ball; SEEN.len()]> {
    let median = |axis: usize| {
        let mut of_axis: Vec<f32> = points.iter().map(|(p, _)| p[axis]).collect();
        let middle = of_axis.len() / 2;
        *of_axis.select_nth_unstable_by(middle, f32::total_cmp).1
    };
    if points.is_empty() {
        return None;
    }
    let centre = Vec3::new(median(0), median(1), median(2));
    let mut distances: Vec<f32> = points.iter().map(|(p, radius)| p.distance(centre) + radius).collect();
    distances.sort_unstable_by(f32::total_cmp);
    let radius = |share: f32| {
        let last = (share * distances.len() as f32).ceil() as usize;
        (distances[last.clamp(1, distances.len()) - 1] * MARGIN).max(f32::MIN_POSITIVE)
    };
    Some(SEEN.map(|share| Ball { centre, radius: radius(share) }))
}

/// What to aim at, and with which shares: such that photons are distributed over what is seen as its points are, and each pixel gets
/// its share.
fn targets(balls: &[Ball; SEEN.len()], casters: Option<Ball>, scene_radius: f32) -> Vec<Target> {
    // From the largest inwards: of balls of about one size it stands for all.
    let mut distinct: Vec<(Ball, f32)> = Vec::new();
    for (&ball, held) in balls.iter().zip(SEEN).rev() {
        if distinct.last().is_none_or(|(larger, _)| ball.radius * LARGER < larger.radius) {
            distinct.push((ball, held));
        }
    }
    distinct.reverse();
    let area = |i: usize| distinct[i].0.radius.powi(2);
    let density = |i: usize| match (i.checked_sub(1), distinct.get(i)) {
        (_, None) => 0.0,
        (None, Some((_, held))) => held / area(i),
        (Some(inner), Some((_, held))) => (held - distinct[inner].1) / (area(i) - area(inner)),
    };
    let weight = |i: usize| (area(i) * (density(i) - density(i + 1))).max(MIN_WEIGHT);
    let whole: f32 = (0..distinct.len()).map(weight).sum();
    let seen = distinct
        .iter()
        .enumerate()
        .map(|(i, &(ball, _))| Target { ball, share: AT_SEEN * weight(i) / whole });
    let all = balls[SEEN.len() - 1];
    let larger = |b: &Ball| Some(Ball { radius: GROWTH * b.radius, ..*b });
    let shells = std::iter::successors(larger(&all), larger).take_while(|ball| ball.radius < scene_radius);
    let share = BEYOND / (shells.clone().count() as f32).max(1.0);
    let casters = casters.map(|ball| Target { ball, share: AT_CASTERS });
    seen.chain(casters).chain(shells.map(|ball| Target { ball, share })).collect()
}

/// Approximately the share of an emitter's power that reaches a ball.
fn arrives(emitter: &Emitter, ball: &Ball) -> f32 {
    let from = |position: Vec3| (ball.radius / position.distance(ball.centre)).powi(2).min(1.0);
    let within =
        |position: Vec3, cone: f32| (from(position) / cone.sin().powi(2).max(f32::MIN_POSITIVE)).min(1.0);
    match &emitter.kind {
        Kind::Area(area) => from(area.middle()),
        Kind::Point(point) => from(point.position),
        Kind::Spot(spot) => within(spot.position, spot.cone.cutoff),
        Kind::Beam(beam) => within(beam.position, beam.reach()),
        Kind::Goniometric(lamp) => from(lamp.position),
        Kind::Constant(Constant { scene, .. })
        | Kind::Directional(Directional { scene, .. })
        | Kind::Environment(Environment { scene, .. }) => (ball.radius / scene.radius).powi(2),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn photons_fall_as_densely_as_points_lie() {
        // Three quarters of the points within 1, the rest evenly within 4: one ball of each.
        let ball = |radius| Ball { centre: Vec3::ZERO, radius };
        let balls = [ball(1.0), ball(3.7), ball(3.9), ball(4.0), ball(4.0)];
        let targets = targets(&balls, None, 100.0);
        let radii: Vec<f32> = targets.iter().map(|t| t.ball.radius).collect();
        assert_eq!(radii, [1.0, 4.0, 16.0, 64.0]);
        let per_area = |t: &Target| t.share / t.ball.radius.powi(2);
        let (inner, outer) = (per_area(&targets[0]) + per_area(&targets[1]), per_area(&targets[1]));
        assert!((inner / outer / (0.75 / (0.25 / 15.0)) - 1.0).abs() < 1e-3, "{inner} {outer}");
        let sum: f32 = targets.iter().map(|t| t.share).sum();
        assert!((sum - AT_SEEN - BEYOND).abs() < 1e-6, "{sum}");
    }

    #[test]
    fn balls_hold_their_shares_of_the_points_around_most_of_them() {
        // A ground seen to the horizon: a thousand points near, a few far off.
        let far = |i: u32| Vec3::X * 2f32.powf((i.leading_zeros() as f32 - 21.0) * 3.0);
        let points: Vec<(Vec3, f32)> = (0..1024u32).map(|i| (far(i), 1e-4)).collect();
        let balls = balls_around(&points).expect("points");
        for (ball, share) in balls.iter().zip(SEEN) {
            let within = points.iter().filter(|(p, r)| p.distance(ball.centre) + r <= ball.radius).count();
            assert!(within as f32 >= share * 1024.0, "{share}: {within}");
        }
        assert!(balls[0].radius < 1e-3 * balls[4].radius, "{balls:?}");
        assert_eq!(balls_around(&[]), None);
    }
}
