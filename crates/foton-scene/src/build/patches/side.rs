//! A side of a triangle, and whether another triangle continues it there.

use foton_math::glam::{DVec3, Vec3};

/// Surfaces continue each other where their normals, turned to the same side, have at least this cosine: what the gather asks
/// of a photon's normal, too.
pub(super) const MIN_COSINE: f64 = 0.1;

/// One side of a triangle.
pub(super) struct Side {
    pub(super) ends: [Vec3; 2],
    third: Vec3,
    pub(super) normal: DVec3,
    /// Unit direction in the triangle's plane, away from the edge and into the triangle.
    pub(super) inward: DVec3,
}

impl Side {
    /// `None` for a triangle that is too thin to have a plane.
    pub(super) fn new(corners: [Vec3; 3], side: usize) -> Option<Self> {
        let [a, b, c] = [0, 1, 2].map(|i| corners[(side + i) % 3]);
        let (from, to) = (a.as_dvec3(), c.as_dvec3());
        let along = (b.as_dvec3() - from).try_normalize()?;
        let across = to - from;
        let inward = (across - along * across.dot(along)).try_normalize()?;
        Some(Self { ends: [a, b], third: c, normal: along.cross(inward), inward })
    }

    /// Whether `other`, which has the same edge, continues this one; if so, whether its normal is turned against this one's.
    pub(super) fn continued_by(&self, other: &Self) -> Option<bool> {
        let [a, b] = self.ends;
        if other.ends != [a, b] && other.ends != [b, a] {
            return None;
        }
        let goes_on = self.inward.dot(other.inward) < -MIN_COSINE;
        (goes_on || self.third == other.third).then(|| self.normal.dot(other.normal) < 0.0)
    }
}
