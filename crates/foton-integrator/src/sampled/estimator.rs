//! What a method does with an eye sample.

use foton_scene::Scene;
use foton_transport::{Cancel, Cancelled, Stage};

use super::sample::{EyeSample, Seen};
use crate::path::PathTracer;
use crate::settings::{Method, RenderSettings};
use crate::whitted::Whitted;

/// One variant a method.
pub(super) enum Estimator {
    Path(PathTracer),
    Whitted(Whitted),
}

impl Estimator {
    /// Makes ready for all passes; `None` for a method that does not estimate pixels by samples.
    pub(super) fn new(
        scene: &Scene,
        settings: &RenderSettings,
        _watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
    ) -> Result<Option<Self>, Cancelled> {
        cancel.check()?;
        Ok(match settings.method {
            Method::Ppm | Method::Sppm => None,
            Method::Path => Some(Self::Path(PathTracer::new(scene, settings))),
            Method::Whitted => Some(Self::Whitted(Whitted::new(scene, settings))),
        })
    }

    /// Whether it is made anew for each pass in which things are elsewhere.
    pub(super) const fn follows_motion(&self) -> bool {
        match self {
            Self::Path(_) | Self::Whitted(_) => true,
        }
    }

    /// Follows an eye sample.
    pub(super) fn follow(&self, scene: &Scene, sample: EyeSample, seen: &mut Seen) {
        match self {
            Self::Path(path) => path.follow(scene, sample, seen),
            Self::Whitted(whitted) => whitted.follow(scene, sample, seen),
        }
    }
}
