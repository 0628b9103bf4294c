//! Final gathering: rays from what is seen to surfaces whose light the global map knows.
//!
//! A ray that meets a Lambertian surface takes the irradiance that is kept nearest `[CHR99]`, at others photons are looked up. Mirrors and
//! glass are followed. Emitters that rays meet are left out: their light is direct light, or a caustic, where the ray began. In
//! corners a ray is shorter than the discs of the map are wide; there the map would show its blur, so that light is followed one
//! surface further: by a shadow ray, the caustic map and another ray.

use std::f32::consts::FRAC_1_PI;

use foton_math::glam::Vec3;
use foton_math::{Frame, Ray, Rgb, Stream};
use foton_scene::{LobeFlags, Scattering, Surface, Transport};
use foton_transport::direct_light::{Lights, Receiver, SCRAMBLES, Scramble};
use foton_transport::kd_tree::{KernelFilter, Nearest};
use foton_transport::shading::{MIN_COSINE, leaves_wrongly, on_the_right_side, shading_view};

use super::maps::LookUp;
use super::place::Place;
use crate::ppm::LOBE_POLICY;

/// So often light is followed one surface further.
const MAX_FURTHER: u32 = 3;

/// From this many specular surfaces on, rays end by roulette.
const ROULETTE: u32 = 4;
/// The chance to go on.
const SURVIVAL: f32 = 0.8;

/// What gather rays need to know.
pub(super) struct Gather<'a> {
    pub(super) look_up: LookUp<'a>,
    pub(super) lights: &'a Lights,
    pub(super) filter: KernelFilter,
    pub(super) max_depth: u32,
}

/// What changes on the way of a ray.
pub(super) struct Scratch<'a> {
    pub(super) stream: &'a mut Stream,
    pub(super) nearest: &'a mut Nearest,
    pub(super) rays: &'a mut u64,
}

/// A ray on its way.
struct Way {
    ray: Ray,
    weight: Rgb,
    /// Edges from the eye to its end.
    edges: u32,
    /// Whether it comes from a surface that spreads light.
    is_spread: bool,
    further: u32,
    specular: u32,
}

/// A surface that a ray has met.
struct Met<'a> {
    surface: &'a Surface,
    scattering: Scattering,
    frame: Frame,
    wo: Vec3,
    local: Vec3,
}

impl Gather<'_> {
    /// Radiance that arrives along a ray, emitters left out. `edges` are those from the eye to the ray's end.
    pub(super) fn arriving(&self, ray: Ray, edges: u32, scratch: &mut Scratch<'_>) -> Rgb {
        let mut sum = Rgb::BLACK;
        let mut way = Some(Way { ray, weight: Rgb::WHITE, edges, is_spread: true, further: 0, specular: 0 });
        while let Some(now) = way {
            way = self.step(now, &mut sum, scratch);
        }
        sum
    }

    fn step(&self, way: Way, sum: &mut Rgb, scratch: &mut Scratch<'_>) -> Option<Way> {
        *scratch.rays += 1;
        let scene = self.look_up.scene;
        if way.edges >= self.max_depth {
            return None;
        }
        let mut surface = scene.nearest(way.ray)?;
        let wo = -way.ray.direction;
        let outward = wo.dot(surface.normal) > 0.0;
        let u = if scene.is_mixture(&surface) { scratch.stream.next_1d() } else { 0.0 };
        scene.choose_component(&mut surface, outward, u);
        let scattering = scene.scattering(&surface, outward)?;
        let (frame, local) = shading_view(scene, &surface, wo);
        let met = Met { surface: &surface, scattering, frame, wo, local };
        let split = LOBE_POLICY.split(&scattering);
        if split.gathers() {
            let distance = surface.position.distance(way.ray.origin);
            let is_near = way.is_spread && distance < self.look_up.maps.reach.irradiance_disc;
            if is_near && way.further < MAX_FURTHER {
                *sum += way.weight * self.looked_for(&met, split.gathered, way.edges, scratch);
                return Self::go_further(way, &met, scratch);
            }
            *sum += way.weight * self.known(&met, split.gathered, way.edges, scratch);
        }
        if split.follows() || scattering.opacity < 1.0 {
            Self::follow(way, &met, split.specular, scratch)
        } else {
            None
        }
    }

    /// Radiance that a surface reflects by `lobes`, as the global map knows it.
    fn known(&self, met: &Met<'_>, lobes: LobeFlags, edges: u32, scratch: &mut Scratch<'_>) -> Rgb {
        // What is kept is irradiance by the geometric normal.
        if let Some(albedo) = met.scattering.lambertian().filter(|_| !met.surface.is_relieved) {
            let place = Place::on(met.surface, met.wo, self.max_depth - edges);
            let kept = self.look_up.maps.kept(&place).map(|(irradiance, _)| irradiance);
            let irradiance = kept.unwrap_or_else(|| {
                self.look_up.global(&place, scratch.nearest, |_| true, |_| Rgb::WHITE).per_area
            });
            return albedo * FRAC_1_PI * irradiance;
        }
        let mut sum = Rgb::BLACK;
        for to in met.sides() {
            let place = Place::on(met.surface, to, self.max_depth - edges);
            let value = |wi: Vec3| met.value_of_photon(wi, lobes);
            sum += self.look_up.global(&place, scratch.nearest, |_| true, value).per_area;
        }
        sum
    }

    /// Direct light and caustics that a surface reflects by `lobes`: without the global map.
    fn looked_for(&self, met: &Met<'_>, lobes: LobeFlags, edges: u32, scratch: &mut Scratch<'_>) -> Rgb {
        let scrambles: [Scramble; SCRAMBLES] =
            std::array::from_fn(|_| std::array::from_fn(|_| scratch.stream.next_bits()));
        let (scene, mut sum) = (self.look_up.scene, Rgb::BLACK);
        for to in met.sides() {
            let place = Place::on(met.surface, to, self.max_depth - edges);
            let side = 1f32.copysign(met.surface.normal.dot(to));
            let at = Receiver {
                origin: met.surface.ray_origin(place.normal),
                normal: met.frame.normal * side,
                edges: self.max_depth - edges,
            };
            let mut add = |arrival: foton_transport::direct_light::Arrival| {
                sum += arrival.irradiance * met.value(arrival.from, lobes);
            };
            self.lights.fixed(scene, &at, scratch.rays, &mut add);
            self.lights.sample(scene, &at, (0, &scrambles), scratch.rays, &mut add);
            let value = |wi: Vec3| met.value_of_photon(wi, lobes);
            sum += self.look_up.caustic(&place, scratch.nearest, self.filter, value).per_area;
        }
        sum
    }

    /// Goes on from a surface by any of its lobes.
    fn go_further(way: Way, met: &Met<'_>, scratch: &mut Scratch<'_>) -> Option<Way> {
        let (u, direction) = (scratch.stream.next_1d(), scratch.stream.next_2d());
        let split = LOBE_POLICY.split(&met.scattering);
        let sample = met.scattering.sample(met.local, Transport::Radiance, u, direction, split.specular)?;
        let is_spread = !split.specular.intersects(sample.lobe.spreading());
        let further = way.further + u32::from(is_spread);
        Self::leave(Way { is_spread, further, ..way }, met, sample.wi, sample.weight)
    }

    /// Goes on by one of the specular lobes of a surface.
    fn follow(way: Way, met: &Met<'_>, lobes: LobeFlags, scratch: &mut Scratch<'_>) -> Option<Way> {
        let mut weight = way.weight;
        if way.specular >= ROULETTE {
            if scratch.stream.next_1d() >= SURVIVAL {
                return None;
            }
            weight = weight / SURVIVAL;
        }
        let (u, facet) = (scratch.stream.next_1d(), scratch.stream.next_2d());
        let lobe = met.scattering.choose_lobe(met.local, Transport::Radiance, u, facet, lobes)?;
        let way = Way { weight, is_spread: false, specular: way.specular + 1, ..way };
        Self::leave(way, met, lobe.wi, lobe.weight / lobe.probability)
    }

    fn leave(way: Way, met: &Met<'_>, wi: Vec3, weight: Rgb) -> Option<Way> {
        let sampled = met.frame.to_outer(wi).normalize();
        let reflects = wi.z * met.local.z > 0.0;
        if way.is_spread && leaves_wrongly(met.surface, met.wo, sampled, reflects) {
            return None;
        }
        let direction = on_the_right_side(met.surface, met.wo, sampled, reflects);
        let weight = way.weight * weight;
        let ray = Ray::new(met.surface.ray_origin(direction), direction);
        (!weight.is_black() && weight.is_finite()).then_some(Way { ray, weight, edges: way.edges + 1, ..way })
    }
}

impl Met<'_> {
    /// Directions to the sides on which light that arrives is gathered.
    fn sides(&self) -> impl Iterator<Item = Vec3> + use<> {
        let wo = self.wo;
        let split = LOBE_POLICY.split(&self.scattering);
        split.sides(self.scattering.flags()).map(move |behind| if behind { -wo } else { wo })
    }

    /// The value of `lobes` for light from the unit direction `wi` (sr⁻¹).
    fn value(&self, wi: Vec3, lobes: LobeFlags) -> Rgb {
        self.scattering.eval(self.local, self.frame.to_local(wi), lobes)
    }

    /// The same for a photon, which measures irradiance about the geometric normal.
    fn value_of_photon(&self, wi: Vec3, lobes: LobeFlags) -> Rgb {
        let (normal, shading) = (self.surface.normal, self.frame.normal);
        let ratio =
            if normal == shading { 1.0 } else { wi.dot(shading) / wi.dot(normal).abs().max(MIN_COSINE) };
        self.value(wi, lobes) * ratio.abs().min(1.0 / MIN_COSINE)
    }
}
