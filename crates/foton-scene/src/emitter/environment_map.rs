//! An environment map: radiance by direction, chosen in proportion to what a direction brings.
//!
//! The picture is a latitude–longitude map as in Mitsuba 3: columns stand for the middles of their pixels, rows for latitudes
//! from pole to pole, so that the first and the last row are the poles. Fewer than three rows are filled up with the last.
//! Radiance is interpolated between those points. Directions are chosen by cells between four of them, each weighed by
//! the light that interpolation puts there; so no bright pixel's slope is left out.

use std::f32::consts::PI;
use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{Mat3, Vec2, Vec3};

use crate::description::Bitmap;
use crate::discrete::Discrete;

/// An environment map ready to be asked and sampled.
#[derive(Clone, Debug)]
pub(crate) struct EnvironmentMap {
    bitmap: Arc<Bitmap>,
    scale: f32,
    to_world: Mat3,
    /// Chance of each row of cells.
    rows: Discrete,
    /// Chance of each cell within its row.
    columns: Vec<Discrete>,
    /// ∫ L dω per channel.
    total: Rgb,
}

/// A direction chosen from an environment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EnvironmentSample {
    /// Unit direction from which light comes.
    pub(crate) direction: Vec3,
    /// Radiance from there.
    pub(crate) radiance: Rgb,
    /// Density per unit solid angle.
    pub(crate) pdf: f32,
}

impl EnvironmentMap {
    pub(crate) fn new(bitmap: Arc<Bitmap>, scale: f32, to_world: Mat3) -> Self {
        let (width, bands) = (bitmap.width as usize, bands(&bitmap));
        let mut environment = Self {
            bitmap,
            scale,
            to_world,
            rows: Discrete::default(),
            columns: Vec::new(),
            total: Rgb::BLACK,
        };
        let mut row_weights = Vec::with_capacity(bands);
        let mut total = [0.0f64; 3];
        for y in 0..bands {
            let weights: Vec<f64> = (0..width)
                .map(|x| {
                    let light = environment.cell_integral(x as i64, y);
                    total.iter_mut().zip(light).for_each(|(sum, c)| *sum += c);
                    light.iter().sum()
                })
                .collect();
            row_weights.push(weights.iter().sum::<f64>());
            environment.columns.push(Discrete::new(weights));
        }
        environment.rows = Discrete::new(row_weights);
        // Each pixel has a weight above zero in it: one that is no number makes the whole none, by which such a sky is refused.
        environment.total = Rgb::from_array(total.map(|t| t as f32));
        environment
    }

    /// ∫ L dω over the cell to the right of and below a pixel, per channel: exact for what [`Self::at`] interpolates.
    fn cell_integral(&self, x: i64, y: usize) -> [f64; 3] {
        let step = std::f64::consts::PI / bands(&self.bitmap) as f64;
        let (above, below) = (y as f64 * step, (y + 1) as f64 * step);
        // ∫ (1 − t) sin θ dθ and ∫ t sin θ dθ, t growing from 0 to 1 in the cell.
        let slope = (below.sin() - above.sin()) / step;
        let (top, bottom) = (above.cos() - slope, slope - below.cos());
        let mean = |y: i64| (self.pixel(x, y) + self.pixel(x + 1, y)).to_array().map(|c| 0.5 * f64::from(c));
        let (upper, lower) = (mean(y as i64), mean(y as i64 + 1));
        let width = 2.0 * std::f64::consts::PI / f64::from(self.bitmap.width);
        std::array::from_fn(|c| width * (upper[c] * top + lower[c] * bottom))
    }

    /// Pixel of the map, columns wrapping around and rows ending at the poles.
    fn pixel(&self, x: i64, y: i64) -> Rgb {
        let x = x.rem_euclid(i64::from(self.bitmap.width)) as usize;
        let y = y.clamp(0, i64::from(self.bitmap.height) - 1) as usize;
        self.bitmap.pixels[y * self.bitmap.width as usize + x] * self.scale
    }

    /// ∫ L dω per channel.
    pub(crate) const fn total(&self) -> Rgb {
        self.total
    }

    /// Radiance that comes from `direction`.
    pub(crate) fn radiance(&self, direction: Vec3) -> Rgb {
        self.at(self.uv(direction))
    }

    /// The cell of a place on the map by its column and row, and how far right and down in it the place is.
    fn cell(&self, uv: Vec2) -> (i64, usize, Vec2) {
        let bands = bands(&self.bitmap);
        let (x, y) = (uv.x * self.bitmap.width as f32 - 0.5, uv.y * bands as f32);
        let (column, row) = (x.floor(), (y as usize).min(bands - 1));
        (column as i64, row, Vec2::new(x - column, y - row as f32))
    }

    /// Radiance at a place on the map, interpolated.
    fn at(&self, uv: Vec2) -> Rgb {
        let (x, y, f) = self.cell(uv);
        let row = |y: i64| self.pixel(x, y) * (1.0 - f.x) + self.pixel(x + 1, y) * f.x;
        row(y as i64) * (1.0 - f.y) + row(y as i64 + 1) * f.y
    }

    /// Where a direction lies on the map: u to the right, v down, both in [0, 1). As in Mitsuba 3: u = 0 lies towards −z
    /// of the map's space, and u grows towards +x.
    fn uv(&self, direction: Vec3) -> Vec2 {
        let v = self.to_world.transpose() * direction;
        let u = v.x.atan2(-v.z) / (2.0 * PI);
        Vec2::new(u - u.floor(), v.y.clamp(-1.0, 1.0).acos() / PI)
    }

    fn direction(&self, uv: Vec2) -> Vec3 {
        let (phi, theta) = (uv.x * 2.0 * PI, uv.y * PI);
        self.to_world * Vec3::new(phi.sin() * theta.sin(), theta.cos(), -phi.cos() * theta.sin())
    }

    /// Density of [`EnvironmentMap::sample`] per unit solid angle.
    pub(crate) fn pdf(&self, direction: Vec3) -> f32 {
        if self.rows.is_empty() {
            return 0.0;
        }
        let uv = self.uv(direction);
        let (x, y, _) = self.cell(uv);
        let x = x.rem_euclid(i64::from(self.bitmap.width)) as usize;
        if self.columns[y].is_empty() {
            return 0.0;
        }
        let cells = f64::from(self.bitmap.width) * bands(&self.bitmap) as f64;
        let chance = self.rows.probability(y) * self.columns[y].probability(x) * cells;
        let sine = f64::from((uv.y * PI).sin()).max(1e-9);
        (chance / (2.0 * std::f64::consts::PI * std::f64::consts::PI * sine)) as f32
    }

    /// A direction chosen in about the proportion of what it brings; `None` for a black map.
    pub(crate) fn sample(&self, u: Vec2) -> Option<EnvironmentSample> {
        if self.rows.is_empty() {
            return None;
        }
        let (y, along_y) = self.rows.choose_and_rest(f64::from(u.y));
        let (x, along_x) = self.columns[y].choose_and_rest(f64::from(u.x));
        let size = Vec2::new(self.bitmap.width as f32, bands(&self.bitmap) as f32);
        let uv = Vec2::new(x as f32 + 0.5 + along_x as f32, y as f32 + along_y as f32) / size;
        let direction = self.direction(uv);
        let pdf = self.pdf(direction);
        (pdf > 0.0).then(|| EnvironmentSample { direction, radiance: self.radiance(direction), pdf })
    }
}

/// How many rows of cells there are from pole to pole.
fn bands(bitmap: &Bitmap) -> usize {
    bitmap.height.max(3) as usize - 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use foton_math::{Purpose, Stream, warp};

    fn map() -> EnvironmentMap {
        let (width, height) = (16u32, 8u32);
        let mut pixels: Vec<Rgb> =
            (0..width * height).map(|i| Rgb::splat(0.1 + (i % 7) as f32 * 0.05)).collect();
        // A sun.
        pixels[2 * 16 + 5] = Rgb::new(100.0, 80.0, 60.0);
        let turn = Mat3::from_rotation_y(0.7) * Mat3::from_rotation_x(0.3);
        EnvironmentMap::new(Arc::new(Bitmap::new(width, height, pixels)), 2.0, turn)
    }

    #[test]
    fn directions_and_places_on_the_map_are_inverse() {
        let (map, mut stream) = (map(), Stream::new(1, Purpose::Test, 0, 0));
        for _ in 0..1000 {
            let d = warp::square_to_sphere(stream.next_2d());
            assert!(map.direction(map.uv(d)).distance(d) < 1e-5);
        }
    }

    #[test]
    fn sampling_brings_the_same_light_as_the_whole_sphere() {
        let (map, mut stream) = (map(), Stream::new(2, Purpose::Test, 0, 0));
        let n = 400_000;
        let g = |d: Vec3| 1.0 + 0.5 * d.x - 0.3 * d.y * d.z;
        let (mut a, mut a2, mut b, mut b2, mut one) = (0.0f64, 0.0f64, 0.0f64, 0.0f64, 0.0f64);
        for _ in 0..n {
            let s = map.sample(stream.next_2d()).expect("not black");
            assert!((map.pdf(s.direction) / s.pdf - 1.0).abs() < 1e-3);
            let x = f64::from(s.radiance.g * g(s.direction) / s.pdf);
            let d = warp::square_to_sphere(stream.next_2d());
            let y = f64::from(map.radiance(d).g * g(d) / warp::square_to_sphere_pdf());
            one += f64::from(map.pdf(d) / warp::square_to_sphere_pdf());
            (a, a2, b, b2) = (a + x, a2 + x * x, b + y, b2 + y * y);
        }
        let n = f64::from(n);
        let sigma = ((a2 + b2).sqrt()) / n;
        assert!((a - b).abs() / n < 4.5 * sigma, "{} {} ± {sigma}", a / n, b / n);
        assert!((one / n - 1.0).abs() < 0.05, "{}", one / n);
        let spread = ((a2 / n) / (a / n).powi(2) - 1.0).sqrt();
        assert!(spread < 1.2, "sampling follows the sun: {spread}");
        // ∫ L dω as photons carry it.
        let whole: f64 = (0..200_000)
            .map(|_| map.sample(stream.next_2d()).map_or(0.0, |s| f64::from(s.radiance.g / s.pdf)))
            .sum::<f64>()
            / 200_000.0;
        assert!((whole / f64::from(map.total().g) - 1.0).abs() < 0.05, "{whole} {:?}", map.total());
    }

    /// A map whose pixels are all different, as it was given to Mitsuba.
    fn small(width: u32, height: u32) -> EnvironmentMap {
        let shade = |x: u32, y: u32| Rgb::splat(((x * 7 + y * 11 + 3) % 13 + 1) as f32);
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| shade(x, y))).collect();
        EnvironmentMap::new(Arc::new(Bitmap::new(width, height, pixels)), 1.0, Mat3::IDENTITY)
    }

    #[test]
    fn tiny_maps_are_those_of_mitsuba_everywhere_and_together() {
        let directions = [
            Vec3::new(0.3, 0.8, 0.5),
            Vec3::new(-0.6, 0.1, 0.7),
            Vec3::new(0.2, -0.9, -0.1),
            Vec3::X,
            Vec3::NEG_Z,
            Vec3::new(-0.5, -0.4, -0.7),
            Vec3::new(0.01, 1.0, -0.02),
            Vec3::new(0.3, -1.0, 0.01),
        ];
        // Printed by Mitsuba 3.9.1, the integrals from 240 × 480 of its values.
        for (width, height, radiances, total) in [
            (2, 1, [6.2959, 9.0789, 5.0331, 4.0, 7.5, 8.882, 6.4669, 4.0742], 94.248),
            (4, 2, [9.2623, 3.4308, 3.4338, 5.5, 6.0, 9.1589, 5.6102, 5.6485], 79.965),
            (8, 4, [9.4805, 6.0221, 6.0071, 5.0, 9.25, 8.1406, 4.5896, 7.3903], 87.376),
        ] {
            let map = small(width, height);
            for (d, wanted) in directions.iter().zip(radiances) {
                let found = map.radiance(d.normalize()).g;
                assert!((found - wanted).abs() < 1e-3, "{width} × {height} {d}: {found}, not {wanted}");
            }
            let found = map.total().g;
            assert!((found / total - 1.0).abs() < 1e-4, "{width} × {height}: {found}, not {total}");
            let mut stream = Stream::new(3, Purpose::Test, 0, 0);
            let n = 100_000;
            let (mut light, mut upward, mut whole) = (0.0f64, 0.0f64, 0.0f64);
            for _ in 0..n {
                let s = map.sample(stream.next_2d()).expect("not black");
                light += f64::from(s.radiance.g / s.pdf) / f64::from(n);
                upward += f64::from(s.radiance.g / s.pdf * s.direction.y) / f64::from(n);
                let d = warp::square_to_sphere(stream.next_2d());
                whole += f64::from(map.pdf(d) / warp::square_to_sphere_pdf()) / f64::from(n);
                upward -= f64::from(map.radiance(d).g * d.y / warp::square_to_sphere_pdf()) / f64::from(n);
            }
            assert!((light / f64::from(total) - 1.0).abs() < 0.01, "{width} × {height}: {light}");
            assert!((whole - 1.0).abs() < 0.01 && upward.abs() < 0.01 * f64::from(total), "{whole} {upward}");
        }
    }
}
