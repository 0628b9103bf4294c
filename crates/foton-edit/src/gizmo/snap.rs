//! Steps that drags snap to.

/// A drag snaps to moves of about so many pixels.
const PIXELS: f64 = 12.0;

/// Degrees between two orientations.
pub(super) const DEGREES: f64 = 15.0;

/// Between two factors.
pub(super) const FACTOR: f64 = 0.1;

/// The step of moves where a pixel covers so many world units: 1, 2 or 5 times a power of ten.
pub(super) fn step(pixel: f64) -> f64 {
    let wanted = pixel * PIXELS;
    if !(wanted.is_finite() && wanted > 0.0) {
        return 1.0;
    }
    let power = 10f64.powf(wanted.log10().floor());
    let digit = [1.0, 2.0, 5.0].into_iter().find(|d| d * power >= wanted);
    digit.unwrap_or(10.0) * power
}

/// The multiple of a step that is nearest.
pub(super) fn nearest(value: f64, step: f64) -> f64 {
    (value / step).round() * step
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round_numbers_and_values_snap_to_the_nearest() {
        for (pixel, expected) in [(0.001, 0.02), (0.01, 0.2), (1.0, 20.0), (0.04, 0.5), (0.06, 1.0)] {
            assert!((step(pixel) / expected - 1.0).abs() < 1e-9, "{pixel}: {}", step(pixel));
        }
        assert_eq!([step(0.0), step(f64::NAN), step(f64::INFINITY)], [1.0; 3]);
        assert_eq!([nearest(0.34, 0.25), nearest(-0.4, 0.25)], [0.25, -0.5]);
    }
}
