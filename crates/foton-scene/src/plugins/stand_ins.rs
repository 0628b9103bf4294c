//! BSDFs and subsurface models of scene files that are not modelled, with what stands in for each.

/// A plugin that is not modelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StandIn {
    /// Its name in files.
    pub name: &'static str,
    /// The plugin that is rendered instead. `None`: a scene that has it is refused.
    pub instead: Option<&'static str>,
    /// What is different about the picture, or why there is none.
    pub help: &'static str,
}

const fn instead(name: &'static str, instead: &'static str, help: &'static str) -> StandIn {
    StandIn { name, instead: Some(instead), help }
}

const fn refused(name: &'static str, help: &'static str) -> StandIn {
    StandIn { name, instead: None, help }
}

/// All of them.
pub const ALL: &[StandIn] = &[
    instead(
        "pplastic",
        "roughplastic",
        "its polarisation is left out, and its base is up to a sixth darker at grazing angles",
    ),
    instead(
        "polarizer",
        "thindielectric",
        "light is unpolarised, so it is a grey filter of half its transmittance, also behind another one",
    ),
    instead(
        "circular",
        "thindielectric",
        "light is unpolarised, so it is a grey filter of half its transmittance, also behind another one",
    ),
    instead("retarder", "thindielectric", "light is unpolarised, so only its transmittance is left"),
    instead(
        "hair",
        "roughplastic",
        "its colour and roughness are kept, but not the highlights along its fibres",
    ),
    instead(
        "irawan",
        "diffuse",
        "the mean of the colours that it states is kept, but neither the weave nor its highlights",
    ),
    instead(
        "hk",
        "principledthin",
        "a sheet of its albedo that passes half of the light stands in for single scattering",
    ),
    instead(
        "sssbrdf",
        "plastic",
        "light leaves where it enters, with the colour that much scattering gives it",
    ),
    instead(
        "dipole",
        "plastic",
        "light leaves where it enters, with the colour that much scattering gives it",
    ),
    instead(
        "singlescatter",
        "plastic",
        "light leaves where it enters, with the colour that much scattering gives it",
    ),
    refused(
        "measured",
        "measured reflectances are not read: a principled or roughconductor of the same look can take its place",
    ),
    refused(
        "measured_polarized",
        "measured reflectances are not read: a principled or roughconductor of the same look can take its place",
    ),
];

/// The plugin of a name.
#[must_use]
pub fn find(name: &str) -> Option<&'static StandIn> {
    ALL.iter().find(|s| s.name == name)
}
