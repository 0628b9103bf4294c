//! Which emitters shadow rays go to: to those of a single point or direction once and for all, to each of few others, and of many
//! to some that are chosen by what they can give.

use foton_math::glam::Vec2;
use foton_math::sobol;
use foton_scene::Scene;

use super::arrival::{Arrival, Receiver, arrival};
use super::tree::LightTree;

/// Up to this many emitters of a single point are sampled once and for all; more are chosen among.
const MAX_FIXED: usize = 16;

/// Up to this many other emitters each get a ray.
const MAX_EACH: usize = 4;

/// Rays to emitters of the tree, each to one quarter of what it can give.
const PICKS: u32 = 4;

/// Scrambles that samples need: for each emitter one, and one for those that are chosen.
pub const SCRAMBLES: usize = MAX_EACH + 1;

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
        let (delta, mut each): (Vec<u32>, Vec<u32>) = all.partition(|&i| emitters[i as usize].is_delta());
        let is_far = |i: u32| emitters[i as usize].extent().is_none();
        let (fixed, chosen): (Vec<u32>, Vec<u32>) =
            delta.iter().partition(|&&i| delta.len() <= MAX_FIXED || is_far(i));
        each.extend(chosen);
        let (each, near): (Vec<u32>, Vec<u32>) = if each.len() <= MAX_EACH {
            (each, Vec::new())
        } else {
            each.into_iter().partition(|&i| is_far(i))
        };
        let tree = LightTree::new(
            near.into_iter().filter_map(|i| Some((i, emitters[i as usize].extent()?))).collect(),
        );
        Self { fixed, each, tree }
    }

    /// Rays that [`Lights::sample`] takes at most.
    #[must_use]
    pub fn rays(&self) -> u32 {
        self.each.len() as u32 + if self.tree.is_empty() { 0 } else { PICKS }
    }

    /// Rays that [`Lights::fixed`] takes at most.
    #[must_use]
    pub const fn fixed_rays(&self) -> u32 {
        self.fixed.len() as u32
    }

    /// Light of emitters of a single point or direction: all of it, without noise.
    pub fn fixed(&self, scene: &Scene, at: &Receiver, rays: &mut u64, mut add: impl FnMut(Arrival)) {
        let of = |&emitter: &u32| arrival(scene, at, emitter, (0.0, Vec2::ZERO), rays);
        self.fixed.iter().filter_map(of).for_each(&mut add);
    }

    /// Light of the others, sampled by the point of that index of a sequence for each scramble: its mean over the points is all of it.
    pub fn sample(
        &self,
        scene: &Scene,
        at: &Receiver,
        (index, scrambles): (u32, &[Scramble; SCRAMBLES]),
        rays: &mut u64,
        mut add: impl FnMut(Arrival),
    ) {
        for (i, &emitter) in self.each.iter().enumerate() {
            let [x, y, _, part] = sobol::point(index, scrambles[i % MAX_EACH]).map(sobol::unit);
            arrival(scene, at, emitter, (part, Vec2::new(x, y)), rays).into_iter().for_each(&mut add);
        }
        if self.tree.is_empty() {
            return;
        }
        for pick in 0..PICKS {
            let point = sobol::point(index.wrapping_mul(PICKS).wrapping_add(pick), scrambles[MAX_EACH]);
            let choice = f64::from(point[2]) / (1u64 << 32) as f64;
            let Some((emitter, probability)) = self.tree.choose(at, choice) else { continue };
            let [x, y, _, part] = point.map(sobol::unit);
            if let Some(found) = arrival(scene, at, emitter, (part, Vec2::new(x, y)), rays) {
                let irradiance = found.irradiance / (probability * f64::from(PICKS)) as f32;
                add(Arrival { irradiance, ..found });
            }
        }
    }
}
