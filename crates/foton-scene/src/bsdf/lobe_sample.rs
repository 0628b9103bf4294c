//! What a path takes at a surface: directions, their weights and probabilities.

use foton_math::Rgb;
use foton_math::glam::Vec3;

use super::flags::LobeFlags;

/// What flows along the path: it decides whether refraction scales by the squared relative index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transport {
    /// Eye paths: radiance is compressed or spread by refraction.
    Radiance,
    /// Photon paths: power is not.
    Importance,
}

/// One direction of a delta or glossy lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LobeSample {
    /// Unit direction.
    pub wi: Vec3,
    /// What the path's weight is multiplied with when every lobe is followed.
    pub weight: Rgb,
    /// The probability with which a path that follows a single lobe should take this one; those of all lobes sum to 1 at most.
    pub probability: f32,
}

impl LobeSample {
    /// A lobe that is the only one.
    pub(super) const fn only(wi: Vec3, weight: Rgb) -> Self {
        Self { wi, weight, probability: 1.0 }
    }

    /// Light that passes straight on, where it does so at all.
    pub(super) fn straight(wo: Vec3, probability: f32, tint: Rgb) -> Option<Self> {
        (probability > 0.0).then(|| Self { wi: -wo, weight: tint * probability, probability })
    }
}

/// One direction of each delta or glossy lobe: of reflection, of refraction, straight on, and of reflection by a coating.
pub type LobeSamples = [Option<LobeSample>; 4];

/// One direction chosen at random among all lobes.
#[derive(Clone, Copy, Debug)]
pub struct BsdfSample {
    /// Unit direction.
    pub wi: Vec3,
    /// `f · |cos θ| / pdf`, the probability of the lobe included.
    pub weight: Rgb,
    /// The lobe that it came from; several where overlapping lobes were weighted together.
    pub lobe: LobeFlags,
}
