//! A vertex of a path from the camera: the surface there, and what its BSDF does with light.

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Frame, Ray, Rgb};
use foton_scene::{Footprint, LobeFlags, LobeSample, LobeSamples, Scattering, Scene, Surface, Transport};

use crate::differential::{Bend, Differential};
use crate::direct_light::Receiver;
use crate::lobes::{Bounce, LobePolicy, LobeSplit};
use crate::shading::{leaves_wrongly, on_the_right_side, shading_view};

/// A point of a surface that a path from the camera has met.
pub struct Vertex<'a> {
    /// The surface.
    pub surface: &'a Surface,
    /// Its BSDF.
    pub scattering: Scattering,
    /// How a method divides its lobes.
    pub split: LobeSplit,
    /// Around the shading normal, in which the BSDF is stated.
    frame: Frame,
    /// Unit direction that the path came from.
    wo: Vec3,
    /// The same in the frame.
    local: Vec3,
}

/// A direction in which a path goes on.
#[derive(Clone, Copy, Debug)]
pub struct Departure {
    /// From the surface on.
    pub ray: Ray,
    /// What the path's weight is multiplied with.
    pub weight: Rgb,
    /// By which kind of lobe.
    pub bounce: Bounce,
    /// The pdf of the direction (sr⁻¹) by all lobes that spread light; 0 where it was chosen by one that does not.
    pub pdf: f32,
}

impl<'a> Vertex<'a> {
    /// Where a path from `wo` meets a surface, its colours the means over what an eye sample covers there, where that is known; `None`
    /// where that side of it is black.
    #[must_use]
    pub fn new(
        scene: &Scene,
        surface: &'a Surface,
        wo: Vec3,
        policy: &LobePolicy,
        footprint: Option<&Footprint>,
    ) -> Option<Self> {
        let scattering = scene.scattering_seen(surface, wo.dot(surface.normal) > 0.0, footprint)?;
        let (frame, local) = shading_view(scene, surface, wo);
        let split = policy.split(&scattering);
        Some(Self { surface, scattering, split, frame, wo, local })
    }

    /// How far neighbouring samples are apart that leave in a unit direction, if that is known of those that arrive.
    #[must_use]
    pub fn bent(
        &self,
        scene: &Scene,
        arriving: Option<(Differential, Footprint)>,
        leaving: Vec3,
    ) -> Option<Differential> {
        let (differential, footprint) = arriving?;
        let (surface, scattering, normal) = (self.surface, &self.scattering, self.frame.normal);
        Some(
            differential
                .bent(&Bend { scene, surface, scattering, normal, arriving: -self.wo, footprint }, leaving),
        )
    }

    /// Its point as one that light arrives at: on the side of the path, or `behind`. `edges` are those to an emitter at most.
    #[must_use]
    pub fn receiver(&self, behind: bool, edges: u32) -> Receiver {
        let towards = |side: f32| if behind { -side } else { side };
        let shading = self.frame.to_outer(Vec3::Z) * towards(1f32.copysign(self.local.z));
        let geometric = self.surface.normal * towards(1f32.copysign(self.wo.dot(self.surface.normal)));
        Receiver { origin: self.surface.ray_origin(geometric), normal: shading, edges }
    }

    /// The value of `lobes` for light from the unit direction `wi`, without the cosine (sr⁻¹).
    #[must_use]
    pub fn eval(&self, wi: Vec3, lobes: LobeFlags) -> Rgb {
        let local = self.frame.to_local(wi);
        if leaves_wrongly(self.surface, self.wo, wi, local.z * self.local.z > 0.0) {
            return Rgb::BLACK;
        }
        self.scattering.eval(self.local, local, lobes)
    }

    /// The pdf (sr⁻¹) of `wi` in [`Vertex::sample`], by all lobes that spread light.
    #[must_use]
    pub fn pdf(&self, wi: Vec3) -> f32 {
        self.scattering.pdf(self.local, self.frame.to_local(wi))
    }

    /// One direction chosen among all lobes; `None` where nothing is scattered.
    #[must_use]
    pub fn sample(&self, u_lobe: f32, u: Vec2) -> Option<Departure> {
        let sample =
            self.scattering.sample(self.local, Transport::Radiance, u_lobe, u, self.split.specular)?;
        let bounce = self.split.bounce(sample.lobe);
        let spreads = sample.lobe.spreads() && !matches!(bounce, Bounce::Straight | Bounce::Delta);
        let pdf = if spreads { self.scattering.pdf(self.local, sample.wi) } else { 0.0 };
        let reflects = sample.wi.z * self.local.z > 0.0;
        self.departure(sample.wi, reflects, sample.weight, bounce, pdf)
    }

    /// All directions of its delta lobes, each with the probability that a path which follows a single one should take it with.
    pub fn delta_lobes(&self) -> impl Iterator<Item = (Departure, f32)> {
        let lobes: LobeSamples =
            self.scattering.lobes(self.local, Transport::Radiance, Vec2::ZERO, LobeFlags::DELTA);
        lobes.into_iter().flatten().filter_map(|LobeSample { wi, weight, probability }| {
            let bounce = if wi == -self.local { Bounce::Straight } else { Bounce::Delta };
            let departure = self.departure(wi, wi.z * self.local.z > 0.0, weight, bounce, 0.0)?;
            Some((departure, probability))
        })
    }

    fn departure(
        &self,
        wi: Vec3,
        reflects: bool,
        weight: Rgb,
        bounce: Bounce,
        mut pdf: f32,
    ) -> Option<Departure> {
        let mut direction = self.frame.to_outer(wi).normalize();
        if bounce == Bounce::Straight {
            direction = -self.wo;
        } else if leaves_wrongly(self.surface, self.wo, direction, reflects) {
            if bounce == Bounce::Gathered {
                return None;
            }
            // Shadow rays do not look for light on behalf of the direction that it had.
            pdf = 0.0;
            direction = on_the_right_side(self.surface, self.wo, direction, reflects);
        }
        let ray = Ray::new(self.surface.ray_origin(direction), direction);
        Some(Departure { ray, weight, bounce, pdf })
    }
}
