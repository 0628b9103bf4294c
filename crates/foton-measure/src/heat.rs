//! A map of errors as colours that people with any kind of colour vision can order.

use foton_film::{Image, Plane, tone_map};
use foton_math::Rgb;

/// Coefficients of t⁰ to t⁶ for red, green and blue of [`viridis`].
const VIRIDIS: [[f32; 3]; 7] = [
    [0.277_727_33, 0.005_407_344_5, 0.334_099_8],
    [0.105_093_04, 1.404_613_5, 1.384_590_1],
    [-0.330_861_83, 0.214_847_56, 0.095_095_165],
    [-4.634_230_5, -5.799_101, -19.332_44],
    [6.228_27, 14.179_933, 56.690_55],
    [4.776_385, -13.745_145, -65.353_035],
    [-5.435_456, 4.645_852_6, 26.312_435],
];

/// The colour map viridis (Smith, van der Walt: CC0) at `t` in [0, 1], encoded sRGB in [0, 1], in the polynomial fit by
/// Matt Zucker (CC0), which is within 0.013 of it. Its lightness rises evenly from dark blue over green to yellow.
#[must_use]
pub fn viridis(t: f32) -> [f32; 3] {
    let horner = |c: usize| VIRIDIS.iter().rev().fold(0.0, |sum, term| sum * t + term[c]);
    [0, 1, 2].map(|c| horner(c).clamp(0.0, 1.0))
}

/// `plane` as linear colours: viridis from 0 to `top` and beyond, which a PNG written without tone map or exposure
/// shows as it is. NaN stays NaN, which such a PNG shows in magenta.
#[must_use]
pub fn heat(plane: &Plane<f32>, top: f32) -> Image {
    let color = |&v: &f32| {
        if v.is_nan() {
            Rgb::splat(f32::NAN)
        } else {
            Rgb::from_array(viridis((v / top).clamp(0.0, 1.0)).map(tone_map::srgb_decode))
        }
    };
    Image { width: plane.width, height: plane.height, pixels: plane.values.iter().map(color).collect() }
}

/// Where a scale for `plane` should end: 1, 2 or 5 times a power of ten, the next from the value that one pixel in a
/// hundred exceeds, so that no single firefly makes the rest dark. 1 where nothing is above zero.
#[must_use]
pub fn scale_top(plane: &Plane<f32>) -> f32 {
    let mut values: Vec<f32> = plane.values.iter().copied().filter(|v| v.is_finite()).collect();
    values.sort_unstable_by(f32::total_cmp);
    let largest = values.last().copied().unwrap_or(0.0);
    let typical = values.get(values.len() * 99 / 100).copied().filter(|v| *v > 0.0).unwrap_or(largest);
    if typical <= 0.0 {
        return 1.0;
    }
    let power = 10f64.powf(f64::from(typical).log10().floor());
    let steps = [1.0, 2.0, 5.0].map(|step| (step * power) as f32);
    steps.into_iter().find(|step| *step >= typical).unwrap_or((10.0 * power) as f32)
}
