//! Photons to hit points: which count, what light they bring, and the refinement that follows, fused. A pass in several batches
//! leaves its sums in the slots until the last one.
//!
//! One photon at a time is tested against the sixteen hit points of a packet. Sums run in the order of the sorted photons,
//! multiplication and addition apart, so the bits are the same for any number of threads and any instruction set.
#![allow(clippy::needless_range_loop, reason = "rows of lanes advance together; indices are what vectorises")]

use std::f32::consts::PI;
use std::ops::AddAssign;

use foton_math::Rgb;
use foton_math::glam::Vec3;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::batch::Batch;
use crate::error::Question;
use crate::grid::Grid;
use crate::hit_point::{Gloss, HitPoints, Irradiance};
use crate::not_finite::{Omissions, Quantity};
use crate::packet::{LANES, Packet};
use crate::photon::Photon;
use crate::photon_map::PhotonMap;
use crate::photon_pass::SMALLEST_COSINE;
use crate::settings::Alpha;
use crate::slots::{Asked, Found, Kept, Slots};

/// A photon counts only where its surface faces about the same way: the cosine between the normals must exceed this.
const SMALLEST_NORMAL_COSINE: f32 = 0.1;

/// What is gathered beside light: nothing, or what the error is estimated from and radii that adapt go by.
pub(crate) const NO_MOMENTS: bool = false;
pub(crate) const MOMENTS: bool = true;

/// Packets that one task looks after.
const BLOCK: usize = 256;

/// What a gather did, summed over hit points.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    /// Photon–packet tests.
    pub(crate) candidates: u64,
    /// Photon–hit-point pairs that counted.
    pub(crate) accepted: u64,
    /// Hit points that no pass has found a photon for.
    pub(crate) unknown: u64,
    /// Hit points whose radius is at its floor.
    pub(crate) floored: u64,
    /// Photon–hit-point pairs, and sums of those, whose light was not a finite number, and that were left out of all sums but the
    /// count.
    pub(crate) omissions: Omissions,
    /// Sum of r² in square scene units.
    pub(crate) radius2: f64,
}

impl Tally {
    /// Counts a value at a lane that was not finite, and notes its place if it is the first.
    #[cold]
    #[inline(never)]
    fn leave_out(&mut self, quantity: Quantity, packet: &Packet, l: usize) {
        self.omissions.add(packet.left_out(quantity, l));
    }
}

/// How a pass is gathered.
#[derive(Clone, Copy)]
pub(crate) struct Rule {
    pub(crate) alpha: Alpha,
    /// Whether it goes by what is known of bias.
    pub(crate) adapts: bool,
    /// What all r² are multiplied by, where they shrink together.
    pub(crate) common: Option<f64>,
    pub(crate) batch: Batch,
    /// What the error asks of one class.
    pub(crate) question: Question,
    pub(crate) arch: Arch,
}

impl AddAssign for Tally {
    fn add_assign(&mut self, o: Self) {
        self.candidates += o.candidates;
        self.accepted += o.accepted;
        self.unknown += o.unknown;
        self.floored += o.floored;
        self.omissions = self.omissions.followed_by(o.omissions);
        self.radius2 += o.radius2;
    }
}

/// Gathers the photons of a batch for all hit points. With the last batch of a pass they are refined, and `irradiance_slots`
/// hold the pass's estimates; before, they and the other slots hold sums.
///
/// `LAYERS` is 3 to keep path classes apart, or 1. With `MOMENTS`, `moment_slots` get what the bias is estimated from, where
/// there are any. `kept` has room where a pass has more than one batch.
pub(crate) fn all<const LAYERS: usize, const MOMENTS: bool>(
    hit_points: &mut HitPoints,
    map: &PhotonMap,
    grid: &Grid,
    rule: Rule,
    irradiance_slots: &mut [Irradiance<LAYERS>],
    moment_slots: &mut [[f32; 2]],
    kept: &mut Kept,
) -> Tally {
    let blocks = hit_points.packets.len().div_ceil(BLOCK);
    let moments = by_block(moment_slots, blocks);
    let (counts, shapes) = (by_block(&mut kept.counts, blocks), by_block(&mut kept.shapes, blocks));
    let evidence = by_block(&mut hit_points.evidence_slots, blocks);
    let shading = &hit_points.shading_normals;
    let (first_glossy, gloss_slots) = (hit_points.first_glossy, &hit_points.gloss_slots);
    let tallies: Vec<Tally> = hit_points
        .packets
        .par_chunks_mut(BLOCK)
        .zip(hit_points.statistics_slots.par_chunks_mut(BLOCK * LANES))
        .zip(hit_points.smallest2_slots.par_chunks(BLOCK * LANES))
        .zip(irradiance_slots.par_chunks_mut(BLOCK * LANES))
        .zip(moments)
        .zip(counts.into_par_iter().zip(shapes))
        .zip(evidence)
        .enumerate()
        .map(
            |(
                block,
                ((((((packets, statistics), smallest2), irradiance), moments), (counts, shapes)), evidence),
            )| {
                let first = block * BLOCK;
                let slots = Slots { statistics, smallest2, irradiance, moments, counts, shapes, evidence };
                let block = Block { first, first_glossy, packets, slots, shading, gloss_slots };
                rule.arch.dispatch(Gather::<LAYERS, MOMENTS> { block, map, grid, rule })
            },
        )
        .collect();
    let mut tally = Tally::default();
    tallies.into_iter().for_each(|t| tally += t);
    tally
}

/// Slots in the shares of blocks; empty shares of none.
fn by_block<T>(slots: &mut [T], blocks: usize) -> Vec<&mut [T]> {
    let mut shares = slots.chunks_mut(BLOCK * LANES);
    (0..blocks).map(|_| shares.next().unwrap_or_default()).collect()
}

/// Packets that one task looks after, and all that belongs to them.
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
struct Gather<'a, const LAYERS: usize, const MOMENTS: bool> {
    block: Block<'a, LAYERS>,
    map: &'a PhotonMap,
    grid: &'a Grid,
    rule: Rule,
}

impl<const LAYERS: usize, const MOMENTS: bool> WithSimd for Gather<'_, LAYERS, MOMENTS> {
    type Output = Tally;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Tally {
        let Self { block, map, grid, rule } = self;
        let mut tally = Tally::default();
        let mut runs = Vec::new();
        // On the heap: else the compiler takes the sums apart into registers of the wrong shapes.
        let mut found = Box::new(Found::<LAYERS>::NONE);
        let Block { first, first_glossy, packets, mut slots, shading, gloss_slots } = block;
        for (i, packet) in packets.iter_mut().enumerate() {
            let index = first + i;
            runs.clear();
            grid.for_each_run(&packet.bounds(), |first, end| runs.push((first, end)));
            *found = Found::NONE;
            let asked = Asked::new(rule.question, packet);
            if let Some(glossy) = index.checked_sub(first_glossy) {
                let gloss = &gloss_slots[glossy * LANES..(glossy + 1) * LANES];
                for &(first, end) in &runs {
                    let photons = map.run(first, end);
                    collect_gloss::<LAYERS, MOMENTS>(packet, gloss, photons, &asked, &mut found, &mut tally);
                }
            } else if let Some(normals) = shading.get(index) {
                for &(first, end) in &runs {
                    let photons = map.run(first, end);
                    collect::<LAYERS, true, MOMENTS>(
                        packet, normals, photons, &asked, &mut found, &mut tally,
                    );
                }
            } else {
                let normals = &[[0.0; LANES]; 3];
                for &(first, end) in &runs {
                    let photons = map.run(first, end);
                    collect::<LAYERS, false, MOMENTS>(
                        packet, normals, photons, &asked, &mut found, &mut tally,
                    );
                }
            }
            let mut slots = slots.of_packet(i);
            if !rule.batch.is_first() {
                slots.add_earlier(&mut found);
            }
            if !rule.batch.is_last() {
                slots.keep(&found);
                continue;
            }
            if MOMENTS {
                found.add_evidence(packet, slots.evidence);
            }
            found.write_moments(packet, rule.question, slots.moments);
            conclude(packet, &found, slots, rule, &mut tally);
        }
        tally
    }
}

/// Sums the photons that count for Lambertian hit points. `SHADED` corrects for interpolated normals.
#[inline(always)]
fn collect<const LAYERS: usize, const SHADED: bool, const MOMENTS: bool>(
    packet: &Packet,
    shading_normals: &[[f32; LANES]; 3],
    photons: &[Photon],
    asked: &Asked,
    found: &mut Found<LAYERS>,
    tally: &mut Tally,
) {
    tally.candidates += photons.len() as u64;
    for photon in photons {
        let counts = counting_lanes(packet, photon);
        if !any(&counts) {
            continue;
        }
        let mut factor = [1.0; LANES];
        if SHADED {
            // What does not count is zero from here on: masks that are asked for again below were taken apart lane by lane.
            factor = shading_factor(packet, shading_normals, photon);
            for l in 0..LANES {
                factor[l] = f32::from_bits(factor[l].to_bits() & counts[l]);
            }
        }
        let layer = &mut found.flux[Found::<LAYERS>::layer(photon)];
        for (channel, power) in [photon.power.r, photon.power.g, photon.power.b].into_iter().enumerate() {
            let sums = &mut layer[channel];
            for l in 0..LANES {
                sums[l] +=
                    if SHADED { power * factor[l] } else { f32::from_bits(power.to_bits() & counts[l]) };
            }
        }
        for l in 0..LANES {
            found.count[l] += counts[l] & 1;
        }
        if MOMENTS {
            let distance2 = distances2(packet, photon);
            let luminance = photon.power.luminance();
            for l in 0..LANES {
                let term = luminance * factor[l] * distance2[l];
                found.moment[l] += f32::from_bits(term.to_bits() & counts[l]);
            }
            if asked.is_of(photon) {
                for l in 0..LANES {
                    let answer = asked.answer(luminance * factor[l], distance2[l], l);
                    found.answer[l] += f32::from_bits(answer.to_bits() & counts[l]);
                }
            }
            let [x, y, z] = offsets(packet, photon);
            let [sx, sy, sz] = &mut found.shape.offset;
            for l in 0..LANES {
                let w = f32::from_bits((luminance * factor[l]).to_bits() & counts[l]);
                found.shape.light[l] += w;
                found.shape.squares[l] += w * w;
                sx[l] += w * x[l];
                sy[l] += w * y[l];
                sz[l] += w * z[l];
            }
        }
    }
}

/// Sums the photons that count for hit points with a BSDF of their own, weighed by it one by one.
#[inline(always)]
fn collect_gloss<const LAYERS: usize, const MOMENTS: bool>(
    packet: &Packet,
    gloss: &[Option<Gloss>],
    photons: &[Photon],
    asked: &Asked,
    found: &mut Found<LAYERS>,
    tally: &mut Tally,
) {
    tally.candidates += photons.len() as u64;
    for photon in photons {
        let counts = counting_lanes(packet, photon);
        if !any(&counts) {
            continue;
        }
        let wi = photon.direction();
        let face = Face::of(photon);
        let distance2 = if MOMENTS { distances2(packet, photon) } else { [0.0; LANES] };
        let offset = if MOMENTS { offsets(packet, photon) } else { [[0.0; LANES]; 3] };
        let layer = &mut found.flux[Found::<LAYERS>::layer(photon)];
        for l in (0..LANES).filter(|&l| counts[l] != 0) {
            let Some(gloss) = gloss[l].as_ref().filter(|g| g.takes(photon)) else { continue };
            found.count[l] += 1;
            let geometric = face.cosine(wi, packet, (gloss.frame.normal / 127.0).to_array(), l).abs() * 127.0;
            let shading = wi.dot(gloss.frame.normal).abs();
            let weighed = photon.power * gloss.eval(wi) * cosine_ratio(shading, geometric);
            if !weighed.is_finite() {
                tally.leave_out(Quantity::GatheredLight, packet, l);
                continue;
            }
            layer[0][l] += weighed.r;
            layer[1][l] += weighed.g;
            layer[2][l] += weighed.b;
            if MOMENTS {
                let luminance = weighed.luminance();
                found.moment[l] += luminance * distance2[l];
                if asked.is_of(photon) {
                    found.answer[l] += asked.answer(luminance, distance2[l], l);
                }
                found.shape.light[l] += luminance;
                found.shape.squares[l] += luminance * luminance;
                for (sum, offset) in found.shape.offset.iter_mut().zip(&offset) {
                    sum[l] += luminance * offset[l];
                }
            }
        }
    }
}

/// Whether the photon counts in any lane.
#[inline(always)]
fn any(counts: &[u32; LANES]) -> bool {
    counts.iter().fold(0, |any, c| any | c) != 0
}

/// All ones for each lane for which the photon counts: disc, slab, normal and side (the normals of both are those of the
/// eye's and the photon's side), patch, and length of the joined path: the marks of equal patches cancel, others are above any
/// budget.
#[inline(always)]
fn counting_lanes(packet: &Packet, photon: &Photon) -> [u32; LANES] {
    let p = photon.position;
    let [n0, n1, n2] = photon.normal;
    let n = [f32::from(n0), f32::from(n1), f32::from(n2)];
    let edges = photon.edges_on_patch();
    let mut counts = [0; LANES];
    let [x, y, z] = &packet.position;
    let [nx, ny, nz] = &packet.normal;
    for l in 0..LANES {
        let (dx, dy, dz) = (x[l] - p.x, y[l] - p.y, z[l] - p.z);
        let distance2 = dx * dx + dy * dy + dz * dz;
        // The packet's normals are divided by 127.
        let height = (dx * nx[l] + dy * ny[l] + dz * nz[l]) * 127.0;
        let cosine = n[0] * nx[l] + n[1] * ny[l] + n[2] * nz[l];
        let counted = (distance2 <= packet.radius2[l])
            & (height * height <= packet.slab2[l] * packet.radius2[l])
            & (cosine > SMALLEST_NORMAL_COSINE)
            & (edges ^ packet.patch[l] <= packet.budget[l]);
        counts[l] = u32::from(counted).wrapping_neg();
    }
    counts
}

/// From a photon to each lane: once more, so that what asks for no moments is left as it is.
#[inline(always)]
fn offsets(packet: &Packet, photon: &Photon) -> [[f32; LANES]; 3] {
    let mut offsets = packet.position;
    for (row, p) in offsets.iter_mut().zip(photon.position.to_array()) {
        row.iter_mut().for_each(|x| *x -= p);
    }
    offsets
}

/// Squared distances of a photon.
#[inline(always)]
fn distances2(packet: &Packet, photon: &Photon) -> [f32; LANES] {
    let [dx, dy, dz] = offsets(packet, photon);
    let mut distance2 = [0.0; LANES];
    for l in 0..LANES {
        distance2[l] = dx[l] * dx[l] + dy[l] * dy[l] + dz[l] * dz[l];
    }
    distance2
}

/// |ω·n_s|/|ω·n_g|: photons measure irradiance about the geometric normal, the BSDF wants it about the shading normal. Zero
/// where the light comes from behind the shading normal.
#[inline(always)]
fn shading_factor(packet: &Packet, shading_normals: &[[f32; LANES]; 3], photon: &Photon) -> [f32; LANES] {
    let w = photon.direction();
    let mut factor = [0.0; LANES];
    let face = Face::of(photon);
    let [sx, sy, sz] = shading_normals;
    for l in 0..LANES {
        let geometric = face.cosine(w, packet, [sx[l], sy[l], sz[l]], l);
        let shading = w.x * sx[l] + w.y * sy[l] + w.z * sz[l];
        factor[l] = cosine_ratio(shading, geometric);
    }
    factor
}

/// The face that a photon fell on, which makes it as dense as its own cosine says, not a neighbouring hit point's: where faces
/// meet at an angle, light along the hit point's own face would count up to a hundred times.
struct Face {
    /// In 127ths, as stored.
    stored: [f32; 3],
    /// Of unit length.
    normal: Vec3,
}

impl Face {
    #[inline(always)]
    fn of(photon: &Photon) -> Self {
        let stored = photon.normal.map(f32::from);
        Self { stored, normal: Vec3::from_array(stored).normalize_or_zero() }
    }

    /// |ω·n_g|/127 at the photon: by a hit point's normal, which is exact, where that rounds to the photon's, and where it is the
    /// shading normal, so that nothing is corrected.
    #[inline(always)]
    fn cosine(&self, w: Vec3, packet: &Packet, shading: [f32; 3], l: usize) -> f32 {
        let [nx, ny, nz] = [0, 1, 2].map(|axis| packet.normal[axis][l]);
        let [px, py, pz] = self.stored;
        let in_127ths = 127.0 * 127.0;
        let off =
            (nx * in_127ths - px).abs().max((ny * in_127ths - py).abs()).max((nz * in_127ths - pz).abs());
        let plain = (nx == shading[0]) & (ny == shading[1]) & (nz == shading[2]);
        let own = w.x * nx + w.y * ny + w.z * nz;
        let stored = w.x * self.normal.x + w.y * self.normal.y + w.z * self.normal.z;
        if (off <= 0.51) | plain { own } else { stored.max(SMALLEST_COSINE) * (1.0 / 127.0) }
    }
}

/// The quotient of two cosines: zero where their signs differ, never above what a floor of |ω·n_g| allows, and exactly 1 where
/// they are the same.
#[inline(always)]
fn cosine_ratio(shading: f32, geometric: f32) -> f32 {
    let ratio = shading / geometric;
    // Not a number where both are zero.
    if ratio > 0.0 { ratio.min(1.0 / SMALLEST_COSINE) } else { 0.0 }
}

/// Turns a packet's sums into irradiance, refines its hit points, and writes the radii of the next pass.
fn conclude<const LAYERS: usize>(
    packet: &mut Packet,
    found: &Found<LAYERS>,
    slots: Slots<'_, LAYERS>,
    rule: Rule,
    tally: &mut Tally,
) {
    let Slots { statistics, smallest2, irradiance, counts, evidence, .. } = slots;
    for l in 0..LANES {
        let radius2 = packet.radius2[l];
        if radius2 < 0.0 {
            continue;
        }
        let per_area = 1.0 / (PI * radius2);
        for (out, flux) in irradiance[l].iter_mut().zip(&found.flux) {
            *out = Rgb::new(flux[0][l], flux[1][l], flux[2][l]) * per_area;
            if !out.is_finite() {
                *out = Rgb::BLACK;
                tally.leave_out(Quantity::Irradiance, packet, l);
            }
        }
        let count = u64::from(found.count[l]) + counts.get(l).copied().unwrap_or(0);
        let smallest2 = f64::from(smallest2[l]);
        let floored = match rule.common {
            None => {
                let known = evidence.get(l).filter(|_| rule.adapts);
                let alpha = known.map_or(rule.alpha, |e| e.alpha(rule.alpha));
                statistics[l].refine(count, alpha, smallest2)
            }
            Some(rho) => statistics[l].shrink(count, rho, smallest2),
        };
        tally.floored += u64::from(floored);
        tally.accepted += count;
        tally.unknown += u64::from(statistics[l].is_unknown());
        tally.radius2 += statistics[l].radius2();
        packet.radius2[l] = statistics[l].radius2() as f32;
    }
}
