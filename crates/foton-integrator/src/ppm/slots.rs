//! What a gather finds for a packet, on its way to the entries of a pass or of the batches so far (`arrived.rs`), and what hit points
//! keep of it. What radii go by is added with the last batch only: a pass that is cancelled between two has not happened.

use std::f32::consts::PI;
use std::ops::Range;

use foton_math::Rgb;
use foton_transport::photon_map::{LANES, Packet, PathClass, Photon};

use super::adaptive::DiscMoments;
use super::arrived::{BatchSums, Entries, Lanes, SlotMoments};
use super::hit_points::BlockSums;
use super::kept::{KeptRadius, KeptStatistics};
use crate::error::Question;

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

    /// Lanes for which a photon has counted, as bits.
    #[inline(always)]
    pub(crate) fn lanes(&self) -> u16 {
        self.count.iter().enumerate().fold(0, |mask, (l, &count)| mask | u16::from(count > 0) << l)
    }

    /// Flux of a lane, all classes together.
    fn luminance(&self, lane: usize) -> f32 {
        let [r, g, b] = &self.flux[0];
        Rgb::new(r[lane], g[lane], b[lane]).luminance()
    }

    /// Adds what the pass has found to what radii go by.
    pub(crate) fn add_radius_statistics(&self, packet: &Packet, radius_statistics: &mut [KeptRadius]) {
        for (lane, kept) in
            radius_statistics.iter_mut().enumerate().filter(|(l, _)| self.disc.squares[*l] > 0.0)
        {
            let mut sums = kept.sums();
            sums.add(packet.radius2[lane], lane, self.moment[lane], &self.disc);
            *kept = KeptRadius::new(&sums);
        }
    }

    /// Σ 6(s − ½) Φ/(π r²) of a lane with s = d²/r², and the answer about a class: see [`crate::error`].
    pub(crate) fn moments(&self, packet: &Packet, question: Question, l: usize) -> SlotMoments {
        let radius2 = packet.radius2[l];
        let per_area = 1.0 / (PI * radius2);
        let answer = self.answer[l] * if question.noise { per_area * per_area } else { per_area };
        let bias = (6.0 * self.moment[l] / radius2 - 3.0 * self.luminance(l)) * per_area;
        SlotMoments { bias, answer }
    }

    /// Adds what earlier batches of the pass found in a lane.
    pub(crate) fn add_earlier(&mut self, l: usize, earlier: &BatchSums<LAYERS>) {
        for (sums, earlier) in self.flux.iter_mut().zip(&earlier.flux) {
            for (sums, earlier) in sums.iter_mut().zip(earlier.to_array()) {
                sums[l] += earlier;
            }
        }
        self.count[l] = self.count[l].saturating_add(earlier.count);
        self.moment[l] += earlier.moment;
        self.answer[l] += earlier.answer;
        self.disc.light[l] += earlier.light;
        self.disc.squares[l] += earlier.squares;
        for (sums, earlier) in self.disc.offset.iter_mut().zip(earlier.offset) {
            sums[l] += earlier;
        }
    }

    /// What a lane leaves for the next batch.
    pub(crate) fn batch_sums(&self, l: usize) -> BatchSums<LAYERS> {
        BatchSums {
            flux: self.flux.map(|[r, g, b]| Rgb::new(r[l], g[l], b[l])),
            count: self.count[l],
            moment: self.moment[l],
            answer: self.answer[l],
            light: self.disc.light[l],
            squares: self.disc.squares[l],
            offset: self.disc.offset.map(|row| row[l]),
        }
    }
}

/// What the hit points of a block keep, and what a pass brings them.
pub(crate) struct Slots<'a, const LAYERS: usize> {
    /// Of its packets, and of the one after them.
    pub(crate) first_place: &'a [u32],
    pub(crate) statistics: &'a mut [KeptStatistics],
    /// Smallest squared radii, of all hit points.
    pub(crate) smallest2: &'a [f32],
    /// Empty unless radii adapt or the error is asked for.
    pub(crate) radius_statistics: &'a mut [KeptRadius],
    /// By packet.
    pub(crate) lanes: &'a mut [Lanes],
    pub(crate) entries: &'a mut Entries<LAYERS>,
    pub(crate) sums: &'a mut BlockSums,
}

impl<const LAYERS: usize> Slots<'_, LAYERS> {
    /// Where the hit points of the packet of that index lie among those of the block.
    #[inline]
    pub(crate) fn places(&self, index: usize) -> Range<usize> {
        let [first, end] = [index, index + 1].map(|i| (self.first_place[i] - self.first_place[0]) as usize);
        first..end
    }
}
