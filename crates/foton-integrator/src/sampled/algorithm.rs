//! A render by samples of each pixel: every pass follows new eye samples, and the image is the mean of all passes.

use std::sync::Arc;

use foton_scene::Scene;
use foton_transport::{Cancel, Cancelled, Halt, Ledger, LeftOut, NotFinite, ShouldSuspend, Stage, Suspended};

use super::block::{BLOCK, Block, Sampling};
use super::estimator::Estimator;
use super::sums::PixelSums;
use crate::by_block::ByBlock;
use crate::photon_map::KeptMaps;
use crate::report::{PassReport, Start};
use crate::settings::RenderSettings;
use crate::shutter::at_pass;
use rayon::prelude::*;

/// A render under way.
pub(crate) struct Sampled {
    pub(super) scene: Arc<Scene>,
    /// The same at the time of the pass under way.
    now: Arc<Scene>,
    pub(super) settings: RenderSettings,
    pub(super) estimator: Estimator,
    pub(super) sums: PixelSums,
    pub(super) passes: u64,
    pub(super) start: Start,
    pub(super) ledger: Ledger,
    /// Blocks of a pass that was suspended; none between passes.
    pub(super) under_way: Vec<Option<Block>>,
    /// Whether a pass that leaves a value out does not happen.
    pub(super) strict: bool,
    pub(super) not_finite: Option<NotFinite>,
}

impl Sampled {
    /// `None` for a method that does not estimate pixels by samples.
    ///
    /// # Errors
    /// When cancelled.
    pub(crate) fn start(
        scene: Arc<Scene>,
        settings: RenderSettings,
        maps: Option<&KeptMaps>,
        watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
    ) -> Result<Option<Self>, Cancelled> {
        let Some(estimator) = Estimator::new(&scene, &settings, maps, watch, cancel)? else {
            return Ok(None);
        };
        let sensor = &scene.sensors()[settings.sensor];
        let size = (sensor.width, sensor.height);
        Ok(Some(Self {
            sums: PixelSums::new(size, settings.layers, settings.error),
            ledger: estimator.ledger(),
            not_finite: estimator.left_out().map(|left_out| NotFinite::new(&scene, 0, left_out)),
            now: Arc::clone(&scene),
            scene,
            settings,
            estimator,
            passes: 0,
            start: Start::default(),
            under_way: Vec::new(),
            strict: false,
        }))
    }

    /// One pass, or what is left of one that was suspended.
    ///
    /// # Errors
    /// When cancelled: the pass then has not happened. When suspended. After [`Sampled::stop_at_first_not_finite`], when a value is
    /// not: the pass then has not happened.
    pub(crate) fn advance(
        &mut self,
        watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
        should_suspend: ShouldSuspend<'_>,
    ) -> Result<PassReport, Halt> {
        self.halt_at(None)?;
        watch(Stage::EyePass);
        if self.under_way.is_empty() {
            self.open_shutter(watch, cancel)?;
        }
        self.follow_samples(cancel, should_suspend);
        if cancel.is_requested() {
            self.under_way.clear();
            return Err(Cancelled.into());
        }
        if self.under_way.iter().any(Option::is_none) {
            return Err(Suspended.into());
        }
        watch(Stage::Radiance);
        self.accumulate()
    }

    /// Brings everything to where it is in this pass: all of it sees a single time, and passes are stratified over the shutter's.
    fn open_shutter(&mut self, watch: &mut dyn FnMut(Stage), cancel: &Cancel) -> Result<(), Cancelled> {
        let (scene, settings) = (&self.scene, &self.settings);
        if !scene.blurs(settings.sensor) || !self.estimator.follows_motion() {
            return Ok(());
        }
        let now = at_pass(scene, settings, self.passes, cancel)?;
        if let Some(estimator) = Estimator::new(&now, settings, None, watch, cancel)? {
            (self.now, self.estimator) = (now, estimator);
        }
        Ok(())
    }

    /// Follows the samples of blocks that have not been followed yet.
    fn follow_samples(&mut self, cancel: &Cancel, should_suspend: ShouldSuspend<'_>) {
        let pixels = self.pixels();
        let sampling = Sampling {
            scene: &self.now,
            settings: &self.settings,
            estimator: &self.estimator,
            before: self.passes,
        };
        let makes_way = || should_suspend() || cancel.is_requested();
        let by_block = ByBlock { done: &mut self.under_way, should_suspend: &makes_way };
        by_block.places(pixels.div_ceil(BLOCK)).enumerate().for_each(|(block, place)| {
            let first = block * BLOCK;
            place.fill(|| sampling.block(first..pixels.min(first + BLOCK)));
        });
    }

    /// Adds the pass to the image.
    fn accumulate(&mut self) -> Result<PassReport, Halt> {
        let blocks: Vec<Block> = std::mem::take(&mut self.under_way).into_iter().flatten().collect();
        let mut left_out = None;
        for block in &blocks {
            left_out = left_out.or(block.omissions.first);
            self.ledger.dropped += block.omissions.count;
        }
        self.halt_at(left_out)?;
        let rays = blocks.iter().map(|block| block.rays).sum();
        self.sums.add(blocks.into_iter(), self.settings.samples_per_pixel.get());
        self.passes += 1;
        Ok(PassReport { pass: self.passes, photons: self.photons_emitted(), rays, ..PassReport::default() })
    }

    /// Notes the first value that was left out.
    ///
    /// # Errors
    /// When the render is to halt at that, or has.
    fn halt_at(&mut self, left_out: Option<LeftOut>) -> Result<(), Halt> {
        if let (None, Some(left_out)) = (&self.not_finite, left_out) {
            self.not_finite = Some(NotFinite::new(&self.scene, self.passes + 1, left_out));
        }
        match &self.not_finite {
            Some(not_finite) if self.strict => Err(Halt::NotFinite(Box::new(not_finite.clone()))),
            _ => Ok(()),
        }
    }

    pub(super) fn pixels(&self) -> usize {
        let sensor = &self.scene.sensors()[self.settings.sensor];
        sensor.width as usize * sensor.height as usize
    }
}
