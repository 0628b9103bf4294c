//! Emitters that are not surfaces.

use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{DAffine3, DVec3};

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
