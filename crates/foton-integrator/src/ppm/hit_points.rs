//! Hit points: where eye paths end on surfaces that spread light, laid out for the gather.
//!
//! Three orders meet here. *Sample order* is that of the eye pass: a pixel's hit points are neighbours in it. *Slot order* is
//! that of the packets, 16 slots each, some empty. What hit points keep lies in the same order without those, apart from the query records.

use std::ops::Range;

use foton_math::glam::Vec3;
use foton_math::{Aabb, Rgb};
use foton_transport::camera_paths::{Gloss, HitPoint};
use foton_transport::photon_map::{self, Groups, LANES, Packet};
use foton_transport::{Cancel, Cancelled, LeftOut, Quantity};
use rayon::prelude::*;

use super::kept::{KeptRadius, KeptStatistics};
use super::shading_normals::{ShadingNormals, members};
use super::statistics::Statistics;

/// Light that arrives at a hit point, all of it and then, where classes are asked for, caustic and indirect light: Σ Φ/(π r²) over the
/// photons of one pass (W·m⁻²), each photon weighed by the BSDF's value where that is not Lambertian (W·m⁻²·sr⁻¹).
pub(crate) type Irradiance<const LAYERS: usize> = [Rgb; LAYERS];

/// Packets of one task.
pub(crate) const BLOCK: usize = 256;

/// How hit points are laid out.
#[derive(Clone, Copy)]
pub(crate) struct Layout {
    /// Whether any surface has normals that photons need a correction for.
    pub(crate) shading_normals: bool,
    /// Whether shadow rays bring direct light.
    pub(crate) shadow_rays: bool,
    /// Hit points among which neighbours are looked for, in sample order.
    pub(crate) in_band: usize,
}

/// What a gather says of the hit points of a block, kept up with them: a pass comes by those alone that it brings something.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BlockSums {
    /// Hit points that no pass has found a photon for.
    pub(crate) unknown: u64,
    /// Sum of r² in square scene units.
    pub(crate) radius2: f64,
}

impl BlockSums {
    /// Adds a hit point.
    pub(crate) fn add(&mut self, statistics: &Statistics) {
        self.unknown += u64::from(statistics.is_unknown());
        self.radius2 += statistics.radius2();
    }

    /// Takes a hit point off that is about to change.
    pub(crate) fn take_off(&mut self, statistics: &Statistics) {
        self.unknown -= u64::from(statistics.is_unknown());
        self.radius2 -= statistics.radius2();
    }
}

/// All hit points. Packets of Lambertian ones come first. What vectors of a value for each hit point are ordered by is its *place*: packet
/// by packet, without the empty lanes; all but `slot_of` and `weights`.
pub(crate) struct HitPoints {
    pub(crate) packets: Vec<Packet>,
    /// The box around the discs of each packet: it says which photons are near, and takes a twenty-seventh of the packet's room.
    pub(crate) bounds: Vec<Aabb>,
    /// Packets from here on hold hit points that are not Lambertian.
    pub(crate) first_glossy: usize,
    /// The place of the first hit point of each packet, and one entry more.
    pub(crate) first_place: Vec<u32>,
    /// Of the hit points of packets from `first_glossy` on.
    pub(crate) gloss: Vec<Gloss>,
    /// Shading normals of packets; empty when the scene has none that matter.
    pub(crate) shading: ShadingNormals,
    /// [`HitPoint::offset`]; empty unless direct light comes by shadow rays.
    pub(crate) offsets: Vec<f32>,
    pub(crate) statistics: Vec<KeptStatistics>,
    /// By block of packets.
    pub(crate) block_sums: Vec<BlockSums>,
    /// [`HitPoint::smallest2`].
    pub(crate) smallest2: Vec<f32>,
    /// Empty unless radii adapt or the error is asked for.
    pub(crate) radius_statistics: Vec<KeptRadius>,
    /// In sample order: where the hit point is.
    pub(crate) slot_of: Vec<u32>,
    /// In sample order: [`HitPoint::weight`].
    pub(crate) weights: Vec<Rgb>,
    /// The hit points of pixel p are `pixel_start[p]..pixel_start[p + 1]` in sample order.
    pub(crate) pixel_start: Vec<u32>,
}

impl HitPoints {
    /// Lays hit points out. `pixel_start` is as in [`HitPoints`].
    ///
    /// # Errors
    /// When cancelled.
    pub(crate) fn new(
        found: &[HitPoint],
        gloss: &[Gloss],
        pixel_start: Vec<u32>,
        how: Layout,
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        let Layout { shading_normals, shadow_rays, in_band } = how;
        let lambertian = photon_map::group(found, |h| h.gloss.is_none(), in_band, cancel)?;
        let glossy = if gloss.is_empty() {
            Groups::default()
        } else {
            photon_map::group(found, |h| h.gloss.is_some(), in_band, cancel)?
        };
        let groups: Vec<&[u32]> = lambertian.iter().chain(glossy.iter()).collect();
        let packet =
            |(p, group): (usize, &&[u32])| cancel.check_at(p).map(|()| Packet::new(members(found, group)));
        let packets = groups.par_iter().enumerate().map(packet).collect::<Result<_, _>>()?;
        let of_glossy = |h: &HitPoint| h.gloss.map(|g| gloss[g.get()]);
        let first_place = first_places(&groups);
        let shadowed = if shadow_rays { &groups[..] } else { &[] };
        let mut slot_of = vec![0u32; found.len()];
        for (p, group) in groups.iter().enumerate() {
            cancel.check_at(p)?;
            for (lane, &i) in group.iter().enumerate() {
                slot_of[i as usize] = (p * LANES + lane) as u32;
            }
        }
        let mut hit_points = Self {
            packets,
            bounds: Vec::new(),
            first_glossy: lambertian.count(),
            gloss: by_place(&groups[lambertian.count()..], found).filter_map(of_glossy).collect(),
            first_place,
            shading: ShadingNormals::new(if shading_normals { &groups } else { &[] }, found),
            offsets: by_place(shadowed, found).map(|h| h.offset).collect(),
            statistics: Vec::new(),
            block_sums: Vec::new(),
            smallest2: by_place(&groups, found).map(|h| h.smallest2).collect(),
            radius_statistics: Vec::new(),
            slot_of,
            weights: found.iter().map(|h| h.weight).collect(),
            pixel_start,
        };
        hit_points.bounds = hit_points.packets.par_iter().map(Packet::bounds).collect();
        Ok(hit_points)
    }

    /// Makes room for statistics, and for what radii that adapt go by, and the error's upper end, where `moments` says so: once what the eye
    /// pass found is not needed any more, so that both are never held at one time.
    #[must_use]
    pub(crate) fn with_statistics(mut self, moments: bool) -> Self {
        self.statistics = vec![KeptStatistics::default(); self.len()];
        self.radius_statistics = vec![KeptRadius::default(); if moments { self.len() } else { 0 }];
        self.follow_radii();
        self
    }

    /// Makes anew what goes by radii and statistics, after these have changed otherwise than by a gather.
    pub(crate) fn follow_radii(&mut self) {
        self.bounds = self.packets.par_iter().map(Packet::bounds).collect();
        let of_block = |(block, packets): (usize, &[Packet])| {
            let mut sums = BlockSums::default();
            for slot in (0..packets.len() * LANES).map(|slot| block * BLOCK * LANES + slot) {
                self.statistics_at(slot).iter().for_each(|statistics| sums.add(statistics));
            }
            sums
        };
        self.block_sums = self.packets.par_chunks(BLOCK).enumerate().map(of_block).collect();
    }

    /// With first radii multiplied by a factor.
    #[must_use]
    pub(crate) fn widened(mut self, factor: f32) -> Self {
        self.packets.par_iter_mut().for_each(|packet| {
            packet.radius2.iter_mut().filter(|r2| **r2 >= 0.0).for_each(|r2| *r2 *= factor * factor);
        });
        self.bounds = self.packets.par_iter().map(Packet::bounds).collect();
        self
    }

    /// The place of the hit point in a slot.
    #[inline(always)]
    pub(crate) fn place(&self, slot: usize) -> usize {
        self.first_place[slot / LANES] as usize + slot % LANES
    }

    /// How a slot weighs light, where that is not Lambertian.
    pub(crate) fn gloss(&self, slot: usize) -> Option<&Gloss> {
        self.gloss.get(self.place(slot).checked_sub(self.first_place[self.first_glossy] as usize)?)
    }

    /// Whether any hit point needs the directions of photons.
    pub(crate) const fn need_directions(&self) -> bool {
        !(self.gloss.is_empty() && self.shading.is_empty())
    }

    /// How many there are.
    pub(crate) const fn len(&self) -> usize {
        self.slot_of.len()
    }

    /// The record of a pixel whose sum was not finite, by its first hit point.
    pub(crate) fn left_out_at(&self, first: u32) -> LeftOut {
        let slot = self.slot_of[first as usize] as usize;
        self.packets[slot / LANES].left_out(Quantity::PixelSum, slot % LANES)
    }

    /// Those of a pixel, in sample order.
    pub(crate) fn of_pixel(&self, pixel: usize) -> Range<usize> {
        self.pixel_start[pixel] as usize..self.pixel_start[pixel + 1] as usize
    }

    /// Statistics of all hit points, in sample order.
    pub(crate) fn in_sample_order(&self) -> impl Iterator<Item = Statistics> {
        self.slot_of.iter().map(|&slot| self.statistics_of(slot as usize))
    }

    /// Those of the hit point in a slot.
    #[inline]
    pub(crate) fn statistics_of(&self, slot: usize) -> Statistics {
        self.statistics[self.place(slot)].beside(self.packets[slot / LANES].radius2[slot % LANES])
    }

    /// The same where there may be none.
    pub(crate) fn statistics_at(&self, slot: usize) -> Option<Statistics> {
        let count = self.first_place[slot / LANES + 1] - self.first_place[slot / LANES];
        (slot % LANES < count as usize).then(|| self.statistics_of(slot))
    }

    /// What shadow rays start from: an origin certainly on the eye's side, and the shading normal.
    #[inline]
    pub(crate) fn shadow_origin(&self, slot: usize) -> (Vec3, Vec3) {
        let (packet, lane) = (&self.packets[slot / LANES], slot % LANES);
        let of = |rows: &[[f32; LANES]; 3]| Vec3::from_array(rows.map(|row| row[lane]));
        let normal = of(&packet.normal) * 127.0;
        let shading_normal = self.shading.of(slot / LANES).map_or(normal, |rows| of(rows) * 127.0);
        (of(&packet.position) + normal * self.offsets[self.place(slot)], shading_normal)
    }

    /// Bytes held.
    pub(crate) const fn bytes(&self) -> usize {
        (size_of::<Packet>() + size_of::<Aabb>()) * self.packets.len()
            + size_of::<Gloss>() * self.gloss.len()
            + self.shading.bytes()
            + size_of::<f32>() * (self.offsets.len() + self.smallest2.len())
            + size_of::<KeptStatistics>() * self.statistics.len()
            + size_of::<BlockSums>() * self.block_sums.len()
            + size_of::<KeptRadius>() * self.radius_statistics.len()
            + (size_of::<u32>() + size_of::<Rgb>()) * self.slot_of.len()
            + size_of::<u32>() * (self.pixel_start.len() + self.first_place.len())
    }
}

/// The hit points of some groups, by place.
fn by_place<'a>(groups: &'a [&'a [u32]], found: &'a [HitPoint]) -> impl Iterator<Item = &'a HitPoint> {
    groups.iter().flat_map(|group| members(found, group))
}

/// The place of the first hit point of each group, and one entry more.
fn first_places(groups: &[&[u32]]) -> Vec<u32> {
    let mut first = Vec::with_capacity(groups.len() + 1);
    let mut sum = 0;
    first.push(sum);
    for group in groups {
        sum += group.len() as u32;
        first.push(sum);
    }
    first
}
