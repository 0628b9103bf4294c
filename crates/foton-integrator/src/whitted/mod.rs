//! Whitted's ray tracing: shadow rays, perfect reflection and refraction, and nothing else. `[WHI80]`
//!
//! What mirrors and glass throw on other surfaces, and what these throw on each other, is missing: that is what photons are for.

use foton_math::{Ray, Rgb};
use foton_scene::{Footprint, Scene};
use foton_transport::direct_light::{Arrival, Lights};
use foton_transport::photon_map::PathClass;
use foton_transport::{Differential, LobePolicy, Vertex};

use crate::sampled::sample::{EyeSample, Numbers, Seen};
use crate::settings::RenderSettings;

/// Shadow rays from a surface to emitters that are not of a single point or direction: to each that is infinitely far away, and to those
/// that are chosen among the others.
const SHADOW_RAYS: u32 = 4;

/// Up to this many rays are followed for an eye sample; of more, one at each surface.
const MAX_RAYS: u32 = 16;

/// A ray tracer for a scene.
pub(crate) struct Whitted {
    lights: Lights,
    max_depth: u32,
}

/// A ray that is to be followed.
struct Branch {
    ray: Ray,
    weight: Rgb,
    edges: u32,
    /// How far neighbouring samples are apart; `None` where nothing asks for it.
    differential: Option<Differential>,
    /// What the sample covers of the surface at the end of `ray`, once that is known.
    footprint: Option<Footprint>,
}

impl Whitted {
    /// All lobes but delta ones are lit by shadow rays, however narrow they are.
    const POLICY: LobePolicy = LobePolicy { max_specular_roughness: 0.0 };

    pub(crate) fn new(scene: &Scene, settings: &RenderSettings) -> Self {
        Self { lights: Lights::new(scene), max_depth: settings.max_depth_in(scene) }
    }

    /// Follows an eye sample through mirrors and glass.
    pub(crate) fn follow(&self, scene: &Scene, sample: EyeSample, seen: &mut Seen) {
        let EyeSample { ray, differential, mut numbers } = sample;
        let mut branches = vec![Branch { ray, weight: Rgb::WHITE, edges: 1, differential, footprint: None }];
        let mut rays = 1;
        while let Some(branch) = branches.pop() {
            self.step(scene, branch, &mut numbers, seen, &mut branches, &mut rays);
        }
    }

    fn step(
        &self,
        scene: &Scene,
        branch: Branch,
        numbers: &mut Numbers,
        seen: &mut Seen,
        branches: &mut Vec<Branch>,
        rays: &mut u32,
    ) {
        seen.rays += 1;
        let is_visible = branch.edges <= self.max_depth;
        let Some(surface) = scene.nearest(branch.ray) else {
            if is_visible {
                seen.add(None, branch.weight * scene.escaped_radiance(branch.ray.direction));
            }
            return;
        };
        if branch.edges == 1 {
            seen.shape = Some(surface.shape);
        }
        let wo = -branch.ray.direction;
        let footprint = branch.differential.map(|d| d.footprint(&branch.ray, &surface));
        let branch = Branch { footprint, ..branch };
        if is_visible {
            seen.add(None, branch.weight * scene.emitted_seen(&surface, wo, footprint.as_ref()));
        }
        if branch.edges >= self.max_depth {
            return;
        }
        for (surface, share) in
            scene.components_seen(&surface, wo.dot(surface.normal) > 0.0, footprint.as_ref())
        {
            if let Some(vertex) = Vertex::new(scene, &surface, wo, &Self::POLICY, footprint.as_ref()) {
                let branch = Branch { weight: branch.weight * share, ..branch };
                self.meet(scene, &branch, &vertex, numbers, seen, branches, rays);
            }
        }
    }

    /// Lights a surface, and goes on by its delta lobes.
    #[allow(clippy::too_many_arguments, reason = "all of a step; a struct of them is a copy of them")]
    fn meet(
        &self,
        scene: &Scene,
        branch: &Branch,
        vertex: &Vertex<'_>,
        numbers: &mut Numbers,
        seen: &mut Seen,
        branches: &mut Vec<Branch>,
        rays: &mut u32,
    ) {
        if vertex.scattering.flags().spreads() {
            seen.scatters = true;
            let lit = self.lit(scene, branch, vertex, numbers, seen);
            seen.add(Some(PathClass::Direct), branch.weight * lit);
        }
        let lobes: Vec<_> = vertex.delta_lobes().collect();
        let follows_all = *rays + lobes.len() as u32 <= MAX_RAYS;
        let mut left = if follows_all { 0.0 } else { numbers.choice() };
        for (departure, probability) in lobes {
            let chance = if follows_all { 1.0 } else { probability };
            let is_chosen = (0.0..chance).contains(&left);
            left -= if follows_all { 0.0 } else { probability };
            if !is_chosen {
                continue;
            }
            let weight = branch.weight * departure.weight / chance;
            if !weight.is_black() && weight.is_finite() {
                *rays += 1;
                let (ray, arriving) = (departure.ray, branch.differential.zip(branch.footprint));
                let differential = vertex.bent(scene, arriving, ray.direction);
                branches.push(Branch { ray, weight, edges: branch.edges + 1, differential, footprint: None });
            }
        }
    }

    /// Radiance that a surface reflects of emitters.
    fn lit(
        &self,
        scene: &Scene,
        branch: &Branch,
        vertex: &Vertex<'_>,
        numbers: &mut Numbers,
        seen: &mut Seen,
    ) -> Rgb {
        let sides: &[bool] = if vertex.scattering.bsdf.transmits() { &[false, true] } else { &[false] };
        let (index, scrambles) = numbers.lights();
        let mut sum = Rgb::BLACK;
        for behind in sides {
            let at = vertex.receiver(*behind, self.max_depth - branch.edges);
            let value =
                |arrival: &Arrival| vertex.eval(arrival.from, vertex.scattering.flags()) * arrival.irradiance;
            self.lights.fixed(scene, &at, &mut seen.rays, |arrival| sum += value(&arrival));
            let mut of_several = Rgb::BLACK;
            for i in 0..SHADOW_RAYS {
                let point = (index.wrapping_mul(SHADOW_RAYS).wrapping_add(i), &scrambles);
                self.lights
                    .sample(scene, &at, point, &mut seen.rays, |arrival| of_several += value(&arrival));
            }
            sum += of_several / SHADOW_RAYS as f32;
        }
        sum
    }
}
