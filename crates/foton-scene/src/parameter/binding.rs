//! The parameters of a BSDF, with the places of their values.

use foton_math::Rgb;

use super::declaration::{Kind, Parameter};
use crate::bsdf::Microfacets;
use crate::description::{Colour, Number};

/// Parameters of a BSDF with the place of what they say.
#[derive(Debug)]
pub struct Binding<'a> {
    /// The parameters: several where they say one thing together.
    pub parameters: &'static [Parameter],
    /// Where their value is.
    pub slot: Slot<'a>,
}

/// Where the value of a parameter is.
#[derive(Debug)]
pub enum Slot<'a> {
    /// A share of light.
    Share(&'a mut Colour),
    /// A number that a texture may give.
    Number(&'a mut Number),
    /// An index of refraction.
    Refraction(&'a mut f32),
    /// An index of refraction, or the reflectance at normal incidence that stands for it.
    Reflectivity(&'a mut f32),
    /// True or false.
    Boolean(&'a mut bool),
    /// One of some words, by its place among them.
    Choice(&'a mut usize),
    /// A metal's complex index of refraction: `eta` and `k`, or its name.
    Metal {
        /// The real part.
        eta: &'a mut Rgb,
        /// The imaginary part.
        k: &'a mut Rgb,
    },
    /// The microfacets, if the surface is rough: [`ROUGHNESS`](crate::bsdf::ROUGHNESS) or
    /// [`ISOTROPIC_ROUGHNESS`](crate::bsdf::ISOTROPIC_ROUGHNESS).
    Roughness(&'a mut Option<Microfacets>),
}

impl<'a> Binding<'a> {
    /// Binds parameters to their value.
    #[must_use]
    pub const fn new(parameters: &'static [Parameter], slot: Slot<'a>) -> Self {
        Self { parameters, slot }
    }

    /// Whether the value lies within the range of its parameters. Of a texture that is not known here.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        let range = &self.parameters[0];
        let is_within = |c: &Rgb| c.is_finite() && c.to_array().iter().all(|&x| range.holds(f64::from(x)));
        let positive = |x: f32| x.is_finite() && x > 0.0;
        match &self.slot {
            Slot::Share(Colour::Constant(c)) => is_within(c),
            Slot::Share(Colour::Texture(_)) | Slot::Boolean(_) | Slot::Number(Number::Texture(_)) => true,
            Slot::Number(Number::Constant(x)) => range.holds(f64::from(*x)),
            Slot::Choice(i) => matches!(range.kind, Kind::Choice(words) if **i < words.len()),
            Slot::Refraction(x) | Slot::Reflectivity(x) => positive(**x),
            Slot::Metal { eta, k } => is_within(eta) && is_within(k),
            Slot::Roughness(r) => r.is_none_or(|r| {
                [r.alpha_u, r.alpha_v].into_iter().filter_map(Number::constant).all(positive)
            }),
        }
    }
}
