//! Double precision beside single: intersection, ray origins, Fresnel and refraction, each against a reference that is as short
//! as its textbook formula and knows nothing of the code that it checks.
//!
//! The reference takes the same rounded coordinates, so that what differs is the arithmetic alone. With `--nocapture` the largest differences are printed. What they mean for a person is in docs/robustness.md.

mod discs;
mod exact;
mod hits;
mod optics;
mod origins;
mod rig;

use std::fmt;

/// The largest of many differences, and how many there were.
#[derive(Clone, Copy, Default)]
struct Worst {
    count: u64,
    largest: f64,
}

impl Worst {
    fn add(&mut self, difference: f64) {
        self.count += 1;
        // NaN is worse than anything.
        self.largest = if difference.is_nan() { f64::INFINITY } else { self.largest.max(difference) };
    }
}

impl fmt::Display for Worst {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.3e} in {} cases", self.largest, self.count)
    }
}

/// The distance to the next number of single precision beyond the largest coordinate.
fn ulp(v: foton_math::glam::Vec3) -> f64 {
    f64::from(f32::EPSILON) * f64::from(v.abs().max_element().max(f32::MIN_POSITIVE)).log2().floor().exp2()
}
