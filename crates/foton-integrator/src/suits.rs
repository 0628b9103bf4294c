//! Which method suits a scene, and which can tell its error there. docs/methods.md has the measurements that the rule rests on.

use foton_scene::Scene;

use crate::ppm::lobe_use;
use crate::settings::Method;

impl Method {
    /// The method that suits what a sensor sees of a scene, and why: where a render goes on for minutes it is the same everywhere.
    #[must_use]
    pub fn chosen_for(scene: &Scene, sensor: usize) -> (Self, &'static str) {
        let lobes = lobe_use(scene);
        let why = if scene.sensors()[sensor].has_lens() {
            "the camera has a lens, whose blur eye samples that stand still leave noisy"
        } else if scene.blurs(sensor) {
            "something moves while the shutter is open"
        } else if lobes.specular_gloss {
            "eye paths follow narrow gloss, which eye samples that stand still leave noisy"
        } else if lobes.specular {
            "mirrors or glass show fine detail, which eye samples that stand still leave jagged"
        } else {
            "edges converge with new eye samples, which cost little beside photons"
        };
        (Self::Sppm, why)
    }

    /// Why nobody can tell how wrong its image of a scene still is; `None` where the error is estimated. A small figure beside light that is
    /// missing would be worse than none.
    #[must_use]
    pub fn error_is_unknown(self, scene: &Scene) -> Option<&'static str> {
        let census = scene.census();
        match self {
            Self::Ppm | Self::Sppm => None,
            Self::Path if census.delta_emitters && census.bends_light() => Some("it misses light"),
            Self::Path => None,
            Self::Whitted => Some("it leaves caustics and indirect light out"),
            Self::PhotonMap => Some("the bias of its maps is not known"),
        }
    }
}
