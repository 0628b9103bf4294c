//! How a render stands: settings, counts, accounts.

use std::sync::Arc;

use foton_scene::Scene;
use foton_transport::light_paths::Batch;
use foton_transport::photon_map::{Chunk, Photon};
use foton_transport::{Ledger, LightUse, Loss, NotFinite};

use super::algorithm::Ppm;
use super::direct::Direct;
use super::under_way::{Once, UnderWay};
use crate::error::ErrorSums;
use crate::report::Start;
use crate::settings::{RenderSettings, SettingChange};

impl Ppm {
    /// From now on a pass in which a value is not finite does not happen. Otherwise such values are left out and counted.
    pub(crate) const fn stop_at_first_not_finite(&mut self) {
        self.strict = true;
    }

    /// The first value that was not finite since the render was started or restored, and was left out.
    #[must_use]
    pub(crate) const fn first_not_finite(&self) -> Option<&NotFinite> {
        self.not_finite.as_ref()
    }

    /// Changes a setting from the next pass on. The change stands in [`Ppm::changes`] with the number of passes before it.
    pub(crate) fn change(&mut self, change: SettingChange) {
        if self.under_way.is_some() {
            self.deferred.push(change);
        } else {
            self.take(change);
        }
    }

    fn take(&mut self, change: SettingChange) {
        // What holds for one pass is logged with that.
        match change {
            SettingChange::CutPass(batches) => self.once.batches = Some(batches),
            SettingChange::PhotonsOnce(photons) => self.once.photons = Some(photons),
            SettingChange::Alpha(_) | SettingChange::PhotonsPerPass(_) => {
                self.log(change);
                self.settings.change(change);
            }
        }
    }

    fn log(&mut self, change: SettingChange) {
        self.changes.add(self.passes, self.settings.in_force(&change), change);
    }

    /// Lets the pass under way end early, as a valid pass of fewer photons, where it has several batches: after the one under way; or, if
    /// `drops`, without that one unless its photons have all been traced. [`Ppm::advance`] then finishes it.
    pub(crate) fn cut_pass(&mut self, drops: bool) {
        if let Some(pass) = &mut self.under_way {
            pass.cut(drops);
        }
    }

    /// Gives up the pass under way, which then has not happened; `false` where hit points have been refined already, or there is none.
    pub(crate) fn discard_pass(&mut self) -> bool {
        if self.has_refined() || self.under_way.is_none() {
            return false;
        }
        self.under_way = None;
        self.forget_hit_points();
        self.take_deferred_changes();
        true
    }

    /// The pass under way has not happened: the next one counts anew at its hit points, where each has some of its own.
    pub(super) fn forget_hit_points(&mut self) {
        if let Some(renewal) = &mut self.renewal {
            renewal.discard();
        }
    }

    /// Logs what held for a pass alone.
    pub(super) fn note_exceptions(&mut self, pass: &UnderWay) {
        let Once { photons, batches } = pass.exceptions();
        let changes = [photons.map(SettingChange::PhotonsOnce), batches.map(SettingChange::CutPass)];
        changes.into_iter().flatten().for_each(|change| self.log(change));
    }

    /// Photons of the next pass's largest batch.
    pub(crate) fn next_batch(&self) -> u64 {
        let photons = self.once.photons.unwrap_or_else(|| self.settings.ppm.photons_after(self.passes));
        let photons = u64::from(photons.get());
        Batch::all(photons, self.max_in_batch).next().map_or(photons, |batch| batch.photons(photons))
    }

    /// Takes the changes on that were made while a pass was under way.
    pub(super) fn take_deferred_changes(&mut self) {
        for change in std::mem::take(&mut self.deferred) {
            self.take(change);
        }
    }

    /// How much of the pass under way is done, from 0 to 1; 0 between passes.
    pub(crate) fn pass_share(&self) -> f64 {
        let traced = || {
            let traced = self.chunks.iter().filter(|chunk| chunk.is_traced).count();
            traced as f64 / self.chunks.len().max(1) as f64
        };
        self.under_way.as_ref().map_or(0.0, |pass| pass.share(traced()))
    }

    /// Whether the pass under way has refined hit points: they are then not as the last whole pass left them.
    pub(crate) fn has_refined(&self) -> bool {
        self.renewal.is_none() && self.under_way.as_ref().is_some_and(|pass| pass.has_refined())
    }

    /// Passes so far.
    #[must_use]
    pub(crate) const fn passes(&self) -> u64 {
        self.passes
    }

    /// Photons emitted so far.
    #[must_use]
    pub(crate) const fn photons_emitted(&self) -> u64 {
        self.photons_emitted
    }

    /// Whether direct light comes by shadow rays.
    #[must_use]
    pub(crate) const fn has_shadow_rays(&self) -> bool {
        match &self.renewal {
            Some(renewal) => renewal.lights.is_some(),
            None => self.direct.is_some(),
        }
    }

    /// The sensors whose renders share its photons, it included.
    pub(crate) fn cameras(&self) -> &[usize] {
        &self.cameras
    }

    /// All changes so far, each with the number of passes before it.
    #[must_use]
    pub(crate) fn changes(&self) -> &[(u64, SettingChange)] {
        self.changes.log()
    }

    /// The settings as they are now.
    #[must_use]
    pub(crate) const fn settings(&self) -> &RenderSettings {
        &self.settings
    }

    /// The scene.
    #[must_use]
    pub(crate) const fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// What the eye pass found.
    #[must_use]
    pub(crate) const fn start_report(&self) -> &Start {
        &self.start
    }

    /// Where all emitted power went.
    #[must_use]
    pub(crate) const fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// What the photons of each emitter were good for, in the order of the scene's emitters.
    #[must_use]
    pub(crate) fn light_use(&self) -> &[LightUse] {
        &self.lights
    }

    /// What went missing at each material, in the order of the scene's materials.
    #[must_use]
    pub(crate) fn material_losses(&self) -> &[Loss] {
        &self.losses
    }

    /// Bytes held, the scene included.
    #[must_use]
    pub(crate) fn bytes(&self) -> usize {
        let chunk =
            |c: &Chunk| c.photons.capacity() * size_of::<Photon>() + c.cells.capacity() * size_of::<u32>();
        self.scene.bytes()
            + self.hit_points.bytes()
            + self.light.bytes()
            + self.direct.as_ref().map_or(0, Direct::bytes)
            + self.renewal.as_ref().map_or(0, |r| r.bytes(!self.hit_points.radius_statistics.is_empty()))
            + self.error.as_ref().map_or(0, ErrorSums::bytes)
            + self.grid.bytes()
            + self.guidance.bytes()
            + self.map.bytes()
            + self.chunks.iter().map(chunk).sum::<usize>()
            + self.shapes.len() * size_of::<u32>()
    }
}
