//! What a render will take, estimated before it is taken.

use std::fmt;

/// Share of a packet's lanes that are used, measured on the shipped scenes: 0.63 in glass-and-ring, else 0.96 and more.
pub(crate) const FILL: f64 = 0.75;

/// A render's memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MemoryEstimate {
    /// Hit points expected.
    pub hit_points: f64,
    /// Pixels.
    pub pixels: f64,
    /// Bytes for the scene and its tree.
    pub scene_bytes: f64,
    /// Bytes for hit points, their statistics and this pass's light.
    pub hit_point_bytes: f64,
    /// Bytes for images.
    pub pixel_bytes: f64,
    /// Bytes for the photons of a batch, their sorted copy, and the counters of the sort.
    pub photon_bytes: f64,
    /// Bytes while hit points are laid out, beyond those that stay.
    pub layout_bytes: f64,
}

/// The largest number of hit points, with room for the lanes of packets that stay empty: they are numbered by 32 bits.
const MAX_HIT_POINTS: f64 = FILL * u32::MAX as f64 * 0.9;

impl MemoryEstimate {
    /// Bytes of the program itself, measured from outside on a scene of nothing.
    pub const PROGRAM_BYTES: f64 = (16 << 20) as f64;

    /// Why the render is not to be started, where it would take more than `limit` bytes, or has more hit points or pixels than
    /// can be numbered; `None` where it may.
    #[must_use]
    pub fn refusal(&self, limit: Option<f64>) -> Option<String> {
        if self.hit_points.max(self.pixels) > MAX_HIT_POINTS {
            return Some(format!(
                "this render has {:.1} billion hit points in {:.1} billion pixels; {:.1} billion of either can be numbered",
                self.hit_points / 1e9,
                self.pixels / 1e9,
                MAX_HIT_POINTS / 1e9
            ));
        }
        let limit = limit.filter(|&limit| self.peak_bytes() > limit)?;
        Some(format!("this render needs about {self}; {:.0} MiB may be used", limit / f64::from(1 << 20)))
    }

    /// The largest number of bytes that are held at one time. Photons come after hit points have been laid out.
    #[must_use]
    pub fn peak_bytes(&self) -> f64 {
        let lasting = self.scene_bytes + self.hit_point_bytes + self.pixel_bytes;
        Self::PROGRAM_BYTES + lasting + self.photon_bytes.max(self.layout_bytes)
    }

    /// The largest number of bytes that are held at one time while another render of the scene, already under way, is kept.
    #[must_use]
    pub fn beside(&self, other: &Self) -> f64 {
        self.peak_bytes() + other.hit_point_bytes + other.pixel_bytes + other.photon_bytes
    }

    /// That of renders of one scene that share their photons ([`Variants`](crate::Variants)): each has hit points, pixels, and its share
    /// of the photons with their sorted copy; those are handed out from one more. `None` of none.
    #[must_use]
    pub fn together(all: &[Self]) -> Option<Self> {
        let first = all.first()?;
        let sum = |of: fn(&Self) -> f64| all.iter().map(of).sum::<f64>();
        Some(Self {
            hit_point_bytes: sum(|e| e.hit_point_bytes),
            pixel_bytes: sum(|e| e.pixel_bytes),
            photon_bytes: sum(|e| e.photon_bytes) + first.photon_bytes,
            ..*first
        })
    }
}

impl fmt::Display for MemoryEstimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mib = |bytes: f64| bytes / f64::from(1 << 20);
        write!(
            f,
            "{:.0} MiB: scene {:.0}, {:.2} M hit points {:.0} (and {:.0} while they are laid out), pixels {:.0}, photons {:.0}",
            mib(self.peak_bytes()),
            mib(self.scene_bytes),
            self.hit_points / 1e6,
            mib(self.hit_point_bytes),
            mib(self.layout_bytes),
            mib(self.pixel_bytes),
            mib(self.photon_bytes),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn renders_that_share_photons_share_the_scene_alone() {
        let one = MemoryEstimate {
            hit_points: 10.0,
            pixels: 5.0,
            scene_bytes: 1e9,
            hit_point_bytes: 1e6,
            pixel_bytes: 1e5,
            photon_bytes: 1e8,
            layout_bytes: 1e3,
        };
        let three = MemoryEstimate::together(&[one; 3]).expect("three");
        assert_eq!(three.peak_bytes(), MemoryEstimate::PROGRAM_BYTES + 1e9 + 3.0 * 1.1e6 + 4.0 * 1e8);
        assert_eq!(three.hit_points, one.hit_points, "each numbers its own");
        assert_eq!(MemoryEstimate::together(&[]), None);
    }
}
