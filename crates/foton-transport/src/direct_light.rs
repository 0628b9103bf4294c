//! Direct light by shadow rays: one sampled point of one emitter at a time.

use foton_math::glam::Vec3;
use foton_math::{Ray, Rgb, Stream};
use foton_scene::Scene;

use crate::straight;

/// Shadow rays end this share before a sampled point on a surface, which must not shadow itself.
pub const SHORTENED: f32 = 1e-4;

/// Irradiance from one sampled point of an emitter over at most `edges` edges, and the direction it comes from.
pub fn estimate(
    scene: &Scene,
    (origin, normal): (Vec3, Vec3),
    edges: u32,
    stream: &mut Stream,
    rays: &mut u64,
) -> Option<(Rgb, Vec3)> {
    let (emitter, probability) = scene.choose_emitter(f64::from(stream.next_1d()))?;
    let emitter = &scene.emitters()[emitter];
    let light = emitter.illuminate(origin, normal, stream.next_1d(), stream.next_2d())?;
    let cosine = light.direction.dot(normal);
    if cosine <= 0.0 {
        return None;
    }
    let ray =
        Ray { origin, direction: light.direction, t_min: 0.0, t_max: light.distance * (1.0 - SHORTENED) };
    let transmittance = straight::transmittance(scene, ray, edges, rays);
    let irradiance = light.radiance_over_pdf * transmittance * (cosine / probability as f32);
    (!transmittance.is_black()).then_some((irradiance, light.direction))
}
