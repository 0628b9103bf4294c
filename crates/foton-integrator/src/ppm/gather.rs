//! Photons to hit points: the light that those bring which count.
//!
//! One photon at a time is tested against the sixteen hit points of a packet. Sums run in the order of the sorted photons,
//! multiplication and addition apart, so the bits are the same for any number of threads and any instruction set.
#![allow(clippy::needless_range_loop, reason = "rows of lanes advance together; indices are what vectorises")]

use foton_transport::Quantity;
use foton_transport::camera_paths::Gloss;
use foton_transport::photon_map::{LANES, Packet, PacketTests, Photon};

use super::lanes::{Face, cosine_ratio, counting_lanes, distances2, offsets, shading_factor};
use super::slots::{ClassTerm, Found};
use super::tally::Tally;

/// Sums the photons that count for Lambertian hit points. `SHADED` corrects for interpolated normals.
#[inline(always)]
pub(super) fn collect<const LAYERS: usize, const SHADED: bool, const MOMENTS: bool>(
    (packet, tests): (&Packet, &PacketTests),
    shading_normals: &[[f32; LANES]; 3],
    photons: &[Photon],
    term: &ClassTerm,
    found: &mut Found<LAYERS>,
    tally: &mut Tally,
) {
    tally.candidates += photons.len() as u64;
    for photon in photons {
        let counts = counting_lanes(packet, tests, photon);
        if !any(&counts) {
            continue;
        }
        let mut factor = [1.0; LANES];
        if SHADED {
            // What does not count is zero from here on: the compiler takes masks that are tested again below apart lane by lane.
            factor = shading_factor(packet, shading_normals, photon);
            for l in 0..LANES {
                factor[l] = f32::from_bits(factor[l].to_bits() & counts[l]);
            }
        }
        add_power::<SHADED>(&mut found.flux[0], photon, &factor, &counts);
        if let Some(class) = Found::<LAYERS>::class_layer(photon) {
            add_power::<SHADED>(&mut found.flux[class], photon, &factor, &counts);
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
            if term.is_of(photon) {
                for l in 0..LANES {
                    let answer = term.of(luminance * factor[l], distance2[l], l);
                    found.answer[l] += f32::from_bits(answer.to_bits() & counts[l]);
                }
            }
            let [x, y, z] = offsets(packet, photon);
            let [sx, sy, sz] = &mut found.disc.offset;
            for l in 0..LANES {
                let w = f32::from_bits((luminance * factor[l]).to_bits() & counts[l]);
                found.disc.light[l] += w;
                found.disc.squares[l] += w * w;
                sx[l] += w * x[l];
                sy[l] += w * y[l];
                sz[l] += w * z[l];
            }
        }
    }
}

/// Adds a photon to the sums of the lanes in which it counts, weighed there by `factor` if normals are interpolated.
#[inline(always)]
fn add_power<const SHADED: bool>(
    sums: &mut [[f32; LANES]; 3],
    photon: &Photon,
    factor: &[f32; LANES],
    counts: &[u32; LANES],
) {
    for (channel, power) in [photon.power.r, photon.power.g, photon.power.b].into_iter().enumerate() {
        let sums = &mut sums[channel];
        for l in 0..LANES {
            sums[l] += if SHADED { power * factor[l] } else { f32::from_bits(power.to_bits() & counts[l]) };
        }
    }
}

/// Sums the photons that count for hit points with a BSDF of their own, weighed by it one by one.
#[inline(always)]
pub(super) fn collect_gloss<const LAYERS: usize, const MOMENTS: bool>(
    (packet, tests): (&Packet, &PacketTests),
    gloss: &[Gloss],
    photons: &[Photon],
    term: &ClassTerm,
    found: &mut Found<LAYERS>,
    tally: &mut Tally,
) {
    tally.candidates += photons.len() as u64;
    for photon in photons {
        let counts = counting_lanes(packet, tests, photon);
        if !any(&counts) {
            continue;
        }
        let wi = photon.direction();
        let face = Face::of(photon);
        let distance2 = if MOMENTS { distances2(packet, photon) } else { [0.0; LANES] };
        let offset = if MOMENTS { offsets(packet, photon) } else { [[0.0; LANES]; 3] };
        let class = Found::<LAYERS>::class_layer(photon);
        for l in (0..LANES).filter(|&l| counts[l] != 0) {
            // Gathered lobes weigh all photons, specular ones only those whose light no eye path can find.
            let Some(gloss) = gloss.get(l).filter(|g| !g.specular || photon.is_lone()) else { continue };
            found.count[l] += 1;
            let geometric = face.cosine(wi, packet, (gloss.frame.normal / 127.0).to_array(), l).abs() * 127.0;
            let shading = wi.dot(gloss.frame.normal).abs();
            let weighed = photon.power * gloss.eval(wi) * cosine_ratio(shading, geometric);
            if !weighed.is_finite() {
                tally.leave_out(Quantity::GatheredLight, packet, l);
                continue;
            }
            for layer in [Some(0), class].into_iter().flatten() {
                let [r, g, b] = &mut found.flux[layer];
                r[l] += weighed.r;
                g[l] += weighed.g;
                b[l] += weighed.b;
            }
            if MOMENTS {
                let luminance = weighed.luminance();
                found.moment[l] += luminance * distance2[l];
                if term.is_of(photon) {
                    found.answer[l] += term.of(luminance, distance2[l], l);
                }
                found.disc.light[l] += luminance;
                found.disc.squares[l] += luminance * luminance;
                for (sum, offset) in found.disc.offset.iter_mut().zip(&offset) {
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
