//! Emitters that are not surfaces.

use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};

use super::sensor::FovAxis;
use super::texture::Colour;
use crate::bitmap::Bitmap;

/// An emitter that is not a surface.
#[derive(Clone, Debug)]
pub struct EmitterDescription {
    /// The id in the file, or a name made from the type.
    pub name: String,
    /// What it emits.
    pub kind: EmitterKind,
}

/// Kinds of emitters that are not surfaces.
#[derive(Clone, Debug)]
pub enum EmitterKind {
    /// The same radiant intensity (W·sr⁻¹) in all directions.
    Point {
        /// Where it is.
        position: DVec3,
        /// Radiant intensity.
        intensity: Rgb,
    },
    /// A point emitter that shines along its +z, fading linearly in the angle between two cones.
    Spot {
        /// Emitter to world.
        to_world: DAffine3,
        /// Radiant intensity inside the inner cone (W·sr⁻¹).
        intensity: Rgb,
        /// Half angle beyond which nothing is emitted, in degrees.
        cutoff_degrees: f64,
        /// Half angle within which the intensity is full, in degrees, at most the cutoff.
        beam_degrees: f64,
        /// What colours its light, as an index into [`SceneDescription::textures`](super::SceneDescription::textures): the texture
        /// covers the square around the cone, u along the emitter's +x and v along its +y.
        texture: Option<usize>,
    },
    /// A picture that is thrown along +z, as Mitsuba 3's `projector` does.
    Projector {
        /// Emitter to world. +y is up in the picture and +x points to its left, as in a camera; its scale does not matter.
        to_world: DAffine3,
        /// What a white surface at distance 1 that faces the emitter sends back, before `scale` (W·m⁻²·sr⁻¹): its irradiance over π.
        irradiance: Colour,
        /// Factor on the irradiance.
        scale: f64,
        /// How wide it throws, in degrees along `fov_axis`, in (0, 180).
        fov_degrees: f64,
        /// What `fov_degrees` spans.
        fov_axis: FovAxis,
    },
    /// A point emitter with a radiant intensity for each direction.
    Goniometric {
        /// Emitter to world; its scale does not matter.
        to_world: DAffine3,
        /// Radiant intensity (W·sr⁻¹) before `scale`: rows are angles from +z, from 0 in the first to 180° in the last, columns those
        /// about it, from +x towards +y, each standing for the middle of its pixels.
        bitmap: Arc<Bitmap>,
        /// Factor on the intensity.
        scale: f32,
    },
    /// The same radiance (W·m⁻²·sr⁻¹) from every direction, from infinitely far away.
    Constant {
        /// Radiance.
        radiance: Rgb,
    },
    /// Parallel light from infinitely far away.
    Directional {
        /// The way the light goes, need not be of unit length.
        direction: DVec3,
        /// On a surface that faces it (W·m⁻²).
        irradiance: Rgb,
    },
    /// Radiance from infinitely far away, by direction: latitudes are rows, the first and the last of them the poles, +y of the
    /// emitter's space is up, the middle of the picture lies towards +z and its right half towards −x, as in Mitsuba 3's
    /// `envmap`.
    Environment {
        /// Emitter to world; only its rotation matters.
        to_world: DAffine3,
        /// Radiance (W·m⁻²·sr⁻¹) before `scale`.
        bitmap: Arc<Bitmap>,
        /// Factor on the radiance.
        scale: f32,
    },
}

impl EmitterKind {
    /// Where it is, unless its light comes from infinity.
    #[must_use]
    pub fn position(&self) -> Option<DVec3> {
        match self {
            Self::Point { position, .. } => Some(*position),
            Self::Spot { to_world, .. }
            | Self::Projector { to_world, .. }
            | Self::Goniometric { to_world, .. } => Some(to_world.translation),
            Self::Constant { .. } | Self::Directional { .. } | Self::Environment { .. } => None,
        }
    }

    /// The same, to move it.
    pub fn position_mut(&mut self) -> Option<&mut DVec3> {
        match self {
            Self::Point { position, .. } => Some(position),
            Self::Spot { to_world, .. }
            | Self::Projector { to_world, .. }
            | Self::Goniometric { to_world, .. } => Some(&mut to_world.translation),
            Self::Constant { .. } | Self::Directional { .. } | Self::Environment { .. } => None,
        }
    }

    /// The way its light goes, not of unit length, where it goes one way more than others.
    #[must_use]
    pub fn axis(&self) -> Option<DVec3> {
        match self {
            Self::Spot { to_world, .. }
            | Self::Projector { to_world, .. }
            | Self::Goniometric { to_world, .. } => Some(to_world.matrix3.z_axis),
            Self::Directional { direction, .. } => Some(*direction),
            Self::Point { .. } | Self::Constant { .. } | Self::Environment { .. } => None,
        }
    }

    /// Whether its light comes from all around, from infinitely far away.
    #[must_use]
    pub const fn is_around(&self) -> bool {
        matches!(self, Self::Constant { .. } | Self::Environment { .. })
    }

    /// The texture that its light comes through, as an index into
    /// [`SceneDescription::textures`](super::SceneDescription::textures).
    #[must_use]
    pub const fn texture(&self) -> Option<usize> {
        match self {
            Self::Spot { texture, .. } => *texture,
            Self::Projector { irradiance: Colour::Texture(texture), .. } => Some(*texture),
            _ => None,
        }
    }
}

/// What a projector throws its light on at distance 1: half its width and half its height, for a picture of so many pixels.
#[must_use]
pub fn projected_half(fov_degrees: f64, fov_axis: FovAxis, [width, height]: [f64; 2]) -> [f64; 2] {
    let half = (fov_degrees.to_radians() * 0.5).tan() / fov_axis.spanned([width, height]);
    [half * width, half * height]
}
