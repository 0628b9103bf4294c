//! Hit points: where eye paths end on surfaces that spread light, laid out for the gather.
//!
//! Three orders meet here. *Sample order* is that of the eye pass: a pixel's hit points are neighbours in it. *Slot order* is
//! that of the packets, 16 slots each, some empty. Statistics have slots of their own, apart from the query records.

use std::ops::Range;

use foton_math::glam::Vec3;
use foton_math::{Aabb, Rgb};
use foton_transport::camera_paths::{Gloss, HitPoint};
use foton_transport::photon_map::{self, Groups, LANES, Packet};
use foton_transport::{Cancel, Cancelled, LeftOut, Quantity};
use rayon::prelude::*;

use super::adaptive::RadiusStatistics;
use super::statistics::Statistics;

/// Light that arrives at a hit point, all of it and then, where classes are asked for, caustic and indirect light: Σ Φ/(π r²) over the
/// photons of one pass (W·m⁻²), each photon weighed by the BSDF's value where that is not Lambertian (W·m⁻²·sr⁻¹).
pub(crate) type Irradiance<const LAYERS: usize> = [Rgb; LAYERS];

/// Packets of one task.
pub(crate) const BLOCK: usize = 256;

/// What shadow rays need of a slot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShadowOrigin {
    pub(crate) origin: Vec3,
    pub(crate) shading_normal: Vec3,
}

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

    /// Of the slots of a block.
    fn of(slots: &[Statistics]) -> Self {
        let mut sums = Self::default();
        slots.iter().filter(|statistics| statistics.radius2() >= 0.0).for_each(|s| sums.add(s));
        sums
    }
}

/// All hit points. Packets of Lambertian ones come first. Vectors whose names end in `_slots` have [`LANES`] entries a packet.
pub(crate) struct HitPoints {
    pub(crate) packets: Vec<Packet>,
    /// The box around the discs of each packet: it says which photons are near, and takes a twenty-seventh of the packet's room.
    pub(crate) bounds: Vec<Aabb>,
    /// Packets from here on hold hit points that are not Lambertian.
    pub(crate) first_glossy: usize,
    /// [`LANES`] entries a packet from `first_glossy` on.
    pub(crate) gloss_slots: Vec<Option<Gloss>>,
    /// Shading normals over 127, as the packets' own are, by packet, as three rows of lanes; empty when the scene has none that matter.
    pub(crate) shading_normals: Vec<[[f32; LANES]; 3]>,
    /// Empty unless direct light comes by shadow rays.
    pub(crate) shadow_slots: Vec<ShadowOrigin>,
    pub(crate) statistics_slots: Vec<Statistics>,
    /// By block of packets.
    pub(crate) block_sums: Vec<BlockSums>,
    /// [`HitPoint::smallest2`].
    pub(crate) smallest2_slots: Vec<f32>,
    /// Empty unless radii adapt or the error is asked for.
    pub(crate) radius_statistics_slots: Vec<RadiusStatistics>,
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
        let rows = |group: &&[u32]| photon_map::rows(members(found, group).map(|h| h.shading_normal / 127.0));
        let none = if shading_normals { 0 } else { groups.len() };
        let of_glossy = |h: &HitPoint| h.gloss.map(|g| gloss[g as usize]);
        let shadow = |h: &HitPoint| ShadowOrigin { origin: h.origin, shading_normal: h.shading_normal };
        let nowhere = ShadowOrigin { origin: Vec3::ZERO, shading_normal: Vec3::ZERO };
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
            gloss_slots: by_slot(&groups[lambertian.count()..], found, None, of_glossy),
            shading_normals: groups[none..].par_iter().map(rows).collect(),
            shadow_slots: by_slot(shadowed, found, nowhere, shadow),
            statistics_slots: by_slot(&groups, found, Statistics::EMPTY_SLOT, |h| Statistics::new(h.radius2)),
            block_sums: Vec::new(),
            smallest2_slots: by_slot(&groups, found, 0.0, |h| h.smallest2),
            radius_statistics_slots: Vec::new(),
            slot_of,
            weights: found.iter().map(|h| h.weight).collect(),
            pixel_start,
        };
        hit_points.follow_radii();
        Ok(hit_points)
    }

    /// Makes anew what goes by radii and statistics, after these have changed otherwise than by a gather.
    pub(crate) fn follow_radii(&mut self) {
        self.bounds = self.packets.par_iter().map(Packet::bounds).collect();
        self.block_sums = self.statistics_slots.par_chunks(BLOCK * LANES).map(BlockSums::of).collect();
    }

    /// With first radii multiplied by a factor.
    #[must_use]
    pub(crate) fn widened(mut self, factor: f32) -> Self {
        let slots = self.statistics_slots.par_chunks_mut(LANES);
        slots.zip(&mut self.packets).for_each(|(statistics, packet)| {
            for (radius2, statistics) in
                packet.radius2.iter_mut().zip(statistics).filter(|(r2, _)| **r2 >= 0.0)
            {
                *radius2 *= factor * factor;
                *statistics = Statistics::new(*radius2);
            }
        });
        self.follow_radii();
        self
    }

    /// Makes room for what radii that adapt go by, and the error's upper end.
    #[must_use]
    pub(crate) fn with_radius_statistics(self) -> Self {
        Self {
            radius_statistics_slots: vec![RadiusStatistics::default(); self.statistics_slots.len()],
            ..self
        }
    }

    /// How a slot weighs light, where that is not Lambertian.
    pub(crate) fn gloss(&self, slot: usize) -> Option<&Gloss> {
        self.gloss_slots.get(slot.checked_sub(self.first_glossy * LANES)?)?.as_ref()
    }

    /// Whether any hit point needs the directions of photons.
    pub(crate) const fn need_directions(&self) -> bool {
        !(self.gloss_slots.is_empty() && self.shading_normals.is_empty())
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
    pub(crate) fn statistics(&self) -> impl Iterator<Item = &Statistics> {
        self.slot_of.iter().map(|&slot| &self.statistics_slots[slot as usize])
    }

    /// Bytes held.
    pub(crate) const fn bytes(&self) -> usize {
        (size_of::<Packet>() + size_of::<Aabb>()) * self.packets.len()
            + size_of::<Option<Gloss>>() * self.gloss_slots.len()
            + size_of::<[[f32; LANES]; 3]>() * self.shading_normals.len()
            + size_of::<ShadowOrigin>() * self.shadow_slots.len()
            + (size_of::<Statistics>() + size_of::<f32>()) * self.statistics_slots.len()
            + size_of::<BlockSums>() * self.block_sums.len()
            + size_of::<RadiusStatistics>() * self.radius_statistics_slots.len()
            + (size_of::<u32>() + size_of::<Rgb>()) * self.slot_of.len()
            + size_of::<u32>() * self.pixel_start.len()
    }
}

fn members<'a>(found: &'a [HitPoint], group: &'a [u32]) -> impl Iterator<Item = &'a HitPoint> + Clone {
    group.iter().map(|&i| &found[i as usize])
}

/// A value for each slot of some groups, `empty` where there is no hit point.
fn by_slot<T: Copy + Send + Sync>(
    groups: &[&[u32]],
    found: &[HitPoint],
    empty: T,
    of: impl Fn(&HitPoint) -> T + Sync,
) -> Vec<T> {
    let mut slots = vec![empty; groups.len() * LANES];
    slots.par_chunks_mut(LANES).zip(groups).for_each(|(slots, group)| {
        for (slot, &i) in slots.iter_mut().zip(*group) {
            *slot = of(&found[i as usize]);
        }
    });
    slots
}
