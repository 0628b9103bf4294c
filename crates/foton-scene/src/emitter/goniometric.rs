//! A point with a radiant intensity for each direction.

use std::f32::consts::PI;

use foton_math::Rgb;
use foton_math::glam::{Vec2, Vec3};

use super::aim::Aim;
use super::emission::{Emission, Illumination, from_point};
use super::environment_map::EnvironmentMap;
use super::extent::Extent;

/// A point with a radiant intensity for each direction: the map's radiance, in all directions that light goes.
#[derive(Clone, Debug)]
pub(crate) struct Goniometric {
    pub(crate) position: Vec3,
    pub(crate) map: Box<EnvironmentMap>,
}

impl Goniometric {
    pub(super) fn emit(&self, aim: &Aim, u: Vec2) -> Emission {
        let own = |u| self.map.sample(u).map_or(Vec3::Z, |sample| sample.direction);
        let (direction, pdf) = if aim.is_empty() {
            let direction = own(u);
            (direction, self.map.pdf(direction))
        } else {
            aim.divergent(self.position, u, own, |direction| self.map.pdf(direction))
        };
        let power = if pdf > 0.0 { self.map.radiance(direction) / pdf } else { Rgb::BLACK };
        Emission { origin: self.position, direction, power }
    }

    pub(super) fn extent(&self) -> Extent {
        // Over a sphere its mean intensity: where it is brighter is not known to a choice among many.
        Extent::of_point(self.position, self.map.total().luminance() / (4.0 * PI))
    }

    pub(super) fn illuminate(&self, position: Vec3) -> Option<Illumination> {
        let direction = (position - self.position).try_normalize()?;
        from_point(self.position, position, self.map.radiance(direction))
    }
}
