//! Which method suits a scene. docs/methods.md has the measurements that the rule rests on.

use foton_scene::Scene;

use crate::ppm::lobe_use;
use crate::settings::Method;

impl Method {
    /// The method that suits what a sensor sees of a scene, and why.
    #[must_use]
    pub fn chosen_for(scene: &Scene, sensor: usize) -> (Self, &'static str) {
        let lobes = lobe_use(scene);
        if scene.sensors()[sensor].has_lens() {
            (Self::Sppm, "the camera has a lens, whose blur eye samples that stand still leave noisy")
        } else if scene.blurs(sensor) {
            (Self::Sppm, "something moves while the shutter is open")
        } else if lobes.specular_gloss {
            (Self::Sppm, "eye paths follow narrow gloss, which eye samples that stand still leave noisy")
        } else if lobes.specular {
            (Self::Sppm, "mirrors or glass show fine detail, which eye samples that stand still leave jagged")
        } else {
            (Self::Ppm, "all surfaces spread light, so that hit points can stay")
        }
    }
}
