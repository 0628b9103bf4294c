//! What a render will be, before it is started.

use foton_scene::Scene;

use super::Render;
use crate::feature::Feature;
use crate::memory::MemoryEstimate;
use crate::settings::{Method, RenderSettings};
use crate::{ppm, sampled};

impl Render {
    /// Its memory on so many threads.
    #[must_use]
    pub fn estimate_memory(scene: &Scene, settings: &RenderSettings, threads: usize) -> MemoryEstimate {
        match settings.method {
            Method::Ppm | Method::Sppm => ppm::memory(scene, settings, threads),
            Method::Path | Method::Whitted | Method::PhotonMap => sampled::memory(scene, settings),
        }
    }

    /// All parts that can be left out, with whether they are.
    #[must_use]
    pub fn features(scene: &Scene, settings: &RenderSettings) -> Vec<Feature> {
        match settings.method {
            Method::Ppm | Method::Sppm => ppm::features(scene, settings),
            Method::Path | Method::Whitted | Method::PhotonMap => sampled::features(settings),
        }
    }
}
