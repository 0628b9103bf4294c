//! Lambertian reflection.

use std::f32::consts::FRAC_1_PI;

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Rgb, warp};

use super::flags::LobeFlags;
use super::info::{BsdfInfo, Described};
use super::lobe_sample::{BsdfSample, Transport};
use super::model::Model;
use super::reflect::{cosine, same_side};
use crate::description::Colour;
use crate::parameter::{Binding, Parameter, Role, Slot};

/// Lambertian reflection: as bright from every direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diffuse<C = Colour> {
    /// Share of light reflected, in [0, 1].
    pub reflectance: C,
}

const REFLECTANCE: Parameter = Parameter::share("reflectance", 0.5)
    .once(&["diffuse_reflectance"])
    .label("Colour")
    .help("Share of light reflected, by channel. Above 0.9 light bounces long and passes get slower.")
    .role(Role::BaseColour);

impl Described for Diffuse {
    const INFO: BsdfInfo = BsdfInfo {
        label: "Diffuse",
        help: "Lambertian reflection: as bright from every direction.",
        plugin: "diffuse",
        rough_plugin: None,
        stated: None,
        is_of_mitsuba_3: true,
    };

    fn default(_: bool) -> Self {
        Self { reflectance: REFLECTANCE.default_colour() }
    }

    fn preset() -> Self {
        Self { reflectance: Rgb::splat(0.8).into() }
    }

    fn parameters(&mut self) -> Vec<Binding<'_>> {
        vec![Binding::new(&[REFLECTANCE], Slot::Share(&mut self.reflectance))]
    }
}

impl<C: Copy> Diffuse<C> {
    #[inline(always)]
    pub(super) fn map<D>(&self, mut f: impl FnMut(C) -> D) -> Diffuse<D> {
        Diffuse { reflectance: f(self.reflectance) }
    }

    pub(super) const fn flags(&self) -> LobeFlags {
        LobeFlags::DIFFUSE.or(LobeFlags::REFLECTION)
    }
}

impl Model for Diffuse<Rgb> {
    fn flags(&self) -> LobeFlags {
        Self::flags(self)
    }

    #[inline(always)]
    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeFlags) -> Rgb {
        if same_side(wo, wi) && lobes.intersects(LobeFlags::DIFFUSE) {
            self.reflectance * FRAC_1_PI
        } else {
            Rgb::BLACK
        }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if same_side(wo, wi) { warp::square_to_cosine_hemisphere_pdf(wi.abs()) } else { 0.0 }
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3, _: Transport, _: f32, u: Vec2, _: LobeFlags) -> Option<BsdfSample> {
        Some(BsdfSample { wi: cosine(wo, u), weight: self.reflectance, lobe: Model::flags(self) })
    }
}
