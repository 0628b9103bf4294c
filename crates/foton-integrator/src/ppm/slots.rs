//! What a gather finds for a packet, and the slots it goes to: those of a pass's results, which hold sums between its batches.
//! What radii go by is added with the last batch only: a pass that is cancelled between two has not happened.

use std::f32::consts::PI;

use foton_math::Rgb;
use foton_transport::photon_map::{LANES, Packet, Photon};

use super::adaptive::{DiscMoments, RadiusStatistics};
use super::hit_points::Irradiance;
use super::statistics::Statistics;
use crate::error::Question;

/// Light found by a packet's lanes.
pub(crate) struct Found<const LAYERS: usize> {
    pub(crate) flux: [[[f32; LANES]; 3]; LAYERS],
    pub(crate) count: [u32; LANES],
    /// Σ d² Φ in luminance, where the error is asked for.
    pub(crate) moment: [f32; LANES],
    /// What [`Asked`] says of the photons of one class, where the error is asked for.
    pub(crate) answer: [f32; LANES],
    /// Where radii adapt.
    pub(crate) disc: DiscMoments,
}

/// A pass's question in numbers: w (a w + b d² + c) is summed over the photons of a class, w their luminance.
pub(crate) struct Asked {
    class: usize,
    a: f32,
    b: [f32; LANES],
    c: f32,
}

impl Asked {
    /// w² for the noise; w · 6(s − ½), s = d²/r², for the blur.
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
    pub(crate) fn answer(&self, w: f32, distance2: f32, lane: usize) -> f32 {
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

    #[inline(always)]
    pub(crate) const fn layer(photon: &Photon) -> usize {
        if LAYERS == 1 { 0 } else { photon.class_index() }
    }

    /// Flux of a lane, all classes together.
    pub(crate) fn luminance(&self, lane: usize) -> f32 {
        self.flux.iter().map(|f| Rgb::new(f[0][lane], f[1][lane], f[2][lane]).luminance()).sum()
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
    pub(crate) fn write_moments(&self, packet: &Packet, question: Question, moments: &mut [[f32; 2]]) {
        for (l, moment) in moments.iter_mut().enumerate() {
            let radius2 = packet.radius2[l];
            let flux = self.luminance(l);
            // Lanes without a hit point have found nothing.
            let per_area = 1.0 / (PI * radius2);
            let answer = self.answer[l] * if question.noise { per_area * per_area } else { per_area };
            *moment = [(6.0 * self.moment[l] / radius2 - 3.0 * flux) * per_area, answer];
        }
    }
}

/// What the batches of a pass leave for the last one beside what its results have room for, by slot; nothing where there is one.
#[derive(Default)]
pub(crate) struct EarlierBatches {
    /// Photons found.
    pub(crate) counts: Vec<u64>,
    /// Where radii adapt: Σ Φ, Σ Φ², Σ Φ d and Σ Φ d² (see [`DiscMoments`]).
    pub(crate) shapes: Vec<[f32; 6]>,
}

impl EarlierBatches {
    /// Room for so many slots.
    pub(crate) fn of(slots: usize, adapts: bool) -> Self {
        Self { counts: vec![0; slots], shapes: vec![[0.0; 6]; if adapts { slots } else { 0 }] }
    }

    /// Bytes held.
    pub(crate) const fn bytes(&self) -> usize {
        self.counts.capacity() * size_of::<u64>() + self.shapes.capacity() * size_of::<[f32; 6]>()
    }

    /// Bytes held a slot.
    pub(crate) const fn bytes_per_slot(adapts: bool) -> usize {
        size_of::<u64>() + if adapts { size_of::<[f32; 6]>() } else { 0 }
    }
}

/// What a gather fills, of some packets.
pub(crate) struct Slots<'a, const LAYERS: usize> {
    pub(crate) statistics: &'a mut [Statistics],
    /// Squared radii below which none shrinks.
    pub(crate) smallest2: &'a [f32],
    pub(crate) irradiance: &'a mut [Irradiance<LAYERS>],
    /// Empty unless the error is asked for.
    pub(crate) moments: &'a mut [[f32; 2]],
    /// Of [`EarlierBatches`].
    pub(crate) counts: &'a mut [u64],
    pub(crate) shapes: &'a mut [[f32; 6]],
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
            shapes: self.shapes.get_mut(lanes.clone()).unwrap_or_default(),
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
        for (l, [moment, answer]) in self.moments.iter().enumerate() {
            found.moment[l] += moment;
            found.answer[l] += answer;
        }
        for (l, [light, squares, x, y, z, moment]) in self.shapes.iter().enumerate() {
            found.disc.light[l] += light;
            found.disc.squares[l] += squares;
            for (sums, earlier) in found.disc.offset.iter_mut().zip([x, y, z]) {
                sums[l] += earlier;
            }
            found.moment[l] += if self.moments.is_empty() { *moment } else { 0.0 };
        }
    }

    /// Keeps sums for the next batch: flux and moments that no area has divided yet.
    pub(crate) fn keep(&mut self, found: &Found<LAYERS>) {
        for (l, earlier) in self.irradiance.iter_mut().enumerate() {
            for (earlier, flux) in earlier.iter_mut().zip(&found.flux) {
                *earlier = Rgb::new(flux[0][l], flux[1][l], flux[2][l]);
            }
        }
        self.counts.iter_mut().zip(found.count).for_each(|(sum, count)| *sum += u64::from(count));
        for (l, moment) in self.moments.iter_mut().enumerate() {
            *moment = [found.moment[l], found.answer[l]];
        }
        for (l, shape) in self.shapes.iter_mut().enumerate() {
            let [x, y, z] = [0, 1, 2].map(|axis| found.disc.offset[axis][l]);
            *shape = [found.disc.light[l], found.disc.squares[l], x, y, z, found.moment[l]];
        }
    }
}
