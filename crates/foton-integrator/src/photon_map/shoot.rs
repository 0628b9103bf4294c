//! Photons for a map: emitted pass by pass until enough are stored.

use foton_math::{Cancel, Cancelled};
use foton_scene::{Scene, Sources};
use foton_transport::guide::Cells;
use foton_transport::light_paths::{Batch, MAX_PHOTONS, PhotonPass};
use foton_transport::photon_map::{CHUNK, Chunk, Grid, Photon};
use foton_transport::{Halt, Ledger, LeftOut, LightUse, Loss};
use pulp::Arch;

use crate::ppm::LOBE_POLICY;

/// A map is shot in about so many passes: what is stored beyond what is wanted is a small part of it.
const PASSES: u64 = 16;

/// Emission stops after so many photons for each one that is wanted, and so many besides: hardly any finds its way.
const MAX_EMITTED: (u64, u64) = (64, 1 << 20);

/// Which photons are wanted, and from where.
pub(super) struct Wanted<'a> {
    pub(super) scene: &'a Scene,
    pub(super) sources: &'a Sources,
    /// Where they start.
    pub(super) cells: &'a Cells,
    /// Whether only those of caustics are stored.
    pub(super) caustics: bool,
    /// How many.
    pub(super) photons: u64,
    pub(super) max_depth: u32,
    pub(super) seed: u64,
}

/// Photons of a map and what was counted on their way.
#[derive(Default)]
pub(super) struct Shot {
    pub(super) photons: Vec<Photon>,
    /// Photons emitted.
    pub(super) emitted: u64,
    pub(super) rays: u64,
    pub(super) ledger: Ledger,
    pub(super) lights: Vec<LightUse>,
    pub(super) losses: Vec<Loss>,
    pub(super) left_out: Option<LeftOut>,
}

impl Wanted<'_> {
    /// Emits photons until as many as are wanted are stored, or so few are that there is no end. Which they are does not depend on
    /// threads.
    ///
    /// # Errors
    /// When cancelled.
    pub(super) fn shoot(&self, cancel: &Cancel) -> Result<Shot, Cancelled> {
        let mut shot = Shot {
            lights: vec![LightUse::default(); self.scene.emitters().len()],
            losses: vec![Loss::default(); self.scene.materials().len()],
            ..Shot::default()
        };
        if self.cells.is_empty() || self.max_depth < 2 {
            return Ok(shot);
        }
        let most = MAX_EMITTED.0 * self.photons + MAX_EMITTED.1;
        let per_pass = (self.photons / PASSES).next_multiple_of(CHUNK).clamp(CHUNK, MAX_PHOTONS);
        let (grid, mut chunks, mut pass) = (Grid::everywhere(), Vec::new(), 0);
        while (shot.photons.len() as u64) < self.photons && shot.emitted < most {
            self.shoot_pass(&grid, (pass, per_pass), &mut chunks, cancel)?;
            pass += 1;
            shot.emitted += per_pass;
            chunks.iter().for_each(|chunk| shot.add(chunk));
        }
        Ok(shot)
    }

    fn shoot_pass(
        &self,
        grid: &Grid,
        (pass, photons): (u64, u64),
        chunks: &mut Vec<Chunk>,
        cancel: &Cancel,
    ) -> Result<(), Cancelled> {
        for batch in Batch::all(photons, photons) {
            let photon_pass = PhotonPass {
                scene: self.scene,
                sources: self.sources,
                cells: self.cells,
                training: None,
                grid,
                stores_direct: !self.caustics,
                ends_where_light_spreads: self.caustics,
                policy: LOBE_POLICY,
                directions: true,
                arch: Arch::new(),
                max_depth: self.max_depth,
                seed: self.seed,
                // Numbers of their own for each map.
                pass: pass | u64::from(self.caustics) << 32,
                photons,
                batch,
            };
            photon_pass.begin(chunks);
            // It is never suspended, and leaves out what is not finite.
            if let Err(Halt::Cancelled(cancelled)) = photon_pass.shoot(chunks, cancel, &|| false) {
                return Err(cancelled);
            }
        }
        Ok(())
    }
}

impl Shot {
    fn add(&mut self, chunk: &Chunk) {
        self.photons.extend_from_slice(&chunk.photons);
        self.rays += chunk.rays;
        self.ledger += chunk.ledger;
        self.lights.iter_mut().zip(&chunk.lights).for_each(|(sum, light)| *sum += *light);
        self.losses.iter_mut().zip(&chunk.losses).for_each(|(sum, loss)| *sum += *loss);
        self.left_out = self.left_out.or(chunk.left_out);
    }
}
