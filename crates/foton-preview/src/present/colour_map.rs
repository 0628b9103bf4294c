//! The colour map of false colour: from dark blue over teal to bright yellow, made by a formula, not a table.
//!
//! It runs along a parabola in Oklab `[OTT20]` at constant speed, so that equal steps look equal. Lightness only rises, and blue
//! against yellow is the pair that most colour-blind people tell apart: the order can be read without seeing hue at all.

use std::sync::LazyLock;

/// How many colours the map has.
pub(crate) const ENTRIES: usize = 256;

/// The control points of a quadratic Bézier curve in Oklab: lightness, green to red, blue to yellow. All of it lies in sRGB.
const CONTROL: [[f64; 3]; 3] = [[0.26, 0.0, -0.15], [0.68, -0.10, -0.06], [0.95, -0.07, 0.18]];

static TABLE: LazyLock<[[u8; 3]; ENTRIES]> = LazyLock::new(|| {
    let along = even_parameters();
    std::array::from_fn(|i| oklab_to_srgb(curve(along[i])).map(|v| (255.0 * v).round() as u8))
});

/// The colour at `t`, in bytes of sRGB; values outside [0, 1] are clamped, NaN is the lower end.
#[must_use]
pub(crate) fn at(t: f32) -> [u8; 3] {
    TABLE[(t.clamp(0.0, 1.0) * (ENTRIES - 1) as f32).round() as usize]
}

/// All colours, from the lower end to the upper.
#[must_use]
pub(crate) fn table() -> &'static [[u8; 3]; ENTRIES] {
    &TABLE
}

/// The point of the curve at `u` in [0, 1].
fn curve(u: f64) -> [f64; 3] {
    let weights = [(1.0 - u) * (1.0 - u), 2.0 * u * (1.0 - u), u * u];
    std::array::from_fn(|axis| (0..3).map(|i| weights[i] * CONTROL[i][axis]).sum())
}

/// The parameters at which the curve has gone 0, 1/255, … 1 of its length, which is measured along a fine polygon.
fn even_parameters() -> [f64; ENTRIES] {
    const PIECES: usize = 4096;
    let mut gone = vec![0.0; PIECES + 1];
    for i in 0..PIECES {
        let (from, to) = (curve(i as f64 / PIECES as f64), curve((i + 1) as f64 / PIECES as f64));
        gone[i + 1] = gone[i] + (0..3).map(|axis| (to[axis] - from[axis]).powi(2)).sum::<f64>().sqrt();
    }
    std::array::from_fn(|i| {
        let wanted = gone[PIECES] * i as f64 / (ENTRIES - 1) as f64;
        let piece = gone.partition_point(|&length| length <= wanted).clamp(1, PIECES) - 1;
        let within = (wanted - gone[piece]) / (gone[piece + 1] - gone[piece]);
        (piece as f64 + within) / PIECES as f64
    })
}

/// From Oklab to encoded sRGB, with the matrices of `[OTT20]`. In [0, 1] for the colours of this map.
fn oklab_to_srgb([lightness, a, b]: [f64; 3]) -> [f64; 3] {
    let l = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
    let linear = [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ];
    linear.map(|v| if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use foton_film::tone_map::srgb_decode;
    use foton_math::Rgb;

    #[test]
    fn lightness_rises_strictly_in_the_bytes_that_are_shown() {
        let luminance =
            |c: &[u8; 3]| Rgb::from_array(c.map(|v| srgb_decode(f32::from(v) / 255.0))).luminance();
        for (i, pair) in table().windows(2).enumerate() {
            assert!(luminance(&pair[0]) < luminance(&pair[1]), "{i}: {pair:?}");
        }
    }

    #[test]
    fn steps_are_even_in_oklab_and_inside_srgb() {
        let points = even_parameters().map(curve);
        let step = |pair: &[[f64; 3]]| (0..3).map(|i| (pair[1][i] - pair[0][i]).powi(2)).sum::<f64>().sqrt();
        let first = step(&points[0..2]);
        for pair in points.windows(2) {
            assert!((step(pair) / first - 1.0).abs() < 1e-3, "{pair:?}");
        }
        for point in points {
            assert!(oklab_to_srgb(point).iter().all(|v| (0.0..=1.0).contains(v)), "{point:?}");
        }
    }

    #[test]
    fn it_ends_in_blue_and_yellow_and_clamps() {
        let [low, high] = [at(0.0), at(1.0)];
        assert!(low[2] > 2 * low[0] && low[2] > 2 * low[1], "{low:?}");
        assert!(high[0] > 200 && high[1] > 200 && high[2] < 160, "{high:?}");
        assert_eq!([at(-1.0), at(2.0), at(f32::NAN)], [low, high, low]);
    }
}
