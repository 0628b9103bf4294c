//! An environment map: radiance by direction, chosen in proportion to what a direction brings.
//!
//! The picture is a latitude–longitude map. Radiance is interpolated between pixel centres; directions are chosen by pixels,
//! each weighed by what interpolation puts there, so that no bright pixel's slope is left out.

use std::f32::consts::PI;
use std::sync::Arc;

use foton_math::Rgb;
use foton_math::glam::{Mat3, Vec2, Vec3};

use crate::description::Bitmap;
use crate::discrete::Discrete;

/// An environment map ready to be asked and sampled.
#[derive(Clone, Debug)]
pub(crate) struct Environment {
    bitmap: Arc<Bitmap>,
    scale: f32,
    to_world: Mat3,
    /// Chance of each row of pixels.
    rows: Discrete,
    /// Chance of each pixel within its row.
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

impl Environment {
    pub(crate) fn new(bitmap: Arc<Bitmap>, scale: f32, to_world: Mat3) -> Self {
        let (width, height) = (bitmap.width as usize, bitmap.height as usize);
        let mut environment = Self {
            bitmap,
            scale,
            to_world,
            rows: Discrete::default(),
            columns: Vec::new(),
            total: Rgb::BLACK,
        };
        let mut row_weights = Vec::with_capacity(height);
        for y in 0..height {
            let weights: Vec<f64> =
                (0..width).map(|x| f64::from(environment.cell_mean(x, y).mean())).collect();
            row_weights.push(weights.iter().sum::<f64>() * environment.row_sine(y));
            environment.columns.push(Discrete::new(weights));
        }
        environment.rows = Discrete::new(row_weights);
        environment.total = environment.integral();
        environment
    }

    /// ∫ L dω by four points to a pixel. Each pixel has a weight above zero in it: one that is no number makes the whole none, by
    /// which such a sky is refused.
    fn integral(&self) -> Rgb {
        let (width, height) = (2 * self.bitmap.width, 2 * self.bitmap.height);
        let step = 1.0 / Vec2::new(width as f32, height as f32);
        let mut total = [0.0f64; 3];
        for y in 0..height {
            let v = (y as f32 + 0.5) * step.y;
            let sine = f64::from((v * PI).sin());
            for x in 0..width {
                let here = self.at(Vec2::new((x as f32 + 0.5) * step.x, v));
                for (sum, c) in total.iter_mut().zip(here.to_array()) {
                    *sum += f64::from(c) * sine;
                }
            }
        }
        let area = 2.0 * f64::from(PI) * f64::from(PI) / (f64::from(width) * f64::from(height));
        Rgb::from_array(total.map(|t| (t * area) as f32))
    }

    /// Pixel of the map, columns wrapping around and rows ending at the poles.
    fn pixel(&self, x: i64, y: i64) -> Rgb {
        let x = x.rem_euclid(i64::from(self.bitmap.width)) as usize;
        let y = y.clamp(0, i64::from(self.bitmap.height) - 1) as usize;
        self.bitmap.pixels[y * self.bitmap.width as usize + x] * self.scale
    }

    /// sin θ in the middle of a row.
    fn row_sine(&self, y: usize) -> f64 {
        let theta = (y as f64 + 0.5) / f64::from(self.bitmap.height) * std::f64::consts::PI;
        theta.sin()
    }

    /// The mean radiance over a pixel as interpolation spreads it over its neighbours: no direction with light has density
    /// zero.
    fn cell_mean(&self, x: usize, y: usize) -> Rgb {
        let (x, y) = (x as i64, y as i64);
        let mut sum = Rgb::BLACK;
        for (dy, wy) in [(-1, 0.125), (0, 0.75), (1, 0.125)] {
            for (dx, wx) in [(-1, 0.125), (0, 0.75), (1, 0.125)] {
                sum += self.pixel(x + dx, y + dy) * (wx * wy);
            }
        }
        sum
    }

    /// ∫ L dω per channel.
    pub(crate) const fn total(&self) -> Rgb {
        self.total
    }

    /// Radiance that comes from `direction`.
    pub(crate) fn radiance(&self, direction: Vec3) -> Rgb {
        self.at(self.uv(direction))
    }

    /// Radiance at a place on the map, interpolated between pixel centres.
    fn at(&self, uv: Vec2) -> Rgb {
        let p = uv * Vec2::new(self.bitmap.width as f32, self.bitmap.height as f32) - 0.5;
        let low = p.floor();
        let f = p - low;
        let (x, y) = (low.x as i64, low.y as i64);
        let row = |y: i64| self.pixel(x, y) * (1.0 - f.x) + self.pixel(x + 1, y) * f.x;
        row(y) * (1.0 - f.y) + row(y + 1) * f.y
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

    /// Density of [`Environment::sample`] per unit solid angle.
    pub(crate) fn pdf(&self, direction: Vec3) -> f32 {
        if self.rows.is_empty() {
            return 0.0;
        }
        let uv = self.uv(direction);
        let y = ((uv.y * self.bitmap.height as f32) as usize).min(self.bitmap.height as usize - 1);
        let x = ((uv.x * self.bitmap.width as f32) as usize).min(self.bitmap.width as usize - 1);
        if self.columns[y].is_empty() {
            return 0.0;
        }
        let cells = f64::from(self.bitmap.width) * f64::from(self.bitmap.height);
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
        let size = Vec2::new(self.bitmap.width as f32, self.bitmap.height as f32);
        let uv = Vec2::new(x as f32 + along_x as f32, y as f32 + along_y as f32) / size;
        let direction = self.direction(uv);
        let pdf = self.pdf(direction);
        (pdf > 0.0).then(|| EnvironmentSample { direction, radiance: self.radiance(direction), pdf })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foton_math::{Purpose, Stream, warp};

    fn map() -> Environment {
        let (width, height) = (16u32, 8u32);
        let mut pixels: Vec<Rgb> =
            (0..width * height).map(|i| Rgb::splat(0.1 + (i % 7) as f32 * 0.05)).collect();
        // A sun.
        pixels[2 * 16 + 5] = Rgb::new(100.0, 80.0, 60.0);
        let turn = Mat3::from_rotation_y(0.7) * Mat3::from_rotation_x(0.3);
        Environment::new(Arc::new(Bitmap { width, height, pixels }), 2.0, turn)
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
}
