//! Emitters: where photons start, and what a point receives without anything in between.
//!
//! Powers and radiances are per channel. Lengths are scene units, so radiant intensity carries the square of the scale.

use std::f32::consts::PI;

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Frame, Rgb, warp};

use crate::discrete::Discrete;
use crate::environment::Environment;
use crate::primitive::Primitive;
use crate::surface::{Surface, locate};

/// An emitter in scene units.
#[derive(Clone, Debug)]
pub struct Emitter {
    /// The name in the scene file: that of the shape for an area emitter.
    pub name: String,
    /// What it emits.
    pub(crate) kind: Kind,
}

#[derive(Clone, Debug)]
pub(crate) enum Kind {
    Area(Area),
    Point { position: Vec3, intensity: Rgb },
    Spot(Spot),
    Constant { radiance: Rgb, reach: Reach },
    Directional { direction: Vec3, irradiance: Rgb, reach: Reach },
    Environment { map: Box<Environment>, reach: Reach },
}

/// Where photons from infinity are aimed at: the whole scene, and apart from it what focuses light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reach {
    pub(crate) scene: Ball,
    /// Around all surfaces that reflect or refract into single directions, if they take up clearly less than the scene.
    pub(crate) casters: Option<Ball>,
}

/// A ball that parallel light is aimed at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    pub(crate) centre: Vec3,
    pub(crate) radius: f32,
}

/// A surface that emits on the side its normal points to.
#[derive(Clone, Debug)]
pub(crate) struct Area {
    pub(crate) radiance: Rgb,
    pub(crate) primitives: Vec<Primitive>,
    pub(crate) by_area: Discrete,
    pub(crate) area: f32,
    pub(crate) shape: u32,
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
}

impl Emitter {
    /// Power per channel (W).
    #[must_use]
    pub fn power(&self) -> Rgb {
        match &self.kind {
            Kind::Area(a) => a.radiance * (PI * a.area),
            Kind::Point { intensity, .. } => *intensity * (4.0 * PI),
            Kind::Spot(s) => s.power(),
            Kind::Constant { radiance, reach } => *radiance * (4.0 * PI * reach.scene.cross_section()),
            Kind::Directional { irradiance, reach, .. } => *irradiance * reach.scene.cross_section(),
            Kind::Environment { map, reach } => map.total() * reach.scene.cross_section(),
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

    /// Whether half of its photons are aimed at what focuses light.
    #[must_use]
    pub const fn aims_at_casters(&self) -> bool {
        match &self.kind {
            Kind::Constant { reach, .. } | Kind::Directional { reach, .. } | Kind::Environment { reach, .. } => {
                reach.casters.is_some()
            }
            _ => false,
        }
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
        match &self.kind {
            Kind::Area(a) => {
                let surface = a.sample(u_part, u_position);
                let local = warp::square_to_cosine_hemisphere(u_direction);
                let direction = Frame::from_normal(surface.normal).to_outer(local);
                Emission {
                    origin: surface.ray_origin(surface.normal),
                    direction,
                    power: a.radiance * (PI * a.area),
                }
            }
            Kind::Point { position, intensity } => Emission {
                origin: *position,
                direction: warp::square_to_sphere(u_direction),
                power: *intensity * (4.0 * PI),
            },
            Kind::Spot(s) => s.emit(u_direction),
            Kind::Constant { radiance, reach } => {
                let direction = warp::square_to_sphere(u_direction);
                let (origin, pdf) = reach.aim(direction, u_part, u_position);
                Emission { origin, direction, power: *radiance / (pdf * warp::square_to_sphere_pdf()) }
            }
            Kind::Directional { direction, irradiance, reach } => {
                let (origin, pdf) = reach.aim(*direction, u_part, u_position);
                Emission { origin, direction: *direction, power: *irradiance / pdf }
            }
            Kind::Environment { map, reach } => {
                let Some(sample) = map.sample(u_direction) else {
                    return Emission { origin: reach.scene.centre, direction: Vec3::Z, power: Rgb::BLACK };
                };
                let direction = -sample.direction;
                let (origin, pdf) = reach.aim(direction, u_part, u_position);
                Emission { origin, direction, power: sample.radiance / (pdf * sample.pdf) }
            }
        }
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
                (pdf > 0.0).then(|| from_infinity(direction, *radiance / pdf))
            }
            Kind::Directional { direction, irradiance, .. } => Some(from_infinity(-*direction, *irradiance)),
            Kind::Environment { map, .. } => {
                map.sample(u).map(|s| from_infinity(s.direction, s.radiance / s.pdf))
            }
        }
    }
}

const fn from_infinity(direction: Vec3, radiance_over_pdf: Rgb) -> Illumination {
    Illumination { direction, distance: f32::INFINITY, radiance_over_pdf }
}

fn from_point(emitter: Vec3, position: Vec3, intensity: Rgb) -> Option<Illumination> {
    let d = emitter - position;
    let distance2 = d.length_squared();
    (distance2 > 0.0 && !intensity.is_black()).then(|| Illumination {
        direction: d / distance2.sqrt(),
        distance: distance2.sqrt(),
        radiance_over_pdf: intensity / distance2,
    })
}

impl Ball {
    /// Area of its shadow.
    fn cross_section(&self) -> f32 {
        PI * self.radius * self.radius
    }

    /// Whether a line through `point` along the unit `direction` meets it.
    fn is_met(&self, point: Vec3, direction: Vec3) -> bool {
        let d = point - self.centre;
        (d - direction * d.dot(direction)).length_squared() <= self.radius * self.radius
    }
}

impl Reach {
    /// A start before the scene for parallel light along `direction`, and its density per unit area across it. Half of the
    /// light is aimed at the casters where there are any; both ways to get a line are weighed together.
    fn aim(&self, direction: Vec3, u_part: f32, u: Vec2) -> (Vec3, f32) {
        let ball = self.casters.filter(|_| u_part < 0.5).unwrap_or(self.scene);
        let disc = warp::square_to_disc(u) * ball.radius;
        let frame = Frame::from_normal(direction);
        let through = ball.centre + frame.tangent * disc.x + frame.bitangent * disc.y;
        let before = (through - self.scene.centre).dot(direction) + self.scene.radius;
        let density = |b: &Ball| if b.is_met(through, direction) { 1.0 / b.cross_section() } else { 0.0 };
        let pdf = match &self.casters {
            None => 1.0 / self.scene.cross_section(),
            Some(casters) => 0.5 * density(&self.scene) + 0.5 * density(casters),
        };
        (through - direction * before, pdf)
    }
}

impl Area {
    /// A point uniform by area.
    fn sample(&self, u_part: f32, u: Vec2) -> Surface {
        let primitive = &self.primitives[self.by_area.choose(f64::from(u_part))];
        let (position, error, normal) = match *primitive {
            Primitive::Triangle(_) => locate(primitive, warp::square_to_triangle(u), Vec3::ZERO),
            Primitive::Sphere { centre, radius, .. } => {
                locate(primitive, Vec2::ZERO, centre + warp::square_to_sphere(u) * radius)
            }
            Primitive::Disc { centre, normal, radius } => {
                let frame = Frame::from_normal(normal);
                let d = warp::square_to_disc(u) * radius;
                locate(primitive, Vec2::ZERO, centre + frame.tangent * d.x + frame.bitangent * d.y)
            }
            Primitive::Tube { from, axis, radius } => {
                let frame = Frame::from_normal(axis.normalize());
                let (sin, cos) = (2.0 * PI * u.y).sin_cos();
                let across = (frame.tangent * cos + frame.bitangent * sin) * radius.abs();
                locate(primitive, Vec2::ZERO, from + axis * u.x + across)
            }
        };
        Surface {
            position,
            error,
            normal,
            shading_normal: normal,
            curved: false,
            shape: self.shape,
            primitive: 0,
            barycentric: Vec2::ZERO,
        }
    }

    fn illuminate(&self, position: Vec3, u_part: f32, u: Vec2) -> Option<Illumination> {
        if let [Primitive::Sphere { centre, radius, inward: false }] = self.primitives[..]
            && let Some(seen) = self.illuminate_from_sphere(centre, radius, position, u)
        {
            return Some(seen);
        }
        let surface = self.sample(u_part, u);
        let d = surface.position - position;
        let distance2 = d.length_squared();
        let direction = d / distance2.sqrt();
        let cosine = -direction.dot(surface.normal);
        (cosine > 0.0 && distance2 > 0.0).then(|| Illumination {
            direction,
            distance: distance2.sqrt(),
            radiance_over_pdf: self.radiance * (cosine * self.area / distance2),
        })
    }

    /// Uniform in the cone under which the sphere is seen; `None` from inside it.
    fn illuminate_from_sphere(
        &self,
        centre: Vec3,
        radius: f32,
        position: Vec3,
        u: Vec2,
    ) -> Option<Illumination> {
        let d = centre - position;
        let distance = d.length();
        let sine = radius / distance;
        if sine >= 1.0 {
            return None;
        }
        let one_minus_cos = sine * sine / (1.0 + (1.0 - sine * sine).sqrt());
        let local = warp::square_to_cone(u, one_minus_cos);
        // Nearer root of |t·local − (0, 0, distance)| = radius; a grazing direction may round to none.
        let discriminant = radius * radius - distance * distance * (local.x * local.x + local.y * local.y);
        Some(Illumination {
            direction: Frame::from_normal(d / distance).to_outer(local),
            distance: distance * local.z - discriminant.max(0.0).sqrt(),
            radiance_over_pdf: self.radiance / warp::square_to_cone_pdf(one_minus_cos),
        })
    }
}

impl Spot {
    /// Relative intensity: 1 inside the beam, falling linearly with the angle to 0 at the cutoff, as in Mitsuba 3.
    fn falloff(&self, direction: Vec3) -> f32 {
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

    fn emit(&self, u: Vec2) -> Emission {
        let direction = self.frame.to_outer(warp::square_to_cone(u, self.one_minus_cos()));
        let pdf = warp::square_to_cone_pdf(self.one_minus_cos());
        Emission { origin: self.position, direction, power: self.intensity * (self.falloff(direction) / pdf) }
    }

    /// ∫ I dω = 2π I (1 − cos b + ∫_b^c (c − θ)/(c − b) sin θ dθ), and the integral is cos b − (sin c − sin b)/(c − b).
    fn power(&self) -> Rgb {
        let (c, b) = (f64::from(self.cutoff), f64::from(self.beam));
        let fade = if c > b { b.cos() - (c.sin() - b.sin()) / (c - b) } else { 0.0 };
        self.intensity * (2.0 * std::f64::consts::PI * (1.0 - b.cos() + fade)) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::Bitmap;
    use foton_math::glam::Mat3;
    use foton_math::{Purpose, Stream};

    fn emitter(kind: Kind) -> Emitter {
        Emitter { name: "test".into(), kind }
    }

    fn area(primitives: Vec<Primitive>) -> Emitter {
        let areas: Vec<f32> = primitives.iter().map(Primitive::area).collect();
        let by_area = Discrete::new(areas.iter().map(|&a| f64::from(a)));
        let area = areas.iter().sum();
        emitter(Kind::Area(Area { radiance: Rgb::splat(2.0), primitives, by_area, area, shape: 0 }))
    }

    fn all() -> Vec<Emitter> {
        let reach = Reach {
            scene: Ball { centre: Vec3::ZERO, radius: 10.0 },
            casters: Some(Ball { centre: Vec3::new(0.5, 0.2, 0.1), radius: 1.1 }),
        };
        let pixels = (0..32).map(|i| Rgb::splat(0.2 + 0.3 * (i % 5) as f32)).collect();
        let bitmap = Bitmap { width: 8, height: 4, pixels };
        let map = Environment::new(bitmap.into(), 1.5, Mat3::from_rotation_x(0.4));
        let square = |x: f32| Vec3::new(x, 0.0, 3.0);
        vec![
            area(vec![Primitive::Sphere { centre: Vec3::new(0.0, 0.0, 5.0), radius: 1.5, inward: false }]),
            area(vec![Primitive::Disc { centre: Vec3::new(0.5, 0.0, 4.0), normal: -Vec3::Z, radius: 1.0 }]),
            area(vec![
                Primitive::Triangle([square(0.0), square(1.0) + Vec3::Y, square(1.0)]),
                Primitive::Triangle([square(0.0), square(-3.0), square(0.0) - Vec3::Y]),
            ]),
            emitter(Kind::Point { position: Vec3::new(1.0, 0.0, 2.0), intensity: Rgb::splat(3.0) }),
            emitter(Kind::Spot(Spot {
                position: Vec3::new(0.0, 0.5, 3.0),
                frame: Frame::from_normal(Vec3::new(0.1, -0.1, -1.0).normalize()),
                intensity: Rgb::splat(4.0),
                cutoff: 0.5,
                beam: 0.3,
            })),
            emitter(Kind::Constant { radiance: Rgb::splat(0.7), reach }),
            emitter(Kind::Directional {
                direction: Vec3::new(0.3, 0.2, -0.9).normalize(),
                irradiance: Rgb::splat(2.0),
                reach,
            }),
            emitter(Kind::Environment { map: Box::new(map), reach }),
            area(vec![Primitive::Tube { from: Vec3::new(-1.0, 0.0, 3.0), axis: Vec3::X * 2.0, radius: 0.4 }]),
        ]
    }

    /// Irradiance on a disc of radius 1 at the origin facing +z, from photons and from shadow rays: two independent codes.
    #[test]
    fn photons_and_shadow_rays_bring_the_same_light_to_a_disc() {
        for emitter in all() {
            let mut stream = Stream::new(4, Purpose::Test, 0, 0);
            let n = 400_000;
            let (mut sum, mut sum2) = (0.0f64, 0.0f64);
            for _ in 0..n {
                let e = emitter.emit(stream.next_1d(), stream.next_2d(), stream.next_2d());
                let t = -e.origin.z / e.direction.z;
                let p = e.origin + e.direction * t;
                let arrives = e.direction.z < 0.0 && t > 0.0 && p.length_squared() <= 1.0;
                let x = if arrives { f64::from(e.power.g) } else { 0.0 };
                sum += x;
                sum2 += x * x;
            }
            let flux = sum / f64::from(n);
            let flux_sigma = ((sum2 / f64::from(n) - flux * flux).max(0.0) / f64::from(n)).sqrt();
            let (mut sum, mut sum2) = (0.0f64, 0.0f64);
            for _ in 0..n {
                let p = warp::square_to_disc(stream.next_2d()).extend(0.0);
                let light = emitter.illuminate(p, Vec3::Z, stream.next_1d(), stream.next_2d());
                let x = light.map_or(0.0, |i| f64::from(i.radiance_over_pdf.g * i.direction.z.max(0.0) * PI));
                sum += x;
                sum2 += x * x;
            }
            let direct = sum / f64::from(n);
            let direct_sigma = ((sum2 / f64::from(n) - direct * direct).max(0.0) / f64::from(n)).sqrt();
            let sigma = flux_sigma.hypot(direct_sigma);
            assert!(
                direct > 0.0 && (flux - direct).abs() < 4.0 * sigma,
                "{emitter:?}: {flux} {direct} ± {sigma}"
            );
        }
    }

    #[test]
    fn the_mean_photon_carries_the_emitters_power() {
        for emitter in all() {
            let mut stream = Stream::new(6, Purpose::Test, 0, 0);
            let n = 100_000;
            let sum: f64 = (0..n)
                .map(|_| {
                    f64::from(emitter.emit(stream.next_1d(), stream.next_2d(), stream.next_2d()).power.r)
                })
                .sum();
            let mean = sum / f64::from(n);
            let expected = f64::from(emitter.power().r);
            assert!((mean / expected - 1.0).abs() < 0.01, "{emitter:?}: {mean} {expected}");
        }
    }

    #[test]
    fn a_rectangle_and_a_sphere_give_the_irradiance_of_their_closed_forms() {
        // Sphere, wholly above the horizon: π L (R/d)² cos θ.
        let irradiance = |emitter: &Emitter, p: Vec3| {
            let mut stream = Stream::new(8, Purpose::Test, 0, 0);
            let n = 200_000;
            let sum: f64 = (0..n)
                .filter_map(|_| emitter.illuminate(p, Vec3::Z, stream.next_1d(), stream.next_2d()))
                .map(|i| f64::from(i.radiance_over_pdf.r * i.direction.z.max(0.0)))
                .sum();
            sum / f64::from(n)
        };
        let p = Vec3::new(2.0, 0.0, 0.0);
        let d2 = 29.0f64;
        let expected = std::f64::consts::PI * 2.0 * 2.25 / d2 * (5.0 / d2.sqrt());
        assert!((irradiance(&all()[0], p) / expected - 1.0).abs() < 2e-3);
        // Disc on its axis: π L a² / (a² + h²).
        let disc = Primitive::Disc { centre: Vec3::new(0.0, 0.0, 4.0), normal: -Vec3::Z, radius: 2.0 };
        let expected = std::f64::consts::PI * 2.0 * 4.0 / 20.0;
        assert!((irradiance(&area(vec![disc]), Vec3::ZERO) / expected - 1.0).abs() < 5e-3);
        // Rectangle: (L/2) Σ acos(vᵢ·vᵢ₊₁) n·norm(vᵢ×vᵢ₊₁).
        let corners = [(-1.0, -1.0), (-1.0, 2.0), (3.0, 2.0), (3.0, -1.0)].map(|(x, y)| Vec3::new(x, y, 2.0));
        let [a, b, c, d] = corners;
        let rectangle = area(vec![Primitive::Triangle([a, b, c]), Primitive::Triangle([a, c, d])]);
        let unit = corners.map(|v| v.as_dvec3().normalize());
        let expected: f64 = (0..4)
            .map(|i| {
                let (v, w) = (unit[i], unit[(i + 1) % 4]);
                v.dot(w).acos() * w.cross(v).normalize().z
            })
            .sum::<f64>();
        assert!((irradiance(&rectangle, Vec3::ZERO) / expected - 1.0).abs() < 5e-3, "{expected}");
    }
}
