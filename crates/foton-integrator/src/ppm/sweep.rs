//! A batch of photons for all hit points: gathered packet by packet and, with the last batch of a pass, refined while a packet is at
//! hand. A pass in several batches leaves its sums in the slots until the last one.

use foton_transport::camera_paths::Gloss;
use foton_transport::photon_map::{Grid, LANES, Packet, PhotonMap};
use pulp::{Simd, WithSimd};
use rayon::prelude::*;

use super::gather::{collect, collect_gloss};
use super::hit_points::{HitPoints, Irradiance};
use super::refine::refine;
use super::rule::Rule;
use super::slots::{ClassTerm, EarlierBatches, Found, Slots};
use super::tally::Tally;
use crate::by_block::ByBlock;
use crate::error::SlotMoments;

/// What is gathered beside light: nothing, or what the error is estimated from and radii that adapt go by.
const NO_MOMENTS: bool = false;
const MOMENTS: bool = true;

/// Packets of one task.
const BLOCK: usize = 256;

/// The photons of a batch, and where they are found.
#[derive(Clone, Copy)]
pub(super) struct Photons<'a> {
    pub(super) map: &'a PhotonMap,
    pub(super) grid: &'a Grid,
}

/// Gathers the photons of a batch for all hit points. With the last batch of a pass they are refined, and `irradiance_slots`
/// hold the pass's estimates; before, they and the other slots hold sums.
///
/// `LAYERS` is 3 to sum caustic and indirect light beside all of it, or 1. `moment_slots` get what the bias is estimated from, where
/// there are any.
/// `earlier` has room where a pass has more than one batch. `tallies` get what each block counts; where the work was suspended, blocks
/// that have theirs are not gathered again.
pub(super) fn sweep<const LAYERS: usize>(
    hit_points: &mut HitPoints,
    photons: Photons<'_>,
    rule: Rule,
    irradiance_slots: &mut [Irradiance<LAYERS>],
    moment_slots: &mut [SlotMoments],
    earlier: &mut EarlierBatches,
    tallies: ByBlock<'_, Tally>,
) {
    if hit_points.radius_statistics_slots.is_empty() {
        sweep_with::<LAYERS, NO_MOMENTS>(
            hit_points,
            photons,
            rule,
            irradiance_slots,
            moment_slots,
            earlier,
            tallies,
        );
    } else {
        sweep_with::<LAYERS, MOMENTS>(
            hit_points,
            photons,
            rule,
            irradiance_slots,
            moment_slots,
            earlier,
            tallies,
        );
    }
}

fn sweep_with<const LAYERS: usize, const MOMENTS: bool>(
    hit_points: &mut HitPoints,
    photons: Photons<'_>,
    rule: Rule,
    irradiance_slots: &mut [Irradiance<LAYERS>],
    moment_slots: &mut [SlotMoments],
    earlier: &mut EarlierBatches,
    tallies: ByBlock<'_, Tally>,
) {
    let blocks = hit_points.packets.len().div_ceil(BLOCK);
    let moments = by_block(moment_slots, blocks);
    let (counts, discs) = (by_block(&mut earlier.counts, blocks), by_block(&mut earlier.discs, blocks));
    let radius_statistics = by_block(&mut hit_points.radius_statistics_slots, blocks);
    let shading = &hit_points.shading_normals;
    let (first_glossy, gloss_slots) = (hit_points.first_glossy, &hit_points.gloss_slots);
    hit_points
        .packets
        .par_chunks_mut(BLOCK)
        .zip(hit_points.statistics_slots.par_chunks_mut(BLOCK * LANES))
        .zip(hit_points.smallest2_slots.par_chunks(BLOCK * LANES))
        .zip(irradiance_slots.par_chunks_mut(BLOCK * LANES))
        .zip(moments)
        .zip(counts.into_par_iter().zip(discs))
        .zip(radius_statistics)
        .zip(tallies.places(blocks))
        .enumerate()
        .for_each(
            |(
                block,
                (
                    (
                        (((((packets, statistics), smallest2), irradiance), moments), (counts, discs)),
                        radius_statistics,
                    ),
                    tally,
                ),
            )| {
                let first = block * BLOCK;
                let slots =
                    Slots { statistics, smallest2, irradiance, moments, counts, discs, radius_statistics };
                let block = Block { first, first_glossy, packets, slots, shading, gloss_slots };
                tally.fill(|| rule.arch.dispatch(OfBlock::<LAYERS, MOMENTS> { block, photons, rule }));
            },
        );
}

/// Slots in the shares of blocks; empty shares of none.
fn by_block<T>(slots: &mut [T], blocks: usize) -> Vec<&mut [T]> {
    let mut shares = slots.chunks_mut(BLOCK * LANES);
    (0..blocks).map(|_| shares.next().unwrap_or_default()).collect()
}

/// The packets of one task, and all that belongs to them.
struct Block<'a, const LAYERS: usize> {
    /// Index of the first packet.
    first: usize,
    first_glossy: usize,
    packets: &'a mut [Packet],
    slots: Slots<'a, LAYERS>,
    shading: &'a [[[f32; LANES]; 3]],
    gloss_slots: &'a [Option<Gloss>],
}

/// The work on a block, compiled for each instruction set; the best that the machine has is taken. Everything that this calls
/// for each photon is inlined into it. No instruction set changes a result.
struct OfBlock<'a, const LAYERS: usize, const MOMENTS: bool> {
    block: Block<'a, LAYERS>,
    photons: Photons<'a>,
    rule: Rule,
}

impl<const LAYERS: usize, const MOMENTS: bool> WithSimd for OfBlock<'_, LAYERS, MOMENTS> {
    type Output = Tally;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Tally {
        let Self { block, photons: Photons { map, grid }, rule } = self;
        let mut tally = Tally::default();
        let mut runs = Vec::new();
        // On the heap: else the compiler takes the sums apart into registers of the wrong shapes.
        let mut found = Box::new(Found::<LAYERS>::NONE);
        let Block { first, first_glossy, packets, mut slots, shading, gloss_slots } = block;
        for (i, packet) in packets.iter_mut().enumerate() {
            let index = first + i;
            runs.clear();
            if !rule.batch.is_closing() {
                grid.for_each_run(&packet.bounds(), |first, end| runs.push((first, end)));
            }
            *found = Found::NONE;
            let term = ClassTerm::new(rule.question, packet);
            if let Some(glossy) = index.checked_sub(first_glossy) {
                let gloss = &gloss_slots[glossy * LANES..(glossy + 1) * LANES];
                for &(first, end) in &runs {
                    let photons = map.run(first, end);
                    collect_gloss::<LAYERS, MOMENTS>(packet, gloss, photons, &term, &mut found, &mut tally);
                }
            } else if let Some(normals) = shading.get(index) {
                for &(first, end) in &runs {
                    let photons = map.run(first, end);
                    collect::<LAYERS, true, MOMENTS>(packet, normals, photons, &term, &mut found, &mut tally);
                }
            } else {
                let normals = &[[0.0; LANES]; 3];
                for &(first, end) in &runs {
                    let photons = map.run(first, end);
                    collect::<LAYERS, false, MOMENTS>(
                        packet, normals, photons, &term, &mut found, &mut tally,
                    );
                }
            }
            let mut slots = slots.of_packet(i);
            if !rule.batch.is_first() {
                slots.add_earlier(&mut found);
            }
            if !rule.batch.is_last() {
                slots.store(&found);
                continue;
            }
            if MOMENTS {
                found.add_radius_statistics(packet, slots.radius_statistics);
            }
            found.write_moments(packet, rule.question, slots.moments);
            refine(packet, &found, slots, rule, &mut tally);
        }
        tally
    }
}
