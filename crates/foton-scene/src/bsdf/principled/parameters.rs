//! Parameters that both principled models have.

use crate::parameter::{Parameter, Role};

/// The numbers between which most parameters lie.
pub(super) const UNIT: [f32; 2] = [0.0, 1.0];
/// Those of parameters that are factors on a lobe.
pub(super) const FACTOR: [f32; 2] = [0.0, 100.0];

const fn unit(name: &'static str, default: f64) -> Parameter {
    Parameter::number(name, default, (0.0, 1.0)).textured()
}

const fn factor(name: &'static str) -> Parameter {
    Parameter::number(name, 0.0, (0.0, 100.0)).textured().slider(0.0, 1.0, false)
}

pub(super) const BASE_COLOR: Parameter = Parameter::share("base_color", 0.5)
    .label("Base colour")
    .help("The colour of the diffuse base, of the metal, and of what passes through.")
    .role(Role::BaseColour);

pub(super) const ROUGHNESS: Parameter = unit("roughness", 0.5)
    .label("Roughness")
    .help("Width of highlights: the square root of the microfacets' α.")
    .role(Role::RootRoughness);

pub(super) const ANISOTROPIC: Parameter = unit("anisotropic", 0.0)
    .label("Anisotropy")
    .help("How much longer highlights are along the texture's u than along v.")
    .advanced();

pub(super) const METALLIC: Parameter = unit("metallic", 0.0)
    .label("Metallic")
    .help("0 is a dielectric with a diffuse base, 1 a metal that reflects the base colour.");

pub(super) const SPEC_TRANS: Parameter = unit("spec_trans", 0.0)
    .label("Transmission")
    .help("Share of the base that is clear and refracts light rather than diffuse.");

pub(super) const SPEC_TINT: Parameter = unit("spec_tint", 0.0)
    .label("Specular tint")
    .help("How far the highlight of a dielectric takes on the base colour.")
    .advanced();

pub(super) const SHEEN: Parameter =
    factor("sheen").label("Sheen").help("Light that cloth scatters at grazing angles.").advanced();

pub(super) const SHEEN_TINT: Parameter = unit("sheen_tint", 0.0)
    .label("Sheen tint")
    .help("How far the sheen takes on the base colour.")
    .advanced();

pub(super) const FLATNESS: Parameter = unit("flatness", 0.0)
    .label("Flatness")
    .help("How far the diffuse base looks like one that light enters a little way, such as skin.")
    .advanced();

pub(super) const CLEARCOAT: Parameter = factor("clearcoat")
    .label("Clear coat")
    .help("Strength of a second, colourless highlight, as of varnish. Eye paths follow it.");

pub(super) const CLEARCOAT_GLOSS: Parameter = unit("clearcoat_gloss", 0.0)
    .label("Coat gloss")
    .help("Sharpness of the clear coat's highlight: α is 0.1 at 0 and 0.001 at 1.")
    .advanced();

pub(super) const DIFF_TRANS: Parameter = Parameter::number("diff_trans", 0.0, (0.0, 2.0))
    .textured()
    .label("Diffuse transmission")
    .help("How much of the diffuse light passes to the other side: 1 is half of it, 2 is all.");

/// Parameters that steer Mitsuba's sampling alone.
pub(super) const fn rate(name: &'static str) -> Parameter {
    Parameter::ignored(name, "Lobes are sampled in proportion to what they reflect.")
}
