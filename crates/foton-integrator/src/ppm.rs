//! Progressive photon mapping: `[PPM08]` with the running mean of every pass's own estimate.

use std::sync::Arc;

use foton_film::Image;
use foton_math::glam::Vec3;
use foton_math::{Purpose, Rgb};
use foton_scene::{Scene, Sources};
use pulp::Arch;

use crate::batch::{self, Batch, Counts};
use crate::error::{ErrorSums, Question};
use crate::eye_pass::EyePass;
use crate::gather::{Rule, Tally};
use crate::grid::Grid;
use crate::hit_point::{HitPoint, HitPoints};
use crate::ledger::{Ledger, Loss};
use crate::light::Light;
use crate::light_use::LightUse;
use crate::not_finite::{Halt, LeftOut, NotFinite};
use crate::photon::Photon;
use crate::photon_map::PhotonMap;
use crate::photon_pass::{Chunk, PhotonPass};
use crate::refine::Statistics;
use crate::settings::{Change, DirectLight, RadiusRule, Settings};
use crate::slots::Kept;
use crate::stage::Stage;
use foton_math::{Cancel, Cancelled};

mod parts;

/// Longest path that is followed, whatever is asked for. What that cuts off stands in the ledger.
const LONGEST_PATH: u32 = 250;

/// About so many hit points tell what is seen.
const LOOKED_AT: usize = 4096;

/// Cells are marked anew when the mean r² has shrunk by this factor since the last time.
const MARK_AGAIN: f64 = 0.7;

/// What the start of a render found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Start {
    /// Hit points.
    pub hit_points: u64,
    /// Eye rays traced.
    pub eye_rays: u64,
    /// Eye paths given up because their weight or light was not a finite number.
    pub dropped: u64,
}

/// What one pass did, and how things stand after it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PassReport {
    /// Passes so far.
    pub pass: u64,
    /// Photons emitted so far.
    pub photons: u64,
    /// Photons emitted in this pass.
    pub photons_in_pass: u64,
    /// Photons stored in this pass.
    pub stored: u64,
    /// Rays traced in this pass, shadow rays included.
    pub rays: u64,
    /// Photon–packet tests in this pass.
    pub candidates: u64,
    /// Photon–hit-point pairs that counted in this pass.
    pub accepted: u64,
    /// Share of hit points that have found no photon in any pass: unknown, not dark.
    pub no_photon_share: f64,
    /// Hit points whose radius is at the smallest that coordinates resolve.
    pub floored: u64,
}

/// A render under way.
pub struct Ppm {
    scene: Arc<Scene>,
    sources: Sources,
    settings: Settings,
    hit_points: HitPoints,
    shapes: Vec<u32>,
    light: Light,
    error: Option<ErrorSums>,
    grid: Grid,
    marked_radius2: f64,
    chunks: Vec<Chunk>,
    map: PhotonMap,
    kept: Kept,
    /// Photons of a batch at most: [`batch::MOST_PHOTONS`] but in tests.
    most_in_batch: u64,
    ledger: Ledger,
    lights: Vec<LightUse>,
    losses: Vec<Loss>,
    passes: u64,
    photons_emitted: u64,
    last_photons: u64,
    changes: Vec<(u64, Change)>,
    start: Start,
    /// Whether a pass that leaves a value out does not happen.
    strict: bool,
    not_finite: Option<NotFinite>,
    /// The instruction set that photons and gather are compiled for. It changes no bit.
    arch: Arch,
}

impl Ppm {
    /// Collects hit points. `watch` is told each stage as it begins.
    ///
    /// # Errors
    /// When cancelled.
    pub fn start(
        scene: Arc<Scene>,
        settings: Settings,
        watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        watch(Stage::EyePass);
        let max_depth = Self::max_depth(&scene, &settings);
        let eye =
            EyePass { scene: &scene, settings: &settings, max_depth, purpose: Purpose::Eye }.run(cancel)?;
        watch(Stage::Layout);
        let shadow_rays = settings.direct_light == DirectLight::ShadowRays;
        let normals = scene.census().shading_normals;
        let hit_points =
            HitPoints::new(&eye.hit_points, &eye.gloss, eye.pixel_start(), normals, shadow_rays, cancel)?;
        let asks = settings.error || settings.radius_rule == RadiusRule::Adaptive;
        let hit_points = if asks { hit_points.with_evidence() } else { hit_points };
        let start = Start { hit_points: hit_points.len() as u64, eye_rays: eye.rays, dropped: eye.dropped };
        let step = (eye.hit_points.len() / LOOKED_AT).max(1);
        let disc = |h: &HitPoint| (h.position, h.radius2.sqrt());
        let seen: Vec<(Vec3, f32)> = eye.hit_points.iter().step_by(step).map(disc).collect();
        let sources = scene.sources(&seen);
        let not_finite = eye.left_out.map(|left_out| NotFinite::new(&scene, 0, left_out));
        drop((eye.hit_points, eye.gloss));
        let grid = Grid::new(&hit_points.packets, cancel)?;
        cancel.check()?;
        let light = Light::new(eye.emission, &hit_points, &settings);
        let (width, samples) = (scene.sensors()[settings.sensor].width, settings.samples_per_pixel.get());
        let error = settings.error.then(|| ErrorSums::new(&hit_points, width, samples));
        let lights = vec![LightUse::default(); scene.emitters().len()];
        let losses = vec![Loss::default(); scene.materials().len()];
        cancel.check()?;
        Ok(Self {
            scene,
            sources,
            settings,
            hit_points,
            shapes: eye.shapes,
            light,
            error,
            grid,
            marked_radius2: f64::INFINITY,
            chunks: Vec::new(),
            map: PhotonMap::default(),
            kept: Kept::default(),
            most_in_batch: batch::MOST_PHOTONS,
            ledger: Ledger::default(),
            lights,
            losses,
            passes: 0,
            photons_emitted: 0,
            last_photons: 0,
            changes: Vec::new(),
            start,
            strict: false,
            not_finite,
            arch: Arch::new(),
        })
    }

    /// One pass: photons from the emitters, sorted into a map, gathered by every hit point, batch by batch; then added to the image.
    ///
    /// # Errors
    /// When cancelled while photons are traced; the pass then has not happened. After [`Ppm::stop_at_first_not_finite`], when a
    /// value is not: the image is then that of the passes before, and hit points may be half-way to the next.
    pub fn advance(&mut self, watch: &mut dyn FnMut(Stage), cancel: &Cancel) -> Result<PassReport, Halt> {
        self.halt_at(None)?;
        let mut counts = self.begin_pass();
        for batch in self.batches(counts.photons) {
            watch(Stage::Trace);
            let mut chunks = std::mem::take(&mut self.chunks);
            let shot = self.photon_pass(counts.photons, batch).shoot(&mut chunks, cancel);
            self.chunks = chunks;
            shot?;
            self.halt_at(self.chunks.iter().find_map(|chunk| chunk.left_out))?;
            self.take_batch(batch, &mut counts, watch, cancel)?;
            self.halt_at(counts.left_out)?;
        }
        self.add_shadow_rays(&mut counts, watch);
        self.halt_at(counts.left_out)?;
        Ok(self.conclude_pass(counts, watch))
    }

    /// An error where a value was left out that must not be: this one, or one before it.
    fn halt_at(&self, left_out: Option<LeftOut>) -> Result<(), Halt> {
        if !self.strict {
            return Ok(());
        }
        let here = left_out.map(|left_out| NotFinite::new(&self.scene, self.passes + 1, left_out));
        self.not_finite.clone().or(here).map_or(Ok(()), |place| Err(Box::new(place).into()))
    }

    /// From now on a pass in which a value is not finite does not happen. Otherwise such values are left out and counted.
    pub const fn stop_at_first_not_finite(&mut self) {
        self.strict = true;
    }

    /// The first value that was not finite since the render was started or restored, and was left out.
    #[must_use]
    pub const fn first_not_finite(&self) -> Option<&NotFinite> {
        self.not_finite.as_ref()
    }

    /// Makes ready for the batches of a pass.
    pub(crate) fn begin_pass(&mut self) -> Counts {
        let photons = u64::from(self.settings.photons_after(self.passes).get());
        let slots = self.hit_points.statistics_slots.len();
        let adapts = !self.hit_points.evidence_slots.is_empty();
        let several = self.batches(photons).nth(1).is_some();
        self.kept = if several { Kept::of(slots, adapts) } else { Kept::default() };
        Counts {
            ledger: self.ledger,
            lights: self.lights.clone(),
            losses: self.losses.clone(),
            photons,
            rays: 0,
            stored: 0,
            tally: Tally::default(),
            left_out: None,
        }
    }

    /// How a pass falls into batches.
    pub(crate) fn batches(&self, photons: u64) -> impl Iterator<Item = Batch> + use<> {
        Batch::all(photons, self.most_in_batch)
    }

    /// Sorts and gathers a batch whose photons lie in `chunks`. Hit points are refined with the last one.
    pub(crate) fn take_batch(
        &mut self,
        batch: Batch,
        counts: &mut Counts,
        watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
    ) -> Result<(), Cancelled> {
        watch(Stage::Sort);
        self.map.build(&self.chunks, self.grid.touched());
        cancel.check()?;
        watch(Stage::Gather);
        let (alpha, before) = (self.settings.alpha, self.photons_emitted);
        let rule = Rule {
            alpha,
            adapts: self.settings.radius_rule == RadiusRule::Adaptive,
            common: self.settings.radius_rule.common(alpha, before, counts.photons),
            batch,
            question: Question::after(self.passes),
            arch: self.arch,
        };
        let (error, kept) = (self.error.as_mut(), &mut self.kept);
        let tally = self.light.gather(&mut self.hit_points, &self.map, &self.grid, rule, error, kept);
        counts.add(&self.chunks, &tally);
        Ok(())
    }

    /// Adds direct light by shadow rays, if it is asked for, once hit points are refined.
    pub(crate) fn add_shadow_rays(&mut self, counts: &mut Counts, watch: &mut dyn FnMut(Stage)) {
        if self.settings.direct_light == DirectLight::ShadowRays {
            watch(Stage::ShadowRays);
            let key = (self.settings.seed, self.passes, counts.photons);
            let (rays, omissions) = self.light.add_direct(&self.scene, &self.hit_points, key);
            counts.rays += rays;
            counts.leave_out(omissions);
        }
    }

    /// What a pass does once its light is gathered.
    pub(crate) fn conclude_pass(&mut self, mut counts: Counts, watch: &mut dyn FnMut(Stage)) -> PassReport {
        watch(Stage::Radiance);
        counts.leave_out(self.light.add_pass(&self.hit_points));
        let Counts { ledger, lights, losses, photons, rays, stored, tally, left_out } = counts;
        (self.ledger, self.lights, self.losses) = (ledger, lights, losses);
        if let (None, Some(left_out)) = (&self.not_finite, left_out) {
            self.not_finite = Some(NotFinite::new(&self.scene, self.passes + 1, left_out));
        }
        self.mark_cells(&tally);
        self.photons_emitted += photons;
        let power = self.mean_power();
        if let Some(error) = &mut self.error {
            let by_shadow_rays = self.settings.direct_light == DirectLight::ShadowRays;
            let asked = (Question::after(self.passes), by_shadow_rays, self.passes);
            self.light.add_error(error, &self.hit_points, (photons, power), asked);
        }
        self.last_photons = photons;
        self.passes += 1;
        PassReport {
            pass: self.passes,
            photons: self.photons_emitted,
            photons_in_pass: photons,
            stored,
            rays,
            candidates: tally.candidates,
            accepted: tally.accepted,
            no_photon_share: tally.unknown as f64 / (self.start.hit_points as f64).max(1.0),
            floored: tally.floored,
        }
    }

    /// Mean power of a photon as it leaves its emitter. Photons that are aimed differ much: there it is that of some of those which
    /// came near hit points in the last batch, if any did.
    fn mean_power(&self) -> f64 {
        let stored = self.map.photons();
        if self.sources.is_aimed() && !stored.is_empty() {
            let step = stored.len().div_ceil(LOOKED_AT);
            let (sum, count) = stored
                .iter()
                .step_by(step)
                .fold((0.0, 0.0), |(sum, count), p| (sum + f64::from(p.power.luminance()), count + 1.0));
            return sum / count;
        }
        self.ledger.emitted / self.photons_emitted.max(1) as f64
    }

    pub(crate) fn photon_pass(&self, photons: u64, batch: Batch) -> PhotonPass<'_> {
        PhotonPass {
            scene: &self.scene,
            sources: &self.sources,
            grid: &self.grid,
            direct_light: self.settings.direct_light,
            directions: self.hit_points.ask_for_directions(),
            arch: self.arch,
            max_depth: Self::max_depth(&self.scene, &self.settings),
            seed: self.settings.seed,
            pass: self.passes,
            // A path of one edge is an emitter seen directly: no photon can add to it.
            photons: if Self::max_depth(&self.scene, &self.settings) > 1 { photons } else { 0 },
            batch,
        }
    }

    /// Photons that no disc can reach any more need not be stored: marks cells anew once discs are clearly smaller.
    fn mark_cells(&mut self, tally: &Tally) {
        if self.marked_radius2.is_infinite() {
            self.marked_radius2 = tally.radius2;
        } else if tally.radius2 < MARK_AGAIN * self.marked_radius2 {
            self.grid.mark(&self.hit_points.packets);
            self.marked_radius2 = tally.radius2;
        }
    }

    /// The longest path of a render, in edges as Mitsuba counts them: what the settings say, or else the scene, but never
    /// more than 250.
    #[must_use]
    pub fn max_depth(scene: &Scene, settings: &Settings) -> u32 {
        settings.max_depth.or(scene.max_depth()).map_or(LONGEST_PATH, |d| d.min(LONGEST_PATH))
    }

    /// Changes a setting from the next pass on. The change stands in [`Ppm::changes`] with the number of passes before it.
    pub fn change(&mut self, change: Change) {
        self.settings.change(change);
        self.changes.push((self.passes, change));
    }

    /// Passes so far.
    #[must_use]
    pub const fn passes(&self) -> u64 {
        self.passes
    }

    /// Photons emitted so far.
    #[must_use]
    pub const fn photons_emitted(&self) -> u64 {
        self.photons_emitted
    }

    /// All changes so far, each with the number of passes before it.
    #[must_use]
    pub fn changes(&self) -> &[(u64, Change)] {
        &self.changes
    }

    /// The settings as they are now.
    #[must_use]
    pub const fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The scene.
    #[must_use]
    pub const fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// What the eye pass found.
    #[must_use]
    pub const fn start_report(&self) -> &Start {
        &self.start
    }

    /// Where all emitted power went.
    #[must_use]
    pub const fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// What the photons of each emitter were good for, in the order of the scene's emitters.
    #[must_use]
    pub fn light_use(&self) -> &[LightUse] {
        &self.lights
    }

    /// What went missing at each material, in the order of the scene's materials.
    #[must_use]
    pub fn material_losses(&self) -> &[Loss] {
        &self.losses
    }

    /// Image size in pixels.
    pub(crate) fn size(&self) -> (u32, u32) {
        let sensor = &self.scene.sensors()[self.settings.sensor];
        (sensor.width, sensor.height)
    }

    pub(crate) fn as_image(&self, pixels: Vec<Rgb>) -> Image {
        let (width, height) = self.size();
        Image { width, height, pixels }
    }

    /// Radiance after all passes so far.
    #[must_use]
    pub fn image(&self) -> Image {
        self.as_image(self.light.total(self.photons_emitted))
    }

    /// The last pass's own, independent estimate of reflected radiance: the image is the mean of these, weighted by photons.
    #[must_use]
    pub fn last_pass(&self) -> Image {
        let scale = 1.0 / self.last_photons.max(1) as f64;
        let pixels = self.light.last_pass().into_iter().map(|l| l * scale as f32);
        self.as_image(pixels.collect())
    }

    pub(crate) fn per_pixel<T>(&self, f: impl Fn(&[Statistics]) -> T) -> Vec<T> {
        let mut statistics = self.hit_points.statistics().copied();
        let mut of_pixel = Vec::new();
        let spans = self.hit_points.pixel_start.windows(2).map(|w| (w[1] - w[0]) as usize);
        spans
            .map(|n| {
                of_pixel.clear();
                of_pixel.extend(statistics.by_ref().take(n));
                f(&of_pixel)
            })
            .collect()
    }

    /// Of those, how many there were in the last batch, whose photons the map still holds.
    pub(crate) fn photons_in_last_batch(&self) -> u64 {
        self.batches(self.last_photons).last().map_or(0, |batch| batch.photons(self.last_photons))
    }

    /// Bytes held, the scene included.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let chunk =
            |c: &Chunk| c.photons.capacity() * size_of::<Photon>() + c.cells.capacity() * size_of::<u32>();
        self.scene.bytes()
            + self.hit_points.bytes()
            + self.light.bytes()
            + self.error.as_ref().map_or(0, ErrorSums::bytes)
            + self.grid.bytes()
            + self.map.bytes()
            + self.kept.bytes()
            + self.chunks.iter().map(chunk).sum::<usize>()
            + self.shapes.len() * size_of::<u32>()
    }
}

#[cfg(test)]
#[path = "instruction_sets.rs"]
mod instruction_sets;

#[cfg(test)]
#[path = "batches.rs"]
mod batches;

#[cfg(test)]
impl Ppm {
    /// Passes of more than `most` photons fall into batches from now on.
    pub(crate) fn with_batches_of(self, most: u64) -> Self {
        Self { most_in_batch: most, ..self }
    }
}
