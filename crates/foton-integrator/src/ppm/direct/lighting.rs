//! Lighting pixels: shadow rays from all hit points of each.

use std::ops::Range;

use foton_math::sobol::reordered;
use foton_math::{Purpose, Rgb, Stream};
use foton_scene::Scene;
use foton_transport::direct_light::{Arrival, Lights, Receiver, SCRAMBLES, Scramble};
use foton_transport::photon_map::LANES;
use foton_transport::{LeftOut, Quantity, Surface};
use rayon::prelude::*;

use super::lit::Lit;
use super::order::Order;
use crate::by_block::ByBlock;
use crate::ppm::hit_points::HitPoints;

/// Places of one task.
const BLOCK: usize = 64;

/// What it takes to light the pixels that some hit points belong to.
#[derive(Clone, Copy)]
pub(crate) struct Lighting<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) hit_points: &'a HitPoints,
    pub(crate) lights: &'a Lights,
    /// Eye samples a pixel.
    pub(crate) samples: u32,
    pub(crate) seed: u64,
}

impl Lighting<'_> {
    /// Lights the pixels whose turn it is. Where the work was suspended, blocks that are done are not lit again.
    pub(crate) fn light(&self, order: &Order, turns: &Range<u64>, by_block: ByBlock<'_, Lit>) {
        let blocks = (turns.end - turns.start).div_ceil(BLOCK as u64) as usize;
        by_block.places(blocks).enumerate().for_each(|(block, place)| {
            let first = turns.start + (block * BLOCK) as u64;
            place.fill(|| self.block(order, first..turns.end.min(first + BLOCK as u64)));
        });
    }

    fn block(&self, order: &Order, turns: Range<u64>) -> Lit {
        let all = order.places();
        let mut lit = Lit::with_room_for(BLOCK, if turns.start < all { BLOCK } else { 0 });
        for turn in turns {
            let pixel = order.pixel(turn);
            let light = pixel.map_or(Rgb::BLACK, |pixel| self.visit(pixel, (turn / all) as u32, &mut lit));
            lit.light.push(light);
            if turn < all {
                let fixed = pixel.map_or(Rgb::BLACK, |pixel| self.fixed(pixel, &mut lit));
                lit.fixed.push(fixed);
            }
        }
        lit
    }

    /// One estimate of a pixel's light, after `before` others.
    fn visit(&self, pixel: usize, before: u32, lit: &mut Lit) -> Rgb {
        if self.lights.rays() == 0 {
            return Rgb::BLACK;
        }
        let (sequence, turn) = (before % 2, before / 2);
        let (scrambles, stream) = self.scrambles(u64::from(sequence), pixel);
        // Hit points take the points of the sequence in turns, and not always the same ones of each row.
        let row = self.hit_points.of_pixel(pixel).len().next_power_of_two() as u32;
        let swap = stream.from_dimension(u64::from(turn)).next_bits() & (row - 1);
        self.sum(pixel, lit, |point, at, rays, add| {
            let index = turn.wrapping_mul(row).wrapping_add(point ^ swap);
            self.lights.sample(self.scene, at, (index, &scrambles), rays, add);
        })
    }

    /// A pixel's light that is the same each time.
    fn fixed(&self, pixel: usize, lit: &mut Lit) -> Rgb {
        self.sum(pixel, lit, |_, at, rays, add| self.lights.fixed(self.scene, at, rays, add))
    }

    /// All light of a pixel whose hit points are new in the pass after so many others.
    pub(crate) fn anew(&self, pixel: usize, pass: u64, lit: &mut Lit) -> Rgb {
        let fixed = self.fixed(pixel, lit);
        if self.lights.rays() == 0 {
            return fixed;
        }
        // As eye samples do, passes take turns with two sequences; samples take the points of a row of one, and where they have more
        // hit points those take rows of others. In another order than the places of eye samples, on which the light would depend.
        let (sequence, turn) = (pass % 2, (pass / 2) as u32);
        let row = self.samples.next_power_of_two();
        let sampled = self.sum(pixel, lit, |point, at, rays, add| {
            let (scrambles, mut stream) = self.scrambles(u64::from(point / row) << 1 | sequence, pixel);
            let index = turn.wrapping_mul(row).wrapping_add(point % row);
            let index = reordered(index, stream.next_bits());
            self.lights.sample(self.scene, at, (index, &scrambles), rays, add);
        });
        fixed + sampled
    }

    /// The scrambles of one of a pixel's sequences, and its stream after them.
    fn scrambles(&self, sequence: u64, pixel: usize) -> ([Scramble; SCRAMBLES], Stream) {
        let mut stream = Stream::new(self.seed, Purpose::ShadowRay, sequence, pixel as u64);
        let scrambles = std::array::from_fn(|_| std::array::from_fn(|_| stream.next_bits()));
        (scrambles, stream)
    }

    /// The mean over a pixel's samples of what arrives at its hit points, which are counted for `arrivals`.
    fn sum(
        &self,
        pixel: usize,
        lit: &mut Lit,
        arrivals: impl Fn(u32, &Receiver, &mut u64, &mut dyn FnMut(Arrival)),
    ) -> Rgb {
        let hit_points = self.hit_points;
        let Lit { rays, omissions, .. } = lit;
        let mut sum = Rgb::BLACK;
        for (point, h) in hit_points.of_pixel(pixel).enumerate() {
            let slot = hit_points.slot_of[h] as usize;
            // A path of two edges: one to the hit point, one to the emitter.
            let edges = u32::from(hit_points.packets[slot / LANES].remaining_edges[slot % LANES]);
            let gloss = hit_points.gloss(slot);
            if edges < 1 || gloss.is_some_and(|g| g.specular) {
                continue;
            }
            let (origin, normal) = hit_points.shadow_origin(slot);
            let at = Receiver { origin, normal, edges };
            let mut add = |Arrival { irradiance, from, emitter, .. }: Arrival| {
                let value = gloss.map_or(Rgb::WHITE, |g| g.eval(from));
                let term = hit_points.weights[h] * value * irradiance;
                // A point light that lies on the surface is infinitely bright there.
                if term.is_finite() {
                    sum += term;
                } else {
                    omissions.add(LeftOut {
                        quantity: Quantity::DirectLight,
                        light: Some(emitter),
                        surface: Surface::Below(at.normal),
                        position: at.origin,
                    });
                }
            };
            arrivals(point as u32, &at, rays, &mut add);
        }
        let mean = sum / self.samples as f32;
        if mean.is_finite() { mean } else { Rgb::BLACK }
    }
}
