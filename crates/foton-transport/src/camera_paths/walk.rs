//! One eye sample on its way through mirrors, glass and narrow gloss.

use std::f32::consts::FRAC_1_PI;

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Ray, Rgb, Stream};
use foton_scene::{Footprint, LobeFlags, LobeSample, Scattering, Surface, Transport};

use super::eye_pass::{EyePass, EyePaths};
use super::highlights::{EmitterDraw, Glossy};
use super::hit_point::{Gloss, GlossIndex, HitPoint};
use super::pixel_samples::SamplePoints;
use super::radius::on_surface;
use crate::differential::{Bend, Differential};
use crate::lobes::LobeSplit;
use crate::not_finite::{self, LeftOut, Quantity};
use crate::shading::{on_the_right_side, shading_view};

/// Paths lighter than this are not split any more.
const SPLIT_WEIGHT: f32 = 1e-3;
/// Paths with more edges than this are not split any more.
const SPLIT_EDGES: u32 = 8;
/// From this many edges on, paths end by roulette, with this chance to go on.
const ROULETTE_EDGES: u32 = 16;
const SURVIVAL: f32 = 0.9;

/// The lobes that a hit point weights light with.
#[derive(Clone, Copy)]
struct Part {
    lobes: LobeFlags,
    /// Whether they are specular: for light that the path cannot find by sampling them.
    specular: bool,
    /// Whether light arrives at the other side, and passes through.
    behind: bool,
}

/// An eye path that goes on.
#[derive(Clone, Copy)]
pub(super) struct Branch {
    ray: Ray,
    weight: Rgb,
    /// Edges up to the end of `ray`.
    edges: u32,
    /// Length of the edges before `ray`.
    distance: f32,
    /// The pdf (sr⁻¹) of its direction, where emitters are sampled as well; 0 where they are not.
    pdf: f32,
    /// How far neighbouring samples are apart; `None` where nothing asks for it.
    differential: Option<Differential>,
    /// What the sample covers of the surface at the end of `ray`, once that is known.
    footprint: Option<Footprint>,
}

/// One eye sample on its way.
pub(super) struct Walk<'a, 'b> {
    pass: &'a EyePass<'b>,
    stream: Stream,
    /// Stratified over the pixel's samples, for the first rough specular lobe.
    facet: Option<Vec2>,
    /// The same for the point on an area emitter that is sampled from there.
    emitter_point: Option<Vec2>,
    /// Direction in which the sample leaves the camera.
    view: Vec3,
    /// Whether the pixel's shape is still to be noted.
    first: bool,
    paths: &'a mut EyePaths,
    branches: &'a mut Vec<Branch>,
    emission: Rgb,
    /// Ends that this sample may have: hit points stored, and branches under way.
    leaves: u32,
}

impl<'a, 'b> Walk<'a, 'b> {
    /// The first sample of a pixel notes the shape that it meets; what it finds is added to `paths`. `branches` is a buffer.
    pub(super) fn new(
        pass: &'a EyePass<'b>,
        stream: Stream,
        points: &SamplePoints,
        first: bool,
        paths: &'a mut EyePaths,
        branches: &'a mut Vec<Branch>,
    ) -> Self {
        Self {
            pass,
            stream,
            facet: Some(points.facet),
            emitter_point: Some(points.emitter),
            view: Vec3::ZERO,
            first,
            paths,
            branches,
            emission: Rgb::BLACK,
            leaves: 1,
        }
    }

    /// Follows the sample to all its ends; returns the emitted light that it sees by specular bounces.
    pub(super) fn follow(&mut self, pixel: u32, place: Vec2, lens: Vec2) -> Rgb {
        let sensor = self.pass.sensor();
        let corner = Vec2::new((pixel % sensor.width) as f32, (pixel / sensor.width) as f32);
        let ray = sensor.eye_ray(corner + 0.5 + sensor.filter.offset(place), lens);
        self.follow_ray(ray)
    }

    /// The same from the sensor on.
    pub(super) fn follow_ray(&mut self, ray: Ray) -> Rgb {
        self.view = ray.direction;
        let Self { pass, .. } = self;
        let (samples, renewed) = (pass.samples_per_pixel.get(), pass.pass.is_some());
        let differential = Differential::of_eye(pass.scene, pass.sensor(), &ray, samples, renewed);
        let weight = Rgb::WHITE;
        self.branches.push(Branch {
            ray,
            weight,
            edges: 1,
            distance: 0.0,
            pdf: 0.0,
            differential,
            footprint: None,
        });
        while let Some(branch) = self.branches.pop() {
            self.step(branch);
        }
        self.emission
    }

    fn step(&mut self, branch: Branch) {
        let scene = self.pass.scene;
        self.paths.rays += 1;
        let surface = scene.nearest(branch.ray);
        let visible = branch.edges <= self.pass.max_depth;
        let Some(surface) = surface else {
            if visible {
                let emitted = branch.weight * scene.escaped_radiance(branch.ray.direction);
                self.see(emitted, branch.ray.origin, None);
            }
            return;
        };
        if std::mem::take(&mut self.first)
            && let Some(shape) = self.paths.shapes.last_mut()
        {
            *shape = surface.shape;
        }
        let wo = -branch.ray.direction;
        let footprint = branch.differential.map(|d| d.footprint(&branch.ray, &surface));
        let branch = Branch { footprint, ..branch };
        if visible {
            let mut emitted = branch.weight * scene.emitted_seen(&surface, wo, footprint.as_ref());
            if branch.pdf > 0.0 && !emitted.is_black() {
                emitted *= Glossy::bsdf_sampling_weight(scene, &surface, branch.ray.origin, branch.pdf);
            }
            self.see(emitted, surface.position, Some(surface.shape));
        }
        let outward = wo.dot(surface.normal) > 0.0;
        if branch.edges >= self.pass.max_depth {
            return;
        }
        for (surface, weight) in scene.components_seen(&surface, outward, footprint.as_ref()) {
            self.meet(&Branch { weight: branch.weight * weight, ..branch }, &surface, outward);
        }
    }

    /// Stores a hit point on a surface, and follows its lobes.
    fn meet(&mut self, branch: &Branch, surface: &Surface, outward: bool) {
        let footprint = branch.footprint.as_ref();
        let Some(scattering) = self.pass.scene.scattering_seen(surface, outward, footprint) else { return };
        let distance = branch.distance + (surface.position - branch.ray.origin).length();
        let split = self.pass.policy.split(&scattering);
        for behind in split.sides(scattering.flags()) {
            let part = Part { lobes: split.gathered, specular: false, behind };
            self.store(branch, surface, &scattering, distance, part);
        }
        if split.follows() || scattering.opacity < 1.0 {
            self.follow_lobes(branch, surface, &scattering, split, distance);
        }
    }

    fn store(
        &mut self,
        branch: &Branch,
        surface: &Surface,
        scattering: &Scattering,
        distance: f32,
        part: Part,
    ) {
        let wo = -branch.ray.direction;
        let (weight, gloss) = match scattering.lambertian() {
            Some(albedo) => (branch.weight * albedo * FRAC_1_PI, None),
            None => {
                let (frame, wo) = shading_view(self.pass.scene, surface, wo);
                let Part { lobes, specular, .. } = part;
                let gloss = Gloss { scattering: *scattering, frame, wo, lobes, specular };
                self.paths.gloss.push(gloss);
                (branch.weight, GlossIndex::last_of(self.paths.gloss.len()))
            }
        };
        if weight.is_black() || !self.is_finite(weight, surface) {
            return;
        }
        let behind = if part.behind { -1.0 } else { 1.0 };
        let side = behind * 1f32.copysign(wo.dot(surface.normal));
        let normal = surface.normal * side;
        let cosine = wo.dot(normal).abs();
        let sensor = self.pass.sensor();
        let footprint = on_surface(sensor.pixel_area(self.view, distance), cosine);
        let confusion = on_surface(sensor.confusion(self.view, distance), cosine);
        let (radius2, smallest2) =
            self.pass.radius.first_and_smallest2(footprint, confusion, surface.position);
        self.paths.hit_points.push(HitPoint {
            position: surface.position,
            normal,
            shading_normal: surface.shading_normal * side,
            offset: surface.ray_offset(),
            weight,
            gloss,
            footprint,
            radius2,
            smallest2,
            patch: surface.patch_towards(side > 0.0),
            curved: surface.curved,
            remaining_edges: (self.pass.max_depth - branch.edges).min(255) as u8,
        });
    }

    /// Adds emitted light that the path sees. If it is not finite, its place is noted here and the sample is dropped at its end.
    fn see(&mut self, light: Rgb, position: Vec3, shape: Option<u32>) {
        if !light.is_finite() {
            let surface = shape.map_or(not_finite::Surface::Unknown, not_finite::Surface::Shape);
            let left_out = LeftOut { quantity: Quantity::SeenEmission, light: None, surface, position };
            self.paths.left_out.get_or_insert(left_out);
        }
        self.emission += light;
    }

    /// Whether a weight is a number; counts those that are not, and notes the first.
    fn is_finite(&mut self, weight: Rgb, surface: &Surface) -> bool {
        if weight.is_finite() {
            return true;
        }
        self.paths.dropped += 1;
        self.paths.left_out.get_or_insert(LeftOut {
            quantity: Quantity::EyeWeight,
            light: None,
            surface: not_finite::Surface::Shape(surface.shape),
            position: surface.position,
        });
        false
    }

    /// The weight with which a path goes on; `None` where it ends.
    fn roulette(&mut self, branch: &Branch) -> Option<Rgb> {
        if branch.edges < ROULETTE_EDGES {
            return Some(branch.weight);
        }
        (self.stream.next_1d() < SURVIVAL).then(|| branch.weight / SURVIVAL)
    }

    /// Adds what a rough specular lobe reflects of sampled emitters.
    fn sample_emitters(&mut self, weight: Rgb, at: &Glossy<'_>) {
        let point = self.emitter_point.take().unwrap_or_else(|| self.stream.next_2d());
        let u = EmitterDraw { emitter: self.stream.next_1d(), part: self.stream.next_1d(), point };
        let highlight = weight * at.highlights(u, &mut self.stream, &mut self.paths.rays);
        self.see(highlight, at.surface.position, Some(at.surface.shape));
    }

    /// Stores hit points of glossy specular lobes, for light that the path cannot find by sampling them.
    fn store_specular(
        &mut self,
        branch: &Branch,
        surface: &Surface,
        scattering: &Scattering,
        split: LobeSplit,
        distance: f32,
    ) {
        let part = Part { lobes: split.specular, specular: true, behind: false };
        self.store(branch, surface, scattering, distance, part);
        if scattering.bsdf.transmits() {
            self.store(branch, surface, scattering, distance, Part { behind: true, ..part });
        }
    }

    /// How far neighbouring samples are apart that leave a surface in a unit direction; `normal` is that about which it scatters.
    fn bent(
        &self,
        branch: &Branch,
        (surface, scattering): (&Surface, &Scattering),
        normal: Vec3,
        leaving: Vec3,
    ) -> Option<Differential> {
        let (differential, footprint) = branch.differential.zip(branch.footprint)?;
        let (scene, arriving) = (self.pass.scene, branch.ray.direction);
        Some(differential.bent(&Bend { scene, surface, scattering, normal, arriving, footprint }, leaving))
    }

    /// Goes on by the specular lobes of a surface: all of them where the path may split, else one chosen by chance.
    fn follow_lobes(
        &mut self,
        branch: &Branch,
        surface: &Surface,
        scattering: &Scattering,
        split: LobeSplit,
        distance: f32,
    ) {
        let Some(weight) = self.roulette(branch) else { return };
        let wo = -branch.ray.direction;
        let (frame, local) = shading_view(self.pass.scene, surface, wo);
        let is_rough = scattering.gloss().is_some();
        let facet = is_rough.then(|| self.facet.take().unwrap_or_else(|| self.stream.next_2d()));
        if self.pass.uses.highlights_by_photons && split.follows_gloss() {
            self.store_specular(&Branch { weight, ..*branch }, surface, scattering, split, distance);
        }
        let samples_emitters = self.pass.uses.highlights && facet.is_some();
        if samples_emitters {
            let edges = self.pass.max_depth - branch.edges;
            let scene = self.pass.scene;
            let at = Glossy { scene, surface, scattering, split, frame: &frame, wo: local, edges };
            self.sample_emitters(weight, &at);
        }
        let facet = facet.unwrap_or_default();
        let lobes = scattering.lobes(local, Transport::Radiance, facet, split.specular);
        let count = lobes.iter().flatten().count() as u32;
        let follows_all = branch.edges <= SPLIT_EDGES
            && weight.max_component() > SPLIT_WEIGHT
            && self.leaves < self.pass.hit_points_per_sample.get();
        let single;
        let chosen: &[_] = if follows_all || count < 2 {
            // The hit point here and each lobe beyond the first is one more end.
            self.leaves += (count + u32::from(split.gathers())).saturating_sub(1);
            &lobes
        } else {
            let u = self.stream.next_1d();
            let lobe = scattering.choose_lobe(local, Transport::Radiance, u, facet, split.specular);
            single = [lobe.map(|l| LobeSample { weight: l.weight / l.probability, ..l })];
            &single
        };
        for lobe in chosen.iter().flatten() {
            let weight = weight * lobe.weight;
            if weight.is_black() || !self.is_finite(weight, surface) {
                continue;
            }
            let sampled = frame.to_outer(lobe.wi).normalize();
            let direction = on_the_right_side(surface, wo, sampled, lobe.wi.z * local.z > 0.0);
            let is_unmirrored = samples_emitters && direction == sampled;
            let differential = self.bent(branch, (surface, scattering), frame.normal, direction);
            self.branches.push(Branch {
                ray: Ray::new(surface.ray_origin(direction), direction),
                weight,
                edges: branch.edges + 1,
                distance,
                pdf: if is_unmirrored { Glossy::pdf(scattering, split, local, lobe.wi) } else { 0.0 },
                differential,
                footprint: None,
            });
        }
    }
}
