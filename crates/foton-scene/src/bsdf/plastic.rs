//! A clear coat over a diffuse base.

use std::f32::consts::FRAC_1_PI;

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Rgb, warp};

use super::coat::{Coat, Coats};
use super::dielectric::{EXT_IOR, INT_IOR};
use super::flags::LobeFlags;
use super::fresnel;
use super::info::{BsdfInfo, Described};
use super::lobe_sample::{BsdfSample, LobeSample, LobeSamples, Transport};
use super::microfacet::{ALPHAS, ISOTROPIC_ROUGHNESS, Microfacets};
use super::model::Model;
use super::reflect::{cosine, facet_pdf, mirrored, reflect_by_facet, same_side, upward};
use crate::description::{Colour, Number};
use crate::parameter::{Binding, Parameter, Role, Slot};

/// A clear coat over a diffuse base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plastic<C = Colour, N = Number> {
    /// Index of refraction of the coat.
    pub int_ior: f32,
    /// Index of refraction outside.
    pub ext_ior: f32,
    /// Share of light that the base reflects, in [0, 1].
    pub diffuse_reflectance: C,
    /// Factor on light reflected by the coat, physically 1.
    pub specular_reflectance: C,
    /// Whether light that is reflected inside the coat takes on the base's colour each time.
    pub nonlinear: bool,
    /// `None`: a smooth coat.
    pub roughness: Option<Microfacets<N>>,
}

/// The index of refraction of polypropylene.
const COAT_IOR: Parameter =
    Parameter { default: 1.49, help: "Index of refraction of the coat: plastics are about 1.5.", ..INT_IOR };

const DIFFUSE_REFLECTANCE: Parameter = Parameter::share("diffuse_reflectance", 0.5)
    .label("Base colour")
    .help("Share of light reflected, by channel. Above 0.9 light bounces long and passes get slower.")
    .role(Role::BaseColour);

const SPECULAR_REFLECTANCE: Parameter = Parameter::share("specular_reflectance", 1.0)
    .label("Reflected")
    .help("Factor on light reflected by the coat; white is physical.");

const NONLINEAR: Parameter = Parameter::boolean("nonlinear")
    .label("Deep colour")
    .help("Light reflected inside the coat takes on the base's colour each time: deeper colours.");

impl Described for Plastic {
    const INFO: BsdfInfo = BsdfInfo {
        label: "Plastic",
        help: "A clear coat over a diffuse base.",
        plugin: "plastic",
        rough_plugin: Some("roughplastic"),
        stated: None,
        is_of_mitsuba_3: true,
    };

    fn default(rough: bool) -> Self {
        Self {
            int_ior: COAT_IOR.default_number(),
            ext_ior: EXT_IOR.default_number(),
            diffuse_reflectance: DIFFUSE_REFLECTANCE.default_colour(),
            specular_reflectance: SPECULAR_REFLECTANCE.default_colour(),
            nonlinear: false,
            roughness: rough.then_some(Microfacets::DEFAULT),
        }
    }

    fn preset() -> Self {
        let diffuse_reflectance = Rgb::splat(0.8).into();
        Self { int_ior: 1.5, ext_ior: 1.0, diffuse_reflectance, ..Described::default(false) }
    }

    fn parameters(&mut self) -> Vec<Binding<'_>> {
        vec![
            Binding::new(&[COAT_IOR], Slot::Refraction(&mut self.int_ior)),
            Binding::new(&[EXT_IOR], Slot::Refraction(&mut self.ext_ior)),
            Binding::new(&[DIFFUSE_REFLECTANCE], Slot::Share(&mut self.diffuse_reflectance)),
            Binding::new(&[SPECULAR_REFLECTANCE], Slot::Share(&mut self.specular_reflectance)),
            Binding::new(&[NONLINEAR], Slot::Boolean(&mut self.nonlinear)),
            Binding::new(ISOTROPIC_ROUGHNESS, Slot::Roughness(&mut self.roughness)),
        ]
    }
}

impl<C: Copy, N: Copy> Plastic<C, N> {
    #[inline(always)]
    pub(super) fn map<D, M>(
        &self,
        mut colours: impl FnMut(C) -> D,
        numbers: impl FnMut(N, [f32; 2]) -> M,
    ) -> Plastic<D, M> {
        let Self { int_ior, ext_ior, diffuse_reflectance, specular_reflectance, nonlinear, roughness } =
            *self;
        Plastic {
            int_ior,
            ext_ior,
            diffuse_reflectance: colours(diffuse_reflectance),
            specular_reflectance: colours(specular_reflectance),
            nonlinear,
            roughness: roughness.map(|r| r.map(numbers)),
        }
    }

    pub(super) const fn flags(&self) -> LobeFlags {
        let coat = if self.roughness.is_some() { LobeFlags::GLOSSY } else { LobeFlags::DELTA };
        LobeFlags::DIFFUSE.or(coat).or(LobeFlags::REFLECTION)
    }
}

impl Plastic {
    /// What gets through its coat, integrated, where that is rough; `ends` says between which numbers a number is.
    pub(super) fn rough_coats(&self, ends: impl Fn(Number, [f32; 2]) -> [f32; 2]) -> Option<Coats> {
        self.roughness.map(|r| {
            let alphas = ends(r.alpha_u, ALPHAS);
            Coats::new(r.distribution, alphas, self.int_ior, self.ext_ior)
        })
    }
}

impl Plastic<Rgb, f32> {
    /// With what gets through its coat, where that is rough.
    #[inline(always)]
    pub(super) const fn under<'a>(&'a self, coat: Option<&'a Coat>) -> Coated<'a> {
        Coated { plastic: self, coat }
    }
}

/// A plastic with what gets through its coat.
pub(super) struct Coated<'a> {
    plastic: &'a Plastic<Rgb, f32>,
    /// `None`: the coat is smooth.
    coat: Option<&'a Coat>,
}

impl Coated<'_> {
    /// Light reflected by a rough coat, above, and the pdf (sr⁻¹) of sampling it, its probability left out.
    #[inline(always)]
    fn coat_with_pdf(&self, r: &Microfacets<f32>, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        let (value, pdf) = r.reflect_with_pdf(wo, wi, |cos| Rgb::splat(self.fresnel(cos)));
        (value * self.plastic.specular_reflectance, pdf)
    }

    fn fresnel(&self, cos: f32) -> f32 {
        fresnel::reflectance(cos, self.plastic.ext_ior, self.plastic.int_ior)
    }

    /// The value of the base by the shares of light that get through the coat on the way in and out, reflections inside the coat
    /// summed up.
    fn base(&self, enters: f32, leaves: f32) -> Rgb {
        let Plastic { int_ior, ext_ior, diffuse_reflectance, nonlinear, .. } = *self.plastic;
        let eta = ext_ior / int_ior;
        let inside = self.coat.map_or_else(|| fresnel::diffuse_reflectance(eta), |c| c.inside);
        let again = if nonlinear { diffuse_reflectance * inside } else { Rgb::splat(inside) };
        let scale = enters * leaves * eta * eta * FRAC_1_PI;
        Rgb::new(
            diffuse_reflectance.r / (1.0 - again.r),
            diffuse_reflectance.g / (1.0 - again.g),
            diffuse_reflectance.b / (1.0 - again.b),
        ) * scale
    }

    /// Share of light at a cosine of incidence that gets through the coat.
    fn enters(&self, cos: f32) -> f32 {
        self.coat.map_or_else(|| 1.0 - self.fresnel(cos), |coat| coat.transmittance(cos))
    }

    /// The probability of sampling the coat rather than the base, by the share that gets through the coat.
    fn coat_probability(&self, enters: f32) -> f32 {
        let coat = self.plastic.specular_reflectance.mean() * (1.0 - enters);
        let base = self.plastic.diffuse_reflectance.mean() * enters;
        if coat + base > 0.0 { coat / (coat + base) } else { 0.0 }
    }

    /// One direction of the coat.
    fn coat_sample(&self, wo: Vec3, u: Vec2) -> Option<LobeSample> {
        let tint = self.plastic.specular_reflectance;
        let reflected = |cos: f32| Rgb::splat(self.fresnel(cos)) * tint;
        match self.plastic.roughness {
            None => Some(LobeSample::only(mirrored(wo), reflected(wo.z.abs()))),
            Some(r) => reflect_by_facet(&r, wo, u, reflected),
        }
    }

    /// One direction of either lobe, both weighted together.
    fn sample_together(&self, r: &Microfacets<f32>, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let enters = self.enters(wo.z.abs());
        let probability = self.coat_probability(enters);
        let wi = if u_lobe < probability { self.coat_sample(wo, u)?.wi } else { cosine(wo, u) };
        if wi.z * wo.z <= 0.0 {
            return None;
        }
        let up = |w: Vec3| w * 1f32.copysign(wo.z);
        let (value, pdf) = self.coat_with_pdf(r, up(wo), up(wi));
        let cosine = up(wi).z;
        let pdf = probability * pdf + (1.0 - probability) * warp::square_to_cosine_hemisphere_pdf(up(wi));
        let weight = (self.base(enters, self.enters(cosine)) + value) * (cosine / pdf);
        (pdf > 0.0).then_some(BsdfSample { wi, weight, lobe: Model::flags(self) })
    }
}

impl Model for Coated<'_> {
    fn flags(&self) -> LobeFlags {
        self.plastic.flags()
    }

    fn gloss(&self) -> Option<f32> {
        self.plastic.roughness.map(|r| r.widest())
    }

    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeFlags) -> Rgb {
        if !same_side(wo, wi) {
            return Rgb::BLACK;
        }
        let (wo, wi) = (upward(wo), upward(wi));
        let coat = match self.plastic.roughness {
            Some(r) if lobes.intersects(LobeFlags::GLOSSY) => self.coat_with_pdf(&r, wo, wi).0,
            _ => Rgb::BLACK,
        };
        if lobes.intersects(LobeFlags::DIFFUSE) {
            self.base(self.enters(wo.z), self.enters(wi.z)) + coat
        } else {
            coat
        }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if !same_side(wo, wi) {
            return 0.0;
        }
        let probability = self.coat_probability(self.enters(wo.z.abs()));
        let base = warp::square_to_cosine_hemisphere_pdf(wi.abs());
        probability * self.glossy_pdf(wo, wi) + (1.0 - probability) * base
    }

    fn glossy_pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        match self.plastic.roughness {
            Some(r) if same_side(wo, wi) => facet_pdf(&r, upward(wo), upward(wi)),
            _ => 0.0,
        }
    }

    fn lobes(&self, wo: Vec3, _: Transport, u: Vec2, lobes: LobeFlags) -> LobeSamples {
        let is_asked = lobes.intersects(self.flags().without(LobeFlags::DIFFUSE).spreading());
        [if is_asked { self.coat_sample(wo, u) } else { None }, None, None, None]
    }

    fn sample(&self, wo: Vec3, _: Transport, u_lobe: f32, u: Vec2, apart: LobeFlags) -> Option<BsdfSample> {
        match self.plastic.roughness {
            Some(r) if !apart.intersects(LobeFlags::GLOSSY) => {
                return self.sample_together(&r, wo, u_lobe, u);
            }
            _ => {}
        }
        let enters = self.enters(wo.z.abs());
        let probability = self.coat_probability(enters);
        if u_lobe < probability {
            let coat = self.coat_sample(wo, u)?;
            let lobe = self.flags().without(LobeFlags::DIFFUSE);
            return Some(BsdfSample { wi: coat.wi, weight: coat.weight / probability, lobe });
        }
        let wi = cosine(wo, u);
        let leaves = self.enters(wi.z.abs());
        let weight = self.base(enters, leaves) * (std::f32::consts::PI / (1.0 - probability));
        Some(BsdfSample { wi, weight, lobe: LobeFlags::DIFFUSE | LobeFlags::REFLECTION })
    }
}
