//! A clear coat over any base: a dielectric layer, smooth or rough, which may absorb light.
//!
//! The two-layer model of Weidlich and Wilkie `[WW07]` as Mitsuba 0.6 has it: light is reflected at the layer by Fresnel's equations, or
//! refracts into it, is absorbed along its refracted path, scattered by the base as seen from inside, absorbed on its way out and refracts
//! out again. With ω′ the refracted directions, T the shares that get through, σ the absorption of the layer's thickness and η its relative
//! index, f(ωo, ωi) = f_coat + f_base(ωo′, ωi′) T(ωo) T(ωi) exp(−σ (1/cos ωo′ + 1/cos ωi′)) / η². Light that the layer sends back to the base
//! is lost, and through a rough layer light refracts by the surface's normal.

use foton_math::Rgb;

use super::coat::{Coats, PackedCoat};
use super::dielectric::{EXT_IOR, INT_IOR};
use super::flags::LobeFlags;
use super::layer::Layer;
use super::microfacet::{ALPHAS, ISOTROPIC_ROUGHNESS, Microfacets};
use crate::description::{Colour, Number};
use crate::parameter::{Binding, Parameter, Slot};

/// A clear coat over any base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coating<C = Colour, N = Number> {
    /// Index of refraction of the layer.
    pub int_ior: f32,
    /// Index of refraction outside.
    pub ext_ior: f32,
    /// How thick it is, in units of one over `sigma_a`.
    pub thickness: N,
    /// What it absorbs along a path of length 1.
    pub sigma_a: C,
    /// Factor on light that it reflects, physically 1.
    pub specular_reflectance: C,
    /// `None`: smooth.
    pub roughness: Option<Microfacets<N>>,
}

const THICKNESS: Parameter = Parameter::number("thickness", 1.0, (0.0, 1e6))
    .label("Coat thickness")
    .help("How thick the layer is, in units of one over what it absorbs.")
    .slider(0.0, 10.0, false);

const SIGMA_A: Parameter = Parameter { textured: true, ..Parameter::colour("sigma_a", 0.0) }
    .label("Coat absorption")
    .help("What the layer absorbs along a path of length 1, by channel.");

const SPECULAR_REFLECTANCE: Parameter = Parameter::share("specular_reflectance", 1.0)
    .label("Coat reflected")
    .help("Factor on light that the layer reflects; white is physical.");

const COAT_INT_IOR: Parameter = Parameter { role: None, label: "Coat index", ..INT_IOR };
const COAT_EXT_IOR: Parameter =
    Parameter { role: None, label: "Coat index outside", advanced: true, ..EXT_IOR };

/// The parameters of a rough layer.
pub(crate) const ROUGH_COATING: &[Parameter] = &[
    COAT_INT_IOR,
    COAT_EXT_IOR,
    THICKNESS,
    SIGMA_A,
    SPECULAR_REFLECTANCE,
    ISOTROPIC_ROUGHNESS[0],
    ISOTROPIC_ROUGHNESS[1],
    ISOTROPIC_ROUGHNESS[2],
];

/// The parameters of a smooth layer.
pub(crate) const COATING: &[Parameter] =
    &[COAT_INT_IOR, COAT_EXT_IOR, THICKNESS, SIGMA_A, SPECULAR_REFLECTANCE];

impl Coating {
    /// As a file means it that gives no parameters.
    #[must_use]
    pub fn default(rough: bool) -> Self {
        Self {
            int_ior: COAT_INT_IOR.default_number(),
            ext_ior: COAT_EXT_IOR.default_number(),
            thickness: THICKNESS.default_number().into(),
            sigma_a: SIGMA_A.default_colour(),
            specular_reflectance: SPECULAR_REFLECTANCE.default_colour(),
            roughness: rough.then_some(Microfacets::DEFAULT),
        }
    }

    /// The plugin that means the same.
    #[must_use]
    pub const fn plugin(&self) -> &'static str {
        if self.roughness.is_some() { "roughcoating" } else { "coating" }
    }

    /// Its parameters, in the order of files and of the inspector, with the places of their values.
    #[must_use]
    pub fn parameters(&mut self) -> Vec<Binding<'_>> {
        vec![
            Binding::new(&[COAT_INT_IOR], Slot::Refraction(&mut self.int_ior)),
            Binding::new(&[COAT_EXT_IOR], Slot::Refraction(&mut self.ext_ior)),
            Binding::new(&[THICKNESS], Slot::Number(&mut self.thickness)),
            Binding::new(&[SIGMA_A], Slot::Share(&mut self.sigma_a)),
            Binding::new(&[SPECULAR_REFLECTANCE], Slot::Share(&mut self.specular_reflectance)),
            Binding::new(ISOTROPIC_ROUGHNESS, Slot::Roughness(&mut self.roughness)),
        ]
    }

    /// What gets through it, integrated, where it is rough; `ends` says between which numbers a number is.
    pub(crate) fn rough_coats(&self, ends: impl Fn(Number, [f32; 2]) -> [f32; 2]) -> Option<Coats> {
        let r = self.roughness?;
        Some(Coats::new(r.distribution, ends(r.alpha_u, ALPHAS), self.int_ior, self.ext_ior))
    }
}

impl<C: Copy, N: Copy> Coating<C, N> {
    /// The same with its colours and numbers replaced.
    #[must_use]
    pub fn map<D, M>(
        &self,
        mut colours: impl FnMut(C) -> D,
        mut numbers: impl FnMut(N, [f32; 2]) -> M,
    ) -> Coating<D, M> {
        let Self { int_ior, ext_ior, thickness, sigma_a, specular_reflectance, roughness } = *self;
        Coating {
            int_ior,
            ext_ior,
            thickness: numbers(thickness, THICKNESS.limits()),
            sigma_a: colours(sigma_a),
            specular_reflectance: colours(specular_reflectance),
            roughness: roughness.map(|r| r.map(numbers)),
        }
    }
}

impl Coating<Rgb, f32> {
    /// The layer at a point, with what gets through where it is rough.
    pub(crate) fn layer(&self, through: Option<&Coats>) -> Layer {
        let Self { int_ior, ext_ior, thickness, sigma_a, specular_reflectance, roughness } = *self;
        Layer {
            eta: int_ior / ext_ior,
            absorption: sigma_a * thickness,
            reflectance: specular_reflectance,
            roughness,
            through: through
                .zip(roughness)
                .map_or_else(PackedCoat::default, |(coats, r)| coats.at(r.widest()).packed()),
        }
    }

    /// The lobes of a base under the layer, and the roughness of the glossy ones.
    #[must_use]
    pub fn over(&self, base: LobeFlags, gloss: Option<f32>) -> (LobeFlags, Option<f32>) {
        self.layer(None).over(base, gloss)
    }
}
