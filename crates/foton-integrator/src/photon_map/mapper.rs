//! What is seen of the maps: an eye sample on its way, and the light where it ends.

use std::cell::RefCell;
use std::sync::Arc;

use foton_math::glam::Vec3;
use foton_math::{Cancel, Cancelled, Frame, Purpose, Ray, Rgb, Stream};
use foton_scene::{Scene, Transport};
use foton_transport::camera_paths::{EyePass, EyePaths, FirstRadius, Gloss, HitPoint};
use foton_transport::direct_light::{Arrival, Lights, Receiver};
use foton_transport::kd_tree::{MapClass, Nearest};
use foton_transport::photon_map::PathClass;
use foton_transport::shading::MIN_COSINE;
use foton_transport::{Ledger, LeftOut, LightUse, LobeUse, Loss, Quantity, Stage, Surface};

use super::gather::{Gather, Scratch};
use super::kept::KeptMaps;
use super::maps::{LookUp, Maps};
use super::place::Place;
use super::settings::MapDisplay;
use super::shadow;
use crate::ppm::{DirectLight, LOBE_POLICY, lobe_use};
use crate::sampled::sample::{EyeSample, Numbers, Seen};
use crate::settings::RenderSettings;

/// Of the directions that are sampled at a surface that is not Lambertian, those by its BSDF; the others go where light comes from.
const BY_BSDF: f32 = 0.5;

/// Two-pass photon mapping for a scene.
pub(crate) struct PhotonMapper {
    maps: Arc<Maps>,
    lights: Lights,
    settings: RenderSettings,
    max_depth: u32,
    radius: FirstRadius,
    uses: LobeUse,
}

/// A place that an eye sample has come to.
struct End<'a> {
    point: &'a HitPoint,
    gloss: Option<&'a Gloss>,
    place: Place,
}

impl PhotonMapper {
    /// Makes the maps, unless some are given.
    ///
    /// # Errors
    /// When cancelled.
    pub(crate) fn new(
        scene: &Scene,
        settings: &RenderSettings,
        kept: Option<&KeptMaps>,
        watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        let maps = match kept {
            Some(KeptMaps(maps)) => Arc::clone(maps),
            None => Arc::new(Maps::make(scene, settings, watch, cancel)?),
        };
        Ok(Self {
            maps,
            lights: Lights::new(scene),
            max_depth: settings.max_depth_in(scene),
            radius: FirstRadius::new(scene, None, 1.0, 0.0, 1),
            // Light of points and suns that mirrors and glass cast on narrow gloss is looked for at no hit points of its own.
            uses: LobeUse { highlights_by_photons: false, ..lobe_use(scene) },
            settings: settings.clone(),
        })
    }

    /// Where the power of the global map's photons went.
    pub(crate) fn ledger(&self) -> &Ledger {
        &self.maps.account.ledger
    }

    pub(crate) fn light_use(&self) -> &[LightUse] {
        &self.maps.account.lights
    }

    pub(crate) fn material_losses(&self) -> &[Loss] {
        &self.maps.account.losses
    }

    /// The first photon whose power was no number.
    pub(crate) fn left_out(&self) -> Option<LeftOut> {
        self.maps.account.left_out
    }

    /// Photons of all maps.
    pub(crate) fn photons_emitted(&self) -> u64 {
        self.maps.account.emitted.iter().sum()
    }

    /// Bytes of the maps.
    pub(crate) fn bytes(&self) -> usize {
        self.maps.bytes()
    }

    /// The maps, to be kept.
    pub(crate) fn kept(&self) -> KeptMaps {
        KeptMaps(Arc::clone(&self.maps))
    }

    /// Follows an eye sample to where it ends, and looks light up there.
    pub(crate) fn follow(&self, scene: &Scene, sample: EyeSample, seen: &mut Seen) {
        let EyeSample { ray, mut numbers, .. } = sample;
        let pass = EyePass {
            scene,
            sensor: self.settings.sensor,
            samples_per_pixel: self.settings.samples_per_pixel,
            hit_points_per_sample: self.settings.ppm.hit_points_per_sample,
            radius: self.radius,
            max_depth: self.max_depth,
            policy: LOBE_POLICY,
            uses: self.uses,
            seed: self.settings.seed,
            purpose: Purpose::Eye,
            // Each pass has other samples, whichever it is.
            pass: Some(0),
        };
        let mut paths = EyePaths::default();
        seen.emission += pass.follow_one(ray, numbers.stream(), &mut paths);
        seen.rays += paths.rays;
        seen.shape =
            paths.shapes.first().copied().filter(|&shape| shape != foton_transport::camera_paths::NO_SHAPE);
        seen.left_out = seen.left_out.or(paths.left_out);
        seen.scatters |= !paths.hit_points.is_empty();
        let whole: f32 = paths.hit_points.iter().map(importance).sum();
        let mut nearest = Nearest::default();
        for point in &paths.hit_points {
            let gloss = point.gloss.map(|g| &paths.gloss[g.get()]);
            let end = End { point, gloss, place: Place::at(point) };
            let rays = (self.settings.photon_map.gather_rays.get() as f32 * importance(point) / whole).ceil();
            self.light(scene, &end, rays.max(1.0) as u32, &mut nearest, &mut numbers, seen);
        }
    }

    /// Adds all light at a place.
    fn light(
        &self,
        scene: &Scene,
        end: &End<'_>,
        gather_rays: u32,
        nearest: &mut Nearest,
        numbers: &mut Numbers,
        seen: &mut Seen,
    ) {
        if end.point.remaining_edges < 1 {
            return;
        }
        let settings = &self.settings.photon_map;
        let look_up = LookUp { maps: &self.maps, scene, neighbours: settings.neighbours.get() as usize };
        let from_map = self.settings.ppm.direct_light == DirectLight::Photons;
        if !from_map {
            self.shadow_rays(scene, end, (numbers, nearest), seen);
        }
        let mut stream = numbers.stream();
        let found = look_up.caustic(&end.place, nearest, settings.filter, |wi| end.value_of_photon(wi));
        self.add(seen, PathClass::Caustic, end, found.per_area, Quantity::GatheredLight);
        let mut show = |class: PathClass, seen: &mut Seen, stream: &mut Stream| {
            let wanted = MapClass::from(class);
            let found = look_up.global(&end.place, nearest, |c| c == wanted, |wi| end.value_of_photon(wi));
            let disc = found.radius2.sqrt();
            let light = if found.photons > 0 {
                found.per_area / end.place.share_of_disc(scene, disc, stream, &mut seen.rays)
            } else {
                Rgb::BLACK
            };
            self.add(seen, class, end, light, Quantity::GatheredLight);
        };
        if from_map {
            show(PathClass::Direct, seen, &mut stream);
        }
        if settings.display == MapDisplay::Direct {
            show(PathClass::Indirect, seen, &mut stream);
            return;
        }
        let gather =
            Gather { look_up, lights: &self.lights, filter: settings.filter, max_depth: self.max_depth };
        let light = gathered(
            &gather,
            end,
            gather_rays,
            &mut Scratch { stream: &mut stream, nearest, rays: &mut seen.rays },
        );
        self.add(seen, PathClass::Indirect, end, light, Quantity::GatheredLight);
    }

    fn shadow_rays(
        &self,
        scene: &Scene,
        end: &End<'_>,
        (numbers, nearest): (&mut Numbers, &mut Nearest),
        seen: &mut Seen,
    ) {
        let at = Receiver {
            origin: end.point.origin(),
            normal: end.point.shading_normal,
            edges: u32::from(end.point.remaining_edges),
        };
        let (index, scrambles) = numbers.lights();
        let (mut sum, mut rays) = (Rgb::BLACK, 0);
        let mut add = |arrival: Arrival| sum += arrival.irradiance * end.value(arrival.from);
        let (lit, lit2) = (&self.maps.lit, self.maps.reach.lit2);
        if lit.is_empty() {
            self.lights.fixed(scene, &at, &mut rays, &mut add);
            self.lights.sample(scene, &at, (index, &scrambles), &mut rays, &mut add);
        } else {
            let nearest = RefCell::new(nearest);
            let sees = |emitter| shadow::sees(lit, lit2, &end.place, emitter, *nearest.borrow_mut());
            self.lights.fixed_where(scene, &at, sees, &mut rays, &mut add);
            self.lights.sample_where(scene, &at, (index, &scrambles), sees, &mut rays, &mut add);
        }
        seen.rays += rays;
        self.add(seen, PathClass::Direct, end, sum, Quantity::DirectLight);
    }

    fn add(&self, seen: &mut Seen, class: PathClass, end: &End<'_>, light: Rgb, quantity: Quantity) {
        let light = end.point.weight * light;
        if light.is_finite() {
            seen.add(Some(class), light);
        } else {
            seen.left_out.get_or_insert(LeftOut {
                quantity,
                light: None,
                surface: Surface::Below(end.point.normal),
                position: end.point.position,
            });
        }
    }
}

/// Indirect light by gather rays, over the weight of the eye path.
fn gathered(gather: &Gather<'_>, end: &End<'_>, count: u32, scratch: &mut Scratch<'_>) -> Rgb {
    let point = end.point;
    let frame = Frame::from_normal(point.shading_normal);
    let edges = gather.max_depth - u32::from(point.remaining_edges) + 1;
    let even = super::directions::Directions::of(std::iter::empty());
    let known = gather.look_up.maps.kept(&end.place).map_or(&even, |(_, directions)| directions);
    let chances = known.chances();
    let mut sum = Rgb::BLACK;
    for i in 0..count {
        let u = (i as f32 + scratch.stream.next_1d()) / count as f32;
        let within = scratch.stream.next_2d();
        let sampled = match end.gloss {
            None => Some(chances.sample(u, within)),
            Some(gloss) => {
                // Directions in the frame of the shading normal on the eye's side, as those of the map.
                let by_bsdf =
                    |wi: Vec3| gloss.scattering.pdf(gloss.wo, gloss.frame.to_local(frame.to_outer(wi)));
                let wi = if scratch.stream.next_1d() < BY_BSDF {
                    let specular = LOBE_POLICY.split(&gloss.scattering).specular;
                    let choice = scratch.stream.next_1d();
                    let sample =
                        gloss.scattering.sample(gloss.wo, Transport::Radiance, choice, within, specular);
                    sample.map(|sample| frame.to_local(gloss.frame.to_outer(sample.wi)))
                } else {
                    Some(chances.sample(u, within).0)
                };
                wi.map(|wi| (wi, BY_BSDF * by_bsdf(wi) + (1.0 - BY_BSDF) * chances.pdf(wi)))
            }
        };
        let Some((wi, pdf)) = sampled else { continue };
        let direction = frame.to_outer(wi).normalize();
        if wi.z <= 0.0 || pdf <= 0.0 || direction.dot(point.normal) <= 0.0 {
            continue;
        }
        let value = end.value(direction);
        if value.is_black() {
            continue;
        }
        let ray = Ray::new(point.origin(), direction);
        sum += gather.arriving(ray, edges, scratch) * value * (wi.z / pdf);
    }
    sum / count as f32
}

/// How much a place counts of all that an eye sample has come to.
fn importance(point: &HitPoint) -> f32 {
    point.weight.luminance().max(f32::MIN_POSITIVE)
}

impl End<'_> {
    /// The value of its lobes for light from a unit direction, but for what is in the weight.
    fn value(&self, wi: Vec3) -> Rgb {
        self.gloss.map_or(Rgb::WHITE, |gloss| gloss.eval(wi))
    }

    /// The same for a photon, which measures irradiance about the geometric normal.
    fn value_of_photon(&self, wi: Vec3) -> Rgb {
        let (normal, shading) = (self.point.normal, self.point.shading_normal);
        if normal == shading {
            return self.value(wi);
        }
        let ratio = wi.dot(shading) / wi.dot(normal).max(MIN_COSINE);
        self.value(wi) * ratio.clamp(0.0, 1.0 / MIN_COSINE)
    }
}
