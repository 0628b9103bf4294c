//! Surfaces that emit: a point on them, and what another point receives from one.

use std::f32::consts::PI;

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Aabb, Frame, Rgb, warp};

use super::aim::{Aim, one_minus_cos_of_cone};
use super::emission::{Emission, Illumination};
use super::extent::Extent;
use super::pattern::Pattern;
use super::place::Place;
use super::rectangle::Rectangle;
use crate::discrete::Discrete;
use crate::plane::Plane;
use crate::primitive::Primitive;
use crate::surface::{Surface, locate};

/// A surface that emits on the side its normal points to.
#[derive(Clone, Debug)]
pub(crate) struct Area {
    /// Its mean over the surface, where it is not the same everywhere.
    pub(crate) radiance: Rgb,
    /// The texture that it comes from, if it does.
    pub(crate) pattern: Option<Box<Pattern>>,
    pub(crate) primitives: Vec<Primitive>,
    /// Those of triangles; whatever for other primitives.
    planes: Vec<Plane>,
    rectangle: Option<Rectangle>,
    pub(crate) by_area: Discrete,
    pub(crate) area: f32,
    pub(crate) shape: u32,
    /// How far from it another surface may lie that counts as the same: photons start beyond.
    pub(crate) gap: f32,
}

/// A point that was chosen on an emitter.
struct Sample {
    surface: Surface,
    radiance: Rgb,
    /// One over its density by area: all of the area where that is the same everywhere.
    area: f32,
}

impl Area {
    /// A shape's surface that emits.
    pub(crate) fn new(shape: u32, radiance: Rgb, primitives: &[Primitive]) -> Self {
        let areas = || primitives.iter().map(Primitive::area);
        Self {
            radiance,
            pattern: None,
            primitives: primitives.to_vec(),
            planes: primitives.iter().map(Primitive::plane).collect(),
            rectangle: Rectangle::of(primitives),
            by_area: Discrete::new(areas().map(f64::from)),
            area: areas().sum(),
            shape,
            gap: 0.0,
        }
    }

    /// Makes its radiance that of a texture.
    pub(crate) fn set_pattern(&mut self, pattern: Pattern) {
        self.radiance = pattern.mean();
        // Points go by the texture, not by the solid angle.
        self.rectangle = None;
        self.pattern = Some(Box::new(pattern));
    }

    /// A point, uniform by area or in proportion to the radiance there.
    fn sample(&self, u_part: f32, u: Vec2) -> Sample {
        let place = |part: usize, u| Place::on(&self.primitives[part], &self.planes[part], u);
        let sampled = self.pattern.as_ref().and_then(|p| Some((p, p.sample(u_part, u)?)));
        let Some((pattern, (part, u, density))) = sampled else {
            let part = self.by_area.choose(f64::from(u_part));
            let surface = self.surface(&place(part, u));
            return Sample { surface, radiance: self.radiance, area: self.area };
        };
        let place = place(part, u);
        let radiance = pattern.radiance(part, &self.primitives[part], &place);
        Sample { surface: self.surface(&place), radiance, area: 1.0 / density }
    }

    /// With its error bound and normal.
    fn surface(&self, &Place { position, error, normal, barycentric }: &Place) -> Surface {
        Surface {
            position,
            error: error + normal.abs() * self.gap,
            normal,
            shading_normal: normal,
            curved: false,
            shape: self.shape,
            patch: 0,
            primitive: 0,
            barycentric,
            interface: None,
            is_relieved: false,
            component: 0,
        }
    }

    pub(super) fn extent(&self) -> Extent {
        Extent::of_surfaces(&self.primitives, self.radiance.luminance())
    }

    /// The middle of the box around it.
    pub(crate) fn middle(&self) -> Vec3 {
        self.primitives.iter().fold(Aabb::EMPTY, |b, p| b.union(p.bounds())).centre()
    }

    pub(super) fn power_factor(&self) -> f32 {
        PI * self.area
    }

    pub(super) fn emit(&self, aim: &Aim, u_part: f32, u_position: Vec2, u_direction: Vec2) -> Emission {
        let Sample { surface, radiance, area } = self.sample(u_part, u_position);
        let frame = Frame::from_normal(surface.normal);
        let own = |u| frame.to_outer(warp::square_to_cosine_hemisphere(u));
        let origin = surface.ray_origin(surface.normal);
        if aim.is_empty() {
            return Emission { origin, direction: own(u_direction), power: radiance * (PI * area) };
        }
        let cosine = |direction: Vec3| direction.dot(surface.normal).max(0.0);
        let (direction, pdf) = aim.divergent(origin, u_direction, own, |direction| cosine(direction) / PI);
        Emission { origin, direction, power: radiance * (area * cosine(direction) / pdf) }
    }

    /// As [`Area::emit`] for a sphere, but such that `u_direction` alone decides the direction: light of a sphere is the same in all
    /// directions, and in each it fills a disc. `None` for other shapes, and where a point's radiance is not that of all.
    pub(super) fn emit_by_direction(&self, u_position: Vec2, u_direction: Vec2) -> Option<Emission> {
        if self.pattern.is_some() {
            return None;
        }
        let [primitive @ Primitive::Sphere { centre, radius, inward: false }] = &self.primitives[..] else {
            return None;
        };
        let direction = warp::square_to_sphere(u_direction);
        let disc = warp::square_to_disc(u_position);
        let towards = disc.extend((1.0 - disc.length_squared()).max(0.0).sqrt());
        let outward = Frame::from_normal(direction).to_outer(towards);
        let (position, error, normal) = locate(primitive, Vec2::ZERO, *centre + outward * *radius);
        let surface = self.surface(&Place { position, error, normal, barycentric: Vec2::ZERO });
        let origin = surface.ray_origin(surface.normal);
        Some(Emission { origin, direction, power: self.radiance * self.power_factor() })
    }

    pub(super) fn illuminate(&self, position: Vec3, u_part: f32, u: Vec2) -> Option<Illumination> {
        if let [Primitive::Sphere { centre, radius, inward: false }] = self.primitives[..]
            && self.pattern.is_none()
            && let Some(seen) = self.illuminate_from_sphere(centre, radius, position, u)
        {
            return Some(seen);
        }
        if let Some(seen) = self.rectangle.as_ref().and_then(|rectangle| rectangle.seen_from(position)) {
            let (direction, distance) = seen.sample(u);
            let radiance_over_pdf = self.radiance * seen.solid_angle();
            return Some(Illumination {
                direction,
                distance,
                radiance_over_pdf,
                pdf: 1.0 / seen.solid_angle(),
            });
        }
        let Sample { surface, radiance, area } = self.sample(u_part, u);
        let d = surface.position - position;
        let distance2 = d.length_squared();
        let direction = d / distance2.sqrt();
        let cosine = -direction.dot(surface.normal);
        (cosine > 0.0 && distance2 > 0.0).then(|| Illumination {
            direction,
            distance: distance2.sqrt(),
            radiance_over_pdf: radiance * (cosine * area / distance2),
            pdf: distance2 / (cosine * area),
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
        let one_minus_cos = one_minus_cos_of_cone(radius, distance)?;
        let local = warp::square_to_cone(u, one_minus_cos);
        // Nearer root of |t·local − (0, 0, distance)| = radius; a grazing direction may round to none.
        let discriminant = radius * radius - distance * distance * (local.x * local.x + local.y * local.y);
        Some(Illumination {
            direction: Frame::from_normal(d / distance).to_outer(local),
            distance: distance * local.z - discriminant.max(0.0).sqrt(),
            radiance_over_pdf: self.radiance / warp::square_to_cone_pdf(one_minus_cos),
            pdf: warp::square_to_cone_pdf(one_minus_cos),
        })
    }

    /// The pdf (sr⁻¹) with which [`Area::illuminate`] chooses the direction from `position` to a point of this surface;
    /// 0 where that is seen from behind.
    pub(crate) fn pdf(&self, point: &Surface, position: Vec3) -> f32 {
        if let [Primitive::Sphere { centre, radius, inward: false }] = self.primitives[..]
            && self.pattern.is_none()
            && let Some(one_minus_cos) = one_minus_cos_of_cone(radius, centre.distance(position))
        {
            return warp::square_to_cone_pdf(one_minus_cos);
        }
        if let Some(seen) = self.rectangle.as_ref().and_then(|rectangle| rectangle.seen_from(position)) {
            return 1.0 / seen.solid_angle();
        }
        let d = point.position - position;
        let distance2 = d.length_squared();
        let cosine = -d.dot(point.normal) / distance2.sqrt();
        if !(cosine > 0.0 && distance2 > 0.0) {
            return 0.0;
        }
        match &self.pattern {
            Some(pattern) => {
                let Surface { position, error, normal, barycentric, primitive, .. } = *point;
                let place = Place { position, error, normal, barycentric };
                distance2 / cosine * pattern.density_at(&self.primitives, primitive, &place)
            }
            None => distance2 / (cosine * self.area),
        }
    }
}
