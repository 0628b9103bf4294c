//! Light on a straight line between two points: how much of it the surfaces in between transmit.

use foton_math::glam::Vec3;
use foton_math::{Ray, Rgb};
use foton_scene::{Scene, Surface};

use crate::shading::shading_view;

/// The transmittance of a ray, each surface that it passes being one more edge; black where one blocks or deflects it, and where
/// that takes more than `edges`. Adds to the number of rays.
pub fn transmittance(scene: &Scene, mut ray: Ray, edges: u32, rays: &mut u64) -> Rgb {
    if !scene.census().straight {
        *rays += 1;
        return if edges == 0 || scene.occluded(ray) { Rgb::BLACK } else { Rgb::WHITE };
    }
    let mut transmittance = Rgb::WHITE;
    for _ in 0..edges {
        *rays += 1;
        let Some(surface) = scene.nearest(ray) else { return transmittance };
        transmittance *= through(scene, &surface, -ray.direction);
        if transmittance.is_black() {
            return Rgb::BLACK;
        }
        let origin = surface.ray_origin(ray.direction);
        let t_max = ray.t_max - (origin - ray.origin).dot(ray.direction);
        if t_max <= 0.0 {
            return transmittance;
        }
        ray = Ray { origin, t_max, ..ray };
    }
    Rgb::BLACK
}

/// The share of light towards the unit direction `wo` that passes a surface straight on.
pub fn through(scene: &Scene, surface: &Surface, wo: Vec3) -> Rgb {
    let outward = wo.dot(surface.normal) > 0.0;
    let mut sum = Rgb::BLACK;
    for (surface, weight) in scene.components(surface, outward) {
        let Some(scattering) = scene.scattering(&surface, outward) else { continue };
        let (_, local) = shading_view(scene, &surface, wo);
        sum += scattering.straight(local) * weight;
    }
    sum
}
