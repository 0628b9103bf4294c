//! Highlights of lights without extent in narrow gloss.
//!
//! An eye path that follows a rough lobe in one direction meets lamps and skies, but never a point, a spot or the sun: those
//! are looked up by the lobe's value where the path is, with a ray that says whether they are seen from there. What lies in
//! between blocks, glass too: their light through glass onto narrow gloss is not found by any path.

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Frame, Ray, Rgb, Stream};
use foton_scene::{Scattering, Scene, Surface};

use crate::eye_pass::leaves_wrongly;

/// So many such lights are all looked up; of more, so many are chosen by chance.
const MOST: usize = 16;

/// Radiance towards the local direction `wo`, off the followed lobes of a surface, from all emitters without extent.
/// Adds to the number of rays.
pub(crate) fn reflected(
    scene: &Scene,
    surface: &Surface,
    scattering: &Scattering,
    (frame, wo): (&Frame, Vec3),
    stream: &mut Stream,
    rays: &mut u64,
) -> Rgb {
    let emitters = scene.emitters();
    let mut sum = Rgb::BLACK;
    let mut add = |index: usize, share: f32| {
        if !emitters[index].is_without_extent() {
            return;
        }
        sum += from_emitter(scene, index, surface, scattering, (frame, wo), rays) / share;
    };
    if emitters.iter().filter(|e| e.is_without_extent()).count() <= MOST {
        (0..emitters.len()).for_each(|index| add(index, 1.0));
    } else {
        for _ in 0..MOST {
            if let Some((index, chance)) = scene.choose_emitter(f64::from(stream.next_1d())) {
                add(index, MOST as f32 * chance as f32);
            }
        }
    }
    sum
}

fn from_emitter(
    scene: &Scene,
    index: usize,
    surface: &Surface,
    scattering: &Scattering,
    (frame, wo): (&Frame, Vec3),
    rays: &mut u64,
) -> Rgb {
    let emitter = &scene.emitters()[index];
    // Where it shines from does not depend on chance, nor on the normal.
    let at = emitter.illuminate(surface.position, surface.normal, 0.0, Vec2::ZERO);
    let Some(light) = at else { return Rgb::BLACK };
    let wi = frame.to_local(light.direction);
    let value = scattering.eval_followed(wo, wi) * wi.z.abs();
    if value.is_black() || leaves_wrongly(surface, frame.to_outer(wo), light.direction, wi.z * wo.z > 0.0) {
        return Rgb::BLACK;
    }
    *rays += 1;
    let origin = surface.ray_origin(light.direction);
    let ray = Ray { origin, direction: light.direction, t_min: 0.0, t_max: light.distance };
    if scene.occluded(ray) { Rgb::BLACK } else { value * light.radiance_over_pdf }
}
