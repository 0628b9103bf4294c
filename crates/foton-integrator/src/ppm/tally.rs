//! What a gather counts.

use std::ops::AddAssign;

use foton_transport::photon_map::Packet;
use foton_transport::{Omissions, Quantity};

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
    pub(super) fn leave_out(&mut self, quantity: Quantity, packet: &Packet, l: usize) {
        self.omissions.add(packet.left_out(quantity, l));
    }
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
