//! A thin pane of glass.

use foton_math::Rgb;
use foton_math::glam::{Vec2, Vec3};

use super::dielectric::{EXT_IOR, INT_IOR, SPECULAR_REFLECTANCE, SPECULAR_TRANSMITTANCE};
use super::flags::LobeFlags;
use super::fresnel;
use super::info::{BsdfInfo, Described};
use super::lobe_sample::{LobeSample, LobeSamples, Transport};
use super::model::Model;
use super::reflect::mirrored;
use crate::description::Colour;
use crate::parameter::{Binding, Slot};

/// A thin pane of glass: light passes straight on, reflections between its faces included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinDielectric<C = Colour> {
    /// Index of refraction of the pane.
    pub int_ior: f32,
    /// Index of refraction around it.
    pub ext_ior: f32,
    /// Factor on reflected light, physically 1.
    pub specular_reflectance: C,
    /// Factor on transmitted light, physically 1.
    pub specular_transmittance: C,
}

impl Described for ThinDielectric {
    const INFO: BsdfInfo = BsdfInfo {
        label: "Thin dielectric",
        help: "A thin pane of glass: light passes straight on, reflections between its faces included.",
        plugin: "thindielectric",
        rough_plugin: None,
        stated: None,
        is_of_mitsuba_3: true,
    };

    fn default(_: bool) -> Self {
        Self {
            int_ior: INT_IOR.default_number(),
            ext_ior: EXT_IOR.default_number(),
            specular_reflectance: SPECULAR_REFLECTANCE.default_colour(),
            specular_transmittance: SPECULAR_TRANSMITTANCE.default_colour(),
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
        ]
    }
}

impl<C: Copy> ThinDielectric<C> {
    #[inline(always)]
    pub(super) fn map<D>(&self, mut f: impl FnMut(C) -> D) -> ThinDielectric<D> {
        let Self { int_ior, ext_ior, specular_reflectance, specular_transmittance } = *self;
        ThinDielectric {
            int_ior,
            ext_ior,
            specular_reflectance: f(specular_reflectance),
            specular_transmittance: f(specular_transmittance),
        }
    }

    pub(super) const fn flags(&self) -> LobeFlags {
        LobeFlags::DELTA.or(LobeFlags::REFLECTION).or(LobeFlags::TRANSMISSION).or(LobeFlags::STRAIGHT)
    }
}

impl ThinDielectric<Rgb> {
    /// The share reflected, all reflections between the faces included: R + T R T + T R³ T + … = 2R/(1 + R).
    fn reflectance(&self, wo: Vec3) -> f32 {
        let once = fresnel::reflectance(wo.z.abs(), self.ext_ior, self.int_ior);
        if once < 1.0 { 2.0 * once / (1.0 + once) } else { 1.0 }
    }
}

impl Model for ThinDielectric<Rgb> {
    fn flags(&self) -> LobeFlags {
        Self::flags(self)
    }

    fn lobes(&self, wo: Vec3, _: Transport, _: Vec2, lobes: LobeFlags) -> LobeSamples {
        if !lobes.intersects(LobeFlags::DELTA) {
            return [None; 4];
        }
        let f = self.reflectance(wo);
        let weight = self.specular_reflectance * f;
        [Some(LobeSample { wi: mirrored(wo), weight, probability: f }), None, self.straight(wo), None]
    }

    fn straight(&self, wo: Vec3) -> Option<LobeSample> {
        LobeSample::straight(wo, 1.0 - self.reflectance(wo), self.specular_transmittance)
    }
}
