//! FLIP \[FLIP20\]: how different two pictures look to a person who flips between them, on an ordinary display.
//!
//! Each pixel gets ΔE = ΔE_c^(1 − ΔE_f) in [0, 1] of a colour difference ΔE_c and a feature difference ΔE_f, after
//! filters that blur what an eye at [`PIXELS_PER_DEGREE`] cannot resolve. Colours are linear sRGB clipped to [0, 1]:
//! what is brighter than white looks white, so it says nothing of errors in highlights. The numbers below are the
//! paper's. Not here: the variant for high dynamic range.

use std::f64::consts::PI;

use foton_film::Plane;
use foton_math::Rgb;
use glam::{Mat3, Vec3};

use crate::Pair;
use crate::convolve::{Kernel, kernel, normalised, separable};

/// Resolution at the eye: a display of 3,840 pixels seen from as far away as it is wide.
pub const PIXELS_PER_DEGREE: f64 = 3840.0 * PI / 180.0;

/// Exponent q_c that compresses colour differences.
const COLOR_EXPONENT: f32 = 0.7;
/// Exponent q_f that widens feature differences.
const FEATURE_EXPONENT: f32 = 0.5;
/// Width of the feature detectors in degrees.
const FEATURE_WIDTH: f64 = 0.082;
/// Colour differences up to this share p_c of the largest are spread over [0, `KNEE_VALUE`] (p_t).
const KNEE: f32 = 0.4;
const KNEE_VALUE: f32 = 0.95;
/// What the eye resolves of luminance, red-green and blue-yellow: sums of a·√(π/b)·exp(−π² z²/b) with z in degrees.
const SENSITIVITY: [&[(f64, f64)]; 3] = [&[(1.0, 0.0047)], &[(1.0, 0.0053)], &[(34.1, 0.04), (13.5, 0.025)]];
/// The largest b of [`SENSITIVITY`]: it sets the radius of all its filters.
const MAX_WIDTH: f64 = 0.04;

/// Linear sRGB to CIE XYZ, in columns, each row divided by its sum so that white is (1, 1, 1).
const RGB_TO_XYZ: Mat3 = Mat3::from_cols(
    Vec3::new(10_135_552.0 / 23_359_437.0, 2_613_072.0 / 12_288_897.0, 1_425_312.0 / 80_288_307.0),
    Vec3::new(8_788_810.0 / 23_359_437.0, 8_788_810.0 / 12_288_897.0, 8_788_810.0 / 80_288_307.0),
    Vec3::new(4_435_075.0 / 23_359_437.0, 887_015.0 / 12_288_897.0, 70_074_185.0 / 80_288_307.0),
);
/// To (Y, X − Y, Y − Z): luminance, red-green, blue-yellow; the paper's linear YCxCz but for factors.
const XYZ_TO_OPPONENT: Mat3 =
    Mat3::from_cols(Vec3::new(0.0, 1.0, 0.0), Vec3::new(1.0, -1.0, 1.0), Vec3::new(0.0, 0.0, -1.0));

/// FLIP of an image and its reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Flip {
    /// Of each pixel, in [0, 1]; NaN where a pixel is left out.
    pub map: Plane<f32>,
    /// Mean over the map.
    pub mean: f64,
}

impl Pair<'_> {
    /// FLIP of the two images, clipped to [0, 1].
    ///
    /// A pixel that is left out takes its finite colour in both images (black if it has none), so that it makes no
    /// difference to its neighbours.
    #[must_use]
    pub fn flip(&self) -> Flip {
        let width = self.a.width as usize;
        let seen = |first: &[Rgb], second: &[Rgb]| Picture::of(&shown(first, second), width);
        let (a, b) = (seen(&self.a.pixels, &self.b.pixels), seen(&self.b.pixels, &self.a.pixels));
        let is_finite = self.a.pixels.iter().zip(&self.b.pixels).map(|(x, y)| x.is_finite() && y.is_finite());
        let largest = largest_color_difference();
        let values: Vec<f32> = is_finite
            .enumerate()
            .map(|(i, is_finite)| if is_finite { a.difference(&b, i, largest) } else { f32::NAN })
            .collect();
        let count = values.len() - self.non_finite().either;
        let mean = values.iter().filter(|v| !v.is_nan()).map(|&v| f64::from(v)).sum::<f64>() / count as f64;
        Flip { map: Plane { width: self.a.width, height: self.a.height, values }, mean }
    }
}

/// A picture as an eye perceives it.
struct Picture {
    /// L*a*b* of the blurred picture with chroma weakened in the dark.
    colors: Vec<Vec3>,
    /// Strength of edges in luminance.
    edges: Vec<f32>,
    /// Strength of points in luminance.
    points: Vec<f32>,
}

impl Picture {
    /// Of linear colours in [0, 1]³.
    fn of(pixels: &[Vec3], width: usize) -> Self {
        let to_opponent = XYZ_TO_OPPONENT * RGB_TO_XYZ;
        let from_opponent = to_opponent.inverse();
        let planes =
            [0, 1, 2].map(|i| -> Vec<f32> { pixels.iter().map(|&c| to_opponent.row(i).dot(c)).collect() });
        let [edges, points] =
            [gaussian_slope(), gaussian_curvature()].map(|k| gradient(&planes[0], width, &k));
        let blurred = [0, 1, 2].map(|i| blur(&planes[i], width, SENSITIVITY[i]));
        let colors = (0..pixels.len())
            .map(|i| Vec3::new(blurred[0][i], blurred[1][i], blurred[2][i]))
            .map(|opponent| perceived(from_opponent * opponent))
            .collect();
        Self { colors, edges, points }
    }

    /// ΔE of pixel `i`; `largest` is the colour difference that counts as 1.
    fn difference(&self, other: &Self, i: usize, largest: f32) -> f32 {
        let color = hyab(self.colors[i], other.colors[i]).powf(COLOR_EXPONENT);
        let knee = KNEE * largest;
        let color = if color < knee {
            KNEE_VALUE / knee * color
        } else {
            KNEE_VALUE + (color - knee) / (largest - knee) * (1.0 - KNEE_VALUE)
        };
        let edge = (self.edges[i] - other.edges[i]).abs();
        let point = (self.points[i] - other.points[i]).abs();
        let feature = (edge.max(point) / 2f32.sqrt()).powf(FEATURE_EXPONENT).clamp(0.0, 1.0);
        color.clamp(0.0, 1.0).powf(1.0 - feature)
    }
}

/// The colours of `pixels` as a display shows them; one that is not finite takes its colour from `others`.
fn shown(pixels: &[Rgb], others: &[Rgb]) -> Vec<Vec3> {
    let finite = |c: &&Rgb| c.is_finite();
    let color =
        |(c, other)| Some(c).filter(finite).or(Some(other).filter(finite)).copied().unwrap_or_default();
    pixels.iter().zip(others).map(color).map(|c| Vec3::from(c).clamp(Vec3::ZERO, Vec3::ONE)).collect()
}

/// L*, and a* and b* weakened by 0.01·L* (Hunt's effect), of a linear colour clipped to [0, 1]³.
fn perceived(c: Vec3) -> Vec3 {
    const DELTA: f32 = 6.0 / 29.0;
    let f = |t: f32| {
        if t > DELTA.powi(3) { t.cbrt() } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
    };
    let [x, y, z] = (RGB_TO_XYZ * c.clamp(Vec3::ZERO, Vec3::ONE)).to_array().map(f);
    let lightness = 116.0 * y - 16.0;
    let hunt = 0.01 * lightness;
    Vec3::new(lightness, hunt * 500.0 * (x - y), hunt * 200.0 * (y - z))
}

/// |ΔL| + √(Δa² + Δb²): a distance that holds for large differences too.
fn hyab(a: Vec3, b: Vec3) -> f32 {
    let d = a - b;
    d.x.abs() + d.y.hypot(d.z)
}

/// The colour difference of green and blue, larger than which none is.
fn largest_color_difference() -> f32 {
    hyab(perceived(Vec3::Y), perceived(Vec3::Z)).powf(COLOR_EXPONENT)
}

/// `plane` filtered by a normalised sum of Gaussians from [`SENSITIVITY`].
fn blur(plane: &[f32], width: usize, terms: &[(f64, f64)]) -> Vec<f32> {
    let radius = (3.0 * (MAX_WIDTH / (2.0 * PI * PI)).sqrt() * PIXELS_PER_DEGREE).ceil() as usize;
    let kernels: Vec<_> = terms
        .iter()
        .map(|&(a, b)| {
            let gaussian = kernel(radius, |x| (-(PI * x / PIXELS_PER_DEGREE).powi(2) / b).exp());
            let sum: f64 = gaussian.iter().sum();
            (a * (PI / b).sqrt() * sum * sum, normalised(&gaussian))
        })
        .collect();
    let total: f64 = kernels.iter().map(|(weight, _)| weight).sum();
    let mut result = vec![0.0; plane.len()];
    for (weight, gaussian) in &kernels {
        let share = (weight / total) as f32;
        for (sum, v) in result.iter_mut().zip(separable(plane, width, gaussian, gaussian)) {
            *sum += share * v;
        }
    }
    result
}

/// Standard deviation of the feature detectors in pixels.
const FEATURE_SIGMA: f64 = 0.5 * FEATURE_WIDTH * PIXELS_PER_DEGREE;

/// A feature detector: `weight(x/σ)` times a Gaussian.
fn detector(weight: impl Fn(f64) -> f64) -> Kernel {
    let radius = (3.0 * FEATURE_SIGMA).ceil() as usize;
    let gaussian = |s: f64| (-0.5 * s * s).exp();
    normalised(&kernel(radius, |x| weight(x / FEATURE_SIGMA) * gaussian(x / FEATURE_SIGMA)))
}

/// First derivative of a Gaussian: it finds edges.
fn gaussian_slope() -> Kernel {
    detector(|s| -s)
}

/// Second derivative of a Gaussian: it finds points and lines.
fn gaussian_curvature() -> Kernel {
    detector(|s| s * s - 1.0)
}

/// Length of the vector of `plane` filtered along x and along y by `derivative`, and by a Gaussian across.
fn gradient(plane: &[f32], width: usize, derivative: &[f32]) -> Vec<f32> {
    let gaussian = detector(|_| 1.0);
    let along_x = separable(plane, width, derivative, &gaussian);
    let along_y = separable(plane, width, &gaussian, derivative);
    along_x.into_iter().zip(along_y).map(|(x, y)| (x * x + y * y).sqrt()).collect()
}
