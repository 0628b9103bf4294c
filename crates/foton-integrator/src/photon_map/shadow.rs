//! Shadow photons: which surfaces see all of an emitter, or nothing of it. `[JC95]`
//!
//! A photon lies where light from an emitter meets its first surface; behind that, at every further surface on the same line, lies a shadow
//! photon. Where all of the nearest are of one kind, shadow rays would only find what is known. Shadows that are narrower than the
//! photons are apart are overlooked.

use std::ops::Range;

use foton_math::glam::Vec3;
use foton_math::{Cancel, Cancelled, Purpose, Ray, Stream};
use foton_scene::{Scene, Sources, Surface};
use foton_transport::guide::Cells;
use foton_transport::kd_tree::{KdTree, MapClass, Nearest, PackedPhoton, Rgbe};
use foton_transport::photon_map::CHUNK;
use foton_transport::shading::shading_normal_towards;
use rayon::prelude::*;

use super::place::Place;
use crate::ppm::LOBE_POLICY;

/// So many photons of an emitter must agree. Of those that fall on a place which a fifth of the emitter is hidden from, one in two hundred sets
/// of them does.
const MUST_AGREE: usize = 24;

/// Surfaces on a line.
const MAX_SURFACES: u32 = 16;

/// What random numbers are for, by pass.
const SHADOWS: u64 = 4;

/// Traces photons straight through everything.
///
/// # Errors
/// When cancelled.
pub(super) fn lit_and_shadowed(
    scene: &Scene,
    sources: &Sources,
    photons: u64,
    seed: u64,
    cancel: &Cancel,
) -> Result<KdTree, Cancelled> {
    let cells = Cells::unguided(sources);
    let chunk = |first: u64| {
        cancel.check()?;
        let mut found = Vec::new();
        trace(scene, sources, &cells, (first..photons.min(first + CHUNK), photons), seed, &mut found);
        Ok(found)
    };
    let chunks: Vec<Vec<PackedPhoton>> =
        (0..photons.div_ceil(CHUNK)).into_par_iter().map(|i| chunk(i * CHUNK)).collect::<Result<_, _>>()?;
    Ok(KdTree::new(chunks.concat()))
}

fn trace(
    scene: &Scene,
    sources: &Sources,
    cells: &Cells,
    (range, of): (Range<u64>, u64),
    seed: u64,
    found: &mut Vec<PackedPhoton>,
) {
    for index in range {
        let mut stream = Stream::new(seed, Purpose::PhotonMap, SHADOWS, index);
        let u = (index as f64 + f64::from(stream.next_1d())) / of as f64;
        let Some(from) = cells.start(u, std::array::from_fn(|_| stream.next_1d())) else { return };
        let start = sources.emit(from.emitter, from.primary);
        if start.power.is_black() || !start.power.is_finite() {
            continue;
        }
        let mut ray = Ray::new(start.origin, start.direction);
        for number in 0..MAX_SURFACES {
            let Some(surface) = scene.nearest(ray) else { break };
            let class = if number == 0 { MapClass::Direct } else { MapClass::Shadow };
            found.extend(photon(scene, &surface, -ray.direction, class, from.emitter as u32));
            ray = Ray { origin: surface.ray_origin(ray.direction), ..ray };
        }
    }
}

/// One where light is gathered; `None` elsewhere.
fn photon(scene: &Scene, surface: &Surface, wo: Vec3, class: MapClass, emitter: u32) -> Option<PackedPhoton> {
    let outward = wo.dot(surface.normal) > 0.0;
    let gathers = |(surface, _): (Surface, f32)| {
        // Light that comes from behind the shading normal is none.
        let is_seen = wo.dot(shading_normal_towards(&surface, wo)).abs() > 0.0;
        let scattering = scene.scattering(&surface, outward);
        is_seen && scattering.is_some_and(|s| LOBE_POLICY.split(&s).gathers())
    };
    let patch = surface.patch_towards(outward);
    let number = Rgbe(emitter.to_le_bytes());
    scene
        .components(surface, outward)
        .any(gathers)
        .then(|| PackedPhoton::new(surface.position, number, wo, patch, class, 1))
}

/// Whether a place sees all of an emitter (`Some(true)`) or nothing of it; `None` where that is not known.
pub(super) fn sees(
    lit: &KdTree,
    reach2: f32,
    at: &Place,
    emitter: u32,
    nearest: &mut Nearest,
) -> Option<bool> {
    let number = Rgbe(emitter.to_le_bytes());
    lit.nearest(at.position, reach2, MUST_AGREE, nearest, |photon, offset| {
        photon.power == number && at.counts(photon, offset)
    });
    nearest.farthest()?;
    let mut classes = nearest.found().iter().map(|found| lit.nodes()[found.index as usize].class());
    let first = classes.next()?;
    classes.all(|class| class == first).then_some(first == MapClass::Direct)
}
