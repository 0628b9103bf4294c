//! The maps: what is kept of all photons, whatever camera will look.

use foton_math::Rgb;
use foton_scene::Scene;
use foton_transport::kd_tree::{Estimate, KdTree, KernelFilter, MapClass, Nearest};
use foton_transport::{Ledger, LeftOut, LightUse, Loss};

use super::directions::Directions;
use super::place::Place;

/// Normals of irradiance that is taken for that of another place differ by less than 45°.
const SAME_NORMAL: f32 = 0.7;

/// How far photons are looked for, squared, and what is near.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Reach {
    pub(super) global2: f32,
    pub(super) caustic2: f32,
    pub(super) lit2: f32,
    /// Half of the discs for which irradiance was computed are larger.
    pub(super) irradiance_disc: f32,
}

/// What became of the photons of the global map, and what they cost.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Account {
    pub(super) ledger: Ledger,
    pub(super) lights: Vec<LightUse>,
    pub(super) losses: Vec<Loss>,
    /// Photons emitted for the global map, and for that of caustics.
    pub(super) emitted: [u64; 2],
    pub(super) rays: u64,
    pub(super) left_out: Option<LeftOut>,
}

/// All maps of a scene.
#[derive(Clone, Debug, Default)]
pub(super) struct Maps {
    /// Photons of all classes wherever light spreads.
    pub(super) global: KdTree,
    /// Light by specular lobes alone, from many more photons.
    pub(super) caustic: KdTree,
    /// Irradiance at some photons of the global map, kept like photons: as power, with the normal as direction. `[CHR99]`
    pub(super) irradiance: KdTree,
    /// Where indirect light comes from there.
    pub(super) directions: Vec<Directions>,
    /// First surfaces that light meets, and those in their shadow; the power is the emitter's index. Empty unless asked for.
    pub(super) lit: KdTree,
    pub(super) reach: Reach,
    /// The longest path in edges.
    pub(super) max_depth: u32,
    /// Photons whose disc made an irradiance.
    pub(super) neighbours: u32,
    pub(super) account: Account,
}

/// What it takes to look light up.
pub(super) struct LookUp<'a> {
    pub(super) maps: &'a Maps,
    pub(super) scene: &'a Scene,
    pub(super) neighbours: usize,
}

impl Maps {
    /// The irradiance that is kept nearest to a place, and the directions that indirect light comes from there; `None` too far from any.
    pub(super) fn kept(&self, at: &Place) -> Option<(Rgb, &Directions)> {
        let limit2 = self.reach.global2;
        let found = self.irradiance.nearest_one(at.position, limit2, |photon, offset| {
            at.counts(photon, offset) && photon.direction().dot(at.normal) > SAME_NORMAL
        })?;
        let index = found.index as usize;
        Some((self.irradiance.nodes()[index].light(), self.directions.get(index)?))
    }

    /// Bytes held.
    pub(super) const fn bytes(&self) -> usize {
        self.global.bytes()
            + self.caustic.bytes()
            + self.irradiance.bytes()
            + self.lit.bytes()
            + self.directions.capacity() * Directions::BYTES
    }
}

impl LookUp<'_> {
    /// Power per area at a place by the photons of some classes, each weighed by `weight`. The disc is not clipped.
    pub(super) fn global(
        &self,
        at: &Place,
        nearest: &mut Nearest,
        is_wanted: impl Fn(MapClass) -> bool,
        weight: impl Fn(foton_math::glam::Vec3) -> Rgb,
    ) -> Estimate {
        let (tree, limit2) = (&self.maps.global, self.maps.reach.global2);
        tree.nearest(at.position, limit2, self.neighbours, nearest, |photon, offset| {
            at.counts(photon, offset) && is_wanted(photon.class())
        });
        Self::estimate(tree, nearest, limit2, KernelFilter::Box, weight)
    }

    /// The same by those of caustics.
    pub(super) fn caustic(
        &self,
        at: &Place,
        nearest: &mut Nearest,
        filter: KernelFilter,
        weight: impl Fn(foton_math::glam::Vec3) -> Rgb,
    ) -> Estimate {
        let (tree, limit2) = (&self.maps.caustic, self.maps.reach.caustic2);
        tree.nearest(at.position, limit2, self.neighbours, nearest, |photon, offset| {
            at.counts(photon, offset)
        });
        Self::estimate(tree, nearest, limit2, filter, weight)
    }

    fn estimate(
        tree: &KdTree,
        nearest: &Nearest,
        limit2: f32,
        filter: KernelFilter,
        weight: impl Fn(foton_math::glam::Vec3) -> Rgb,
    ) -> Estimate {
        Estimate::of(nearest, limit2, filter, |found| {
            let photon = &tree.nodes()[found.index as usize];
            photon.light() * weight(photon.direction())
        })
    }
}
