//! One path of the path tracer.
//!
//! Light is found in two ways: a shadow ray goes to a sampled point of an emitter, and the direction that the path goes on in may meet
//! one. The power heuristic weighs both `[VEA97, §9.2]`. Emitters of a single point or direction are met by no path: their light is
//! found by shadow rays only, and none of it behind mirrors or bending glass.

use foton_math::glam::Vec3;
use foton_math::{Ray, Rgb};
use foton_scene::{Footprint, Scene, Surface};
use foton_transport::direct_light::{Arrival, Lights, Receiver};
use foton_transport::photon_map::PathClass;
use foton_transport::{Bounce, Departure, Differential, LeftOut, LobePolicy, Quantity, Vertex};

use crate::ppm::LOBE_POLICY;
use crate::sampled::sample::{EyeSample, Numbers, Seen};
use crate::settings::RenderSettings;

/// From this many edges on, paths end by roulette.
const ROULETTE_EDGES: u32 = 5;
/// The largest chance to go on.
const SURVIVAL: f32 = 0.95;

/// A path tracer for a scene.
pub(crate) struct PathTracer {
    lights: Lights,
    max_depth: u32,
    /// Tells caustic from indirect light, as for photons.
    policy: LobePolicy,
}

/// A path that goes on.
struct Path {
    ray: Ray,
    weight: Rgb,
    /// Edges up to the end of `ray`.
    edges: u32,
    /// What light is that it meets now; `None` as long as emitters are seen directly or by specular bounces.
    class: Option<PathClass>,
    /// Where shadow rays have been sent from for the same light, and the pdf of its direction; `None` where none have.
    sampled_at: Option<(Receiver, f32)>,
}

impl PathTracer {
    pub(crate) fn new(scene: &Scene, settings: &RenderSettings) -> Self {
        Self { lights: Lights::new(scene), max_depth: settings.max_depth_in(scene), policy: LOBE_POLICY }
    }

    /// Follows an eye sample to its end.
    pub(crate) fn follow(&self, scene: &Scene, sample: EyeSample, seen: &mut Seen) {
        let EyeSample { ray, mut differential, mut numbers } = sample;
        let mut path = Path { ray, weight: Rgb::WHITE, edges: 1, class: None, sampled_at: None };
        while self.step(scene, &mut path, &mut differential, &mut numbers, seen).is_some() {}
    }

    /// Follows the path to the next surface and on from there; `None` where it ends. `differential` is how far neighbouring samples are apart
    /// on it, as long as they go together.
    fn step(
        &self,
        scene: &Scene,
        path: &mut Path,
        differential: &mut Option<Differential>,
        numbers: &mut Numbers,
        seen: &mut Seen,
    ) -> Option<()> {
        seen.rays += 1;
        let Some(mut surface) = scene.nearest(path.ray) else {
            self.see_surroundings(scene, path, seen);
            return None;
        };
        if path.edges == 1 {
            seen.shape = Some(surface.shape);
        }
        let footprint = differential.map(|d| d.footprint(&path.ray, &surface));
        self.see_emitter(scene, path, (&surface, footprint.as_ref()), seen);
        let wo = -path.ray.direction;
        let outward = wo.dot(surface.normal) > 0.0;
        let u = if scene.is_mixture(&surface) { numbers.choice() } else { 0.0 };
        scene.choose_component(&mut surface, outward, u);
        let vertex = Vertex::new(scene, &surface, wo, &self.policy, footprint.as_ref())?;
        seen.scatters |= path.class.is_none() && vertex.split.gathers();
        if path.edges >= self.max_depth {
            return None;
        }
        if vertex.scattering.flags().spreads() {
            self.look_for_emitters(scene, path, &vertex, numbers, seen);
        }
        let bounce = self.go_on(path, &vertex, numbers, seen)?;
        if differential.is_some() {
            // Light that spreads does not go together any more.
            let arriving = differential.zip(footprint).filter(|_| bounce != Bounce::Gathered);
            *differential = vertex.bent(scene, arriving, path.ray.direction);
        }
        Some(())
    }

    /// Adds what the path sees of emitters that are infinitely far away.
    fn see_surroundings(&self, scene: &Scene, path: &Path, seen: &mut Seen) {
        if !scene.census().environment || path.edges > self.max_depth {
            return;
        }
        let direction = path.ray.direction;
        for (index, emitter) in scene.emitters().iter().enumerate().filter(|(_, e)| e.is_environment()) {
            let pdf = |at: &Receiver| emitter.pdf_of_direction(at.normal, direction);
            let weight = self.weight(path, index, pdf);
            self.add(
                seen,
                path.class,
                path.weight * emitter.escaped_radiance(direction) * weight,
                path.ray.origin,
            );
        }
    }

    /// Adds what a surface that the path has met emits.
    fn see_emitter(
        &self,
        scene: &Scene,
        path: &Path,
        (surface, footprint): (&Surface, Option<&Footprint>),
        seen: &mut Seen,
    ) {
        if path.edges > self.max_depth {
            return;
        }
        let Some(index) = scene.emitter_of(surface) else { return };
        let emitted = scene.emitted_seen(surface, -path.ray.direction, footprint);
        if emitted.is_black() {
            return;
        }
        let emitter = &scene.emitters()[index];
        let weight = self.weight(path, index, |at| emitter.pdf_of_point(surface, at.origin));
        self.add(seen, path.class, path.weight * emitted * weight, surface.position);
    }

    /// The weight of light that a path meets by chance and shadow rays find with that pdf.
    fn weight(&self, path: &Path, emitter: usize, pdf: impl Fn(&Receiver) -> f32) -> f32 {
        let Some((at, by_bsdf)) = &path.sampled_at else { return 1.0 };
        power_heuristic(*by_bsdf, pdf(at) * self.lights.probability(at, emitter as u32) as f32)
    }

    /// Sends shadow rays to emitters.
    fn look_for_emitters(
        &self,
        scene: &Scene,
        path: &Path,
        vertex: &Vertex<'_>,
        numbers: &mut Numbers,
        seen: &mut Seen,
    ) {
        let edges = self.max_depth - path.edges;
        let sides: &[bool] = if vertex.scattering.bsdf.transmits() { &[false, true] } else { &[false] };
        let (index, scrambles) = numbers.lights();
        for behind in sides {
            let at = vertex.receiver(*behind, edges);
            let mut rays = 0;
            let add = |arrival: Arrival| self.add_arrival(path, vertex, &arrival, seen);
            let mut add = add;
            self.lights.fixed(scene, &at, &mut rays, &mut add);
            self.lights.sample(scene, &at, (index, &scrambles), &mut rays, &mut add);
            seen.rays += rays;
        }
    }

    fn add_arrival(&self, path: &Path, vertex: &Vertex<'_>, arrival: &Arrival, seen: &mut Seen) {
        let Arrival { irradiance, from, pdf, .. } = *arrival;
        let weight = if pdf.is_finite() { power_heuristic(pdf, vertex.pdf(from)) } else { 1.0 };
        let light = path.weight * irradiance * weight;
        for (lobes, bounce) in
            [(vertex.split.gathered, Bounce::Gathered), (vertex.split.specular, Bounce::Glossy)]
        {
            if lobes.spreads() {
                let class = after(path.class, bounce);
                self.add(seen, class, light * vertex.eval(from, lobes), vertex.surface.position);
            }
        }
    }

    /// Chooses a direction in which the path goes on.
    fn go_on(
        &self,
        path: &mut Path,
        vertex: &Vertex<'_>,
        numbers: &mut Numbers,
        seen: &mut Seen,
    ) -> Option<Bounce> {
        let (choice, direction) = (numbers.choice(), numbers.direction());
        let Departure { ray, weight, bounce, pdf } = vertex.sample(choice, direction)?;
        let mut weight = path.weight * weight;
        if !weight.is_finite() {
            self.note(seen, Quantity::EyeWeight, vertex.surface.position);
            return None;
        }
        if path.edges >= ROULETTE_EDGES {
            let survival = weight.max_component().min(SURVIVAL);
            if numbers.choice() >= survival {
                return None;
            }
            weight = weight / survival;
        }
        if weight.is_black() {
            return None;
        }
        path.sampled_at = match bounce {
            Bounce::Straight => path.sampled_at.take(),
            _ if pdf > 0.0 => {
                let behind =
                    !is_on_the_side_of_the_path(path.ray.direction, ray.direction, vertex.surface.normal);
                Some((vertex.receiver(behind, 0), pdf))
            }
            _ => None,
        };
        (path.ray, path.weight) = (ray, weight);
        path.edges += 1;
        path.class = after(path.class, bounce);
        Some(bounce)
    }

    /// Adds light, or notes where it is no number.
    fn add(&self, seen: &mut Seen, class: Option<PathClass>, light: Rgb, position: Vec3) {
        if !light.is_finite() {
            self.note(seen, Quantity::SeenEmission, position);
        }
        seen.add(class, light);
    }

    fn note(&self, seen: &mut Seen, quantity: Quantity, position: Vec3) {
        seen.left_out.get_or_insert(LeftOut {
            quantity,
            light: None,
            surface: foton_transport::Surface::Unknown,
            position,
        });
    }
}

/// What light is that a path meets after a bounce.
pub(crate) const fn after(class: Option<PathClass>, bounce: Bounce) -> Option<PathClass> {
    match (class, bounce) {
        (class, Bounce::Straight) => class,
        (None, Bounce::Gathered) => Some(PathClass::Direct),
        (Some(_), Bounce::Gathered) => Some(PathClass::Indirect),
        (Some(PathClass::Direct), _) => Some(PathClass::Caustic),
        (class, _) => class,
    }
}

/// Whether a direction leaves on the side that a path came from.
fn is_on_the_side_of_the_path(arriving: Vec3, leaving: Vec3, normal: Vec3) -> bool {
    arriving.dot(normal) * leaving.dot(normal) < 0.0
}

/// The weight of a direction found with the pdf `a`, that another way finds with `b`. `[VEA97]` equation 9.9 with β = 2
fn power_heuristic(a: f32, b: f32) -> f32 {
    // The ratio does not overflow.
    if a > b { 1.0 / (1.0 + (b / a).powi(2)) } else { (a / b).powi(2) / (1.0 + (a / b).powi(2)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_of_both_ways_add_up_to_one() {
        for (a, b) in [(1.0, 1.0), (0.0, 2.0), (2.0, 0.0), (1e-20, 1e20), (1e30, 1e29), (3.0, 7.0)] {
            let sum = power_heuristic(a, b) + power_heuristic(b, a);
            assert!((sum - 1.0).abs() < 1e-6, "{a} {b}: {sum}");
        }
        assert_eq!(power_heuristic(3.0, 0.0), 1.0);
        assert!((power_heuristic(1.0, 2.0) - 0.2).abs() < 1e-6);
    }

    #[test]
    fn light_is_of_the_class_that_photons_of_the_same_path_have() {
        use Bounce::{Delta, Gathered, Glossy, Straight};
        let class = |bounces: &[Bounce]| bounces.iter().fold(None, |class, bounce| after(class, *bounce));
        assert_eq!(class(&[Delta, Glossy, Straight]), None);
        assert_eq!(class(&[Delta, Gathered, Straight]), Some(PathClass::Direct));
        assert_eq!(class(&[Gathered, Delta, Straight, Glossy]), Some(PathClass::Caustic));
        assert_eq!(class(&[Gathered, Delta, Gathered]), Some(PathClass::Indirect));
        assert_eq!(class(&[Gathered, Gathered, Delta]), Some(PathClass::Indirect));
    }
}
