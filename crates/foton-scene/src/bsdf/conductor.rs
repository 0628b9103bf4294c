//! A metal, smooth or rough.

use foton_math::Rgb;
use foton_math::glam::{Vec2, Vec3};

use super::flags::LobeFlags;
use super::fresnel;
use super::info::{BsdfInfo, Described};
use super::lobe_sample::{LobeSample, LobeSamples, Transport};
use super::microfacet::{Microfacets, ROUGHNESS};
use super::model::Model;
use super::reflect::{facet_pdf, mirrored, reflect_by_facet, same_side, upward};
use crate::description::{Colour, Number};
use crate::metals::METALS;
use crate::parameter::{Binding, Kind, Parameter, Slot};

/// A metal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor<C = Colour, N = Number> {
    /// Real part of the index of refraction per channel, relative to the outside.
    pub eta: Rgb,
    /// Imaginary part per channel.
    pub k: Rgb,
    /// Factor on reflected light, physically 1.
    pub specular_reflectance: C,
    /// `None`: smooth.
    pub roughness: Option<Microfacets<N>>,
}

/// The metal that a surface becomes in the window.
const PRESET: &str = "Au";

/// The complex index of refraction, or what stands for it.
const METAL: &[Parameter] = &[
    Parameter::colour("eta", 0.0)
        .label("eta")
        .help("Real part of the index of refraction.")
        .slider(0.0, 12.0, false),
    Parameter::colour("k", 1.0)
        .label("k")
        .help("Imaginary part of the index of refraction: larger reflects more.")
        .slider(0.0, 12.0, false),
    Parameter::other("material", Kind::Metal, "none")
        .label("Metal")
        .help("Measured indices of refraction by name.")
        .excludes(&["eta", "k"]),
    Parameter::refraction("ext_eta", 1.0)
        .help("Index of refraction outside, by which eta and k are divided."),
];

const SPECULAR_REFLECTANCE: Parameter = Parameter::share("specular_reflectance", 1.0)
    .label("Tint")
    .help("Factor on reflected light; white is physical.");

impl Described for Conductor {
    const INFO: BsdfInfo = BsdfInfo {
        label: "Conductor",
        help: "A metal. Smooth, and without eta, k and material, it is a perfect mirror.",
        plugin: "conductor",
        rough_plugin: Some("roughconductor"),
        stated: None,
        is_of_mitsuba_3: true,
    };

    fn default(rough: bool) -> Self {
        Self {
            eta: Rgb::splat(METAL[0].default_number()),
            k: Rgb::splat(METAL[1].default_number()),
            specular_reflectance: SPECULAR_REFLECTANCE.default_colour(),
            roughness: rough.then_some(Microfacets::DEFAULT),
        }
    }

    fn preset() -> Self {
        let metal = METALS.iter().find(|m| m.0 == PRESET);
        let (eta, k) = metal.map_or(([0.2; 3], [3.0; 3]), |m| (m.1, m.2));
        Self { eta: Rgb::from_array(eta), k: Rgb::from_array(k), ..Described::default(false) }
    }

    fn parameters(&mut self) -> Vec<Binding<'_>> {
        vec![
            Binding::new(METAL, Slot::Metal { eta: &mut self.eta, k: &mut self.k }),
            Binding::new(&[SPECULAR_REFLECTANCE], Slot::Share(&mut self.specular_reflectance)),
            Binding::new(ROUGHNESS, Slot::Roughness(&mut self.roughness)),
        ]
    }
}

impl<C: Copy, N: Copy> Conductor<C, N> {
    #[inline(always)]
    pub(super) fn map<D, M>(
        &self,
        mut colours: impl FnMut(C) -> D,
        numbers: impl FnMut(N, [f32; 2]) -> M,
    ) -> Conductor<D, M> {
        let Self { eta, k, specular_reflectance, roughness } = *self;
        let roughness = roughness.map(|r| r.map(numbers));
        Conductor { eta, k, specular_reflectance: colours(specular_reflectance), roughness }
    }

    pub(super) const fn flags(&self) -> LobeFlags {
        let spreads = if self.roughness.is_some() { LobeFlags::GLOSSY } else { LobeFlags::DELTA };
        spreads.or(LobeFlags::REFLECTION)
    }
}

impl Model for Conductor<Rgb, f32> {
    fn flags(&self) -> LobeFlags {
        Self::flags(self)
    }

    fn gloss(&self) -> Option<f32> {
        self.roughness.map(|r| r.widest())
    }

    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeFlags) -> Rgb {
        match self.roughness {
            Some(r) if same_side(wo, wi) && lobes.intersects(LobeFlags::GLOSSY) => {
                let fresnel = |cos: f32| fresnel::conductor(cos, self.eta, self.k);
                r.reflect(upward(wo), upward(wi), fresnel) * self.specular_reflectance
            }
            _ => Rgb::BLACK,
        }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.glossy_pdf(wo, wi)
    }

    fn glossy_pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        match self.roughness {
            Some(r) if same_side(wo, wi) => facet_pdf(&r, upward(wo), upward(wi)),
            _ => 0.0,
        }
    }

    fn lobes(&self, wo: Vec3, _: Transport, u: Vec2, lobes: LobeFlags) -> LobeSamples {
        if !lobes.intersects(self.flags().spreading()) {
            return [None; 4];
        }
        let fresnel = |cos: f32| fresnel::conductor(cos, self.eta, self.k) * self.specular_reflectance;
        let reflected = match self.roughness {
            None => Some(LobeSample::only(mirrored(wo), fresnel(wo.z.abs()))),
            Some(r) => reflect_by_facet(&r, wo, u, fresnel),
        };
        [reflected, None, None, None]
    }
}
