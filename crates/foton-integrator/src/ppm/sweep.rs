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
use super::shading_normals::ShadingNormals;
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
    if hit_points.radius_statistics.is_empty() {
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
    let first_place = &hit_points.first_place;
    let statistics = by_block(&mut hit_points.statistics, first_place);
    let radius_statistics = by_block(&mut hit_points.radius_statistics, first_place);
    let shading = &hit_points.shading;
    let (first_glossy, gloss) = (hit_points.first_glossy, &hit_points.gloss[..]);
    let first_gloss = first_place[first_glossy] as usize;
    let smallest2 = &hit_points.smallest2[..];
    let kept = statistics.into_par_iter().zip(radius_statistics);
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
            let (statistics, radius_statistics) = kept;
            let first = block * BLOCK;
            let slots = Slots {
                first_place: &first_place[first..=first + packets.len()],
                statistics,
                smallest2,
                radius_statistics,
                lanes,
                entries,
                sums,
            };
            let block = Block { first, first_glossy, first_gloss, packets, bounds, slots, shading, gloss };
            tally.fill(|| rule.arch.dispatch(OfBlock::<LAYERS, MOMENTS> { block, photons, rule }));
        });
}

/// Values by place in the shares of blocks; empty shares of none.
fn by_block<'a, T>(values: &'a mut [T], first_place: &[u32]) -> Vec<&'a mut [T]> {
    let mut rest = values;
    let packets = first_place.len() - 1;
    (0..packets.div_ceil(BLOCK))
        .map(|block| {
            let [first, end] = [block, block + 1].map(|b| first_place[packets.min(b * BLOCK)] as usize);
            let length = rest.len().min(end - first);
            let (share, others) = std::mem::take(&mut rest).split_at_mut(length);
            rest = others;
            share
        })
        .collect()
}

/// The packets of one task, and all that belongs to them.
struct Block<'a, const LAYERS: usize> {
    /// Index of the first packet.
    first: usize,
    first_glossy: usize,
    /// The place of the first hit point that is not Lambertian.
    first_gloss: usize,
    packets: &'a mut [Packet],
    bounds: &'a mut [Aabb],
    slots: Slots<'a, LAYERS>,
    shading: &'a ShadingNormals,
    gloss: &'a [Gloss],
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
        let Block { first, first_glossy, first_gloss, packets, bounds, mut slots, shading, gloss } = block;
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
            let places = slots.places(i);
            let glossy = index.checked_sub(first_glossy).map(|_| {
                let first = slots.first_place[i] as usize - first_gloss;
                &gloss[first..first + places.len()]
            });
            let how = Weighing { index, shading, glossy, term: &term };
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
                found.add_radius_statistics(packet, &mut slots.radius_statistics[places]);
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
    shading: &'a ShadingNormals,
    /// Of its hit points, where they are not Lambertian.
    glossy: Option<&'a [Gloss]>,
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
    let &Weighing { index, shading, glossy, term } = how;
    let packet = (packet, &packet.tests());
    if let Some(gloss) = glossy {
        for photons in runs {
            collect_gloss::<LAYERS, MOMENTS>(packet, gloss, photons, term, found, tally);
        }
    } else if !shading.is_empty() {
        let normals = shading.of(index).unwrap_or(&packet.0.normal);
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
