//! Where settings come from: what a scene file suggests and a preset says, over the defaults. `foton render`, `foton measure`, the window
//! and the render without one all begin here; options and controls come on top.

use std::num::NonZeroU32;

use foton_format::Suggested;
use foton_integrator::{Alpha, PpmSettings, RenderSettings};
use foton_session::Preset;

/// The defaults with what the scene suggests, or with what a preset says: whoever names one wants that and not the scene's.
pub(crate) fn base(suggested: &Suggested, preset: Option<Preset>) -> RenderSettings {
    let defaults = RenderSettings::default();
    if let Some(preset) = preset {
        return preset.apply(defaults);
    }
    let photons = suggested.photons_per_pass.and_then(NonZeroU32::new);
    RenderSettings {
        ppm: PpmSettings {
            alpha: suggested.alpha.and_then(Alpha::new).unwrap_or(defaults.ppm.alpha),
            photons_per_pass: photons.unwrap_or(defaults.ppm.photons_per_pass),
            radius: suggested.radius,
            ..defaults.ppm
        },
        ..defaults
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_preset_stands_for_what_the_scene_suggests() {
        let suggested =
            Suggested { alpha: Some(0.25), photons_per_pass: Some(5000), radius: Some(3.0), passes: Some(7) };
        let of_scene = base(&suggested, None).ppm;
        assert_eq!(
            (of_scene.alpha.get(), of_scene.photons_per_pass.get(), of_scene.radius),
            (0.25, 5000, Some(3.0))
        );
        let defaults = RenderSettings::default();
        assert_eq!(base(&suggested, Some(Preset::Balanced)), defaults);
        assert_eq!(base(&Suggested::default(), None), defaults);
    }
}
