//! Photons to hit points: which count, what light they bring, and the refinement that follows, fused.
//!
//! One photon at a time is tested against the sixteen hit points of a packet. Sums run in the order of the sorted photons,
//! multiplication and addition apart, so the bits are the same for any number of threads.

use std::f32::consts::PI;

use foton_math::Rgb;
use foton_math::glam::Vec3;
use rayon::prelude::*;

use crate::grid::Grid;
use crate::hit_point::{Gloss, HitPoints, Irradiance};
use crate::packet::{LANES, Packet};
use crate::photon::Photon;
use crate::photon_map::PhotonMap;
use crate::photon_pass::SMALLEST_COSINE;
use crate::refine::Statistics;
use crate::settings::Alpha;

/// A photon counts only where its surface faces about the same way: the cosine between the normals must exceed this.
const SMALLEST_NORMAL_COSINE: f32 = 0.1;

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
    /// Sum of r² in square scene units.
    pub(crate) radius2: f64,
}

/// How a pass is gathered.
#[derive(Clone, Copy)]
pub(crate) struct Rule {
    pub(crate) alpha: Alpha,
    /// r² never falls below.
    pub(crate) smallest2: f64,
}

/// Light found by a packet's lanes.
struct Found<const LAYERS: usize> {
    flux: [[[f32; LANES]; 3]; LAYERS],
    count: [u32; LANES],
}

/// Gathers all photons for all hit points and refines them. Fills `irradiance_slots` with this pass's estimates.
///
/// `LAYERS` is 3 to keep path classes apart, or 1.
pub(crate) fn all<const LAYERS: usize>(
    hit_points: &mut HitPoints,
    map: &PhotonMap,
    grid: &Grid,
    rule: Rule,
    irradiance_slots: &mut [Irradiance<LAYERS>],
) -> Tally {
    let shading = &hit_points.shading_normals;
    let (first_glossy, gloss_slots) = (hit_points.first_glossy, &hit_points.gloss_slots);
    let tallies: Vec<Tally> = hit_points
        .packets
        .par_chunks_mut(BLOCK)
        .zip(hit_points.statistics_slots.par_chunks_mut(BLOCK * LANES))
        .zip(irradiance_slots.par_chunks_mut(BLOCK * LANES))
        .enumerate()
        .map(|(block, ((packets, statistics), irradiance))| {
            let mut tally = Tally::default();
            let slots = statistics.chunks_mut(LANES).zip(irradiance.chunks_mut(LANES));
            for (i, (packet, (statistics, irradiance))) in packets.iter_mut().zip(slots).enumerate() {
                let index = block * BLOCK + i;
                let mut found = Found::<LAYERS>::NONE;
                let visit = Visit { packet, map, grid };
                if let Some(glossy) = index.checked_sub(first_glossy) {
                    let gloss = &gloss_slots[glossy * LANES..(glossy + 1) * LANES];
                    visit.collect_gloss(gloss, &mut found, &mut tally);
                } else {
                    match shading.get(index) {
                        None => visit.collect::<LAYERS, false>(&[[0.0; LANES]; 3], &mut found, &mut tally),
                        Some(normals) => visit.collect::<LAYERS, true>(normals, &mut found, &mut tally),
                    }
                }
                conclude(packet, &found, statistics, irradiance, rule, &mut tally);
            }
            tally
        })
        .collect();
    tallies.into_iter().fold(Tally::default(), |a, b| Tally {
        candidates: a.candidates + b.candidates,
        accepted: a.accepted + b.accepted,
        unknown: a.unknown + b.unknown,
        floored: a.floored + b.floored,
        radius2: a.radius2 + b.radius2,
    })
}

impl<const LAYERS: usize> Found<LAYERS> {
    const NONE: Self = Self { flux: [[[0.0; LANES]; 3]; LAYERS], count: [0; LANES] };

    const fn layer(photon: &Photon) -> usize {
        if LAYERS == 1 { 0 } else { photon.class_index() }
    }
}

/// A packet and where its photons are.
struct Visit<'a> {
    packet: &'a Packet,
    map: &'a PhotonMap,
    grid: &'a Grid,
}

impl Visit<'_> {
    /// Calls `f` with each photon that counts in any lane, and with the lanes in which it does.
    #[inline]
    fn for_each(&self, tally: &mut Tally, mut f: impl FnMut(&Photon, &[u32; LANES])) {
        self.grid.for_each_run(&self.packet.bounds(), |first, end| {
            let photons = self.map.run(first, end);
            tally.candidates += photons.len() as u64;
            for photon in photons {
                let counts = counting_lanes(self.packet, photon);
                if counts.iter().fold(0, |any, c| any | c) != 0 {
                    f(photon, &counts);
                }
            }
        });
    }

    /// Sums the photons that count for Lambertian hit points. `SHADED` corrects for interpolated normals.
    fn collect<const LAYERS: usize, const SHADED: bool>(
        &self,
        shading_normals: &[[f32; LANES]; 3],
        found: &mut Found<LAYERS>,
        tally: &mut Tally,
    ) {
        self.for_each(tally, |photon, counts| {
            let factor =
                if SHADED { shading_factor(self.packet, shading_normals, photon) } else { [1.0; LANES] };
            let layer = &mut found.flux[Found::<LAYERS>::layer(photon)];
            for (channel, power) in layer.iter_mut().zip(photon.power.to_array()) {
                for l in 0..LANES {
                    let term = if SHADED { power * factor[l] } else { power };
                    channel[l] += f32::from_bits(term.to_bits() & counts[l]);
                }
            }
            for (count, counted) in found.count.iter_mut().zip(counts) {
                *count += counted & 1;
            }
        });
    }

    /// Sums the photons that count for hit points with a BSDF of their own, weighed by it one by one.
    fn collect_gloss<const LAYERS: usize>(
        &self,
        gloss: &[Option<Gloss>],
        found: &mut Found<LAYERS>,
        tally: &mut Tally,
    ) {
        self.for_each(tally, |photon, counts| {
            let wi = photon.direction();
            let layer = &mut found.flux[Found::<LAYERS>::layer(photon)];
            for l in (0..LANES).filter(|&l| counts[l] != 0) {
                found.count[l] += 1;
                let Some(gloss) = &gloss[l] else { continue };
                let geometric = wi.dot(Vec3::from_array(self.packet.normal.map(|row| row[l]))).abs() * 127.0;
                let shading = wi.dot(gloss.frame.normal).abs();
                let weighed = photon.power * gloss.eval(wi) * cosine_ratio(shading, geometric);
                for (channel, term) in layer.iter_mut().zip(weighed.to_array()) {
                    channel[l] += term;
                }
            }
        });
    }
}

/// All ones for each lane for which the photon counts: disc, slab, normal and side (the normals of both are those of the
/// eye's and the photon's side), and length of the joined path.
#[inline]
#[allow(
    clippy::needless_range_loop,
    reason = "eight rows of lanes advance together; indices are what vectorises"
)]
fn counting_lanes(packet: &Packet, photon: &Photon) -> [u32; LANES] {
    let p = photon.position;
    let n = photon.normal.map(f32::from);
    let edges = i32::from(photon.edges);
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
            & (edges <= packet.budget[l]);
        counts[l] = u32::from(counted).wrapping_neg();
    }
    counts
}

/// |ω·n_s|/|ω·n_g|: photons measure irradiance about the geometric normal, the BSDF wants it about the shading normal. Zero
/// where the light comes from behind the shading normal.
#[inline]
fn shading_factor(packet: &Packet, shading_normals: &[[f32; LANES]; 3], photon: &Photon) -> [f32; LANES] {
    let w = photon.direction();
    let mut factor = [0.0; LANES];
    let [nx, ny, nz] = &packet.normal;
    let [sx, sy, sz] = shading_normals;
    for l in 0..LANES {
        let geometric = w.x * nx[l] + w.y * ny[l] + w.z * nz[l];
        let shading = w.x * sx[l] + w.y * sy[l] + w.z * sz[l];
        factor[l] = cosine_ratio(shading, geometric);
    }
    factor
}

/// The quotient of two cosines: zero where their signs differ, never above what a floor of |ω·n_g| allows, and exactly 1 where
/// they are the same.
#[inline]
fn cosine_ratio(shading: f32, geometric: f32) -> f32 {
    let ratio = shading / geometric;
    // Not a number where both are zero.
    if ratio > 0.0 { ratio.min(1.0 / SMALLEST_COSINE) } else { 0.0 }
}

/// Turns a packet's sums into irradiance, refines its hit points, and writes the radii of the next pass.
fn conclude<const LAYERS: usize>(
    packet: &mut Packet,
    found: &Found<LAYERS>,
    statistics: &mut [Statistics],
    irradiance: &mut [Irradiance<LAYERS>],
    rule: Rule,
    tally: &mut Tally,
) {
    for l in 0..LANES {
        let radius2 = packet.radius2[l];
        if radius2 < 0.0 {
            continue;
        }
        let per_area = 1.0 / (PI * radius2);
        for (out, flux) in irradiance[l].iter_mut().zip(&found.flux) {
            *out = Rgb::new(flux[0][l], flux[1][l], flux[2][l]) * per_area;
        }
        let count = found.count[l];
        tally.floored += u64::from(statistics[l].refine(u64::from(count), rule.alpha, rule.smallest2));
        tally.accepted += u64::from(count);
        tally.unknown += u64::from(statistics[l].is_unknown());
        tally.radius2 += statistics[l].radius2();
        packet.radius2[l] = statistics[l].radius2() as f32;
    }
}
