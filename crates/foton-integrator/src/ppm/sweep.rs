//! A batch of photons for all hit points: gathered packet by packet and, with the last batch of a pass, refined while a packet is at
//! hand. A pass in several batches leaves its sums in the entries until the last one. Packets that no photon is near are passed over.

use foton_math::Aabb;
use foton_transport::camera_paths::Gloss;
use foton_transport::photon_map::{Grid, LANES, Packet, Photon, PhotonMap};
use pulp::{Simd, WithSimd};
use rayon::prelude::*;

use super::arrived::{Arrived, Lanes};
use super::gather::{collect, collect_gloss};
use super::hit_points::{BLOCK, HitPoints};
use super::refine::refine;
use super::rule::Rule;
use super::slots::{ClassTerm, Found, Slots};
use super::tally::Tally;
use crate::by_block::ByBlock;

/// What is gathered beside light: nothing, or what the error is estimated from and radii that adapt go by.
const NO_MOMENTS: bool = false;
const MOMENTS: bool = true;

/// The photons of a batch, and where they are found.
#[derive(Clone, Copy)]
pub(super) struct Photons<'a> {
    pub(super) map: &'a PhotonMap,
    pub(super) grid: &'a Grid,
}

/// Gathers the photons of a batch for all hit points. With the last batch of a pass they are refined, and `arrived` holds the pass's
/// estimates; before, it holds sums.
///
/// `LAYERS` is 3 to sum caustic and indirect light beside all of it, or 1. `tallies` get what each block counts; where the work was
/// suspended, blocks that have theirs are not gathered again.
pub(super) fn sweep<const LAYERS: usize>(
    hit_points: &mut HitPoints,
    photons: Photons<'_>,
    rule: Rule,
    arrived: &mut Arrived<LAYERS>,
    tallies: ByBlock<'_, Tally>,
) {
    if hit_points.radius_statistics_slots.is_empty() {
        sweep_with::<LAYERS, NO_MOMENTS>(hit_points, photons, rule, arrived, tallies);
    } else {
        sweep_with::<LAYERS, MOMENTS>(hit_points, photons, rule, arrived, tallies);
    }
}

fn sweep_with<const LAYERS: usize, const MOMENTS: bool>(
    hit_points: &mut HitPoints,
    photons: Photons<'_>,
    rule: Rule,
    arrived: &mut Arrived<LAYERS>,
    tallies: ByBlock<'_, Tally>,
) {
    let blocks = hit_points.packets.len().div_ceil(BLOCK);
    let radius_statistics = by_block(&mut hit_points.radius_statistics_slots, blocks);
    let shading = &hit_points.shading_normals;
    let (first_glossy, gloss_slots) = (hit_points.first_glossy, &hit_points.gloss_slots);
    let kept = hit_points.statistics_slots.par_chunks_mut(BLOCK * LANES);
    let kept = kept.zip(hit_points.smallest2_slots.par_chunks(BLOCK * LANES)).zip(radius_statistics);
    let brought = arrived.lanes.par_chunks_mut(BLOCK).zip(&mut arrived.blocks);
    hit_points
        .packets
        .par_chunks_mut(BLOCK)
        .zip(hit_points.bounds.par_chunks_mut(BLOCK))
        .zip(kept)
        .zip(brought.zip(&mut hit_points.block_sums))
        .zip(tallies.places(blocks))
        .enumerate()
        .for_each(|(block, ((((packets, bounds), kept), ((lanes, entries), sums)), tally))| {
            let ((statistics, smallest2), radius_statistics) = kept;
            let slots = Slots { statistics, smallest2, radius_statistics, lanes, entries, sums };
            let first = block * BLOCK;
            let block = Block { first, first_glossy, packets, bounds, slots, shading, gloss_slots };
            tally.fill(|| rule.arch.dispatch(OfBlock::<LAYERS, MOMENTS> { block, photons, rule }));
        });
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
    bounds: &'a mut [Aabb],
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
        let Block { first, first_glossy, packets, bounds, mut slots, shading, gloss_slots } = block;
        let earlier = slots.entries.begin();
        let has_photons = !rule.batch.is_closing() && !map.photons().is_empty();
        for (i, (packet, bounds)) in packets.iter_mut().zip(bounds).enumerate() {
            let index = first + i;
            runs.clear();
            if has_photons {
                grid.for_each_run(bounds, |first, end| {
                    let photons = map.run(first, end);
                    if !photons.is_empty() {
                        runs.push(photons);
                    }
                });
            }
            let before = if rule.batch.is_first() { Lanes::default() } else { slots.lanes[i] };
            slots.lanes[i] = Lanes::default();
            if runs.is_empty() && before.is_none() && rule.common.is_none() {
                continue;
            }
            *found = Found::NONE;
            let term = ClassTerm::new(rule.question, packet);
            let how = Weighing { index, first_glossy, shading, gloss_slots, term: &term };
            collect_runs::<LAYERS, MOMENTS>(packet, &how, &runs, &mut found, &mut tally);
            for (l, place) in before.each() {
                found.add_earlier(l, &earlier[place]);
            }
            slots.lanes[i] = slots.entries.next(found.lanes());
            if !rule.batch.is_last() {
                let sums = slots.lanes[i].each().map(|(l, _)| found.batch_sums(l));
                slots.entries.sums.extend(sums);
                continue;
            }
            if MOMENTS {
                let of_packet = i * LANES..(i + 1) * LANES;
                found.add_radius_statistics(packet, &mut slots.radius_statistics[of_packet]);
            }
            if refine((i, packet), &found, &mut slots, rule, &mut tally) {
                *bounds = packet.bounds();
            }
        }
        slots.entries.end();
        if rule.batch.is_last() {
            (tally.unknown, tally.radius2) = (slots.sums.unknown, slots.sums.radius2);
        }
        tally
    }
}

/// How the hit points of a packet weigh photons.
struct Weighing<'a> {
    /// Of the packet.
    index: usize,
    first_glossy: usize,
    shading: &'a [[[f32; LANES]; 3]],
    gloss_slots: &'a [Option<Gloss>],
    term: &'a ClassTerm,
}

/// Sums the photons of all runs of cells that a packet touches.
#[inline(always)]
fn collect_runs<const LAYERS: usize, const MOMENTS: bool>(
    packet: &Packet,
    how: &Weighing<'_>,
    runs: &[&[Photon]],
    found: &mut Found<LAYERS>,
    tally: &mut Tally,
) {
    let &Weighing { index, first_glossy, shading, gloss_slots, term } = how;
    if let Some(glossy) = index.checked_sub(first_glossy) {
        let gloss = &gloss_slots[glossy * LANES..(glossy + 1) * LANES];
        for photons in runs {
            collect_gloss::<LAYERS, MOMENTS>(packet, gloss, photons, term, found, tally);
        }
    } else if let Some(normals) = shading.get(index) {
        for photons in runs {
            collect::<LAYERS, true, MOMENTS>(packet, normals, photons, term, found, tally);
        }
    } else {
        let normals = &[[0.0; LANES]; 3];
        for photons in runs {
            collect::<LAYERS, false, MOMENTS>(packet, normals, photons, term, found, tally);
        }
    }
}
