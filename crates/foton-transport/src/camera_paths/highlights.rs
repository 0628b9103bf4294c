//! Highlights of lights in narrow gloss, by looking at the lights.
//!
//! An eye path that follows a rough lobe in one direction meets a sky, often a large lamp, rarely a small one, and a point, a
//! spot or the sun never. So lights are also looked up from where a rough lobe of a metal or coat is followed: those without
//! extent all of them, of lamps one. A lamp is then found in two ways, weighted by the balance heuristic [VEA97, §9.2].
//! What lies in between blocks; but what lights without extent send straight through thin glass, masks and nothing is weighed by
//! those, since no path finds it otherwise. What mirrors and glass bend of such light comes as photons to hit points of such
//! lobes' own ([`Gloss::narrow`](super::hit_point::Gloss)).

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Frame, Ray, Rgb, Stream};
use foton_scene::{Scattering, Scene, Surface};

use crate::direct_light::SHORTENED;
use crate::lobes::LobeSplit;
use crate::shading::leaves_wrongly;
use crate::straight;

/// So many lights without extent are all looked up; of more, so many are chosen by chance.
const MAX: usize = 16;

/// Where an eye path follows rough lobes.
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
    /// The most edges from here to a light.
    pub edges: u32,
}

impl Glossy<'_> {
    /// Radiance towards `wo`, off the followed lobes, from lights that are looked up; a lamp is chosen and sampled by `u`.
    /// Adds to the number of rays.
    pub(super) fn looked_up(&self, u: (f32, f32, Vec2), stream: &mut Stream, rays: &mut u64) -> Rgb {
        let census = self.scene.census();
        let mut sum = Rgb::BLACK;
        if census.delta_emitters {
            sum += self.delta_emitters(stream, rays);
        }
        if census.area_emitters {
            sum += self.lamp(u, rays);
        }
        sum
    }

    /// The pdf (sr⁻¹) with which a glossy specular lobe is followed into `wi`; 0 for rough glass, which finds emitters by following
    /// alone.
    pub(super) fn pdf(scattering: &Scattering, split: LobeSplit, wo: Vec3, wi: Vec3) -> f32 {
        if split.follows_gloss() { scattering.glossy_pdf(wo, wi) } else { 0.0 }
    }

    /// Of two ways to find a lamp, the share of following a lobe with the given density (sr⁻¹) into it from `position`.
    pub(super) fn share_of_following(scene: &Scene, lamp: &Surface, position: Vec3, density: f32) -> f32 {
        let looking = scene.area_emitter_pdf(lamp, position);
        if looking > 0.0 { density / (density + looking) } else { 1.0 }
    }

    fn delta_emitters(&self, stream: &mut Stream, rays: &mut u64) -> Rgb {
        let (emitters, found) = (self.scene.emitters(), self.scene.delta_emitters());
        if found.len() <= MAX {
            return found.iter().map(|&i| self.look_at(i as usize, (0.0, Vec2::ZERO), |_| 1.0, rays)).sum();
        }
        let mut sum = Rgb::BLACK;
        for _ in 0..MAX {
            if let Some((i, chance)) = self.scene.choose_emitter(f64::from(stream.next_1d()))
                && emitters[i].is_delta()
            {
                sum += self.look_at(i, (0.0, Vec2::ZERO), |_| 1.0, rays) / (MAX as f32 * chance as f32);
            }
        }
        sum
    }

    fn lamp(&self, (u_emitter, u_part, u): (f32, f32, Vec2), rays: &mut u64) -> Rgb {
        let Some((i, chance)) = self.scene.choose_emitter(f64::from(u_emitter)) else { return Rgb::BLACK };
        if !self.scene.emitters()[i].is_area() {
            return Rgb::BLACK;
        }
        let chance = chance as f32;
        let share = |[looking, following]: [f32; 2]| chance * looking / (chance * looking + following);
        self.look_at(i, (u_part, u), share, rays) / chance
    }

    /// What one sampled point of an emitter adds, times a share made of the densities of looking there and of following a
    /// lobe there.
    fn look_at(
        &self,
        index: usize,
        (u_part, u): (f32, Vec2),
        share: impl Fn([f32; 2]) -> f32,
        rays: &mut u64,
    ) -> Rgb {
        let emitter = &self.scene.emitters()[index];
        let at = emitter.illuminate(self.surface.position, self.surface.normal, u_part, u);
        let Some(light) = at else { return Rgb::BLACK };
        let wi = self.frame.to_local(light.direction);
        let following = Self::pdf(self.scattering, self.split, self.wo, wi);
        if emitter.is_area() && following <= 0.0 {
            // Glass: its lobes find lamps by following alone.
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
        let passed = if emitter.is_area() {
            // Followed paths find it behind what they pass straight through, and weigh it there by itself.
            *rays += 1;
            if self.scene.occluded(ray) { Rgb::BLACK } else { Rgb::WHITE }
        } else {
            straight::share(self.scene, ray, self.edges, rays)
        };
        value * light.radiance_over_pdf * passed * share([light.density, following])
    }
}
