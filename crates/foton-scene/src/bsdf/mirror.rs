//! A smooth mirror that reflects the same share at every angle.

use foton_math::Rgb;
use foton_math::glam::{Vec2, Vec3};

use super::flags::LobeFlags;
use super::info::{BsdfInfo, Described};
use super::lobe_sample::{LobeSample, LobeSamples, Transport};
use super::model::Model;
use super::reflect::mirrored;
use crate::description::Colour;
use crate::parameter::{Binding, Parameter, Role, Slot};

/// A smooth mirror that reflects the same share at every angle (Mitsuba's conductor of the material `none`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mirror<C = Colour> {
    /// Share of light reflected, in [0, 1].
    pub reflectance: C,
}

const REFLECTANCE: Parameter = Parameter::share("specular_reflectance", 1.0)
    .label("Colour")
    .help("Share of light reflected, by channel. Above 0.9 light bounces long and passes get slower.")
    .role(Role::BaseColour);

impl Described for Mirror {
    const INFO: BsdfInfo = BsdfInfo {
        label: "Mirror",
        help: "A smooth mirror that reflects the same share at every angle.",
        plugin: "conductor",
        rough_plugin: None,
        stated: Some(["string", "material", "none"]),
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

impl<C: Copy> Mirror<C> {
    #[inline(always)]
    pub(super) fn map<D>(&self, mut f: impl FnMut(C) -> D) -> Mirror<D> {
        Mirror { reflectance: f(self.reflectance) }
    }

    pub(super) const fn flags(&self) -> LobeFlags {
        LobeFlags::DELTA.or(LobeFlags::REFLECTION)
    }
}

impl Model for Mirror<Rgb> {
    fn flags(&self) -> LobeFlags {
        Self::flags(self)
    }

    fn lobes(&self, wo: Vec3, _: Transport, _: Vec2, lobes: LobeFlags) -> LobeSamples {
        let is_asked = lobes.intersects(LobeFlags::DELTA);
        [is_asked.then(|| LobeSample::only(mirrored(wo), self.reflectance)), None, None, None]
    }
}
