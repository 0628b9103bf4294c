//! Light from one sampled point of an emitter.

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Ray, Rgb};
use foton_scene::Scene;

use crate::straight;

/// Shadow rays end this share before a sampled point on a surface, which must not shadow itself.
pub const SHORTENED: f32 = 1e-4;

/// A point that light arrives at.
#[derive(Clone, Copy, Debug)]
pub struct Receiver {
    /// Certainly on the side that is lit.
    pub origin: Vec3,
    /// Unit shading normal.
    pub normal: Vec3,
    /// The largest number of edges from here to an emitter.
    pub edges: u32,
}

/// Light that arrives at a receiver.
#[derive(Clone, Copy, Debug)]
pub struct Arrival {
    /// Irradiance over the probability of the sample.
    pub irradiance: Rgb,
    /// Unit direction that it comes from.
    pub from: Vec3,
    /// The pdf of the direction (sr⁻¹), times the probability of the emitter; infinite where light comes from a single one.
    pub pdf: f32,
    /// Index of the emitter.
    pub emitter: u32,
}

/// Light from a sampled point of an emitter; `None` if it does not get here. Adds to the number of rays.
pub fn arrival(
    scene: &Scene,
    at: &Receiver,
    emitter: u32,
    u: (f32, Vec2),
    rays: &mut u64,
) -> Option<Arrival> {
    arrival_if(scene, at, emitter, u, None, rays)
}

/// The same where it may be known whether the point sees all of the emitter (`Some(true)`) or nothing of it: that takes no ray.
pub(super) fn arrival_if(
    scene: &Scene,
    at: &Receiver,
    emitter: u32,
    (u_part, u): (f32, Vec2),
    sees: Option<bool>,
    rays: &mut u64,
) -> Option<Arrival> {
    let light = scene.emitters()[emitter as usize].illuminate(at.origin, at.normal, u_part, u)?;
    let cosine = light.direction.dot(at.normal);
    if cosine <= 0.0 {
        return None;
    }
    let t_max = light.distance * (1.0 - SHORTENED);
    let ray = Ray { origin: at.origin, direction: light.direction, t_min: 0.0, t_max };
    let transmittance = match sees {
        Some(true) => Rgb::WHITE,
        Some(false) => return None,
        None => straight::transmittance(scene, ray, at.edges, rays),
    };
    let irradiance = light.radiance_over_pdf * transmittance * cosine;
    (!transmittance.is_black()).then_some(Arrival {
        irradiance,
        from: light.direction,
        pdf: light.pdf,
        emitter,
    })
}
