//! The steps of a pass.

use foton_transport::light_paths::{Batch, PhotonPass};
use foton_transport::{Cancel, Cancelled, Halt, LeftOut, NotFinite, ShouldSuspend, Stage, Suspended};

use super::algorithm::Ppm;
use super::counts::Counts;
use super::direct::Lighting;
use super::laid_out::MAX_PROBED;
use super::light::Light;
use super::lobes::LOBE_POLICY;
use super::rule::Rule;
use super::settings::RadiusRule;
use super::sweep::{Photons, sweep};
use super::tally::Tally;
use super::under_way::{NextStep, UnderWay};
use crate::by_block::ByBlock;
use crate::error::{PassFacts, Question};
use crate::report::PassReport;

/// Cells are marked again when the mean r² has shrunk by this factor since the last time.
const MARK_AGAIN: f64 = 0.7;

impl Ppm {
    /// An error where a value was left out that must not be: this one, or one before it.
    pub(crate) fn halt_at(&self, left_out: Option<LeftOut>) -> Result<(), Halt> {
        if !self.strict {
            return Ok(());
        }
        let here = left_out.map(|left_out| NotFinite::new(&self.scene, self.passes + 1, left_out));
        self.not_finite.clone().or(here).map_or(Ok(()), |place| Err(Box::new(place).into()))
    }

    /// Prepares for the batches of a pass.
    pub(super) fn begin_pass(&mut self) -> UnderWay {
        let once = std::mem::take(&mut self.once);
        let scheduled = self.settings.ppm.photons_after(self.passes);
        let photons = u64::from(once.photons.unwrap_or(scheduled).get());
        self.guidance.begin_pass();
        let batches: Vec<Batch> = Batch::all(photons, self.max_in_batch).collect();
        let counts = Counts {
            ledger: self.ledger,
            lights: self.lights.clone(),
            losses: self.losses.clone(),
            photons,
            rays: 0,
            stored: 0,
            tally: Tally::default(),
            left_out: None,
        };
        UnderWay::new(counts, self.settings.ppm.alpha, batches, once)
    }

    /// Whether photons can add light to surfaces: not where only shadow rays light them.
    fn photons_add(&self) -> bool {
        self.settings.max_depth_in(&self.scene) > if self.has_shadow_rays() { 2 } else { 1 }
    }

    pub(super) fn photon_pass(&self, photons: u64, batch: Batch) -> PhotonPass<'_> {
        PhotonPass {
            scene: &self.scene,
            sources: &self.sources,
            cells: self.guidance.cells(),
            training: self.guidance.training(self.passes, photons),
            grid: &self.grid,
            stores_direct: !self.has_shadow_rays(),
            ends_where_light_spreads: false,
            policy: LOBE_POLICY,
            directions: self.hit_points.need_directions(),
            arch: self.arch,
            max_depth: self.settings.max_depth_in(&self.scene),
            seed: self.settings.photon_seed(),
            pass: self.passes,
            // A path of one edge is an emitter seen directly: no photon can add to it.
            photons: if self.settings.max_depth_in(&self.scene) > 1 { photons } else { 0 },
            batch,
        }
    }

    /// Emits the photons of a batch and traces them until they are absorbed or leave.
    pub(super) fn emit_and_trace(
        &mut self,
        batch: Batch,
        pass: &mut UnderWay,
        watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
        should_suspend: ShouldSuspend<'_>,
    ) -> Result<(), Halt> {
        if batch.is_closing() && pass.next < NextStep::Gather {
            // Nothing more is emitted: the map stays as it was, and nothing is gathered from it.
            pass.next = NextStep::Gather;
            pass.tallies.clear();
        }
        if pass.next > NextStep::Trace {
            return Ok(());
        }
        watch(Stage::Trace);
        let mut chunks = std::mem::take(&mut self.chunks);
        let photon_pass = self.photon_pass(pass.planned(), batch);
        if pass.next == NextStep::Begin {
            photon_pass.begin(&mut chunks);
            pass.next = NextStep::Trace;
        }
        let shot = photon_pass.shoot(&mut chunks, cancel, should_suspend);
        self.chunks = chunks;
        shot?;
        self.guidance.take(&mut self.chunks);
        pass.next = NextStep::Sort;
        self.halt_at(self.chunks.iter().find_map(|chunk| chunk.left_out))
    }

    /// Sorts the photons that lie in `chunks` into the map.
    pub(super) fn build_map(
        &mut self,
        pass: &mut UnderWay,
        watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
    ) -> Result<(), Cancelled> {
        if pass.next > NextStep::Sort {
            return Ok(());
        }
        watch(Stage::Sort);
        self.map.build(&self.chunks, self.grid.touched());
        self.map_photons = pass.batch().map_or(0, |batch| batch.photons(pass.planned()));
        pass.next = NextStep::Gather;
        pass.tallies.clear();
        cancel.check()
    }

    /// Gathers a batch from the map. With the last one hit points are refined, packet by packet while it is at hand.
    pub(super) fn gather_and_refine(
        &mut self,
        batch: Batch,
        pass: &mut UnderWay,
        watch: &mut dyn FnMut(Stage),
        should_suspend: ShouldSuspend<'_>,
    ) -> Result<(), Suspended> {
        watch(Stage::Gather);
        let (alpha, before) = (pass.alpha, self.photons_emitted);
        let common = self.settings.ppm.radius_rule.common(alpha, before, pass.counts.photons);
        let rule = Rule {
            alpha,
            error: self.error.is_some(),
            adapts: self.settings.ppm.radius_rule == RadiusRule::Adaptive,
            // Hit points of a single pass only count: their pixels' radii shrink once it is whole.
            common: if self.renewal.is_some() { Some(1.0) } else { common },
            batch,
            question: Question::after(self.passes),
            arch: self.arch,
        };
        let hit_points = &mut self.hit_points;
        let photons = Photons { map: &self.map, grid: &self.grid };
        let tallies = ByBlock { done: &mut pass.tallies, should_suspend };
        match &mut self.light {
            Light::Whole(sums) => sweep(hit_points, photons, rule, sums.arrived(), tallies),
            Light::ByClass(sums) => sweep(hit_points, photons, rule, sums.arrived(), tallies),
        }
        let mut tally = Tally::default();
        for of_block in &pass.tallies {
            tally += (*of_block).ok_or(Suspended)?;
        }
        pass.counts.add(if batch.is_closing() { &[] } else { &self.chunks }, &tally);
        Ok(())
    }

    /// Adds direct light by shadow rays, if settings ask for them, once hit points are refined.
    pub(super) fn add_shadow_rays(
        &mut self,
        pass: &mut UnderWay,
        watch: &mut dyn FnMut(Stage),
        should_suspend: ShouldSuspend<'_>,
    ) -> Result<(), Suspended> {
        if pass.is_lit || !self.has_shadow_rays() {
            return Ok(());
        }
        watch(Stage::ShadowRays);
        if let Some(renewal) = &self.renewal {
            self.light_hit_points(renewal, pass, should_suspend)?;
        } else if let Some(direct) = &self.direct {
            let (scene, hit_points, samples) = (&*self.scene, &self.hit_points, direct.samples);
            let (lights, seed) = (&direct.lights, self.settings.photon_seed());
            let lighting = Lighting { scene, hit_points, lights, samples, seed };
            let by_block = ByBlock { done: &mut pass.lit, should_suspend };
            lighting.light(&direct.order, &direct.turns(pass.counts.rays), by_block);
        }
        if pass.lit.iter().any(Option::is_none) {
            return Err(Suspended);
        }
        pass.is_lit = true;
        for block in pass.lit.iter().flatten() {
            pass.counts.rays += block.rays;
            pass.counts.leave_out(block.omissions);
        }
        Ok(())
    }

    /// Adds a pass to the image, its error to the error, and what it counted to the render's own.
    pub(super) fn accumulate(&mut self, mut pass: UnderWay, watch: &mut dyn FnMut(Stage)) -> PassReport {
        watch(Stage::Radiance);
        self.note_exceptions(&pass);
        pass.counts.leave_out(self.light.add_pass(&self.hit_points, pass.counts.photons));
        let unknown_pixels = self.add_to_renewal(&mut pass);
        let counts = pass.counts;
        if let Some(direct) = &mut self.direct {
            direct.add(pass.lit.into_iter().flatten());
        }
        let Counts { ledger, lights, losses, photons, rays, stored, tally, left_out } = counts;
        (self.ledger, self.lights, self.losses) = (ledger, lights, losses);
        if let (None, Some(left_out)) = (&self.not_finite, left_out) {
            self.not_finite = Some(NotFinite::new(&self.scene, self.passes + 1, left_out));
        }
        self.mark_cells(&tally);
        self.photons_emitted += photons;
        let power = if self.photons_add() { self.mean_power() } else { 0.0 };
        let radii_shrink_alike = self.settings.ppm.radius_rule == RadiusRule::Global;
        if let Some(error) = &mut self.error {
            let facts = PassFacts {
                photons,
                power,
                question: Question::after(self.passes),
                before: self.passes,
                radii_shrink_alike,
            };
            let apart = (self.direct.as_ref(), self.renewal.as_deref());
            self.light.add_error(error, &self.hit_points, apart, facts);
        }
        self.guidance.learn(self.passes, &self.sources);
        self.last_photons = photons;
        self.passes += 1;
        self.take_deferred_changes();
        PassReport {
            pass: self.passes,
            photons: self.photons_emitted,
            photons_in_pass: photons,
            stored,
            rays,
            candidates: tally.candidates,
            accepted: tally.accepted,
            no_photon_share: unknown_pixels
                .unwrap_or(tally.unknown as f64 / self.hit_points.len().max(1) as f64),
            floored: tally.floored,
        }
    }

    /// Mean power of a photon as it leaves its emitter. Photons that are aimed or guided differ much: there it is that of some of those which
    /// came near hit points in the last batch, if any did.
    fn mean_power(&self) -> f64 {
        let stored = self.map.photons();
        if (self.sources.is_aimed() || self.guidance.is_on()) && !stored.is_empty() {
            let step = stored.len().div_ceil(MAX_PROBED);
            let (sum, count) = stored
                .iter()
                .step_by(step)
                .fold((0.0, 0.0), |(sum, count), p| (sum + f64::from(p.power.luminance()), count + 1.0));
            return sum / count;
        }
        self.ledger.emitted / self.photons_emitted.max(1) as f64
    }

    /// Photons that no disc can reach any more need not be stored: marks cells again once discs are clearly smaller.
    fn mark_cells(&mut self, tally: &Tally) {
        if self.renewal.is_some() {
            // Cells are marked for the hit points of each pass.
        } else if self.marked_radius2.is_infinite() {
            self.marked_radius2 = tally.radius2;
        } else if tally.radius2 < MARK_AGAIN * self.marked_radius2 {
            self.grid.mark(&self.hit_points.packets);
            self.marked_radius2 = tally.radius2;
        }
    }

    /// Marks cells for discs as they are now.
    pub(super) fn mark_all_cells(&mut self) {
        self.grid.mark(&self.hit_points.packets);
        self.marked_radius2 = f64::INFINITY;
    }
}
