//! Which emitters shadow rays go to: to those of a single point or direction once and for all, to each that is infinitely far away,
//! and of the others to one that is chosen by what it can give. A ray to each of three lamps was measured, too: it takes three times
//! as long until all is lit, and then direct light has a thirtieth of the error of the rest.

use foton_math::glam::Vec2;
use foton_math::sobol;
use foton_scene::Scene;

use super::arrival::{Arrival, Receiver, arrival_if};
use super::tree::LightTree;

/// Up to this many emitters of a single point are sampled once and for all; more are chosen among.
const MAX_FIXED: usize = 16;

/// Scrambles that samples need: one for emitters that are chosen, and some for those that each get a ray.
pub const SCRAMBLES: usize = 4;

/// Digits of a Sobol' sequence that are flipped.
pub type Scramble = [u32; sobol::DIMENSIONS];

/// The emitters of a scene by how shadow rays go to them, as indices.
#[derive(Clone, Debug, Default)]
pub struct Lights {
    fixed: Vec<u32>,
    each: Vec<u32>,
    tree: LightTree,
}

impl Lights {
    /// Those of a scene.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let emitters = scene.emitters();
        let shines = |i: &u32| scene.emitter_share(*i as usize) > 0.0;
        let all = (0..emitters.len() as u32).filter(shines);
        let (delta, mut others): (Vec<u32>, Vec<u32>) = all.partition(|&i| emitters[i as usize].is_delta());
        let is_far = |i: u32| emitters[i as usize].extent().is_none();
        let (fixed, chosen): (Vec<u32>, Vec<u32>) =
            delta.iter().partition(|&&i| delta.len() <= MAX_FIXED || is_far(i));
        others.extend(chosen);
        let (each, near): (Vec<u32>, Vec<u32>) = others.into_iter().partition(|&i| is_far(i));
        let tree = LightTree::new(
            near.into_iter().filter_map(|i| Some((i, emitters[i as usize].extent()?))).collect(),
        );
        Self { fixed, each, tree }
    }

    /// Rays that [`Lights::sample`] takes at most.
    #[must_use]
    pub fn rays(&self) -> u32 {
        self.each.len() as u32 + u32::from(!self.tree.is_empty())
    }

    /// Rays that [`Lights::fixed`] takes at most.
    #[must_use]
    pub const fn fixed_rays(&self) -> u32 {
        self.fixed.len() as u32
    }

    /// The probability with which [`Lights::sample`] sends a ray to an emitter: for paths that find it without.
    #[must_use]
    pub fn probability(&self, at: &Receiver, emitter: u32) -> f64 {
        if self.each.contains(&emitter) { 1.0 } else { self.tree.probability(emitter, at) }
    }

    /// Light of emitters of a single point or direction: all of it, without noise.
    pub fn fixed(&self, scene: &Scene, at: &Receiver, rays: &mut u64, add: impl FnMut(Arrival)) {
        self.fixed_where(scene, at, |_| None, rays, add);
    }

    /// The same where `sees` may know of an emitter, by its index, that the point sees all or nothing of it: that takes no ray.
    pub fn fixed_where(
        &self,
        scene: &Scene,
        at: &Receiver,
        sees: impl Fn(u32) -> Option<bool>,
        rays: &mut u64,
        mut add: impl FnMut(Arrival),
    ) {
        let of = |&emitter: &u32| arrival_if(scene, at, emitter, (0.0, Vec2::ZERO), sees(emitter), rays);
        self.fixed.iter().filter_map(of).for_each(&mut add);
    }

    /// Light of the others, sampled by the point of that index of a sequence for each scramble: its mean over the points is all of it.
    pub fn sample(
        &self,
        scene: &Scene,
        at: &Receiver,
        point: (u32, &[Scramble; SCRAMBLES]),
        rays: &mut u64,
        add: impl FnMut(Arrival),
    ) {
        self.sample_where(scene, at, point, |_| None, rays, add);
    }

    /// The same where `sees` may know of an emitter, by its index, that the point sees all or nothing of it: that takes no ray.
    pub fn sample_where(
        &self,
        scene: &Scene,
        at: &Receiver,
        (index, scrambles): (u32, &[Scramble; SCRAMBLES]),
        sees: impl Fn(u32) -> Option<bool>,
        rays: &mut u64,
        mut add: impl FnMut(Arrival),
    ) {
        for (i, &emitter) in self.each.iter().enumerate() {
            let [x, y, _, part] = sobol::point(index, scrambles[1 + i % (SCRAMBLES - 1)]).map(sobol::unit);
            let u = (part, Vec2::new(x, y));
            arrival_if(scene, at, emitter, u, sees(emitter), rays).into_iter().for_each(&mut add);
        }
        if self.tree.is_empty() {
            return;
        }
        let point = sobol::point(index, scrambles[0]);
        let choice = f64::from(point[2]) / (1u64 << 32) as f64;
        let Some((emitter, probability)) = self.tree.choose(at, choice) else { return };
        let [x, y, _, part] = point.map(sobol::unit);
        let u = (part, Vec2::new(x, y));
        if let Some(found) = arrival_if(scene, at, emitter, u, sees(emitter), rays) {
            let probability = probability as f32;
            add(Arrival {
                irradiance: found.irradiance / probability,
                pdf: found.pdf * probability,
                ..found
            });
        }
    }
}
