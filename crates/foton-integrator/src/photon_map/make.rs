//! Making the maps: photons, their trees, and irradiance at some of them.

use foton_math::glam::Vec3;
use foton_math::{Cancel, Cancelled, Frame, Purpose, Ray, Rgb, Stream};
use foton_scene::{Scene, Sources};
use foton_transport::guide::Cells;
use foton_transport::kd_tree::{KdTree, MapClass, Nearest, PackedPhoton, Rgbe};
use foton_transport::photon_map::Photon;
use foton_transport::{LobeUse, Stage};
use rayon::prelude::*;

use super::directions::Directions;
use super::maps::{Account, LookUp, Maps};
use super::place::Place;
use super::shadow::lit_and_shadowed;
use super::shoot::{Shot, Wanted};
use crate::ppm::LOBE_POLICY;
use crate::settings::RenderSettings;

/// Irradiance is kept where one photon of so many lies `[CHR99]`. That photon counts for no estimate, the others for more: were it one of
/// those that tell how densely they lie, irradiance would be kept where they happen to lie densely, and looked up farther around where
/// they do not, both of which is bias.
const PHOTONS_PER_IRRADIANCE: usize = 8;

/// Photons of a tree whose distances tell how far others are looked for.
const PROBED: usize = 256;

/// Photons are looked for within so many times the usual distance of the farthest that is wanted.
const GLOBAL_REACH: f32 = 4.0;
const CAUSTIC_REACH: f32 = 2.0;

/// No farther than this share of the scene's radius.
const FARTHEST: f32 = 0.25;

/// A ray back to the surface that a photon lies on starts this far above it, in scene units.
const ABOVE: f32 = 0.01;

/// What random numbers are for, by pass.
const ROUNDING: u64 = 0;
const IRRADIANCE: u64 = 3;

impl Maps {
    /// Makes the maps of a scene.
    ///
    /// # Errors
    /// When cancelled.
    pub(super) fn make(
        scene: &Scene,
        settings: &RenderSettings,
        watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        let wanted = &settings.photon_map;
        let (max_depth, seed) = (settings.max_depth_in(scene), settings.photon_seed());
        // Maps are for any camera: photons are aimed at no view.
        let sources = scene.sources(&[]);
        watch(Stage::Trace);
        let shoot = |sources: &Sources, cells: &Cells, caustics, photons| {
            let wanted = Wanted { scene, sources, cells, caustics, photons, max_depth, seed };
            wanted.shoot(cancel)
        };
        let global = shoot(
            &sources,
            &Cells::unguided(&sources),
            false,
            with_sites(wanted.global_photons.get().into()),
        )?;
        let has_casters = LobeUse::of(scene.census(), &LOBE_POLICY).specular;
        let caustic = if has_casters && wanted.caustic_photons > 0 {
            let sources = scene.sources(&[]).by_direction();
            let cells = Cells::towards_casters(scene, &sources, &LOBE_POLICY);
            shoot(&sources, &cells, true, u64::from(wanted.caustic_photons))?
        } else {
            Shot::default()
        };
        watch(Stage::Sort);
        let mut maps = Self {
            global: KdTree::new(pack(&global, PHOTONS_PER_IRRADIANCE, seed, ROUNDING)),
            caustic: KdTree::new(pack(&caustic, usize::MAX, seed, ROUNDING + 1)),
            max_depth,
            neighbours: wanted.neighbours.get(),
            ..Self::default()
        };
        cancel.check()?;
        maps.reach_out(scene, &sources, settings, cancel)?;
        watch(Stage::Gather);
        maps.keep_irradiance(scene, &global.photons, seed, cancel)?;
        maps.account = Account {
            ledger: global.ledger,
            lights: global.lights,
            losses: global.losses,
            emitted: [global.emitted, caustic.emitted],
            rays: global.rays + caustic.rays,
            left_out: global.left_out.or(caustic.left_out),
        };
        Ok(maps)
    }

    /// Finds out how far photons are looked for, and adds shadow photons if they are asked for.
    fn reach_out(
        &mut self,
        scene: &Scene,
        sources: &Sources,
        settings: &RenderSettings,
        cancel: &Cancel,
    ) -> Result<(), Cancelled> {
        let (wanted, neighbours) = (&settings.photon_map, self.neighbours as usize);
        self.reach.global2 = reach2(scene, &self.global, neighbours, GLOBAL_REACH);
        self.reach.caustic2 = reach2(scene, &self.caustic, neighbours, CAUSTIC_REACH);
        // Surfaces that light passes straight through cast shadows of their own.
        if wanted.shadow_photons && !scene.census().straight {
            let (photons, seed) = (wanted.global_photons.get().into(), settings.photon_seed());
            self.lit = lit_and_shadowed(scene, sources, photons, seed, cancel)?;
            self.reach.lit2 = reach2(scene, &self.lit, neighbours, 1.0);
        }
        Ok(())
    }

    /// Computes irradiance, and where it comes from, at some photons of the global map.
    fn keep_irradiance(
        &mut self,
        scene: &Scene,
        photons: &[Photon],
        seed: u64,
        cancel: &Cancel,
    ) -> Result<(), Cancelled> {
        let points: Vec<PackedPhoton> =
            photons.par_iter().step_by(PHOTONS_PER_IRRADIANCE).filter_map(|p| point_on(scene, p)).collect();
        cancel.check()?;
        let tree = KdTree::new(points);
        let look_up = LookUp { maps: self, scene, neighbours: self.neighbours as usize };
        let edges = self.max_depth.saturating_sub(2);
        let of_node = |(i, point): (usize, &PackedPhoton)| {
            if i.is_multiple_of(Cancel::EVERY) {
                cancel.check()?;
            }
            Ok(irradiance(
                &look_up,
                point,
                edges,
                Stream::new(seed, Purpose::PhotonMap, IRRADIANCE, i as u64),
            ))
        };
        let kept: Vec<Kept> = tree.nodes().par_iter().enumerate().map(of_node).collect::<Result<_, _>>()?;
        let nodes: Vec<PackedPhoton> =
            tree.nodes().iter().zip(&kept).map(|(node, kept)| node.with_power(kept.irradiance)).collect();
        let mut discs: Vec<f32> = kept.iter().map(|kept| kept.disc).collect();
        self.irradiance = KdTree::from_nodes(nodes).unwrap_or_default();
        self.directions = kept.into_iter().map(|kept| kept.directions).collect();
        self.reach.irradiance_disc = median(&mut discs);
        Ok(())
    }
}

/// What is kept of a point.
struct Kept {
    irradiance: Rgbe,
    directions: Directions,
    /// The radius of the disc.
    disc: f32,
}

/// Photons such that so many are left without those where irradiance is kept.
const fn with_sites(photons: u64) -> u64 {
    let every = PHOTONS_PER_IRRADIANCE as u64;
    (photons * every).div_ceil(every - 1)
}

/// The photons of a map with the power of each, but for the first of every `every`.
fn pack(shot: &Shot, every: usize, seed: u64, pass: u64) -> Vec<PackedPhoton> {
    let left = 1.0 - 1.0 / every as f32;
    let share = 1.0 / ((shot.emitted as f32).max(1.0) * left);
    let packed = |(i, photon): (usize, &Photon)| {
        if i.is_multiple_of(every) && every < usize::MAX {
            return None;
        }
        let power = photon.power * share;
        if !power.is_finite() || power.is_black() {
            return None;
        }
        let power = Rgbe::new(power, numbers(&mut Stream::new(seed, Purpose::PhotonMap, pass, i as u64)));
        let class = MapClass::from(photon.class());
        Some(PackedPhoton::new(
            photon.position,
            power,
            photon.direction(),
            photon.patch(),
            class,
            photon.edges,
        ))
    };
    shot.photons.par_iter().enumerate().filter_map(packed).collect()
}

fn numbers(stream: &mut Stream) -> [f32; 3] {
    std::array::from_fn(|_| stream.next_1d())
}

/// How far photons are looked for, squared.
fn reach2(scene: &Scene, tree: &KdTree, neighbours: usize, times: f32) -> f32 {
    let farthest = FARTHEST * scene.bounds().radius();
    let step = tree.len().div_ceil(PROBED).max(1);
    let mut distances: Vec<f32> = tree
        .nodes()
        .par_iter()
        .step_by(step)
        .map_init(Nearest::default, |nearest, photon| {
            let is_like = |other: &PackedPhoton, _: Vec3| other.patch() == photon.patch();
            tree.nearest(photon.position, farthest * farthest, neighbours, nearest, is_like);
            nearest.farthest().map_or(farthest, |found| found.distance2.sqrt())
        })
        .collect();
    (times * median(&mut distances)).min(farthest).powi(2)
}

/// The median; zero of nothing.
fn median(values: &mut [f32]) -> f32 {
    let middle = values.len() / 2;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(middle, f32::total_cmp).1 }
}

/// A point of the surface below a photon with its exact normal; `None` where there is none.
fn point_on(scene: &Scene, photon: &Photon) -> Option<PackedPhoton> {
    let normal = Vec3::from_array(photon.normal.map(f32::from)).try_normalize()?;
    let ray = Ray { t_max: 2.0 * ABOVE, ..Ray::new(photon.position + normal * ABOVE, -normal) };
    let surface = scene.nearest(ray)?;
    let place = Place::on(&surface, normal, u32::MAX);
    (place.patch == photon.patch()).then(|| {
        let none = Rgbe::default();
        PackedPhoton::new(place.position, none, place.normal, place.patch, MapClass::Indirect, 1)
    })
}

/// The irradiance at a point, and where indirect light comes from.
fn irradiance(look_up: &LookUp<'_>, point: &PackedPhoton, edges: u32, mut stream: Stream) -> Kept {
    let scene = look_up.scene;
    let u = numbers(&mut stream);
    let none =
        || Kept { irradiance: Rgbe::default(), directions: Directions::of(std::iter::empty()), disc: 0.0 };
    let above = point.direction();
    let ray = Ray { t_max: 2.0 * ABOVE, ..Ray::new(point.position + above * ABOVE, -above) };
    let Some(surface) = scene.nearest(ray) else { return none() };
    let place = Place::on(&surface, above, edges);
    let mut nearest = Nearest::default();
    let found = look_up.global(&place, &mut nearest, |_| true, |_| Rgb::WHITE);
    if found.photons == 0 {
        return none();
    }
    let disc = found.radius2.sqrt();
    let mut rays = 0;
    let share = place.share_of_disc(scene, disc, &mut stream, &mut rays);
    let frame = Frame::from_normal(place.normal);
    let photons = nearest.found().iter().map(|found| &look_up.maps.global.nodes()[found.index as usize]);
    let directions = Directions::of(
        photons
            .filter(|photon| photon.class() == MapClass::Indirect)
            .map(|photon| (frame.to_local(photon.direction()), photon.light().luminance())),
    );
    Kept { irradiance: Rgbe::new(found.per_area / share, u), directions, disc }
}
