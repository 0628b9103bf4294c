//! Sixteen hit points side by side, to be tested together against one photon.

use foton_math::Aabb;
use foton_math::glam::Vec3;

use super::photon::patch_mark;
use crate::camera_paths::{HitPoint, slab2};
use crate::not_finite::{LeftOut, Quantity, Surface};

/// Hit points in a packet.
pub const LANES: usize = 16;

/// Hot query records of up to [`LANES`] hit points. Empty lanes have a negative squared radius, which nothing reaches.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Packet {
    /// Rows of x, y and z.
    pub position: [[f32; LANES]; 3],
    /// Geometric normal over 127: its dot product with a photon's stored normal is the cosine between both.
    pub normal: [[f32; LANES]; 3],
    /// Squared radii; negative in empty lanes.
    pub radius2: [f32; LANES],
    /// See [`HitPoint::remaining_edges`].
    pub remaining_edges: [u8; LANES],
    /// See [`HitPoint::patch`].
    pub patch: [u8; LANES],
    /// Bits of the lanes that are [`HitPoint::curved`].
    pub curved: u16,
}

/// What a packet holds in short, in rows to test photons against.
#[derive(Clone, Debug)]
pub struct PacketTests {
    /// See [`slab2`].
    pub slab2: [f32; LANES],
    /// See [`HitPoint::remaining_edges`].
    pub remaining_edges: [i32; LANES],
    /// [`HitPoint::patch`], above the bits of the remaining_edges.
    pub patch: [i32; LANES],
}

/// Vectors as three rows of lanes, zero where there are fewer.
pub fn rows(vectors: impl Iterator<Item = Vec3>) -> [[f32; LANES]; 3] {
    let mut rows = [[0.0; LANES]; 3];
    for (lane, v) in vectors.enumerate() {
        for (axis, row) in rows.iter_mut().enumerate() {
            row[lane] = v[axis];
        }
    }
    rows
}

impl Packet {
    /// Up to [`LANES`] hit points, lane by lane.
    pub fn new<'a>(members: impl Iterator<Item = &'a HitPoint> + Clone) -> Self {
        let mut packet = Self {
            position: rows(members.clone().map(|h| h.position)),
            normal: rows(members.clone().map(|h| h.normal / 127.0)),
            radius2: [-1.0; LANES],
            remaining_edges: [0; LANES],
            patch: [0; LANES],
            curved: 0,
        };
        for (lane, h) in members.enumerate() {
            packet.radius2[lane] = h.radius2;
            packet.remaining_edges[lane] = h.remaining_edges;
            packet.patch[lane] = h.patch;
            packet.curved |= u16::from(h.curved) << lane;
        }
        packet
    }

    /// What photons are tested against beside position, normal and radius.
    #[inline(always)]
    pub fn tests(&self) -> PacketTests {
        PacketTests {
            slab2: std::array::from_fn(|l| slab2(self.curved >> l & 1 != 0)),
            remaining_edges: self.remaining_edges.map(i32::from),
            patch: self.patch.map(patch_mark),
        }
    }

    /// The record of a value at a lane that was not finite.
    pub fn left_out(&self, quantity: Quantity, l: usize) -> LeftOut {
        let of = |rows: &[[f32; LANES]; 3]| Vec3::from_array(rows.map(|row| row[l]));
        let surface = Surface::Below(of(&self.normal) * 127.0);
        LeftOut { quantity, light: None, surface, position: of(&self.position) }
    }

    /// Boxes around the spheres of the packet's discs.
    pub fn disc_boxes(&self) -> impl Iterator<Item = Aabb> {
        (0..LANES).filter(|&l| self.radius2[l] >= 0.0).map(|l| {
            let centre = Vec3::from_array(self.position.map(|row| row[l]));
            Aabb::around(centre, self.radius2[l].sqrt())
        })
    }

    /// The box around all of them.
    #[inline(always)]
    #[allow(
        clippy::needless_range_loop,
        reason = "rows of lanes advance together; indices are what vectorises"
    )]
    pub fn bounds(&self) -> Aabb {
        let mut bounds = Aabb::EMPTY;
        for (axis, row) in self.position.iter().enumerate() {
            let mut low = [f32::INFINITY; LANES];
            let mut high = [f32::NEG_INFINITY; LANES];
            for l in 0..LANES {
                let there = self.radius2[l] >= 0.0;
                let radius = self.radius2[l].max(0.0).sqrt();
                low[l] = if there { row[l] - radius } else { f32::INFINITY };
                high[l] = if there { row[l] + radius } else { f32::NEG_INFINITY };
            }
            for half in [8, 4, 2, 1] {
                for l in 0..half {
                    low[l] = if low[l + half] < low[l] { low[l + half] } else { low[l] };
                    high[l] = if high[l + half] > high[l] { high[l + half] } else { high[l] };
                }
            }
            (bounds.min[axis], bounds.max[axis]) = (low[0], high[0]);
        }
        bounds
    }
}
