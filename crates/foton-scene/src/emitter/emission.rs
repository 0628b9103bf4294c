//! What emitters give: the start of a photon, and light that arrives at a point.

use foton_math::Rgb;
use foton_math::glam::Vec3;

/// The start of a photon path.
#[derive(Clone, Copy, Debug)]
pub struct Emission {
    /// Where the photon starts, off the emitting surface.
    pub origin: Vec3,
    /// Unit direction.
    pub direction: Vec3,
    /// The emitter's power, as this one photon would carry it were it the only one emitted.
    pub power: Rgb,
}

/// Light that arrives at a point from one sampled point of an emitter, unless something is in between.
#[derive(Clone, Copy, Debug)]
pub struct Illumination {
    /// Unit direction towards the emitter.
    pub direction: Vec3,
    /// Distance to the sampled point; infinite for emitters at infinity.
    pub distance: f32,
    /// Radiance over the pdf per solid angle; for point emitters intensity over squared distance.
    /// Times `f cos θ` it estimates the reflected radiance.
    pub radiance_over_pdf: Rgb,
    /// The pdf of the direction (sr⁻¹); infinite for delta emitters.
    pub pdf: f32,
}

/// Light that arrives from infinitely far away.
pub(super) const fn from_infinity(direction: Vec3, radiance_over_pdf: Rgb, pdf: f32) -> Illumination {
    Illumination { direction, distance: f32::INFINITY, radiance_over_pdf, pdf }
}

/// Light that arrives from one point.
pub(super) fn from_point(emitter: Vec3, position: Vec3, intensity: Rgb) -> Option<Illumination> {
    let d = emitter - position;
    let distance2 = d.length_squared();
    (distance2 > 0.0 && !intensity.is_black()).then(|| Illumination {
        direction: d / distance2.sqrt(),
        distance: distance2.sqrt(),
        radiance_over_pdf: intensity / distance2,
        pdf: f32::INFINITY,
    })
}
