//! Single photons once more, with the places where they turn: for a person to look at. Not on the way of a pass.

use std::ops::Range;

use foton_math::glam::Vec3;

use super::draws::Draws;
use super::pass::{Path, PhotonPass};
use crate::ledger::Loss;
use crate::light_use::LightUse;
use crate::photon_map::{Chunk, Photon};

/// A photon that was stored, and the way that it came.
#[derive(Clone, Debug)]
pub struct Way {
    /// Where it was emitted, where it was scattered, and where it was stored.
    pub points: Vec<Vec3>,
    /// The photon.
    pub photon: Photon,
}

impl PhotonPass<'_> {
    /// The ways of photons of the batch to places where they are stored and `counts` says yes: the same photons that
    /// [`PhotonPass::shoot`] traces, by their numbers in the batch.
    #[must_use]
    pub fn ways(&self, range: Range<u64>, counts: &dyn Fn(&Photon) -> bool) -> Vec<Way> {
        let mut found = Vec::new();
        let mut chunk = Chunk::default();
        chunk.lights.resize(self.scene.emitters().len(), LightUse::default());
        chunk.losses.resize(self.scene.materials().len(), Loss::default());
        let (mut draws, mut paths, mut next) = (Draws::default(), Vec::new(), Vec::new());
        for index in self.batch.indices(range) {
            paths.clear();
            self.start(index, &mut chunk, &mut paths);
            let mut points: Vec<Vec3> = paths.iter().map(|path: &Path| path.ray.origin).collect();
            while let Some(path) = paths.first() {
                chunk.photons.clear();
                chunk.cells.clear();
                let hit = self.scene.nearest_hit(path.ray);
                draws.draw(&paths);
                self.go_on(path, hit.as_ref(), draws.of(0), &mut chunk, &mut next);
                if let Some(hit) = &hit {
                    points.push(self.scene.surface(&path.ray, hit).position);
                }
                let stored = chunk.photons.last().filter(|photon| counts(photon));
                found.extend(stored.map(|photon| Way { points: points.clone(), photon: *photon }));
                paths.clear();
                paths.append(&mut next);
            }
        }
        found
    }
}
