//! One photon against the sixteen hit points of a packet: for which it counts, how far away it is, at which angle it came.
#![allow(clippy::needless_range_loop, reason = "rows of lanes advance together; indices are what vectorises")]

use foton_math::glam::Vec3;
use foton_transport::photon_map::{LANES, Packet, PacketTests, Photon};
use foton_transport::shading::MIN_COSINE;

/// A photon counts only where its surface faces about the same way: the cosine between the normals must exceed this.
const MIN_NORMAL_COSINE: f32 = 0.1;

/// All ones for each lane for which the photon counts: disc, slab, normal and side (the normals of both are those of the
/// eye's and the photon's side), patch, and length of the joined path: the marks of equal patches cancel, others are above any
/// remaining_edges.
#[inline(always)]
pub(super) fn counting_lanes(packet: &Packet, tests: &PacketTests, photon: &Photon) -> [u32; LANES] {
    let p = photon.position;
    let [n0, n1, n2] = photon.normal;
    let n = [f32::from(n0), f32::from(n1), f32::from(n2)];
    let edges = photon.edges_on_patch();
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
            & (height * height <= tests.slab2[l] * packet.radius2[l])
            & (cosine > MIN_NORMAL_COSINE)
            & (edges ^ tests.patch[l] <= tests.remaining_edges[l]);
        counts[l] = u32::from(counted).wrapping_neg();
    }
    counts
}

/// From a photon to each lane: computed again, so that the loop without moments stays as it is.
#[inline(always)]
pub(super) fn offsets(packet: &Packet, photon: &Photon) -> [[f32; LANES]; 3] {
    let mut offsets = packet.position;
    for (row, p) in offsets.iter_mut().zip(photon.position.to_array()) {
        row.iter_mut().for_each(|x| *x -= p);
    }
    offsets
}

/// Squared distances of a photon.
#[inline(always)]
pub(super) fn distances2(packet: &Packet, photon: &Photon) -> [f32; LANES] {
    let [dx, dy, dz] = offsets(packet, photon);
    let mut distance2 = [0.0; LANES];
    for l in 0..LANES {
        distance2[l] = dx[l] * dx[l] + dy[l] * dy[l] + dz[l] * dz[l];
    }
    distance2
}

/// |ω·n_s|/|ω·n_g|: photons measure irradiance about the geometric normal, the BSDF wants it about the shading normal. Zero
/// where the light comes from behind the shading normal.
#[inline(always)]
pub(super) fn shading_factor(
    packet: &Packet,
    shading_normals: &[[f32; LANES]; 3],
    photon: &Photon,
) -> [f32; LANES] {
    let w = photon.direction();
    let mut factor = [0.0; LANES];
    let face = Face::of(photon);
    let [sx, sy, sz] = shading_normals;
    for l in 0..LANES {
        let geometric = face.cosine(w, packet, [sx[l], sy[l], sz[l]], l);
        let shading = w.x * sx[l] + w.y * sy[l] + w.z * sz[l];
        factor[l] = cosine_ratio(shading, geometric);
    }
    factor
}

/// The face that a photon fell on, which makes it as dense as its own cosine says, not a neighbouring hit point's: where faces
/// meet at an angle, light along the hit point's own face would count up to a hundred times.
pub(super) struct Face {
    /// In 127ths, as stored.
    stored: [f32; 3],
    /// Of unit length.
    normal: Vec3,
}

impl Face {
    #[inline(always)]
    pub(super) fn of(photon: &Photon) -> Self {
        let stored = photon.normal.map(f32::from);
        Self { stored, normal: Vec3::from_array(stored).normalize_or_zero() }
    }

    /// |ω·n_g|/127 at the photon: by a hit point's normal, which is exact, where that rounds to the photon's, and where it is the
    /// shading normal, so that nothing is corrected.
    #[inline(always)]
    pub(super) fn cosine(&self, w: Vec3, packet: &Packet, shading: [f32; 3], l: usize) -> f32 {
        let [nx, ny, nz] = [0, 1, 2].map(|axis| packet.normal[axis][l]);
        let [px, py, pz] = self.stored;
        let in_127ths = 127.0 * 127.0;
        let off =
            (nx * in_127ths - px).abs().max((ny * in_127ths - py).abs()).max((nz * in_127ths - pz).abs());
        let plain = (nx == shading[0]) & (ny == shading[1]) & (nz == shading[2]);
        let own = w.x * nx + w.y * ny + w.z * nz;
        let stored = w.x * self.normal.x + w.y * self.normal.y + w.z * self.normal.z;
        if (off <= 0.51) | plain { own } else { stored.max(MIN_COSINE) * (1.0 / 127.0) }
    }
}

/// The quotient of two cosines: zero where their signs differ, never above what a floor of |ω·n_g| allows, and exactly 1 where
/// they are the same.
#[inline(always)]
pub(super) fn cosine_ratio(shading: f32, geometric: f32) -> f32 {
    let ratio = shading / geometric;
    // Not a number where both are zero.
    if ratio > 0.0 { ratio.min(1.0 / MIN_COSINE) } else { 0.0 }
}
