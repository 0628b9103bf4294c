//! Direct light by shadow rays: one a hit point and pass, to an emitter chosen by power.
//!
//! What lies in between blocks, but for surfaces that light passes straight through: thin glass, masks, nothing. Those weigh it,
//! and photons that passed nothing else are direct light, too. Light that is bent on its way comes as photons.

use foton_math::{Purpose, Rgb, Stream};
use foton_scene::Scene;
use foton_transport::direct_light::estimate;
use foton_transport::photon_map::LANES;
use foton_transport::{LeftOut, Omissions, Quantity, Surface};
use rayon::prelude::*;

use super::by_block::ByBlock;
use super::hit_points::{HitPoints, Irradiance};

/// Slots of one task.
const BLOCK: usize = 256 * LANES;

/// What the random numbers and the weights of a pass's shadow rays go by.
#[derive(Clone, Copy)]
pub(crate) struct PassKey {
    pub(crate) seed: u64,
    /// Passes before this one.
    pub(crate) pass: u64,
    /// Photons of this pass.
    pub(crate) photons: u64,
}

/// Adds this pass's estimate of direct irradiance, times `photons` so that it can join sums that are divided by the number of
/// photons. `by_block` gets the number of rays, and what was left out because it was not finite; where the work was suspended, blocks
/// that have theirs are not lit again.
pub(crate) fn add<const LAYERS: usize>(
    scene: &Scene,
    hit_points: &HitPoints,
    irradiance_slots: &mut [Irradiance<LAYERS>],
    PassKey { seed, pass, photons }: PassKey,
    by_block: ByBlock<'_, (u64, Omissions)>,
) {
    let places = by_block.places(irradiance_slots.len().div_ceil(BLOCK));
    let blocks = irradiance_slots.par_chunks_mut(BLOCK).zip(places).enumerate();
    blocks.for_each(|(block, (irradiance, place))| {
        place.fill(|| {
            let (mut rays, mut omissions) = (0, Omissions::default());
            for (i, irradiance) in irradiance.iter_mut().enumerate() {
                let slot = block * BLOCK + i;
                let packet = &hit_points.packets[slot / LANES];
                // A path of two edges: one to the hit point, one to the emitter.
                if packet.radius2[slot % LANES] < 0.0 || packet.remaining_edges[slot % LANES] < 1 {
                    continue;
                }
                let mut stream = Stream::new(seed, Purpose::ShadowRay, pass, slot as u64);
                if hit_points.gloss(slot).is_some_and(|g| g.specular) {
                    continue;
                }
                let at = &hit_points.shadow_slots[slot];
                let remaining_edges = packet.remaining_edges[slot % LANES] as u32;
                if let Some((light, from)) =
                    estimate(scene, (at.origin, at.shading_normal), remaining_edges, &mut stream, &mut rays)
                {
                    let value = hit_points.gloss(slot).map_or(Rgb::WHITE, |g| g.eval(from));
                    let term = light * value * photons as f32;
                    // A point light that lies on the surface is infinitely bright there.
                    if term.is_finite() {
                        irradiance[0] += term;
                    } else {
                        let mut stream = Stream::new(seed, Purpose::ShadowRay, pass, slot as u64);
                        let light = scene.choose_emitter(f64::from(stream.next_1d()));
                        omissions.add(LeftOut {
                            quantity: Quantity::DirectLight,
                            light: light.map(|(emitter, _)| emitter as u32),
                            surface: Surface::Below(at.shading_normal),
                            position: at.origin,
                        });
                    }
                }
            }
            (rays, omissions)
        });
    });
}
