//! Emitters: where photons start, and what a point receives without anything in between. Each kind has a file.
//!
//! Powers and radiances are per channel. Lengths are scene units, so radiant intensity carries the square of the scale.

mod aim;
mod area;
mod beam;
mod cells;
mod directional;
mod emission;
mod environment;
mod environment_map;
mod extent;
mod goniometric;
mod pattern;
mod place;
mod point;
mod rectangle;
mod spot;
#[cfg(test)]
mod tests;

use foton_math::Rgb;
use foton_math::glam::{Vec2, Vec3};

use crate::plugins::emitters;
use crate::surface::Surface;

pub(crate) use aim::{Aim, Ball, Target};
pub(crate) use area::Area;
pub(crate) use beam::{Beam, Light, Picture};
pub(crate) use directional::Directional;
pub use emission::{Emission, Illumination};
pub(crate) use environment::{Constant, Environment};
pub(crate) use environment_map::EnvironmentMap;
pub use extent::Extent;
pub(crate) use goniometric::Goniometric;
pub(crate) use pattern::Pattern;
pub(crate) use point::Point;
pub(crate) use spot::{Cone, Spot};

/// An emitter in scene units.
#[derive(Clone, Debug)]
pub struct Emitter {
    /// The name in the scene file: that of the shape for an area emitter.
    pub name: String,
    /// What it emits.
    pub(crate) kind: Kind,
    /// What its photons are aimed at.
    pub(crate) aim: Aim,
}

#[derive(Clone, Debug)]
pub(crate) enum Kind {
    Area(Area),
    Point(Point),
    Spot(Spot),
    Beam(Box<Beam>),
    Goniometric(Goniometric),
    Constant(Constant),
    Directional(Directional),
    Environment(Environment),
}

impl Emitter {
    /// Power per channel (W).
    #[must_use]
    pub fn power(&self) -> Rgb {
        let emission = match &self.kind {
            Kind::Area(area) => area.radiance,
            Kind::Point(point) => point.intensity,
            Kind::Spot(spot) => spot.intensity,
            Kind::Beam(beam) => beam.total(),
            Kind::Goniometric(lamp) => lamp.map.total(),
            Kind::Constant(sky) => sky.radiance,
            Kind::Directional(sun) => sun.irradiance,
            Kind::Environment(sky) => sky.map.total(),
        };
        emission * self.power_factor()
    }

    /// Its power for each unit of what it emits; for a map or a picture, of its integral.
    pub(crate) fn power_factor(&self) -> f32 {
        match &self.kind {
            Kind::Area(area) => area.power_factor(),
            Kind::Point(point) => point.power_factor(),
            Kind::Spot(spot) => spot.power_factor(),
            Kind::Beam(_) | Kind::Goniometric(_) => 1.0,
            Kind::Constant(sky) => sky.power_factor(),
            Kind::Directional(sun) => sun.power_factor(),
            Kind::Environment(sky) => sky.power_factor(),
        }
    }

    /// Whether light comes from a single point or direction, which rays cannot hit.
    #[must_use]
    pub const fn is_delta(&self) -> bool {
        self.is_point() || matches!(self.kind, Kind::Directional(_))
    }

    /// Whether light comes from a single point.
    const fn is_point(&self) -> bool {
        matches!(self.kind, Kind::Point(_) | Kind::Spot(_) | Kind::Beam(_) | Kind::Goniometric(_))
    }

    /// Whether light comes from infinity, where rays that leave the scene see it.
    #[must_use]
    pub const fn is_environment(&self) -> bool {
        matches!(self.kind, Kind::Constant(_) | Kind::Environment(_))
    }

    /// Whether its light comes from infinity in parallel lines.
    pub(crate) const fn is_at_infinity(&self) -> bool {
        self.is_environment() || matches!(self.kind, Kind::Directional(_))
    }

    /// Whether it is a surface.
    #[must_use]
    pub const fn is_area(&self) -> bool {
        matches!(self.kind, Kind::Area(_))
    }

    /// Whether half of its photons are aimed at what focuses light.
    #[must_use]
    pub fn aims_at_casters(&self) -> bool {
        !self.aim.is_empty()
    }

    /// What kind it is: the name of its plugin.
    #[must_use]
    pub fn kind_name(&self) -> &'static str {
        match self.kind {
            Kind::Area(_) => emitters::AREA.name,
            Kind::Point(_) => emitters::POINT.name,
            Kind::Spot(_) => emitters::SPOT.name,
            Kind::Beam(ref beam) if beam.is_spot() => emitters::SPOT.name,
            Kind::Beam(_) => emitters::PROJECTOR.name,
            Kind::Goniometric(_) => emitters::GONIOMETRIC.name,
            Kind::Constant(_) => emitters::CONSTANT.name,
            Kind::Directional(_) => emitters::DIRECTIONAL.name,
            Kind::Environment(_) => emitters::ENVMAP.name,
        }
    }

    /// Radiance that a ray which leaves the scene along `direction` sees.
    #[must_use]
    pub fn escaped_radiance(&self, direction: Vec3) -> Rgb {
        match &self.kind {
            Kind::Constant(sky) => sky.radiance,
            Kind::Environment(sky) => sky.map.radiance(direction),
            _ => Rgb::BLACK,
        }
    }

    /// Starts a photon: a point chosen by `u_position` (and `u_part` in [0, 1) among the parts of a mesh), a direction by
    /// `u_direction`.
    #[must_use]
    pub fn emit(&self, u_part: f32, u_position: Vec2, u_direction: Vec2) -> Emission {
        self.emit_aimed(&self.aim, u_part, u_position, u_direction)
    }

    /// Whether its photons differ by `u_part`, by `u_position` and by `u_direction` of [`Emitter::emit`], aims apart.
    pub(crate) const fn uses(&self) -> (bool, bool, bool) {
        match &self.kind {
            Kind::Area(area) => (area.primitives.len() > 1, true, true),
            Kind::Point(_) | Kind::Spot(_) | Kind::Beam(_) | Kind::Goniometric(_) => (false, false, true),
            Kind::Constant(_) | Kind::Environment(_) => (false, true, true),
            Kind::Directional(_) => (false, true, false),
        }
    }

    /// The same, aimed at something else.
    pub(crate) fn emit_aimed(&self, aim: &Aim, u_part: f32, u_position: Vec2, u_direction: Vec2) -> Emission {
        match &self.kind {
            Kind::Area(area) => area.emit(aim, u_part, u_position, u_direction),
            Kind::Point(point) => point.emit(aim, u_direction),
            Kind::Spot(spot) => spot.emit(aim, u_direction),
            Kind::Beam(beam) => beam.emit(aim, u_direction),
            Kind::Goniometric(lamp) => lamp.emit(aim, u_direction),
            Kind::Constant(sky) => sky.emit(aim, u_part, u_position, u_direction),
            Kind::Directional(sun) => sun.emit(aim, u_part, u_position),
            Kind::Environment(sky) => sky.emit(aim, u_part, u_position, u_direction),
        }
    }

    /// Starts a photon such that `u_direction` alone decides its direction; `None` where [`Emitter::emit`] does so anyway, or for shapes
    /// that have no such way.
    pub(crate) fn emit_by_direction(&self, u_position: Vec2, u_direction: Vec2) -> Option<Emission> {
        let Kind::Area(area) = &self.kind else { return None };
        area.emit_by_direction(u_position, u_direction)
    }

    /// Where it lies; `None` if that is infinitely far away.
    #[must_use]
    pub fn extent(&self) -> Option<Extent> {
        match &self.kind {
            Kind::Area(area) => Some(area.extent()),
            Kind::Point(point) => Some(point.extent()),
            Kind::Spot(spot) => Some(spot.extent()),
            Kind::Beam(beam) => Some(beam.extent()),
            Kind::Goniometric(lamp) => Some(lamp.extent()),
            Kind::Constant(_) | Kind::Directional(_) | Kind::Environment(_) => None,
        }
    }

    /// Light from a random point of the emitter at `position` on a surface with the unit `normal`, to which an environment
    /// is sampled by the cosine. `None` where the emitter does not shine.
    #[must_use]
    pub fn illuminate(&self, position: Vec3, normal: Vec3, u_part: f32, u: Vec2) -> Option<Illumination> {
        match &self.kind {
            Kind::Area(area) => area.illuminate(position, u_part, u),
            Kind::Point(point) => point.illuminate(position),
            Kind::Spot(spot) => spot.illuminate(position),
            Kind::Beam(beam) => beam.illuminate(position),
            Kind::Goniometric(lamp) => lamp.illuminate(position),
            Kind::Constant(sky) => sky.illuminate(normal, u),
            Kind::Directional(sun) => Some(sun.illuminate()),
            Kind::Environment(sky) => sky.illuminate(u),
        }
    }

    /// The pdf (sr⁻¹) with which [`Emitter::illuminate`] chooses the direction from `position` to this point of its surface; 0 if it
    /// is no surface, or seen from behind.
    #[must_use]
    pub fn pdf_of_point(&self, point: &Surface, position: Vec3) -> f32 {
        match &self.kind {
            Kind::Area(area) => area.pdf(point, position),
            _ => 0.0,
        }
    }

    /// The pdf (sr⁻¹) with which [`Emitter::illuminate`] chooses the unit `direction` towards it, where its light comes from infinity
    /// by any direction; 0 otherwise.
    #[must_use]
    pub fn pdf_of_direction(&self, normal: Vec3, direction: Vec3) -> f32 {
        match &self.kind {
            Kind::Constant(sky) => sky.pdf(normal, direction),
            Kind::Environment(sky) => sky.pdf(direction),
            _ => 0.0,
        }
    }
}
