//! Emitters: where photons start, and what a point receives without anything in between.
//!
//! Powers and radiances are per channel. Lengths are scene units, so radiant intensity carries the square of the scale.

use std::f32::consts::PI;

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Frame, Rgb, warp};

use crate::environment::Environment;

mod aim;
mod area;
#[cfg(test)]
mod tests;

pub(crate) use aim::{Aim, Ball, Target};
pub(crate) use area::Area;

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
    Point { position: Vec3, intensity: Rgb },
    Spot(Spot),
    Constant { radiance: Rgb, scene: Ball },
    Directional { direction: Vec3, irradiance: Rgb, scene: Ball },
    Environment { map: Box<Environment>, scene: Ball },
}

/// A point emitter with a cone.
#[derive(Clone, Debug)]
pub(crate) struct Spot {
    pub(crate) position: Vec3,
    pub(crate) frame: Frame,
    pub(crate) intensity: Rgb,
    /// Half angles in radians.
    pub(crate) cutoff: f32,
    pub(crate) beam: f32,
}

/// The start of a photon path.
#[derive(Clone, Copy, Debug)]
pub struct Emission {
    /// Where the photon starts, off the emitting surface.
    pub origin: Vec3,
    /// Unit direction.
    pub direction: Vec3,
    /// The emitter's power, as this one photon would carry it were it the only one emitted.
    pub power: Rgb,
}

/// Light that arrives at a point from one sampled point of an emitter, unless something is in between.
#[derive(Clone, Copy, Debug)]
pub struct Illumination {
    /// Unit direction towards the emitter.
    pub direction: Vec3,
    /// Distance to the sampled point; infinite for emitters at infinity.
    pub distance: f32,
    /// Radiance over the density per solid angle; for point emitters intensity over squared distance.
    /// Times `f cos θ` it estimates the reflected radiance.
    pub radiance_over_pdf: Rgb,
    /// The density of the direction (sr⁻¹); infinite where the emitter has no extent.
    pub density: f32,
}

impl Emitter {
    /// Power per channel (W).
    #[must_use]
    pub fn power(&self) -> Rgb {
        let emission = match &self.kind {
            Kind::Area(a) => a.radiance,
            Kind::Point { intensity, .. } => *intensity,
            Kind::Spot(s) => s.intensity,
            Kind::Constant { radiance, .. } => *radiance,
            Kind::Directional { irradiance, .. } => *irradiance,
            Kind::Environment { map, .. } => map.total(),
        };
        emission * self.power_factor()
    }

    /// Its power for each unit of what it emits; for a map, of its integral.
    pub(crate) fn power_factor(&self) -> f32 {
        match &self.kind {
            Kind::Area(a) => PI * a.area,
            Kind::Point { .. } => 4.0 * PI,
            Kind::Spot(s) => s.power_factor(),
            Kind::Constant { scene, .. } => 4.0 * PI * scene.cross_section(),
            Kind::Directional { scene, .. } | Kind::Environment { scene, .. } => scene.cross_section(),
        }
    }

    /// Whether light comes from a single point or direction, which rays cannot hit.
    #[must_use]
    pub const fn is_delta(&self) -> bool {
        matches!(self.kind, Kind::Point { .. } | Kind::Spot(_) | Kind::Directional { .. })
    }

    /// Whether light comes from infinity, where rays that leave the scene see it.
    #[must_use]
    pub const fn is_environment(&self) -> bool {
        matches!(self.kind, Kind::Constant { .. } | Kind::Environment { .. })
    }

    /// Whether its light comes from infinity in parallel lines.
    pub(crate) const fn is_at_infinity(&self) -> bool {
        self.is_environment() || matches!(self.kind, Kind::Directional { .. })
    }

    /// Whether half of its photons are aimed at what focuses light.
    #[must_use]
    pub fn aims_at_casters(&self) -> bool {
        !self.aim.is_empty()
    }

    /// What kind it is, in a word.
    #[must_use]
    pub const fn kind_name(&self) -> &'static str {
        match self.kind {
            Kind::Area(_) => "area",
            Kind::Point { .. } => "point",
            Kind::Spot(_) => "spot",
            Kind::Constant { .. } => "constant",
            Kind::Directional { .. } => "directional",
            Kind::Environment { .. } => "envmap",
        }
    }

    /// Radiance that a ray which leaves the scene along `direction` sees.
    #[must_use]
    pub fn escaped_radiance(&self, direction: Vec3) -> Rgb {
        match &self.kind {
            Kind::Constant { radiance, .. } => *radiance,
            Kind::Environment { map, .. } => map.radiance(direction),
            _ => Rgb::BLACK,
        }
    }

    /// Starts a photon: a point chosen by `u_position` (and `u_part` in [0, 1) among the parts of a mesh), a direction by
    /// `u_direction`.
    #[must_use]
    pub fn emit(&self, u_part: f32, u_position: Vec2, u_direction: Vec2) -> Emission {
        self.emit_aimed(&self.aim, u_part, u_position, u_direction)
    }

    /// The same, aimed at something else.
    pub(crate) fn emit_aimed(&self, aim: &Aim, u_part: f32, u_position: Vec2, u_direction: Vec2) -> Emission {
        match &self.kind {
            Kind::Area(a) => {
                let surface = a.sample(u_part, u_position);
                let frame = Frame::from_normal(surface.normal);
                let own = |u| frame.to_outer(warp::square_to_cosine_hemisphere(u));
                let origin = surface.ray_origin(surface.normal);
                if aim.is_empty() {
                    return Emission {
                        origin,
                        direction: own(u_direction),
                        power: a.radiance * (PI * a.area),
                    };
                }
                let cosine = |direction: Vec3| direction.dot(surface.normal).max(0.0);
                let (direction, pdf) =
                    aim.divergent(origin, u_direction, own, |direction| cosine(direction) / PI);
                Emission { origin, direction, power: a.radiance * (a.area * cosine(direction) / pdf) }
            }
            Kind::Point { position, intensity } => {
                if aim.is_empty() {
                    let direction = warp::square_to_sphere(u_direction);
                    return Emission { origin: *position, direction, power: *intensity * (4.0 * PI) };
                }
                let uniform = |_| warp::square_to_sphere_pdf();
                let (direction, pdf) = aim.divergent(*position, u_direction, warp::square_to_sphere, uniform);
                Emission { origin: *position, direction, power: *intensity / pdf }
            }
            Kind::Spot(s) => s.emit(aim, u_direction),
            Kind::Constant { radiance, scene } => {
                let direction = warp::square_to_sphere(u_direction);
                let (origin, pdf) = aim.parallel(scene, direction, u_part, u_position);
                Emission { origin, direction, power: *radiance / (pdf * warp::square_to_sphere_pdf()) }
            }
            Kind::Directional { direction, irradiance, scene } => {
                let (origin, pdf) = aim.parallel(scene, *direction, u_part, u_position);
                Emission { origin, direction: *direction, power: *irradiance / pdf }
            }
            Kind::Environment { map, scene } => {
                let Some(sample) = map.sample(u_direction) else {
                    return Emission { origin: scene.centre, direction: Vec3::Z, power: Rgb::BLACK };
                };
                let direction = -sample.direction;
                let (origin, pdf) = aim.parallel(scene, direction, u_part, u_position);
                Emission { origin, direction, power: sample.radiance / (pdf * sample.pdf) }
            }
        }
    }

    /// Whether it is a surface.
    #[must_use]
    pub const fn is_area(&self) -> bool {
        matches!(self.kind, Kind::Area(_))
    }

    /// Light from a random point of the emitter at `position` on a surface with the unit `normal`, to which an environment
    /// is sampled by the cosine. `None` where the emitter does not shine.
    #[must_use]
    pub fn illuminate(&self, position: Vec3, normal: Vec3, u_part: f32, u: Vec2) -> Option<Illumination> {
        match &self.kind {
            Kind::Area(a) => a.illuminate(position, u_part, u),
            Kind::Point { position: p, intensity } => from_point(*p, position, *intensity),
            Kind::Spot(s) => {
                let direction = (position - s.position).try_normalize()?;
                from_point(s.position, position, s.intensity * s.falloff(direction))
            }
            Kind::Constant { radiance, .. } => {
                let local = warp::square_to_cosine_hemisphere(u);
                let pdf = warp::square_to_cosine_hemisphere_pdf(local);
                let direction = Frame::from_normal(normal).to_outer(local);
                (pdf > 0.0).then(|| from_infinity(direction, *radiance / pdf, pdf))
            }
            Kind::Directional { direction, irradiance, .. } => {
                Some(from_infinity(-*direction, *irradiance, f32::INFINITY))
            }
            Kind::Environment { map, .. } => {
                map.sample(u).map(|s| from_infinity(s.direction, s.radiance / s.pdf, s.pdf))
            }
        }
    }
}

const fn from_infinity(direction: Vec3, radiance_over_pdf: Rgb, density: f32) -> Illumination {
    Illumination { direction, distance: f32::INFINITY, radiance_over_pdf, density }
}

fn from_point(emitter: Vec3, position: Vec3, intensity: Rgb) -> Option<Illumination> {
    let d = emitter - position;
    let distance2 = d.length_squared();
    (distance2 > 0.0 && !intensity.is_black()).then(|| Illumination {
        direction: d / distance2.sqrt(),
        distance: distance2.sqrt(),
        radiance_over_pdf: intensity / distance2,
        density: f32::INFINITY,
    })
}

impl Spot {
    /// Relative intensity: 1 inside the beam, falling linearly with the angle to 0 at the cutoff, as in Mitsuba 3.
    pub(crate) fn falloff(&self, direction: Vec3) -> f32 {
        let local = self.frame.to_local(direction);
        let angle = local.x.hypot(local.y).atan2(local.z);
        if angle >= self.cutoff {
            0.0
        } else if angle <= self.beam {
            1.0
        } else {
            (self.cutoff - angle) / (self.cutoff - self.beam)
        }
    }

    /// 1 − cos of the cutoff, by a form that does not cancel for a narrow beam.
    fn one_minus_cos(&self) -> f32 {
        2.0 * (self.cutoff * 0.5).sin().powi(2)
    }

    fn emit(&self, aim: &Aim, u: Vec2) -> Emission {
        let own = |u| self.frame.to_outer(warp::square_to_cone(u, self.one_minus_cos()));
        let uniform = warp::square_to_cone_pdf(self.one_minus_cos());
        let (direction, pdf) = if aim.is_empty() {
            (own(u), uniform)
        } else {
            aim.divergent(self.position, u, own, |d| if self.falloff(d) > 0.0 { uniform } else { 0.0 })
        };
        Emission { origin: self.position, direction, power: self.intensity * (self.falloff(direction) / pdf) }
    }

    /// ∫ I dω / I = 2π (1 − cos b + ∫_b^c (c − θ)/(c − b) sin θ dθ), and the integral is cos b − (sin c − sin b)/(c − b).
    fn power_factor(&self) -> f32 {
        let (c, b) = (f64::from(self.cutoff), f64::from(self.beam));
        let fade = if c > b { b.cos() - (c.sin() - b.sin()) / (c - b) } else { 0.0 };
        (2.0 * std::f64::consts::PI * (1.0 - b.cos() + fade)) as f32
    }
}
