//! Glass and water, smooth and rough: reflection and refraction by the surface's normal or by a facet's.

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Frame, Rgb};

use super::flags::LobeFlags;
use super::fresnel;
use super::info::{BsdfInfo, Described};
use super::lobe_sample::{LobeSample, LobeSamples, Transport};
use super::microfacet::{Microfacets, ROUGHNESS};
use super::model::Model;
use super::reflect::mirrored;
use crate::description::{Colour, Number};
use crate::parameter::{Binding, Parameter, Role, Slot};

/// A boundary of two transparent media.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric<C = Colour, N = Number> {
    /// Index of refraction on the side away from the normal.
    pub int_ior: f32,
    /// Index of refraction on the side that the normal points to.
    pub ext_ior: f32,
    /// Factor on reflected light, physically 1.
    pub specular_reflectance: C,
    /// Factor on refracted light, physically 1.
    pub specular_transmittance: C,
    /// `None`: smooth.
    pub roughness: Option<Microfacets<N>>,
}

/// The index of refraction of air.
pub(super) const AIR: f64 = 1.000_277;
/// That of BK7, a common glass.
const GLASS: f64 = 1.5046;

pub(super) const INT_IOR: Parameter = Parameter::refraction("int_ior", GLASS)
    .label("Index of refraction")
    .help("How strongly light bends: water 1.33, window glass 1.52, sapphire 1.77, diamond 2.42.")
    .role(Role::InsideIor);

pub(super) const EXT_IOR: Parameter = Parameter::refraction("ext_ior", AIR)
    .label("Index outside")
    .help("Index of refraction of what surrounds it: air 1, water 1.33.")
    .role(Role::OutsideIor);

pub(super) const SPECULAR_REFLECTANCE: Parameter = Parameter::share("specular_reflectance", 1.0)
    .label("Reflected")
    .help("Factor on reflected light; white is physical.");

pub(super) const SPECULAR_TRANSMITTANCE: Parameter = Parameter::share("specular_transmittance", 1.0)
    .label("Transmitted")
    .help("Factor on light that passes; white is physical, a tint colours every crossing alike.");

impl Described for Dielectric {
    const INFO: BsdfInfo = BsdfInfo {
        label: "Dielectric",
        help: "A boundary of two transparent media, such as glass or water.",
        plugin: "dielectric",
        rough_plugin: Some("roughdielectric"),
        stated: None,
        is_of_mitsuba_3: true,
    };

    fn default(rough: bool) -> Self {
        Self {
            int_ior: INT_IOR.default_number(),
            ext_ior: EXT_IOR.default_number(),
            specular_reflectance: SPECULAR_REFLECTANCE.default_colour(),
            specular_transmittance: SPECULAR_TRANSMITTANCE.default_colour(),
            roughness: rough.then_some(Microfacets::DEFAULT),
        }
    }

    fn preset() -> Self {
        Self { int_ior: 1.5, ext_ior: 1.0, ..Described::default(false) }
    }

    fn parameters(&mut self) -> Vec<Binding<'_>> {
        vec![
            Binding::new(&[INT_IOR], Slot::Refraction(&mut self.int_ior)),
            Binding::new(&[EXT_IOR], Slot::Refraction(&mut self.ext_ior)),
            Binding::new(&[SPECULAR_REFLECTANCE], Slot::Share(&mut self.specular_reflectance)),
            Binding::new(&[SPECULAR_TRANSMITTANCE], Slot::Share(&mut self.specular_transmittance)),
            Binding::new(ROUGHNESS, Slot::Roughness(&mut self.roughness)),
        ]
    }
}

impl<C: Copy, N: Copy> Dielectric<C, N> {
    #[inline(always)]
    pub(super) fn map<D, M>(
        &self,
        mut colours: impl FnMut(C) -> D,
        numbers: impl FnMut(N, [f32; 2]) -> M,
    ) -> Dielectric<D, M> {
        let Self { int_ior, ext_ior, specular_reflectance, specular_transmittance, roughness } = *self;
        Dielectric {
            int_ior,
            ext_ior,
            specular_reflectance: colours(specular_reflectance),
            specular_transmittance: colours(specular_transmittance),
            roughness: roughness.map(|r| r.map(numbers)),
        }
    }

    pub(super) const fn flags(&self) -> LobeFlags {
        let spreads = if self.roughness.is_some() { LobeFlags::GLOSSY } else { LobeFlags::DELTA };
        spreads.or(LobeFlags::REFLECTION).or(LobeFlags::TRANSMISSION)
    }
}

impl Model for Dielectric<Rgb, f32> {
    fn flags(&self) -> LobeFlags {
        Self::flags(self)
    }

    fn gloss(&self) -> Option<f32> {
        self.roughness.map(|r| r.widest())
    }

    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeFlags) -> Rgb {
        match self.roughness {
            Some(r) if lobes.intersects(LobeFlags::GLOSSY) => self.eval_rough(&r, wo, wi),
            _ => Rgb::BLACK,
        }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.roughness.map_or(0.0, |r| self.pdf_rough(&r, wo, wi))
    }

    fn lobes(&self, wo: Vec3, transport: Transport, u: Vec2, lobes: LobeFlags) -> LobeSamples {
        if lobes.intersects(self.flags().spreading()) { self.sampled(wo, transport, u) } else { [None; 4] }
    }
}

impl Dielectric<Rgb, f32> {
    /// Reflection and refraction at glass, by the surface's normal or by a facet's.
    fn sampled(&self, wo: Vec3, transport: Transport, u: Vec2) -> LobeSamples {
        let Self {
            int_ior,
            ext_ior,
            specular_reflectance: reflected,
            specular_transmittance: refracted,
            roughness,
        } = *self;
        let side = 1f32.copysign(wo.z);
        let h = roughness.map_or(Vec3::Z, |r| r.sample(wo * side, u)) * side;
        // The boundary in the facet's own frame, whose z is the facet's normal on the outside.
        let frame = Frame::from_normal(h * side);
        let local = if roughness.is_some() { frame.to_local(wo) } else { wo };
        let back = |w: Vec3| if roughness.is_some() { frame.to_outer(w) } else { w };
        let boundary = fresnel::dielectric(local, int_ior, ext_ior);
        let f = boundary.reflectance;
        let visible = |wi: Vec3, same_side: bool| match roughness {
            None => 1.0,
            Some(_) if (wi.z * wo.z > 0.0) != same_side => 0.0,
            Some(r) => r.visible(wi, h * side) * r.sample_weight(wo * side, h * side),
        };
        let spread = match transport {
            Transport::Radiance => boundary.relative_ior * boundary.relative_ior,
            Transport::Importance => 1.0,
        };
        let lobe = |wi: Vec3, chance: f32, tint: Rgb, same_side: bool| {
            let weight = tint * (chance * visible(wi, same_side));
            (!weight.is_black()).then_some(LobeSample { wi, weight, probability: chance })
        };
        let reflection = (f > 0.0).then(|| lobe(back(mirrored(local)), f, reflected, true)).flatten();
        let refraction = boundary
            .refracted
            .filter(|_| f < 1.0)
            .and_then(|wi| lobe(back(wi), 1.0 - f, refracted * spread, false));
        [reflection, refraction, None, None]
    }

    /// `f(wo, wi)` of rough glass for radiance, reflection and refraction. `[WML07]` equations 20 and 21
    fn eval_rough(&self, r: &Microfacets<f32>, wo: Vec3, wi: Vec3) -> Rgb {
        let Some(facet) = GlassFacet::between(wo, wi, self.int_ior, self.ext_ior) else { return Rgb::BLACK };
        let g = r.visible(wo, facet.normal) * r.visible(wi, facet.normal);
        let d = r.density(facet.normal) * g / (wo.z * wi.z).abs();
        if wo.z * wi.z > 0.0 {
            return self.specular_reflectance * (facet.reflectance * d * 0.25);
        }
        let jacobian =
            (wo.dot(facet.normal) * wi.dot(facet.normal)).abs() / facet.denominator(wo, wi).powi(2);
        // Radiance: the squared relative index of both sides cancels the jacobian's.
        self.specular_transmittance * ((1.0 - facet.reflectance) * d * jacobian * facet.eta * facet.eta)
    }

    /// The pdf (sr⁻¹) of sampling rough glass.
    fn pdf_rough(&self, r: &Microfacets<f32>, wo: Vec3, wi: Vec3) -> f32 {
        let Some(facet) = GlassFacet::between(wo, wi, self.int_ior, self.ext_ior) else { return 0.0 };
        let side = 1f32.copysign(wo.z);
        let pdf = r.pdf(wo * side, facet.normal);
        if wo.z * wi.z > 0.0 {
            return facet.reflectance * pdf / (4.0 * wo.dot(facet.normal).abs());
        }
        let jacobian = wi.dot(facet.normal).abs() / facet.denominator(wo, wi).powi(2);
        (1.0 - facet.reflectance) * pdf * jacobian
    }
}

/// The facet that takes one direction to another.
pub(super) struct GlassFacet {
    /// Its normal, with z > 0.
    pub(super) normal: Vec3,
    /// What it reflects.
    pub(super) reflectance: f32,
    /// Index on `wo`'s side over that on the other.
    pub(super) eta: f32,
}

impl GlassFacet {
    pub(super) fn between(wo: Vec3, wi: Vec3, int_ior: f32, ext_ior: f32) -> Option<Self> {
        let eta = if wo.z > 0.0 { ext_ior / int_ior } else { int_ior / ext_ior };
        let sum = if wo.z * wi.z > 0.0 { wo + wi } else { wo * eta + wi };
        let normal = sum.try_normalize()?;
        let normal = normal * 1f32.copysign(normal.z);
        let faces = wo.dot(normal) * wo.z > 0.0 && wi.dot(normal) * wi.z > 0.0;
        let local = Frame::from_normal(normal).to_local(wo);
        let reflectance = fresnel::dielectric(local, int_ior, ext_ior).reflectance;
        faces.then_some(Self { normal, reflectance, eta })
    }

    /// η (wo·h) + (wi·h), the indices being relative to `wi`'s side.
    pub(super) fn denominator(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.eta * wo.dot(self.normal) + wi.dot(self.normal)
    }
}
