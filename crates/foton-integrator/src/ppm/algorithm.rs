//! Progressive photon mapping: `[PPM08]` with the running mean of every pass's own estimate; and `[SPPM09]`, where each pass begins with
//! eye samples of its own (`crate::sppm`).

use std::num::NonZeroU32;
use std::sync::Arc;

use foton_math::Rgb;
use foton_scene::{Scene, Sources};
use foton_transport::light_paths::MAX_PHOTONS;
use foton_transport::photon_map::{Chunk, Grid, PhotonMap};
use foton_transport::{Cancel, Cancelled, Halt, Ledger, LightUse, Loss, NotFinite, ShouldSuspend, Stage};
use pulp::Arch;

use super::direct::{Direct, by_shadow_rays};
use super::eye_samples::EyeSamples;
use super::guidance::Guidance;
use super::hit_points::HitPoints;
use super::laid_out::{LaidOut, has_moments};
use super::light::Light;
use super::schedule::begin_small;
use super::under_way::{Once, UnderWay};
use crate::changes::Changes;
use crate::error::ErrorSums;
use crate::report::{PassReport, Start};
use crate::settings::{Method, RenderSettings, SettingChange};
use crate::sppm::Renewal;

/// A render under way.
pub(crate) struct Ppm {
    pub(crate) scene: Arc<Scene>,
    pub(super) sources: Sources,
    pub(super) guidance: Guidance,
    pub(crate) settings: RenderSettings,
    pub(crate) hit_points: HitPoints,
    pub(crate) shapes: Vec<u32>,
    pub(crate) light: Light,
    /// What pixels keep where each pass has hit points of its own; `None` where those of the start stay.
    pub(crate) renewal: Option<Box<Renewal>>,
    /// Direct light by shadow rays at hit points that stay.
    pub(super) direct: Option<Direct>,
    pub(crate) error: Option<ErrorSums>,
    pub(crate) grid: Grid,
    pub(super) marked_radius2: f64,
    pub(super) chunks: Vec<Chunk>,
    pub(super) map: PhotonMap,
    /// Photons that were emitted for those in the map.
    pub(super) map_photons: u64,
    /// The largest number of photons in a batch: [`MAX_PHOTONS`], except in tests.
    pub(super) max_in_batch: u64,
    pub(super) ledger: Ledger,
    pub(super) lights: Vec<LightUse>,
    pub(super) losses: Vec<Loss>,
    pub(crate) passes: u64,
    pub(crate) photons_emitted: u64,
    pub(super) last_photons: u64,
    pub(super) changes: Changes,
    /// Changes that wait for the end of the pass under way.
    pub(super) deferred: Vec<SettingChange>,
    /// What holds for the next pass alone.
    pub(super) once: Once,
    /// A pass that was suspended.
    pub(super) under_way: Option<Box<UnderWay>>,
    pub(super) start: Start,
    /// The sensors whose renders share the photons of this one, it included; none where it has its own.
    pub(super) cameras: Vec<usize>,
    /// Whether a pass that leaves a value out does not happen.
    pub(super) strict: bool,
    pub(super) not_finite: Option<NotFinite>,
    /// The instruction set that photons and gather are compiled for. It changes no bit.
    pub(super) arch: Arch,
}

impl Ppm {
    /// Collects hit points. `tell` is told by many threads what share of the eye samples is followed, `watch` each stage as it begins.
    ///
    /// # Errors
    /// When cancelled.
    pub(crate) fn start(
        mut eye: EyeSamples,
        tell: &(dyn Fn(f64) + Sync),
        watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        watch(Stage::EyePass);
        eye.follow_all(cancel, tell)?;
        watch(Stage::Layout);
        let laid_out = LaidOut::new(&eye, &eye.settings, 1.0, cancel)?;
        let EyeSamples { scene, settings, paths } = eye;
        let shapes = paths.shapes;
        // What was found is most of the memory at this point, and not needed any more.
        drop((paths.hit_points, paths.gloss));
        Self::over(scene, settings, shapes, (laid_out, 1.0), cancel)
    }

    /// The same over the first `samples` of each pixel alone: to be looked at while the others are followed, with other `settings` of
    /// passes, and with first radii multiplied by `widened`.
    ///
    /// # Errors
    /// When cancelled.
    pub(crate) fn start_with_some(
        (eye, samples): (&mut EyeSamples, u32),
        (settings, widened): (RenderSettings, f32),
        tell: &(dyn Fn(f64) + Sync),
        watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        watch(Stage::EyePass);
        eye.follow(samples, cancel, tell)?;
        watch(Stage::Layout);
        let laid_out = LaidOut::new(eye, &settings, widened, cancel)?;
        // Passes of new samples have as many of them.
        let samples_per_pixel = NonZeroU32::new(eye.followed()).unwrap_or(settings.samples_per_pixel);
        let settings = RenderSettings { samples_per_pixel, ..settings };
        Self::over(Arc::clone(&eye.scene), settings, eye.paths.shapes.clone(), (laid_out, widened), cancel)
    }

    fn over(
        scene: Arc<Scene>,
        mut settings: RenderSettings,
        shapes: Vec<u32>,
        (laid_out, widened): (LaidOut, f32),
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        let LaidOut { hit_points, sources, guidance, samples, mut emission, start, .. } = laid_out;
        cancel.check()?;
        let hit_points = hit_points.with_statistics(has_moments(&settings));
        let grid = Grid::new(&hit_points.packets, cancel)?;
        begin_small(&mut settings.ppm, &hit_points.packets, &grid);
        cancel.check()?;
        let width = scene.sensors()[settings.sensor].width;
        let shadow_rays = by_shadow_rays(&scene, &settings);
        let renewal = (settings.method == Method::Sppm).then(|| {
            let none = vec![Rgb::BLACK; emission.len()];
            let (emission, first) = (std::mem::replace(&mut emission, none), laid_out.first_radius2);
            let moments = !hit_points.radius_statistics.is_empty();
            Box::new(Renewal::new((&scene, shadow_rays), emission, (first, widened), moments))
        });
        let turns = renewal.is_none() && shadow_rays;
        let direct = turns.then(|| Direct::new(&scene, &settings, &hit_points, samples));
        let error = settings.error.then(|| ErrorSums::new(&hit_points, width, samples, renewal.is_some()));
        cancel.check()?;
        Ok(Self {
            lights: vec![LightUse::default(); scene.emitters().len()],
            losses: vec![Loss::default(); scene.materials().len()],
            scene,
            sources,
            guidance,
            light: Light::new(emission, &hit_points, samples, settings.layers),
            renewal,
            direct,
            settings,
            hit_points,
            shapes,
            error,
            grid,
            marked_radius2: f64::INFINITY,
            chunks: Vec::new(),
            map: PhotonMap::default(),
            map_photons: 0,
            max_in_batch: MAX_PHOTONS,
            ledger: Ledger::default(),
            passes: 0,
            photons_emitted: 0,
            last_photons: 0,
            changes: Changes::default(),
            deferred: Vec::new(),
            once: Once::default(),
            under_way: None,
            start,
            cameras: Vec::new(),
            strict: false,
            not_finite: laid_out.not_finite,
            arch: Arch::new(),
        })
    }

    /// One pass: eye samples, where each pass has new ones; photons from the emitters, sorted into a map, gathered by every hit point,
    /// which is then refined, batch by batch; then added to the image. Where a pass was suspended, this goes on with it; how often that happens changes no bit.
    ///
    /// # Errors
    /// When cancelled while photons are traced; the pass then has not happened. When suspended. After
    /// [`Ppm::stop_at_first_not_finite`], when a value is not: the image is then that of the passes before, and hit points may be
    /// half-way to the next.
    pub(crate) fn advance(
        &mut self,
        watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
        should_suspend: ShouldSuspend<'_>,
    ) -> Result<PassReport, Halt> {
        self.halt_at(None)?;
        let mut pass = self.under_way.take().unwrap_or_else(|| Box::new(self.begin_pass()));
        match self.complete(&mut pass, watch, cancel, should_suspend) {
            Ok(()) => Ok(self.accumulate(*pass, watch)),
            Err(halt) => {
                self.under_way = matches!(halt, Halt::Suspended(_)).then_some(pass);
                if self.under_way.is_none() {
                    self.forget_hit_points();
                    self.take_deferred_changes();
                }
                Err(halt)
            }
        }
    }

    /// What is left of a pass: each step does what it has not done before.
    fn complete(
        &mut self,
        pass: &mut UnderWay,
        watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
        should_suspend: ShouldSuspend<'_>,
    ) -> Result<(), Halt> {
        self.renew_hit_points(pass, watch, cancel, should_suspend)?;
        while let Some(batch) = pass.batch() {
            self.emit_and_trace(batch, pass, watch, cancel, should_suspend)?;
            self.build_map(pass, watch, cancel)?;
            self.gather_and_refine(batch, pass, watch, should_suspend)?;
            self.halt_at(pass.counts.left_out)?;
            pass.end_batch();
        }
        self.add_shadow_rays(pass, watch, should_suspend)?;
        self.halt_at(pass.counts.left_out)
    }
}
