//! What a method does with an eye sample.

use foton_scene::Scene;
use foton_transport::{Cancel, Cancelled, Ledger, LeftOut, LightUse, Loss, Stage};

use super::sample::{EyeSample, Seen};
use crate::path::PathTracer;
use crate::photon_map::{KeptMaps, PhotonMapper};
use crate::settings::{Method, RenderSettings};
use crate::whitted::Whitted;

/// One variant a method.
pub(super) enum Estimator {
    Path(PathTracer),
    Whitted(Whitted),
    PhotonMap(Box<PhotonMapper>),
}

impl Estimator {
    /// Makes ready for all passes, with maps of photons if some are given; `None` for a method that does not estimate pixels by samples.
    pub(super) fn new(
        scene: &Scene,
        settings: &RenderSettings,
        maps: Option<&KeptMaps>,
        watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
    ) -> Result<Option<Self>, Cancelled> {
        cancel.check()?;
        Ok(match settings.method {
            Method::Ppm | Method::Sppm => None,
            Method::Path => Some(Self::Path(PathTracer::new(scene, settings))),
            Method::Whitted => Some(Self::Whitted(Whitted::new(scene, settings))),
            Method::PhotonMap => {
                let mapper = PhotonMapper::new(scene, settings, maps, watch, cancel)?;
                Some(Self::PhotonMap(Box::new(mapper)))
            }
        })
    }

    /// Whether it is made anew for each pass in which things are elsewhere.
    pub(super) const fn follows_motion(&self) -> bool {
        match self {
            Self::Path(_) | Self::Whitted(_) => true,
            // Photons that stay have seen everything at one time.
            Self::PhotonMap(_) => false,
        }
    }

    /// Follows an eye sample.
    pub(super) fn follow(&self, scene: &Scene, sample: EyeSample, seen: &mut Seen) {
        match self {
            Self::Path(path) => path.follow(scene, sample, seen),
            Self::Whitted(whitted) => whitted.follow(scene, sample, seen),
            Self::PhotonMap(mapper) => mapper.follow(scene, sample, seen),
        }
    }

    /// Photon mapping, if it is that.
    pub(super) const fn mapper(&self) -> Option<&PhotonMapper> {
        match self {
            Self::PhotonMap(mapper) => Some(mapper),
            Self::Path(_) | Self::Whitted(_) => None,
        }
    }

    /// Where the power of photons went.
    pub(super) fn ledger(&self) -> Ledger {
        self.mapper().map_or_else(Ledger::default, |mapper| *mapper.ledger())
    }

    /// The first photon whose power was no number.
    pub(super) fn left_out(&self) -> Option<LeftOut> {
        self.mapper().and_then(PhotonMapper::left_out)
    }

    pub(super) fn light_use(&self) -> &[LightUse] {
        self.mapper().map_or(&[], PhotonMapper::light_use)
    }

    pub(super) fn material_losses(&self) -> &[Loss] {
        self.mapper().map_or(&[], PhotonMapper::material_losses)
    }
}
