//! Shading normals of packets: kept only where they are not the geometric ones, as on flat faces they are.

use foton_transport::camera_paths::HitPoint;
use foton_transport::photon_map::{self, LANES};
use rayon::prelude::*;

/// Three rows of lanes: normals over 127, as the packets' own are.
pub(crate) type Rows = [[f32; LANES]; 3];

/// Those of all packets.
#[derive(Debug, Default)]
pub(crate) struct ShadingNormals {
    rows: Vec<Rows>,
    /// By packet: one more than where its rows are; 0 where they are its geometric normals. Empty where no normal is interpolated.
    place: Vec<u32>,
}

impl ShadingNormals {
    /// Of so many groups of hit points.
    pub(super) fn new(groups: &[&[u32]], found: &[HitPoint]) -> Self {
        let differ = |group: &&[u32]| members(found, group).any(|h| h.shading_normal != h.normal);
        let mut place: Vec<u32> = groups.par_iter().map(|group| u32::from(differ(group))).collect();
        let mut count = 0;
        for place in place.iter_mut().filter(|place| **place > 0) {
            count += 1;
            *place = count;
        }
        let mut rows = Vec::with_capacity(count as usize);
        let of = |group: &[u32]| photon_map::rows(members(found, group).map(|h| h.shading_normal / 127.0));
        rows.extend(groups.iter().zip(&place).filter(|(_, place)| **place > 0).map(|(group, _)| of(group)));
        Self { rows, place }
    }

    /// Whether no hit point has any.
    pub(crate) const fn is_empty(&self) -> bool {
        self.place.is_empty()
    }

    /// Those of a packet; `None` where they are its geometric normals.
    #[inline(always)]
    pub(crate) fn of(&self, packet: usize) -> Option<&Rows> {
        let place = *self.place.get(packet)?;
        self.rows.get((place as usize).wrapping_sub(1))
    }

    /// Bytes held.
    pub(crate) const fn bytes(&self) -> usize {
        size_of::<Rows>() * self.rows.len() + size_of::<u32>() * self.place.len()
    }
}

/// The hit points of a group.
pub(super) fn members<'a>(
    found: &'a [HitPoint],
    group: &'a [u32],
) -> impl Iterator<Item = &'a HitPoint> + Clone {
    group.iter().map(|&i| &found[i as usize])
}
