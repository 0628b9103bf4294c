//! Projection maps: where photons must start to meet what reflects or refracts. `[JEN96]`
//!
//! Jensen's map is a hemisphere of cells around each light, in which those are marked that see a caster of caustics; photons of the
//! caustic map start in marked cells alone, and their power is that share of the light's. Here cells divide the primary numbers with
//! which photons start ([`Cells`]), so that every emitter has a map, suns and skies too, and aims are taken into account. A few
//! photons tell in which cells casters are met. Cells in which they were not still get some photons: what was overlooked is noisy, not
//! missing.

use foton_math::{Purpose, Ray, Rgb, Stream};
use foton_scene::{PRIMARY_NUMBERS, Scene, Sources, Surface};
use rayon::prelude::*;

use super::cells::{Cell, Cells, MAX_CUTS};
use crate::lobes::LobePolicy;
use crate::straight;

/// Cells along each of the two axes that are cut most.
const SIDE: usize = 64;

/// Photons that look for casters in each cell.
const PROBES: u64 = 8;

/// The share of photons that start as their emitters shine.
const ELSEWHERE: f64 = 0.1;

/// Surfaces that a photon passes straight through on its way to the first that counts.
const MAX_STRAIGHT: u32 = 8;

impl Cells {
    /// The projection maps of all emitters; without any caster in sight, where photons start without one.
    #[must_use]
    pub fn towards_casters(scene: &Scene, sources: &Sources, policy: &LobePolicy) -> Self {
        let emitters = sources.choices().count().max(1);
        let cut: Vec<(Cell, f64)> = sources
            .choices()
            .flat_map(|(i, chance)| {
                let cells = cut(i as u32, sources.uses(i), MAX_CUTS / emitters);
                cells.into_iter().map(move |cell| (cell, chance * cell.volume()))
            })
            .collect();
        let marks: Vec<f64> = cut
            .par_iter()
            .enumerate()
            .map(|(i, (cell, _))| {
                let of_cell = i as u64 * PROBES;
                let probes =
                    (of_cell..of_cell + PROBES).filter(|&n| meets_caster(scene, sources, policy, cell, n));
                (probes.count() as f64 / PROBES as f64).sqrt()
            })
            .collect();
        let marked: f64 = cut.iter().zip(&marks).map(|((_, share), mark)| share * mark).sum();
        if marked <= 0.0 {
            return Self::unguided(sources);
        }
        let probabilities = cut
            .iter()
            .zip(&marks)
            .map(|((_, share), mark)| (1.0 - ELSEWHERE) * share * mark / marked + ELSEWHERE * share)
            .collect();
        Self::new(cut.into_iter().map(|(cell, _)| cell).collect(), probabilities)
    }
}

/// Cells of an emitter, `budget` at most: along those of its primary numbers that decide what a photon meets.
fn cut(emitter: u32, uses: [bool; PRIMARY_NUMBERS], budget: usize) -> Vec<Cell> {
    let [part, position, _, direction, _] = uses;
    // By direction; light from one direction by where it passes. From infinity, the part says what is aimed at.
    let (axes, parts) = match (direction, position) {
        (true, _) => ([3, 4], if part { 4 } else { 1 }),
        (false, true) => ([1, 2], if part { 4 } else { 1 }),
        (false, false) => ([3, 4], 1),
    };
    let (mut side, mut parts) = (SIDE / if parts > 1 { 2 } else { 1 }, parts);
    while side * side * parts > budget.max(1) {
        (side, parts) = (side.div_ceil(2), 1);
        if side == 1 {
            break;
        }
    }
    let mut cells = Vec::with_capacity(side * side * parts);
    for p in 0..parts {
        for i in 0..side * side {
            let mut cell = Cell::whole(emitter);
            for (axis, at, of) in [(0, p, parts), (axes[0], i % side, side), (axes[1], i / side, side)] {
                (cell.low[axis], cell.size[axis]) = (at as f32 / of as f32, 1.0 / of as f32);
            }
            cells.push(cell);
        }
    }
    cells
}

/// Whether a photon that starts in a cell meets a surface with a specular lobe first, apart from those that it passes straight through.
fn meets_caster(scene: &Scene, sources: &Sources, policy: &LobePolicy, cell: &Cell, number: u64) -> bool {
    let mut stream = Stream::new(0, Purpose::Pilot, 2, number);
    let primary = cell.at(std::array::from_fn(|_| stream.next_1d()));
    let start = sources.emit(cell.emitter as usize, primary);
    if start.power.is_black() || !start.power.is_finite() {
        return false;
    }
    let mut ray = Ray::new(start.origin, start.direction);
    for _ in 0..MAX_STRAIGHT {
        let Some(surface) = scene.nearest(ray) else { return false };
        let wo = -ray.direction;
        let outward = wo.dot(surface.normal) > 0.0;
        let straight = straight::through(scene, &surface, wo);
        let casts = |(surface, _): (Surface, f32)| {
            scene.scattering(&surface, outward).is_some_and(|s| policy.split(&s).follows())
        };
        if straight != Rgb::WHITE && scene.components(&surface, outward).any(casts) {
            return true;
        }
        if straight.is_black() {
            return false;
        }
        ray = Ray { origin: surface.ray_origin(ray.direction), ..ray };
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use foton_math::glam::{DAffine3, DVec3, Vec3};
    use foton_scene::description::{
        Bsdf, Colour, Dielectric, Diffuse, EmitterDescription, EmitterKind, Filter, FovAxis, Geometry,
        Material, SceneDescription, SensorDescription, ShapeDescription,
    };

    /// A diffuse ball of radius 1 around a lamp, and a ball of glass of radius 0.1, half-way to it.
    fn scene(has_glass: bool) -> Scene {
        let white = Colour::Constant(Rgb::WHITE);
        let glass = Bsdf::Dielectric(Dielectric {
            int_ior: 1.5,
            ext_ior: 1.0,
            specular_reflectance: white,
            specular_transmittance: white,
            roughness: None,
        });
        let grey = Bsdf::Diffuse(Diffuse { reflectance: white });
        let ball = |material, x, radius| ShapeDescription {
            name: format!("ball {material}"),
            geometry: Geometry::Sphere { centre: DVec3::X * x, radius },
            to_world: DAffine3::IDENTITY,
            flip_normals: material == 0,
            material,
            radiance: None,
        };
        let sensor = SensorDescription {
            name: "camera".into(),
            to_world: DAffine3::IDENTITY,
            fov_degrees: 60.0,
            fov_axis: FovAxis::X,
            width: 1,
            height: 1,
            filter: Filter::Box { radius: 0.5 },
            ..SensorDescription::default()
        };
        let material = |front| Material { name: "material".into(), front, back: None, ..Material::default() };
        let lamp = EmitterKind::Point { position: DVec3::ZERO, intensity: Rgb::WHITE };
        let mut shapes = vec![ball(0, 0.0, 1.0), ball(1, 0.5, 0.1)];
        shapes.truncate(1 + usize::from(has_glass));
        let description = SceneDescription {
            sensors: vec![sensor],
            emitters: vec![EmitterDescription { name: "lamp".into(), kind: lamp }],
            materials: vec![material(grey), material(glass)],
            shapes,
            ..SceneDescription::default()
        };
        Scene::build(&description).expect("a sound scene")
    }

    #[test]
    fn photons_meet_casters_and_bring_them_the_light_that_they_get_anyway() {
        let (scene, policy) = (scene(true), LobePolicy { max_specular_roughness: 0.1 });
        let sources = scene.sources(&[]);
        let n = 20_000u32;
        let shoot = |cells: &Cells| {
            let (mut share, mut power) = (0.0, 0.0);
            for i in 0..n {
                let mut stream = Stream::new(1, Purpose::Test, 0, u64::from(i));
                let u = (f64::from(i) + f64::from(stream.next_1d())) / f64::from(n);
                let from = cells.start(u, std::array::from_fn(|_| stream.next_1d())).expect("a lamp");
                let start = sources.emit(from.emitter, from.primary);
                let hit = scene.nearest(Ray::new(start.origin, start.direction)).expect("a ball");
                if hit.shape == 1 {
                    share += 1.0 / f64::from(n);
                    power += f64::from(start.power.g) / from.density / f64::from(n);
                }
            }
            (share, power)
        };
        let cells = Cells::towards_casters(&scene, &sources, &policy);
        let (share, power) = shoot(&cells);
        let (unguided_share, _) = shoot(&Cells::unguided(&sources));
        assert!(share > 0.6 && share > 30.0 * unguided_share, "{share} {unguided_share}");
        // The lamp sees the ball under a sine of 0.2: a share of (1 − √0.96)/2 of its light, which is 4π.
        let unit = f64::from(scene.normalisation().length(1.0));
        let all = 4.0 * std::f64::consts::PI * unit * unit;
        assert!((power / (all * 0.5 * (1.0 - 0.96f64.sqrt())) - 1.0).abs() < 0.03, "{power} of {all}");
    }

    #[test]
    fn without_casters_photons_start_as_emitters_shine() {
        let scene = scene(false);
        let sources = scene.sources(&[]);
        let cells = Cells::towards_casters(&scene, &sources, &LobePolicy { max_specular_roughness: 0.1 });
        assert_eq!(cells, Cells::unguided(&sources));
        assert!(scene.bounds().size().cmpgt(Vec3::ZERO).all());
    }

    #[test]
    fn cells_of_an_emitter_fill_its_space_within_the_budget() {
        let (yes, no) = (true, false);
        for uses in [[no, no, no, yes, yes], [yes, yes, yes, no, no], [yes; 5], [no; 5]] {
            for budget in [1, 3, 50, 5000] {
                let cells = cut(0, uses, budget);
                assert!(cells.len() <= budget);
                let volume: f64 = cells.iter().map(Cell::volume).sum();
                assert!((volume - 1.0).abs() < 1e-6, "{uses:?} {budget}: {volume}");
            }
        }
    }
}
