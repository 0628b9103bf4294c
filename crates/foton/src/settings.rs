//! Where settings come from: the defaults, then what a scene file suggests or a preset says, then options. `foton render`,
//! `foton measure`, the window and the render without one all build theirs here.

use std::num::NonZeroU32;

use foton_format::Suggested;
use foton_integrator::{Alpha, LayerKind, Method, PhotonMapSettings, PpmSettings, RenderSettings};
use foton_session::Preset;

use crate::args::{Guide, Radius, SettingsOptions};

/// Builds the settings of a render; what comes later counts.
pub(crate) struct SettingsBuilder(RenderSettings);

impl SettingsBuilder {
    /// The defaults with what the scene suggests.
    pub(crate) fn of_scene(suggested: &Suggested) -> Self {
        let defaults = RenderSettings::default();
        let photons = suggested.photons_per_pass.and_then(NonZeroU32::new);
        Self(RenderSettings {
            ppm: PpmSettings {
                alpha: suggested.alpha.and_then(Alpha::new).unwrap_or(defaults.ppm.alpha),
                photons_per_pass: photons.unwrap_or(defaults.ppm.photons_per_pass),
                radius: suggested.radius,
                ..defaults.ppm
            },
            ..defaults
        })
    }

    /// What a preset says, in place of what the scene suggests: whoever names one wants that.
    pub(crate) fn preset(self, preset: Option<Preset>) -> Self {
        preset.map_or(self, |preset| Self(preset.apply(RenderSettings::default())))
    }

    /// By this method.
    pub(crate) fn method(mut self, method: Method) -> Self {
        self.0.method = method;
        self.0.samples_per_pixel = method.default_samples();
        self
    }

    /// What options say.
    pub(crate) fn options(mut self, options: &SettingsOptions) -> Self {
        let settings = &mut self.0;
        settings.samples_per_pixel = options.spp.unwrap_or(settings.method.default_samples());
        settings.max_depth = options.max_depth;
        settings.seed = options.seed;
        settings.photon_seed = options.photon_seed;
        let ppm = &mut settings.ppm;
        ppm.alpha = options.alpha.unwrap_or(ppm.alpha);
        ppm.photons_per_pass = options.photons.unwrap_or(ppm.photons_per_pass);
        (ppm.radius, ppm.radius_scale) = Radius::split(options.radius, ppm.radius, ppm.radius_scale);
        ppm.radius_floor = options.radius_floor;
        ppm.radius_rule = options.radius_rule.into();
        ppm.direct_light = options.direct.into();
        ppm.guided = options.guide == Guide::Auto;
        self
    }

    /// What options of two-pass photon mapping say.
    pub(crate) fn photon_map(mut self, photon_map: PhotonMapSettings) -> Self {
        self.0.photon_map = photon_map;
        self
    }

    /// The index of the sensor.
    pub(crate) fn sensor(mut self, sensor: usize) -> Self {
        self.0.sensor = sensor;
        self
    }

    /// Whether the error is estimated.
    pub(crate) fn error(mut self, is_estimated: bool) -> Self {
        self.0.error = is_estimated;
        self
    }

    /// Estimates what these layers need.
    pub(crate) fn layers(mut self, layers: &[LayerKind]) -> Self {
        self.0.layers = layers.iter().any(|layer| layer.needs_classes());
        self.0.error |= layers.iter().any(|layer| layer.needs_error());
        self
    }

    /// The settings.
    pub(crate) fn build(self) -> RenderSettings {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_preset_stands_for_what_the_scene_suggests() {
        let suggested =
            Suggested { alpha: Some(0.25), photons_per_pass: Some(5000), radius: Some(3.0), passes: Some(7) };
        let of_scene = SettingsBuilder::of_scene(&suggested).preset(None).build().ppm;
        assert_eq!(
            (of_scene.alpha.get(), of_scene.photons_per_pass.get(), of_scene.radius),
            (0.25, 5000, Some(3.0))
        );
        let defaults = RenderSettings::default();
        let preset = |preset| SettingsBuilder::of_scene(&suggested).preset(Some(preset)).build();
        assert_eq!(preset(Preset::Balanced), defaults);
        assert_eq!(SettingsBuilder::of_scene(&Suggested::default()).build(), defaults);
    }
}
