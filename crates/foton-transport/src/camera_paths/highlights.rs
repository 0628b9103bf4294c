//! Highlights in narrow gloss, by sampling emitters (next-event estimation).
//!
//! An eye path that samples a rough specular lobe once meets an environment, often a large area emitter, rarely a small one, and
//! a delta emitter never. So emitters are also sampled from rough specular lobes of metals and coats: all delta emitters, and one
//! area emitter. Light of area emitters is then found in two ways, weighted by the balance heuristic [VEA97, §9.2]. Surfaces in
//! between block, except that light of delta emitters passes straight through thin glass, masks and null surfaces, attenuated by
//! them, since no path finds it otherwise. Such light that mirrors and glass deflect arrives as photons, at hit points for these
//! lobes alone ([`Gloss::narrow`](super::hit_point::Gloss)).

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Frame, Ray, Rgb, Stream};
use foton_scene::{Scattering, Scene, Surface};

use crate::direct_light::SHORTENED;
use crate::lobes::LobeSplit;
use crate::shading::leaves_wrongly;
use crate::straight;

/// Up to this many delta emitters are all sampled; of more, this many are chosen at random.
const MAX_DELTA_EMITTERS: usize = 16;

/// Random numbers for a point on an area emitter.
#[derive(Clone, Copy)]
pub(super) struct EmitterDraw {
    /// Chooses the emitter.
    pub(super) emitter: f32,
    /// Chooses a primitive of it.
    pub(super) part: f32,
    /// Chooses a point of that.
    pub(super) point: Vec2,
}

/// A point with rough specular lobes on an eye path.
#[derive(Clone, Copy)]
pub(super) struct Glossy<'a> {
    pub scene: &'a Scene,
    pub surface: &'a Surface,
    pub scattering: &'a Scattering,
    pub split: LobeSplit,
    /// Around the shading normal.
    pub frame: &'a Frame,
    /// Where the path came from, local.
    pub wo: Vec3,
    /// The largest number of edges from here to an emitter.
    pub edges: u32,
}

impl Glossy<'_> {
    /// Radiance towards `wo` that the specular lobes reflect or transmit of sampled emitters; `u` chooses a point on an area
    /// emitter. Adds to the number of rays.
    pub(super) fn highlights(&self, u: EmitterDraw, stream: &mut Stream, rays: &mut u64) -> Rgb {
        let census = self.scene.census();
        let mut sum = Rgb::BLACK;
        if census.delta_emitters {
            sum += self.delta_emitters(stream, rays);
        }
        if census.area_emitters {
            sum += self.area_emitter(u, rays);
        }
        sum
    }

    /// The pdf (sr⁻¹) of sampling `wi` by a glossy specular lobe; 0 for rough glass, since only sampling its lobes finds area emitters.
    pub(super) fn pdf(scattering: &Scattering, split: LobeSplit, wo: Vec3, wi: Vec3) -> f32 {
        if split.follows_gloss() { scattering.glossy_pdf(wo, wi) } else { 0.0 }
    }

    /// The balance heuristic's weight of meeting an area emitter by sampling a lobe with this pdf (sr⁻¹) at `position`.
    pub(super) fn bsdf_sampling_weight(scene: &Scene, hit: &Surface, position: Vec3, pdf: f32) -> f32 {
        let emitter_pdf = scene.area_emitter_pdf(hit, position);
        if emitter_pdf > 0.0 { pdf / (pdf + emitter_pdf) } else { 1.0 }
    }

    fn delta_emitters(&self, stream: &mut Stream, rays: &mut u64) -> Rgb {
        let (emitters, found) = (self.scene.emitters(), self.scene.delta_emitters());
        if found.len() <= MAX_DELTA_EMITTERS {
            return found
                .iter()
                .map(|&i| self.sample_emitter(i as usize, (0.0, Vec2::ZERO), |_| 1.0, rays))
                .sum();
        }
        let mut sum = Rgb::BLACK;
        for _ in 0..MAX_DELTA_EMITTERS {
            if let Some((i, chance)) = self.scene.choose_emitter(f64::from(stream.next_1d()))
                && emitters[i].is_delta()
            {
                sum += self.sample_emitter(i, (0.0, Vec2::ZERO), |_| 1.0, rays)
                    / (MAX_DELTA_EMITTERS as f32 * chance as f32);
            }
        }
        sum
    }

    fn area_emitter(&self, u: EmitterDraw, rays: &mut u64) -> Rgb {
        let Some((i, chance)) = self.scene.choose_emitter(f64::from(u.emitter)) else { return Rgb::BLACK };
        if !self.scene.emitters()[i].is_area() {
            return Rgb::BLACK;
        }
        let chance = chance as f32;
        let weight = |[emitter, bsdf]: [f32; 2]| chance * emitter / (chance * emitter + bsdf);
        self.sample_emitter(i, (u.part, u.point), weight, rays) / chance
    }

    /// The radiance due to one sampled point of an emitter, times a weight made of the pdfs of sampling it on the emitter and by the
    /// BSDF.
    fn sample_emitter(
        &self,
        index: usize,
        (u_part, u): (f32, Vec2),
        weight: impl Fn([f32; 2]) -> f32,
        rays: &mut u64,
    ) -> Rgb {
        let emitter = &self.scene.emitters()[index];
        let at = emitter.illuminate(self.surface.position, self.surface.normal, u_part, u);
        let Some(light) = at else { return Rgb::BLACK };
        let wi = self.frame.to_local(light.direction);
        let bsdf_pdf = Self::pdf(self.scattering, self.split, self.wo, wi);
        if emitter.is_area() && bsdf_pdf <= 0.0 {
            // Glass: only sampling its lobes finds area emitters.
            return Rgb::BLACK;
        }
        let value = self.scattering.eval(self.wo, wi, self.split.specular) * wi.z.abs();
        let reflects = wi.z * self.wo.z > 0.0;
        if value.is_black()
            || leaves_wrongly(self.surface, self.frame.to_outer(self.wo), light.direction, reflects)
        {
            return Rgb::BLACK;
        }
        let origin = self.surface.ray_origin(light.direction);
        let t_max = light.distance * (1.0 - SHORTENED);
        let ray = Ray { origin, direction: light.direction, t_min: 0.0, t_max };
        let transmittance = if emitter.is_area() {
            // Paths that pass straight through surfaces find it by themselves, with its full weight.
            *rays += 1;
            if self.scene.occluded(ray) { Rgb::BLACK } else { Rgb::WHITE }
        } else {
            straight::transmittance(self.scene, ray, self.edges, rays)
        };
        value * light.radiance_over_pdf * transmittance * weight([light.pdf, bsdf_pdf])
    }
}
