//! A render's parts for the rest of this crate: checkpoints, layers, variants.

use super::Ppm;
use crate::error::ErrorSums;
use crate::grid::Grid;
use crate::hit_point::HitPoints;
use crate::ledger::{Ledger, Loss};
use crate::light::Light;
use crate::light_use::LightUse;
use crate::photon_map::PhotonMap;
use crate::photon_pass::Chunk;
use crate::settings::{Change, Settings};

impl Ppm {
    pub(crate) fn set_progress(
        &mut self,
        passes: u64,
        photons_emitted: u64,
        last_photons: u64,
        changes: Vec<(u64, Change)>,
    ) {
        (self.passes, self.photons_emitted, self.last_photons) = (passes, photons_emitted, last_photons);
        self.changes = changes;
    }

    pub(crate) const fn settings_mut(&mut self) -> &mut Settings {
        &mut self.settings
    }

    pub(crate) const fn ledger_mut(&mut self) -> &mut Ledger {
        &mut self.ledger
    }

    pub(crate) fn lights_mut(&mut self) -> &mut [LightUse] {
        &mut self.lights
    }

    pub(crate) fn losses_mut(&mut self) -> &mut [Loss] {
        &mut self.losses
    }

    pub(crate) const fn hit_points_mut(&mut self) -> &mut HitPoints {
        &mut self.hit_points
    }

    pub(crate) const fn light_mut(&mut self) -> &mut Light {
        &mut self.light
    }

    /// Marks cells for discs as they are now.
    pub(crate) fn mark_all_cells(&mut self) {
        self.grid.mark(&self.hit_points.packets);
        self.marked_radius2 = f64::INFINITY;
    }

    pub(crate) const fn hit_points(&self) -> &HitPoints {
        &self.hit_points
    }

    /// The shape seen at the middle of each pixel.
    pub(crate) fn shapes(&self) -> &[u32] {
        &self.shapes
    }

    pub(crate) const fn light(&self) -> &Light {
        &self.light
    }

    pub(crate) fn chunks_and_grid(&mut self) -> (&mut Vec<Chunk>, &Grid) {
        (&mut self.chunks, &self.grid)
    }

    pub(crate) const fn map(&self) -> &PhotonMap {
        &self.map
    }

    pub(crate) const fn error_sums(&self) -> Option<&ErrorSums> {
        self.error.as_ref()
    }

    pub(crate) const fn error_sums_mut(&mut self) -> Option<&mut ErrorSums> {
        self.error.as_mut()
    }

    pub(crate) const fn photons_in_last_pass(&self) -> u64 {
        self.last_photons
    }
}
