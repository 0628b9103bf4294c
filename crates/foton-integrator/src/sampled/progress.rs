//! How a render stands: settings, counts, accounts. What photons tell elsewhere is nothing here.

use std::sync::Arc;

use foton_scene::Scene;
use foton_transport::{Ledger, LightUse, Loss, NotFinite};

use super::algorithm::Sampled;
use crate::photon_map::{KeptMaps, PhotonMapper};
use crate::report::Start;
use crate::settings::{RenderSettings, SettingChange};

impl Sampled {
    pub(crate) const fn stop_at_first_not_finite(&mut self) {
        self.strict = true;
    }

    pub(crate) const fn first_not_finite(&self) -> Option<&NotFinite> {
        self.not_finite.as_ref()
    }

    /// Photons and radii can be changed, to no effect: there are none. So no change stands in the log.
    pub(crate) const fn change(&mut self, change: SettingChange) {
        self.settings.change(change);
    }

    pub(crate) const fn changes(&self) -> &[(u64, SettingChange)] {
        &[]
    }

    /// A pass has no batches.
    pub(crate) const fn cut_pass(&mut self, _drops: bool) {}

    pub(crate) const fn next_batch(&self) -> u64 {
        0
    }

    /// Gives up the pass under way; `false` where there is none.
    pub(crate) fn discard_pass(&mut self) -> bool {
        let was_under_way = !self.under_way.is_empty();
        self.under_way.clear();
        was_under_way
    }

    /// How much of the pass under way is done, from 0 to 1; 0 between passes.
    pub(crate) fn pass_share(&self) -> f64 {
        let done = self.under_way.iter().filter(|block| block.is_some()).count();
        done as f64 / self.under_way.len().max(1) as f64
    }

    /// A pass that is under way changes nothing until it is whole.
    pub(crate) const fn has_refined(&self) -> bool {
        false
    }

    pub(crate) const fn passes(&self) -> u64 {
        self.passes
    }

    pub(crate) fn photons_emitted(&self) -> u64 {
        self.estimator.mapper().map_or(0, PhotonMapper::photons_emitted)
    }

    pub(crate) fn maps(&self) -> Option<KeptMaps> {
        self.estimator.mapper().map(PhotonMapper::kept)
    }

    pub(crate) const fn has_shadow_rays(&self) -> bool {
        true
    }

    pub(crate) const fn settings(&self) -> &RenderSettings {
        &self.settings
    }

    pub(crate) const fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    pub(crate) const fn start_report(&self) -> &Start {
        &self.start
    }

    pub(crate) const fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    pub(crate) fn light_use(&self) -> &[LightUse] {
        self.estimator.light_use()
    }

    pub(crate) fn material_losses(&self) -> &[Loss] {
        self.estimator.material_losses()
    }

    /// Bytes held, the scene included.
    pub(crate) fn bytes(&self) -> usize {
        self.scene.bytes() + self.sums.bytes() + self.estimator.mapper().map_or(0, PhotonMapper::bytes)
    }
}
