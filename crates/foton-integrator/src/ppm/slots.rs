//! What a gather finds for a packet, and the slots it goes to: those of a pass's results, which hold sums between its batches.
//! What radii go by is added with the last batch only: a pass that is cancelled between two has not happened.

use std::f32::consts::PI;

use foton_math::Rgb;
use foton_transport::photon_map::{LANES, Packet, PathClass, Photon};

use super::adaptive::{DiscMoments, RadiusStatistics};
use super::hit_points::Irradiance;
use super::statistics::Statistics;
use crate::error::{Question, SlotMoments};

/// Light found by a packet's lanes.
pub(crate) struct Found<const LAYERS: usize> {
    /// All of it, and where there are three layers caustic and indirect light once more: the rest is direct. So the whole is
    /// summed in one order whether classes are asked for or not, and has the same bits.
    pub(crate) flux: [[[f32; LANES]; 3]; LAYERS],
    pub(crate) count: [u32; LANES],
    /// Σ d² Φ in luminance, where the error is asked for.
    pub(crate) moment: [f32; LANES],
    /// [`ClassTerm`] summed over the photons of one class, where the error is asked for.
    pub(crate) answer: [f32; LANES],
    /// Where radii adapt.
    pub(crate) disc: DiscMoments,
}

/// The term w (a w + b d² + c) that a pass sums over the photons of one class, w their luminance.
pub(crate) struct ClassTerm {
    class: usize,
    a: f32,
    b: [f32; LANES],
    c: f32,
}

impl ClassTerm {
    /// w² for the noise; w · 6(s − ½), s = d²/r², for the bias.
    #[inline(always)]
    pub(crate) fn new(question: Question, packet: &Packet) -> Self {
        let Question { class, noise } = question;
        if noise {
            return Self { class, a: 1.0, b: [0.0; LANES], c: 0.0 };
        }
        Self { class, a: 0.0, b: packet.radius2.map(|r2| 6.0 / r2), c: -3.0 }
    }

    #[inline(always)]
    pub(crate) const fn is_of(&self, photon: &Photon) -> bool {
        photon.class_index() == self.class
    }

    #[inline(always)]
    pub(crate) fn of(&self, w: f32, distance2: f32, lane: usize) -> f32 {
        w * (self.a * w + self.b[lane] * distance2 + self.c)
    }
}

impl<const LAYERS: usize> Found<LAYERS> {
    pub(crate) const NONE: Self = Self {
        flux: [[[0.0; LANES]; 3]; LAYERS],
        count: [0; LANES],
        moment: [0.0; LANES],
        answer: [0.0; LANES],
        disc: DiscMoments::NONE,
    };

    /// The layer of a photon's class beside that of all light, if it has one.
    #[inline(always)]
    pub(crate) const fn class_layer(photon: &Photon) -> Option<usize> {
        let class = photon.class_index();
        if LAYERS == 1 || class == PathClass::Direct as usize { None } else { Some(class) }
    }

    /// Flux of a lane, all classes together.
    pub(crate) fn luminance(&self, lane: usize) -> f32 {
        let [r, g, b] = &self.flux[0];
        Rgb::new(r[lane], g[lane], b[lane]).luminance()
    }

    /// Adds what the pass has found to what radii go by.
    pub(crate) fn add_radius_statistics(&self, packet: &Packet, radius_statistics: &mut [RadiusStatistics]) {
        for (lane, radius_statistics) in
            radius_statistics.iter_mut().enumerate().filter(|(l, _)| self.disc.squares[*l] > 0.0)
        {
            radius_statistics.add(packet.radius2[lane], lane, self.moment[lane], &self.disc);
        }
    }

    /// Σ 6(s − ½) Φ/(π r²) with s = d²/r², and the answer about a class: see [`crate::error`].
    pub(crate) fn write_moments(&self, packet: &Packet, question: Question, moments: &mut [SlotMoments]) {
        for (l, moment) in moments.iter_mut().enumerate() {
            let radius2 = packet.radius2[l];
            let flux = self.luminance(l);
            // Lanes without a hit point have found nothing.
            let per_area = 1.0 / (PI * radius2);
            let answer = self.answer[l] * if question.noise { per_area * per_area } else { per_area };
            let bias = (6.0 * self.moment[l] / radius2 - 3.0 * flux) * per_area;
            *moment = SlotMoments { bias, answer };
        }
    }
}

/// The [`DiscMoments`] of one slot, and Σ Φ d².
#[derive(Clone, Copy, Default)]
pub(crate) struct DiscSums {
    light: f32,
    squares: f32,
    offset: [f32; 3],
    moment: f32,
}

/// What the batches of a pass leave for the last one beside what its results have room for, by slot; nothing where there is one.
#[derive(Default)]
pub(crate) struct EarlierBatches {
    /// Photons found.
    pub(crate) counts: Vec<u64>,
    /// Where radii adapt.
    pub(crate) discs: Vec<DiscSums>,
}

impl EarlierBatches {
    /// Room for that many slots.
    pub(crate) fn of(slots: usize, adapts: bool) -> Self {
        Self { counts: vec![0; slots], discs: vec![DiscSums::default(); if adapts { slots } else { 0 }] }
    }

    /// Bytes held.
    pub(crate) const fn bytes(&self) -> usize {
        self.counts.capacity() * size_of::<u64>() + self.discs.capacity() * size_of::<DiscSums>()
    }

    /// Bytes held a slot.
    pub(crate) const fn bytes_per_slot(adapts: bool) -> usize {
        size_of::<u64>() + if adapts { size_of::<DiscSums>() } else { 0 }
    }
}

/// What a gather fills, of some packets.
pub(crate) struct Slots<'a, const LAYERS: usize> {
    pub(crate) statistics: &'a mut [Statistics],
    /// Smallest squared radii.
    pub(crate) smallest2: &'a [f32],
    pub(crate) irradiance: &'a mut [Irradiance<LAYERS>],
    /// Empty unless the error is asked for.
    pub(crate) moments: &'a mut [SlotMoments],
    /// Of [`EarlierBatches`].
    pub(crate) counts: &'a mut [u64],
    pub(crate) discs: &'a mut [DiscSums],
    /// Empty unless radii adapt.
    pub(crate) radius_statistics: &'a mut [RadiusStatistics],
}

impl<const LAYERS: usize> Slots<'_, LAYERS> {
    /// Those of the packet of that index.
    pub(crate) fn of_packet(&mut self, index: usize) -> Slots<'_, LAYERS> {
        let lanes = index * LANES..(index + 1) * LANES;
        Slots {
            statistics: &mut self.statistics[lanes.clone()],
            smallest2: &self.smallest2[lanes.clone()],
            irradiance: &mut self.irradiance[lanes.clone()],
            moments: self.moments.get_mut(lanes.clone()).unwrap_or_default(),
            counts: self.counts.get_mut(lanes.clone()).unwrap_or_default(),
            discs: self.discs.get_mut(lanes.clone()).unwrap_or_default(),
            radius_statistics: self.radius_statistics.get_mut(lanes).unwrap_or_default(),
        }
    }

    /// Adds what earlier batches of the pass found.
    pub(crate) fn add_earlier(&self, found: &mut Found<LAYERS>) {
        for (l, earlier) in self.irradiance.iter().enumerate() {
            for (sums, earlier) in found.flux.iter_mut().zip(earlier) {
                for (sums, earlier) in sums.iter_mut().zip(earlier.to_array()) {
                    sums[l] += earlier;
                }
            }
        }
        for (l, earlier) in self.moments.iter().enumerate() {
            found.moment[l] += earlier.bias;
            found.answer[l] += earlier.answer;
        }
        for (l, earlier) in self.discs.iter().enumerate() {
            found.disc.light[l] += earlier.light;
            found.disc.squares[l] += earlier.squares;
            for (sums, earlier) in found.disc.offset.iter_mut().zip(earlier.offset) {
                sums[l] += earlier;
            }
            found.moment[l] += if self.moments.is_empty() { earlier.moment } else { 0.0 };
        }
    }

    /// Stores sums for the next batch: flux and moments that no area has divided yet.
    pub(crate) fn store(&mut self, found: &Found<LAYERS>) {
        for (l, earlier) in self.irradiance.iter_mut().enumerate() {
            for (earlier, flux) in earlier.iter_mut().zip(&found.flux) {
                *earlier = Rgb::new(flux[0][l], flux[1][l], flux[2][l]);
            }
        }
        self.counts.iter_mut().zip(found.count).for_each(|(sum, count)| *sum += u64::from(count));
        for (l, moment) in self.moments.iter_mut().enumerate() {
            *moment = SlotMoments { bias: found.moment[l], answer: found.answer[l] };
        }
        for (l, disc) in self.discs.iter_mut().enumerate() {
            *disc = DiscSums {
                light: found.disc.light[l],
                squares: found.disc.squares[l],
                offset: found.disc.offset.map(|row| row[l]),
                moment: found.moment[l],
            };
        }
    }
}
