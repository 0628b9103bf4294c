//! Nothing: light passes as if there were no surface.

use foton_math::Rgb;
use foton_math::glam::{Vec2, Vec3};

use super::flags::LobeFlags;
use super::info::{BsdfInfo, Described};
use super::lobe_sample::{LobeSample, LobeSamples, Transport};
use super::model::Model;
use crate::parameter::Binding;

/// Nothing: light passes as if there were no surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Null;

impl Described for Null {
    const INFO: BsdfInfo = BsdfInfo {
        label: "Null",
        help: "Nothing: light passes as if there were no surface.",
        plugin: "null",
        rough_plugin: None,
        stated: None,
        is_of_mitsuba_3: true,
    };

    fn default(_: bool) -> Self {
        Self
    }

    fn preset() -> Self {
        Self
    }

    fn parameters(&mut self) -> Vec<Binding<'_>> {
        Vec::new()
    }
}

impl Null {
    pub(super) const fn flags(self) -> LobeFlags {
        LobeFlags::DELTA.or(LobeFlags::TRANSMISSION).or(LobeFlags::STRAIGHT)
    }
}

impl Model for Null {
    fn flags(&self) -> LobeFlags {
        Self::flags(*self)
    }

    fn lobes(&self, wo: Vec3, _: Transport, _: Vec2, lobes: LobeFlags) -> LobeSamples {
        [None, None, if lobes.intersects(LobeFlags::DELTA) { self.straight(wo) } else { None }, None]
    }

    fn straight(&self, wo: Vec3) -> Option<LobeSample> {
        LobeSample::straight(wo, 1.0, Rgb::WHITE)
    }
}
