//! A point whose light comes through a picture: a projector, and a spot with a texture.
//!
//! Its directions are the image of the unit square: of the plane that a projector throws its picture on, or of a spot's cone. The square is
//! divided into cells about half as large as the picture's pixels; each is chosen by the mean of what its directions carry, with a small
//! share for all alike, so that no light between the points of a cell that were looked at is left out.

use std::f32::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Frame, Rgb, warp};
use rayon::prelude::*;

use super::aim::Aim;
use super::cells::Cells;
use super::emission::{Emission, Illumination, from_point};
use super::extent::Extent;
use super::spot::Cone;
use crate::attributes::Corner;
use crate::texture::{At, Sampler};

/// Cells of one emitter, at most.
const MAX_CELLS: f32 = (1 << 18) as f32;

/// Cells along a side at least: what fades with the angle does so in steps.
const FEWEST: f32 = 16.0;

/// Points along a side of a cell whose mean counts.
const POINTS: usize = 3;

/// The share of the probability that all cells have alike.
const DEFENSIVE_SHARE: f64 = 0.02;

/// Directions this far outside of the square, as a share of it, are at its edge: rounding.
const ROUNDING: f32 = 1e-5;

/// A point whose light comes through a picture.
#[derive(Clone, Debug)]
pub(crate) struct Beam {
    pub(crate) position: Vec3,
    /// Its axes in the scene: light goes along the normal.
    frame: Frame,
    picture: Picture,
    light: Light,
    cells: Cells,
    /// ∫ I dω per channel, and the largest luminance of I that was met.
    total: Rgb,
    brightest: f32,
}

/// What light comes through.
#[derive(Clone, Debug)]
pub(crate) enum Picture {
    /// The same everywhere.
    Even,
    /// A texture.
    Texture(Arc<Sampler>),
}

/// How a picture becomes radiant intensity.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Light {
    /// The picture lies on the plane at distance 1, with `half` its width and height around the axis; its irradiance there is that of the
    /// picture times `factor`.
    Projected { half: Vec2, factor: Rgb },
    /// The picture colours a cone's light.
    Coloured { cone: Cone, intensity: Rgb },
}

impl Picture {
    /// Its width and height in pixels; a square where it has none.
    pub(crate) fn shape(&self) -> [f64; 2] {
        match self {
            Self::Even => [1.0; 2],
            Self::Texture(sampler) => sampler.shape(),
        }
    }
}

impl Beam {
    pub(crate) fn new(position: Vec3, frame: Frame, picture: Picture, light: Light) -> Self {
        let mut beam = Self {
            position,
            frame,
            picture,
            light,
            cells: Cells::default(),
            total: Rgb::BLACK,
            brightest: 0.0,
        };
        let (width, height) = beam.fineness();
        let rows: Vec<Vec<([f64; 3], f32)>> = (0..height)
            .into_par_iter()
            .map(|y| (0..width).map(|x| beam.mean([x, y], [width, height])).collect())
            .collect();
        let mut total = [0.0; 3];
        for (cell, brightest) in rows.iter().flatten() {
            total.iter_mut().zip(cell).for_each(|(sum, c)| *sum += c / (width * height) as f64);
            beam.brightest = beam.brightest.max(*brightest);
        }
        let even = DEFENSIVE_SHARE * total.iter().sum::<f64>();
        let weight = |(cell, _): &([f64; 3], f32)| cell.iter().sum::<f64>() + even;
        beam.cells = Cells::new(rows.iter().map(|row| row.iter().map(weight).collect()).collect());
        beam.total = Rgb::from_array(total.map(|c| c as f32));
        beam
    }

    /// Columns and rows of cells.
    fn fineness(&self) -> (usize, usize) {
        let detail = match &self.picture {
            Picture::Even => Vec2::ZERO,
            Picture::Texture(sampler) => sampler.detail().unwrap_or_default(),
        };
        let wanted = match self.light {
            // Two to a pixel: between the middles of pixels colours rise or fall.
            Light::Projected { .. } => 2.0 * detail,
            // The radius and the circumference of a cone.
            Light::Coloured { .. } => detail.max_element() * Vec2::new(1.0, 6.0),
        };
        let wanted = wanted.clamp(Vec2::splat(FEWEST), Vec2::splat(MAX_CELLS));
        let fits = (MAX_CELLS / wanted.element_product()).sqrt().min(1.0);
        let [x, y] = (wanted * fits).max(Vec2::ONE).to_array().map(|c| c as usize);
        (x, y)
    }

    /// The mean over a cell of what directions carry, by area of the square, and the largest luminance of intensities.
    fn mean(&self, [x, y]: [usize; 2], [width, height]: [usize; 2]) -> ([f64; 3], f32) {
        let (mut sum, mut brightest) = ([0.0; 3], 0f32);
        for i in 0..POINTS * POINTS {
            let at = |cell: usize, i: usize, count: usize| {
                ((cell * POINTS + i) as f32 + 0.5) / (count * POINTS) as f32
            };
            let place = Vec2::new(at(x, i % POINTS, width), at(y, i / POINTS, height));
            let direction = self.light.direction(place);
            let intensity = self.intensity_along(direction);
            brightest = brightest.max(intensity.luminance());
            let carried = (intensity * self.light.solid_angle(direction)).to_array();
            sum.iter_mut().zip(carried).for_each(|(sum, c)| *sum += f64::from(c));
        }
        (sum.map(|c| c / (POINTS * POINTS) as f64), brightest)
    }

    /// Radiant intensity along a unit vector of its own space.
    fn intensity_along(&self, local: Vec3) -> Rgb {
        let (uv, intensity) = match &self.light {
            Light::Projected { half, factor } => {
                let Some(uv) = projected(local, *half).filter(|uv| is_in_square(*uv, 0.0)) else {
                    return Rgb::BLACK;
                };
                // E cos θ of the plane is I cos³ θ.
                (uv, *factor / local.z.powi(3))
            }
            Light::Coloured { cone, intensity } => {
                let falloff = cone.falloff(local);
                if falloff == 0.0 {
                    return Rgb::BLACK;
                }
                let uv = local.truncate() / (local.z * cone.cutoff.tan());
                let uv = Vec2::splat(0.5) + 0.5 * uv;
                (if uv.is_finite() { uv } else { Vec2::splat(0.5) }, *intensity * falloff)
            }
        };
        match &self.picture {
            Picture::Even => intensity,
            Picture::Texture(sampler) => {
                let corner = Corner::default();
                intensity * sampler.colour(&At { uv, corner })
            }
        }
    }

    /// Radiant intensity along a unit direction of the scene.
    pub(crate) fn intensity(&self, direction: Vec3) -> Rgb {
        self.intensity_along(self.frame.to_local(direction))
    }

    /// ∫ I dω per channel.
    pub(crate) const fn total(&self) -> Rgb {
        self.total
    }

    /// The largest angle to its axis at which it shines, in radians.
    pub(crate) fn reach(&self) -> f32 {
        match self.light {
            Light::Projected { half, .. } => half.length().atan(),
            Light::Coloured { cone, .. } => cone.cutoff,
        }
    }

    /// Whether it is a spot and not a projector.
    pub(super) const fn is_spot(&self) -> bool {
        matches!(self.light, Light::Coloured { .. })
    }

    pub(super) fn emit(&self, aim: &Aim, u: Vec2) -> Emission {
        let density = |local: Vec3, place: Vec2| {
            self.cells.density(place) as f32 / self.light.solid_angle(local).max(f32::MIN_POSITIVE)
        };
        let (direction, pdf) = if aim.is_empty() {
            let place = self.cells.sample(u);
            let local = self.light.direction(place);
            (self.frame.to_outer(local), density(local, place))
        } else {
            let own = |u| self.frame.to_outer(self.light.direction(self.cells.sample(u)));
            aim.divergent(self.position, u, own, |direction| {
                let local = self.frame.to_local(direction);
                self.light.place(local).map_or(0.0, |place| density(local, place))
            })
        };
        let intensity = self.intensity(direction);
        let power = if pdf > 0.0 { intensity / pdf } else { Rgb::BLACK };
        Emission { origin: self.position, direction, power }
    }

    pub(super) fn extent(&self) -> Extent {
        let reach = self.reach();
        Extent {
            axis: self.frame.normal,
            normals: (reach - FRAC_PI_2).max(0.0),
            reach: reach.min(FRAC_PI_2),
            ..Extent::of_point(self.position, self.brightest)
        }
    }

    pub(super) fn illuminate(&self, position: Vec3) -> Option<Illumination> {
        let direction = (position - self.position).try_normalize()?;
        from_point(self.position, position, self.intensity(direction))
    }
}

impl Light {
    /// The unit vector that a point of the unit square stands for.
    fn direction(&self, at: Vec2) -> Vec3 {
        match self {
            Self::Projected { half, .. } => (*half * (1.0 - 2.0 * at)).extend(1.0).normalize(),
            Self::Coloured { cone, .. } => warp::square_to_cone(at, cone.one_minus_cos()),
        }
    }

    /// The point of the unit square that stands for a unit vector; `None` outside.
    fn place(&self, local: Vec3) -> Option<Vec2> {
        let at = match self {
            Self::Projected { half, .. } => projected(local, *half)?,
            Self::Coloured { cone, .. } => {
                // 1 − cos of the angle to the axis, by a form that does not cancel.
                let h = 0.5 * (local - Vec3::Z).length_squared();
                let turn = local.y.atan2(local.x) / (2.0 * PI);
                Vec2::new(h / cone.one_minus_cos(), turn - turn.floor())
            }
        };
        is_in_square(at, ROUNDING).then(|| at.clamp(Vec2::ZERO, Vec2::splat(1.0 - f32::EPSILON)))
    }

    /// The solid angle that the square has there, by its area.
    fn solid_angle(&self, local: Vec3) -> f32 {
        match self {
            Self::Projected { half, .. } => 4.0 * half.x * half.y * local.z.powi(3),
            Self::Coloured { cone, .. } => 1.0 / warp::square_to_cone_pdf(cone.one_minus_cos()),
        }
    }
}

/// Where a direction meets the plane at distance 1, on which the unit square has `half` its width and height to each side: from the
/// picture's left, which is towards +x, and from its top.
fn projected(local: Vec3, half: Vec2) -> Option<Vec2> {
    (local.z > 0.0).then(|| 0.5 - 0.5 * local.truncate() / (local.z * half))
}

fn is_in_square(at: Vec2, tolerance: f32) -> bool {
    at.cmpge(Vec2::splat(-tolerance)).all() && at.cmple(Vec2::splat(1.0 + tolerance)).all()
}
