//! Which lobes progressive photon mapping follows from the eye, and for which its hit points gather photons.

use foton_scene::Scene;
use foton_transport::{LobePolicy, LobeUse};

/// A glossy lobe below this roughness is narrower than about 6°: a hit point would weight a few photons very much and most not at
/// all.
pub(crate) const LOBE_POLICY: LobePolicy = LobePolicy { max_specular_roughness: 0.1 };

/// What eye paths and hit points meet in a scene.
#[must_use]
pub fn lobe_use(scene: &Scene) -> LobeUse {
    LobeUse::of(scene.census(), &LOBE_POLICY)
}
