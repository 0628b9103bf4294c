//! A thin sheet that spreads all light that it lets through in all directions on its other side.
//!
//! What hit points gather on such a surface arrives from the side that the eye does not see: photons are stored on the far side.

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

/// Lambertian transmission: as bright from every direction on the other side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffuseTransmitter<C = Colour> {
    /// Share of light that passes, in [0, 1].
    pub transmittance: C,
}

const TRANSMITTANCE: Parameter = Parameter::share("transmittance", 0.5)
    .once(&["diffuse_transmittance"])
    .label("Colour")
    .help("Share of light that passes, by channel.")
    .role(Role::BaseColour);

impl Described for DiffuseTransmitter {
    const INFO: BsdfInfo = BsdfInfo {
        label: "Diffuse transmitter",
        help: "A thin sheet that spreads what it lets through in all directions, such as a lamp shade or a leaf.",
        plugin: "difftrans",
        rough_plugin: None,
        stated: None,
        is_of_mitsuba_3: false,
    };

    fn default(_: bool) -> Self {
        Self { transmittance: TRANSMITTANCE.default_colour() }
    }

    fn preset() -> Self {
        Described::default(false)
    }

    fn parameters(&mut self) -> Vec<Binding<'_>> {
        vec![Binding::new(&[TRANSMITTANCE], Slot::Share(&mut self.transmittance))]
    }
}

impl<C: Copy> DiffuseTransmitter<C> {
    #[inline(always)]
    pub(super) fn map<D>(&self, mut f: impl FnMut(C) -> D) -> DiffuseTransmitter<D> {
        DiffuseTransmitter { transmittance: f(self.transmittance) }
    }

    pub(super) const fn flags(&self) -> LobeFlags {
        LobeFlags::DIFFUSE.or(LobeFlags::TRANSMISSION)
    }
}

impl Model for DiffuseTransmitter<Rgb> {
    fn flags(&self) -> LobeFlags {
        Self::flags(self)
    }

    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeFlags) -> Rgb {
        if wo.z * wi.z < 0.0 && lobes.intersects(LobeFlags::DIFFUSE) {
            self.transmittance * FRAC_1_PI
        } else {
            Rgb::BLACK
        }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if same_side(wo, wi) { 0.0 } else { warp::square_to_cosine_hemisphere_pdf(wi.abs()) }
    }

    fn sample(&self, wo: Vec3, _: Transport, _: f32, u: Vec2, _: LobeFlags) -> Option<BsdfSample> {
        let wi = cosine(-wo, u);
        Some(BsdfSample { wi, weight: self.transmittance, lobe: Model::flags(self) })
    }
}
