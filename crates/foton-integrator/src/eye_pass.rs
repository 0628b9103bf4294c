//! The eye pass: from the sensor through mirrors, glass and narrow gloss to the surfaces that spread light, once.
//!
//! At each surface the lobes that spread light are kept by a hit point and the others are followed. Where there are several
//! to follow, a path splits, weighted by Fresnel, while its weight and depth are worth it and the sample's share of hit
//! points lasts; after that it takes one by chance. Light seen by followed bounces only is added up here: no photon is stored
//! for it anywhere.

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Purpose, Ray, Rgb, Stream};
use foton_scene::{Scattering, Scene, Sensor, Surface, Transport};
use rayon::prelude::*;
use std::f32::consts::FRAC_1_PI;

use crate::highlights::Glossy;
use crate::hit_point::{Gloss, HitPoint};
use crate::not_finite::{self, LeftOut, Quantity};
use crate::radius::{FirstRadius, slab2};
use crate::sampling::PixelSamples;
use crate::settings::Settings;
use foton_math::{Cancel, Cancelled};

/// Paths lighter than this are not split any more.
const SPLIT_WEIGHT: f32 = 1e-3;
/// Paths with more edges than this are not split any more.
const SPLIT_EDGES: u32 = 8;
/// From this many edges on, paths end by roulette, with this chance to go on.
const ROULETTE_EDGES: u32 = 16;
const SURVIVAL: f32 = 0.9;
/// Pixels that one task looks after.
const CHUNK: usize = 1024;
/// What the shape-id layer says where a pixel sees nothing.
pub(crate) const NO_SHAPE: u32 = u32::MAX;

/// What the eye pass finds in some pixels.
#[derive(Default)]
pub(crate) struct EyePaths {
    pub(crate) hit_points: Vec<HitPoint>,
    /// How those scatter that are not Lambertian.
    pub(crate) gloss: Vec<Gloss>,
    /// Hit points of each pixel.
    pub(crate) counts: Vec<u32>,
    /// Mean emitted light that each pixel sees directly or by specular bounces.
    pub(crate) emission: Vec<Rgb>,
    /// Shape that each pixel's first sample meets first; [`NO_SHAPE`] for none.
    pub(crate) shapes: Vec<u32>,
    /// Rays traced.
    pub(crate) rays: u64,
    /// Paths given up because their weight or light was not a finite number.
    pub(crate) dropped: u64,
    /// The first value of those that was none.
    pub(crate) left_out: Option<LeftOut>,
}

impl EyePaths {
    /// Where each pixel's hit points begin, and one entry more.
    pub(crate) fn pixel_start(&self) -> Vec<u32> {
        let mut start = Vec::with_capacity(self.counts.len() + 1);
        let mut sum = 0;
        start.push(0);
        for &count in &self.counts {
            sum += count;
            start.push(sum);
        }
        start
    }
}

/// Everything the eye pass needs to know.
pub(crate) struct EyePass<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) settings: &'a Settings,
    pub(crate) max_depth: u32,
    pub(crate) purpose: Purpose,
}

/// What a hit point weighs light with.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    /// The lobes that spread light.
    Kept,
    /// Narrow lobes that the path follows as well, lit from its own side: for photons that it cannot find the light of.
    Followed,
    /// The same, lit from the other side, through rough glass.
    FollowedBehind,
}

/// An eye path that goes on.
#[derive(Clone, Copy)]
struct Branch {
    ray: Ray,
    weight: Rgb,
    /// Edges up to the end of `ray`.
    edges: u32,
    /// Length of the edges before `ray`.
    distance: f32,
    /// The density (sr⁻¹) of its direction, where lamps are looked up as well; 0 where they are not.
    density: f32,
}

impl EyePass<'_> {
    fn sensor(&self) -> &Sensor {
        &self.scene.sensors()[self.settings.sensor]
    }

    /// Follows all samples of all pixels.
    pub(crate) fn run(&self, cancel: &Cancel) -> Result<EyePaths, Cancelled> {
        let pixels = self.sensor().width as usize * self.sensor().height as usize;
        let parts: Vec<EyePaths> = (0..pixels.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let part =
                    self.follow((chunk * CHUNK..pixels.min((chunk + 1) * CHUNK)).map(|p| p as u32), cancel);
                cancel.check().map(|()| part)
            })
            .collect::<Result<_, _>>()?;
        let mut all = EyePaths::default();
        all.hit_points.reserve_exact(parts.iter().map(|p| p.hit_points.len()).sum());
        for part in parts {
            cancel.check()?;
            let before = all.gloss.len() as u32;
            all.hit_points.extend(part.hit_points.into_iter().map(|mut h| {
                h.gloss = h.gloss.map(|g| g + before);
                h
            }));
            all.gloss.extend(part.gloss);
            all.counts.extend(part.counts);
            all.emission.extend(part.emission);
            all.shapes.extend(part.shapes);
            all.rays += part.rays;
            all.dropped += part.dropped;
            all.left_out = all.left_out.or(part.left_out);
        }
        Ok(all)
    }

    /// Follows all samples of some pixels; once cancelled no more of them.
    pub(crate) fn follow(&self, pixels: impl Iterator<Item = u32>, cancel: &Cancel) -> EyePaths {
        let mut paths = EyePaths::default();
        let radius = FirstRadius::new(self.scene, self.settings);
        let samples = self.settings.samples_per_pixel.get();
        let mut branches = Vec::new();
        for pixel in pixels {
            let before = paths.hit_points.len();
            let mut emission = Rgb::BLACK;
            let mut scramble = Stream::new(self.settings.seed, self.purpose, 0, u64::from(pixel));
            let places = PixelSamples::new(&mut scramble);
            let facets = PixelSamples::new(&mut scramble);
            let lamps = PixelSamples::new(&mut scramble);
            paths.shapes.push(NO_SHAPE);
            for sample in 0..samples {
                if cancel.is_requested() {
                    return paths;
                }
                let index = u64::from(pixel) * u64::from(samples) + u64::from(sample);
                let mut walk = Walk {
                    pass: self,
                    radius,
                    stream: Stream::new(self.settings.seed, self.purpose, 1, index),
                    facet: Some(facets.point(sample)),
                    lamp: Some(lamps.point(sample)),
                    solid_angle: 0.0,
                    first: sample == 0,
                    paths: &mut paths,
                    branches: &mut branches,
                    emission: Rgb::BLACK,
                    leaves: 1,
                };
                walk.follow(pixel, places.point(sample));
                let sum = emission + walk.emission;
                if sum.is_finite() {
                    emission = sum;
                } else {
                    paths.dropped += 1;
                    // A sum of numbers that is none has no other place.
                    paths.left_out.get_or_insert(LeftOut {
                        quantity: Quantity::SeenEmission,
                        light: None,
                        surface: not_finite::Surface::Unknown,
                        position: self.sensor().origin(),
                    });
                }
            }
            paths.counts.push((paths.hit_points.len() - before) as u32);
            paths.emission.push(emission / samples as f32);
        }
        paths
    }
}

/// One eye sample on its way.
struct Walk<'a, 'b> {
    pass: &'a EyePass<'b>,
    radius: FirstRadius,
    stream: Stream,
    /// Stratified over the pixel's samples, for the first rough lobe that is followed.
    facet: Option<Vec2>,
    /// The same for the lamp that is looked at from there.
    lamp: Option<Vec2>,
    solid_angle: f32,
    /// Whether the pixel's shape is still to be noted.
    first: bool,
    paths: &'a mut EyePaths,
    branches: &'a mut Vec<Branch>,
    emission: Rgb,
    /// Ends that this sample may still come to: hit points stored, and branches under way.
    leaves: u32,
}

impl Walk<'_, '_> {
    fn follow(&mut self, pixel: u32, place: Vec2) {
        let sensor = self.pass.sensor();
        let corner = Vec2::new((pixel % sensor.width) as f32, (pixel / sensor.width) as f32);
        let ray = sensor.ray(corner + 0.5 + sensor.filter.offset(place));
        self.solid_angle = sensor.pixel_solid_angle(ray.direction);
        self.branches.push(Branch { ray, weight: Rgb::WHITE, edges: 1, distance: 0.0, density: 0.0 });
        while let Some(branch) = self.branches.pop() {
            self.step(branch);
        }
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
        if visible {
            let mut emitted = branch.weight * scene.emitted(&surface, wo);
            if branch.density > 0.0 && !emitted.is_black() {
                emitted *= Glossy::share_of_following(scene, &surface, branch.ray.origin, branch.density);
            }
            self.see(emitted, surface.position, Some(surface.shape));
        }
        let outward = wo.dot(surface.normal) > 0.0;
        let Some(scattering) = scene.scattering(&surface, outward) else { return };
        if branch.edges >= self.pass.max_depth {
            return;
        }
        let distance = branch.distance + (surface.position - branch.ray.origin).length();
        if scattering.bsdf.keeps() {
            self.store(&branch, &surface, &scattering, distance, Part::Kept);
        }
        if scattering.bsdf.follows() || scattering.opacity < 1.0 {
            self.follow_lobes(&branch, &surface, &scattering, distance);
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
                let normal = shading_normal_towards(surface, wo);
                let frame = self.pass.scene.shading_frame(surface, normal);
                let narrow = part != Part::Kept;
                let gloss = Gloss { scattering: *scattering, frame, wo: frame.to_local(wo), narrow };
                self.paths.gloss.push(gloss);
                (branch.weight, Some(self.paths.gloss.len() as u32 - 1))
            }
        };
        if weight.is_black() || !self.is_finite(weight, surface) {
            return;
        }
        let behind = if part == Part::FollowedBehind { -1.0 } else { 1.0 };
        let side = behind * 1f32.copysign(wo.dot(surface.normal));
        let normal = surface.normal * side;
        let (radius2, smallest2) = self.radius.first_and_smallest2(
            self.solid_angle,
            distance,
            wo.dot(normal).abs(),
            surface.position,
        );
        self.paths.hit_points.push(HitPoint {
            position: surface.position,
            normal,
            shading_normal: surface.shading_normal * side,
            origin: surface.ray_origin(normal),
            weight,
            gloss,
            radius2,
            smallest2,
            patch: surface.patch_towards(side > 0.0),
            slab2: slab2(surface),
            budget: (self.pass.max_depth - branch.edges).min(255) as u8,
        });
    }

    /// Adds emitted light that the path sees. Where it is no number the sample is given up at its end, and its place noted here.
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

    fn follow_lobes(&mut self, branch: &Branch, surface: &Surface, scattering: &Scattering, distance: f32) {
        let mut weight = branch.weight;
        if branch.edges >= ROULETTE_EDGES {
            if self.stream.next_1d() >= SURVIVAL {
                return;
            }
            weight = weight / SURVIVAL;
        }
        let wo = -branch.ray.direction;
        let frame = self.pass.scene.shading_frame(surface, shading_normal_towards(surface, wo));
        let local = frame.to_local(wo);
        let facet = match scattering.bsdf.roughness() {
            Some(_) => Some(self.facet.take().unwrap_or_else(|| self.stream.next_2d())),
            None => None,
        };
        if self.pass.scene.census().has_narrow_caustics() && scattering.follows_narrow_lobes() {
            let lit = Branch { weight, ..*branch };
            self.store(&lit, surface, scattering, distance, Part::Followed);
            if scattering.bsdf.transmits() {
                self.store(&lit, surface, scattering, distance, Part::FollowedBehind);
            }
        }
        let looks = self.pass.scene.census().has_narrow_highlights() && facet.is_some();
        if looks {
            let edges = self.pass.max_depth - branch.edges;
            let at = Glossy { scene: self.pass.scene, surface, scattering, frame: &frame, wo: local, edges };
            let point = self.lamp.take().unwrap_or_else(|| self.stream.next_2d());
            let u = (self.stream.next_1d(), self.stream.next_1d(), point);
            let highlight = weight * at.looked_up(u, &mut self.stream, &mut self.paths.rays);
            self.see(highlight, surface.position, Some(surface.shape));
        }
        let facet = facet.unwrap_or_default();
        let lobes = scattering.followed_lobes(local, Transport::Radiance, facet);
        let count = lobes.iter().flatten().count() as u32;
        let split = branch.edges <= SPLIT_EDGES
            && weight.max_component() > SPLIT_WEIGHT
            && self.leaves < self.pass.settings.hit_points_per_sample.get();
        let single;
        let chosen: &[_] = if split || count < 2 {
            // What is kept here and each lobe beyond the first is one more end.
            self.leaves += (count + u32::from(scattering.bsdf.keeps())).saturating_sub(1);
            &lobes
        } else {
            let lobe = scattering.choose_followed(local, Transport::Radiance, self.stream.next_1d(), facet);
            single = [lobe.map(|mut l| {
                l.weight = l.weight / l.probability;
                l
            })];
            &single
        };
        for lobe in chosen.iter().flatten() {
            let weight = weight * lobe.weight;
            if weight.is_black() || !self.is_finite(weight, surface) {
                continue;
            }
            let sampled = frame.to_outer(lobe.wi).normalize();
            let direction = on_the_right_side(surface, wo, sampled, lobe.wi.z * local.z > 0.0);
            let is_sampled = looks && direction == sampled;
            self.branches.push(Branch {
                ray: Ray::new(surface.ray_origin(direction), direction),
                weight,
                edges: branch.edges + 1,
                distance,
                density: if is_sampled { scattering.density_followed(local, lobe.wi) } else { 0.0 },
            });
        }
    }
}

/// The shading normal, outside, or the geometric one where the shading normal turns away from a direction that the geometry
/// does see (or sees one that it does not): a smooth silhouette is not black.
pub(crate) fn shading_normal_towards(surface: &Surface, wo: Vec3) -> Vec3 {
    let agrees = wo.dot(surface.normal) * wo.dot(surface.shading_normal) > 0.0;
    if agrees { surface.shading_normal } else { surface.normal }
}

/// Whether a direction made with the shading normal lies on the wrong side of the true surface.
pub(crate) fn leaves_wrongly(surface: &Surface, wo: Vec3, wi: Vec3, reflects: bool) -> bool {
    (wo.dot(surface.normal) * wi.dot(surface.normal) > 0.0) != reflects
}

/// A direction of a followed lobe, mirrored in the plane of the true surface where it would end on its wrong side. To drop it
/// would darken whatever is seen at grazing angles: waves from near the water line lose up to 5 % of their light.
pub(crate) fn on_the_right_side(surface: &Surface, wo: Vec3, wi: Vec3, reflects: bool) -> Vec3 {
    if leaves_wrongly(surface, wo, wi, reflects) { wi.reflect(surface.normal) } else { wi }
}
