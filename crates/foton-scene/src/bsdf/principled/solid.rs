//! The principled surface of a closed body.

use foton_math::Rgb;

use super::clear_coat::WIDEST;
use super::parameters::{
    ANISOTROPIC, BASE_COLOR, CLEARCOAT, CLEARCOAT_GLOSS, FACTOR, FLATNESS, METALLIC, ROUGHNESS, SHEEN,
    SHEEN_TINT, SPEC_TINT, SPEC_TRANS, UNIT, rate,
};
use super::shading::alphas;
use crate::bsdf::flags::LobeFlags;
use crate::bsdf::info::{BsdfInfo, Described};
use crate::description::{Amount, Colour, Number};
use crate::parameter::{Binding, Parameter, Role, Slot};

/// A surface between a dielectric with a diffuse base, clear glass and a metal, under a clear coat.
///
/// Its lobes are a diffuse base with sheen; the main highlight, of facets that reflect and where the base is clear, refract; and the
/// coat's highlight. The coat is always narrower than α = 0.1, so eye paths follow it. Where there is a coat over a main highlight that
/// is wider, that highlight therefore counts as diffuse: one set of lobes is gathered and the other followed, by methods that
/// divide glossy lobes by their width. A clear base is followed as all rough glass is, whatever its width.
///
/// The model makes energy: its diffuse base does not lose what the highlight reflects. White and dull, it reflects up to 1.6 times
/// what arrives at grazing angles, and 1.04 times at normal incidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Principled<C = Colour, N = Number> {
    /// Colour of the diffuse base and of the metal; what passes through takes on its square root.
    pub base_color: C,
    /// The square root of the facets' α.
    pub roughness: N,
    /// How much the facets are stretched along u.
    pub anisotropic: N,
    /// From a dielectric, 0, to a metal, 1.
    pub metallic: N,
    /// Share of the base that is clear.
    pub spec_trans: N,
    /// Index of refraction, relative to the outside.
    pub eta: f32,
    /// How far the dielectric's highlight is tinted.
    pub spec_tint: N,
    /// Strength of the sheen.
    pub sheen: N,
    /// How far it is tinted.
    pub sheen_tint: N,
    /// How far the diffuse base looks like one that light enters.
    pub flatness: N,
    /// Strength of the clear coat.
    pub clearcoat: N,
    /// How sharp its highlight is.
    pub clearcoat_gloss: N,
}

const ETA: &[Parameter] = &[
    Parameter::refraction("eta", 1.5)
        .label("Index of refraction")
        .help("Of the inside, relative to the outside. Larger reflects more.")
        .excludes(&["specular"])
        .role(Role::InsideIor),
    Parameter::number("specular", 0.5, (0.0, 12.0))
        .help("States the index by what is reflected at normal incidence: 0.08 times this.")
        .excludes(&["eta"]),
    rate("main_specular_sampling_rate"),
    rate("clearcoat_sampling_rate"),
    rate("diffuse_reflectance_sampling_rate"),
];

/// The index of refraction that a `specular` stands for: what is reflected at normal incidence is 0.08 times that. `[BUR12]`
#[must_use]
pub fn index_of_specular(specular: f32) -> f32 {
    2.0 / (1.0 - (0.08 * specular).sqrt()) - 1.0
}

impl Described for Principled {
    const INFO: BsdfInfo = BsdfInfo {
        label: "Principled",
        help: "Disney's model of many materials: dielectrics, metals, glass, cloth, varnish.",
        plugin: "principled",
        rough_plugin: None,
        stated: None,
        is_of_mitsuba_3: true,
    };

    fn default(_: bool) -> Self {
        let number = |p: Parameter| Number::Constant(p.default_number());
        Self {
            base_color: BASE_COLOR.default_colour(),
            roughness: number(ROUGHNESS),
            anisotropic: number(ANISOTROPIC),
            metallic: number(METALLIC),
            spec_trans: number(SPEC_TRANS),
            eta: ETA[0].default_number(),
            spec_tint: number(SPEC_TINT),
            sheen: number(SHEEN),
            sheen_tint: number(SHEEN_TINT),
            flatness: number(FLATNESS),
            clearcoat: number(CLEARCOAT),
            clearcoat_gloss: number(CLEARCOAT_GLOSS),
        }
    }

    fn preset() -> Self {
        Self { base_color: Rgb::splat(0.8).into(), ..Described::default(false) }
    }

    fn parameters(&mut self) -> Vec<Binding<'_>> {
        vec![
            Binding::new(&[BASE_COLOR], Slot::Share(&mut self.base_color)),
            Binding::new(&[ROUGHNESS], Slot::Number(&mut self.roughness)),
            Binding::new(&[METALLIC], Slot::Number(&mut self.metallic)),
            Binding::new(&[SPEC_TRANS], Slot::Number(&mut self.spec_trans)),
            Binding::new(ETA, Slot::Reflectivity(&mut self.eta)),
            Binding::new(&[CLEARCOAT], Slot::Number(&mut self.clearcoat)),
            Binding::new(&[CLEARCOAT_GLOSS], Slot::Number(&mut self.clearcoat_gloss)),
            Binding::new(&[SHEEN], Slot::Number(&mut self.sheen)),
            Binding::new(&[SHEEN_TINT], Slot::Number(&mut self.sheen_tint)),
            Binding::new(&[SPEC_TINT], Slot::Number(&mut self.spec_tint)),
            Binding::new(&[ANISOTROPIC], Slot::Number(&mut self.anisotropic)),
            Binding::new(&[FLATNESS], Slot::Number(&mut self.flatness)),
        ]
    }
}

impl<C: Copy, N: Amount> Principled<C, N> {
    #[inline(always)]
    pub(in crate::bsdf) fn map<D, M>(
        &self,
        mut colours: impl FnMut(C) -> D,
        mut numbers: impl FnMut(N, [f32; 2]) -> M,
    ) -> Principled<D, M> {
        Principled {
            base_color: colours(self.base_color),
            roughness: numbers(self.roughness, UNIT),
            anisotropic: numbers(self.anisotropic, UNIT),
            metallic: numbers(self.metallic, UNIT),
            spec_trans: numbers(self.spec_trans, UNIT),
            eta: self.eta,
            spec_tint: numbers(self.spec_tint, UNIT),
            sheen: numbers(self.sheen, FACTOR),
            sheen_tint: numbers(self.sheen_tint, UNIT),
            flatness: numbers(self.flatness, UNIT),
            clearcoat: numbers(self.clearcoat, FACTOR),
            clearcoat_gloss: numbers(self.clearcoat_gloss, UNIT),
        }
    }

    /// The lobes that it has; in a description, those that it may have anywhere.
    pub(in crate::bsdf) fn flags(&self) -> LobeFlags {
        let is_metal = self.metallic.least() >= 1.0;
        let has_base = !is_metal && (self.spec_trans.least() < 1.0 || self.sheen.most() > 0.0);
        let mut flags = LobeFlags::GLOSSY | LobeFlags::REFLECTION;
        if has_base || self.main_is_gathered() {
            flags = flags | LobeFlags::DIFFUSE;
        }
        if !is_metal && self.spec_trans.most() > 0.0 {
            flags = flags | LobeFlags::TRANSMISSION;
        }
        flags
    }

    /// Whether the main highlight counts as diffuse, being wider than the coat over it. In a description, whether it may anywhere.
    pub(super) fn main_is_gathered(&self) -> bool {
        let [alpha, _] = alphas(self.roughness.most(), self.anisotropic.most());
        self.clearcoat.most() > 0.0 && self.spec_trans.least() == 0.0 && alpha > WIDEST
    }
}
