//! What a path takes at a surface: directions, their weights and chances.

use foton_math::Rgb;
use foton_math::glam::Vec3;

/// What flows along the path: it decides whether refraction scales by the squared relative index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transport {
    /// Eye paths: radiance is compressed or spread by refraction.
    Radiance,
    /// Photon paths: power is not.
    Importance,
}

/// A direction in which a specular lobe continues.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpecularLobe {
    /// Unit direction.
    pub wi: Vec3,
    /// What the path's weight is multiplied with when every lobe is followed.
    pub weight: Rgb,
    /// The chance with which a path that follows a single lobe should take this one; chances of all lobes sum to 1 at most.
    pub probability: f32,
}

/// Specular lobes of one surface: reflection, refraction, straight on.
pub const LOBES: usize = 3;

/// The kind of a lobe that a path took. Eye paths follow all but the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lobe {
    /// One for which hit points gather photons.
    Gathered,
    /// A single direction: that of a mirror or of smooth glass.
    Single,
    /// A narrow one, or that of rough glass.
    Narrow,
    /// Straight on, as if there were no surface.
    Straight,
}

/// One direction chosen at random.
#[derive(Clone, Copy, Debug)]
pub struct BsdfSample {
    /// Unit direction.
    pub wi: Vec3,
    /// `f · |cos θ| / pdf`, the chance of the lobe included.
    pub weight: Rgb,
    /// What kind of lobe it came from.
    pub lobe: Lobe,
}
