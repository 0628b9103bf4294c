//! Radiance from a texture: what each point of a surface emits, and points chosen in proportion to that.
//!
//! Each primitive is the image of the unit square, uniform by area (`Area::place`). The square is divided into cells, up to as fine as
//! the texture; each is chosen by the mean radiance of points in it, with a small share for all alike, so that no light between those
//! points is left out. Within a cell points are uniform by area: their density is known exactly, wherever it came from.

use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{Mat3, Vec2};
use rayon::prelude::*;

use super::cells::Cells;
use super::place::Place;
use crate::attributes::Corner;
use crate::coordinates::coordinate;
use crate::discrete::Discrete;
use crate::primitive::Primitive;
use crate::texture::{At, Sampler};

/// Cells of one emitter, at most.
const MAX_CELLS: usize = 1 << 18;

/// Cells along a side of a primitive whose texture has no pixels: colours of vertices change evenly.
const EVEN: f32 = 4.0;

/// Points along a side of a cell whose mean counts.
const POINTS: (f32, f32) = (2.0, 4.0);

/// The share of the probability that goes by area alone.
const DEFENSIVE_SHARE: f64 = 0.02;

/// The texture on the primitives of an emitter.
#[derive(Clone, Debug)]
pub(crate) struct Pattern {
    pub(crate) sampler: Arc<Sampler>,
    shape: u32,
    to_object: Mat3,
    /// Texture coordinates of triangles' vertices.
    uvs: Vec<[Vec2; 3]>,
    /// Place of the first primitive in the order in which shapes state them.
    first: u32,
    /// That order, by the tree's; known when there is a tree.
    order: Arc<[u32]>,
    areas: Vec<f32>,
    parts: Discrete,
    cells: Vec<Cells>,
    /// Mean radiance over the surface.
    mean: Rgb,
}

/// A primitive as it is divided: its mean radiance, and the chance of each cell.
struct Divided {
    cells: Cells,
    mean: [f64; 3],
}

impl Pattern {
    /// `uvs` are those of the primitives, or nothing where there are none; `first` is the place of the first of them among all.
    pub(crate) fn new(
        sampler: Arc<Sampler>,
        primitives: &[Primitive],
        uvs: &[[Vec2; 3]],
        (shape, first): (u32, u32),
        to_object: Mat3,
    ) -> Self {
        let areas: Vec<f32> = primitives.iter().map(Primitive::area).collect();
        let mut pattern = Self {
            sampler,
            shape,
            to_object,
            uvs: uvs.to_vec(),
            first,
            order: Arc::default(),
            areas,
            parts: Discrete::default(),
            cells: Vec::new(),
            mean: Rgb::BLACK,
        };
        let most = ((MAX_CELLS / primitives.len().max(1)) as f32).sqrt().max(1.0);
        let (mut weights, mut sum, mut area) = (Vec::new(), [0.0; 3], 0.0);
        for (part, primitive) in primitives.iter().enumerate() {
            let Divided { cells, mean } = pattern.divide(part, primitive, most);
            let of_part = f64::from(pattern.areas[part]);
            weights.push(of_part * mean.iter().sum::<f64>());
            sum.iter_mut().zip(mean).for_each(|(sum, mean)| *sum += mean * of_part);
            area += of_part;
            pattern.cells.push(cells);
        }
        pattern.mean = Rgb::from_array(sum.map(|sum| (sum / area) as f32));
        let even: f64 = weights.iter().sum::<f64>() * DEFENSIVE_SHARE / area;
        let areas = pattern.areas.iter().map(|&a| f64::from(a) * even);
        pattern.parts = Discrete::new(weights.iter().zip(areas).map(|(w, even)| w + even));
        pattern
    }

    /// The order of primitives, once there is a tree.
    pub(crate) fn set_order(&mut self, order: &Arc<[u32]>) {
        self.order = Arc::clone(order);
    }

    pub(super) const fn mean(&self) -> Rgb {
        self.mean
    }

    /// About how many cells there are along a side of a part, and how many points along a side of a cell.
    fn fineness(&self, part: usize, primitive: &Primitive, most: f32) -> (usize, usize) {
        let pixels = self.sampler.detail().map_or(EVEN, |detail| match primitive {
            Primitive::Triangle(_) => {
                let [a, b, c] = self.uvs.get(part).copied().unwrap_or_default();
                let size = a.max(b).max(c) - a.min(b).min(c);
                (size * detail).max_element()
            }
            _ => detail.max_element(),
        });
        // Two to a pixel: between the middles of pixels radiance rises or falls.
        let cells = (2.0 * pixels).ceil().clamp(1.0, most.floor());
        let points = (3.0 * pixels / cells).ceil().clamp(POINTS.0, POINTS.1);
        (cells as usize, points as usize)
    }

    fn divide(&self, part: usize, primitive: &Primitive, most: f32) -> Divided {
        let (side, points) = self.fineness(part, primitive, most);
        let step = 1.0 / (side * points) as f32;
        let of_cell = |x: usize, y: usize| {
            let mut sum = [0.0; 3];
            for i in 0..points * points {
                let at = [x * points + i % points, y * points + i / points].map(|i| (i as f32 + 0.5) * step);
                let place = Place::new(primitive, Vec2::from(at));
                let radiance = self.radiance(part, primitive, &place).to_array();
                sum.iter_mut().zip(radiance).for_each(|(sum, c)| *sum += f64::from(c));
            }
            sum.map(|sum| sum / (points * points) as f64)
        };
        let rows: Vec<Vec<[f64; 3]>> =
            (0..side).into_par_iter().map(|y| (0..side).map(|x| of_cell(x, y)).collect()).collect();
        let mut mean = [0.0; 3];
        for cell in rows.iter().flatten() {
            mean.iter_mut().zip(cell).for_each(|(mean, c)| *mean += c / (side * side) as f64);
        }
        let of_row = |row: &Vec<[f64; 3]>| row.iter().map(|cell| cell.iter().sum()).collect();
        let mut weights: Vec<Vec<f64>> = rows.iter().map(of_row).collect();
        let even = DEFENSIVE_SHARE * mean.iter().sum::<f64>();
        weights.iter_mut().flatten().for_each(|w| *w += even);
        let cells = if side == 1 { Cells::default() } else { Cells::new(weights) };
        Divided { cells, mean }
    }

    /// A part, a point of the unit square that is mapped to it, and the point's density by area.
    pub(super) fn sample(&self, u_part: f32, u: Vec2) -> Option<(usize, Vec2, f32)> {
        if self.parts.is_empty() {
            return None;
        }
        let part = self.parts.choose(f64::from(u_part));
        let at = self.cells[part].sample(u);
        Some((part, at, self.density(part, at)))
    }

    /// The density by area of a point of the unit square that is mapped to a part.
    fn density(&self, part: usize, at: Vec2) -> f32 {
        let chance = if self.parts.is_empty() { 0.0 } else { self.parts.probability(part) };
        (chance * self.cells[part].density(at)) as f32 / self.areas[part]
    }

    /// The same of a point that a ray met, by the primitive's index in the tree's order.
    pub(super) fn density_at(&self, primitives: &[Primitive], primitive: u32, place: &Place) -> f32 {
        let index = self.order.get(primitive as usize).map(|i| i.wrapping_sub(self.first) as usize);
        let Some((part, primitive)) = index.and_then(|i| Some((i, primitives.get(i)?))) else { return 0.0 };
        self.density(part, place.on_the_square(primitive))
    }

    /// The radiance of a place on a part.
    pub(super) fn radiance(&self, part: usize, primitive: &Primitive, place: &Place) -> Rgb {
        let uvs = self.uvs.get(part).copied().unwrap_or_default();
        let uv = coordinate(primitive, place.position, place.barycentric, uvs, &self.to_object);
        let corner = Corner {
            shape: self.shape,
            primitive: self.first + part as u32,
            weights: place.barycentric,
            is_turned: false,
        };
        self.sampler.colour(&At { uv, corner })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emitter::tests::{patterned, shapes_with_patterns};
    use foton_math::{Purpose, Stream};

    /// Points fall into each part of the square as the density says, which integrates to one; and radiance over density is about the
    /// same everywhere.
    #[test]
    fn points_are_chosen_with_the_density_that_is_told_and_in_proportion_to_radiance() {
        for primitives in shapes_with_patterns() {
            let area = patterned(primitives.clone());
            let pattern = area.pattern.as_ref().expect("it has one");
            let (n, side) = (200_000u32, 6usize);
            let cell = |part: usize, at: Vec2| {
                let [x, y] = (at * side as f32).to_array().map(|c| (c as usize).min(side - 1));
                (part * side + y) * side + x
            };
            let mut counts = vec![0u32; primitives.len() * side * side];
            let (mut sum, mut sum2, mut others) = (0.0, 0.0, 0u32);
            let mut stream = Stream::new(3, Purpose::Test, 0, 0);
            for _ in 0..n {
                let (part, at, density) =
                    pattern.sample(stream.next_1d(), stream.next_2d()).expect("it shines");
                counts[cell(part, at)] += 1;
                let place = Place::new(&primitives[part], at);
                let told = pattern.density_at(&primitives, part as u32, &place);
                others += u32::from((told / density - 1.0).abs() > 1e-3);
                let ratio = f64::from(pattern.radiance(part, &primitives[part], &place).g / density);
                (sum, sum2) = (sum + ratio, sum2 + ratio * ratio);
            }
            // Rounding may take a point at the edge of a cell for one of the next.
            assert!(others < n / 100, "{others} of {n}");
            // ∫ p over each cell by a fine grid.
            let fine = 240usize;
            let mut expected = vec![0.0f64; counts.len()];
            for part in 0..primitives.len() {
                let weight = f64::from(n) * f64::from(pattern.areas[part]) / (fine * fine) as f64;
                for i in 0..fine * fine {
                    let at = Vec2::new((i % fine) as f32 + 0.5, (i / fine) as f32 + 0.5) / fine as f32;
                    expected[cell(part, at)] += f64::from(pattern.density(part, at)) * weight;
                }
            }
            let whole: f64 = expected.iter().sum();
            assert!((whole / f64::from(n) - 1.0).abs() < 0.01, "∫ p dA = {}", whole / f64::from(n));
            let chi2: f64 =
                counts.iter().zip(&expected).map(|(&c, e)| (f64::from(c) - e).powi(2) / e.max(1.0)).sum();
            let freedom = (counts.len() - 1) as f64;
            assert!(chi2 < freedom + 5.0 * (2.0 * freedom).sqrt(), "χ² of {freedom}: {chi2}");
            let mean = sum / f64::from(n);
            let spread = (sum2 / f64::from(n) / (mean * mean) - 1.0).max(0.0).sqrt();
            assert!(spread < 0.45, "{spread}");
            // E[L/p] is ∫ L dA.
            let area: f64 = pattern.areas.iter().map(|&a| f64::from(a)).sum();
            assert!((mean / (f64::from(pattern.mean().g) * area) - 1.0).abs() < 0.01);
        }
    }
}
