//! Lookups over an area of texture coordinates: several in a row, each over a part that is about as long as it is wide. `[MPFJ99]`

use foton_math::Rgb;
use foton_math::glam::Vec2;

/// A footprint in the units of a texture: a rectangle, and how it is divided.
#[derive(Clone, Copy, Debug)]
pub(super) struct Probes {
    /// From the middle to the middle of the first part.
    first: Vec2,
    /// From each part to the next.
    step: Vec2,
    count: u32,
    /// The side of each part.
    pub(super) width: f32,
}

impl Probes {
    /// The rectangle that has the area and the second moments of the parallelogram with these sides, in up to `most` parts, none of them
    /// smaller than `smallest`.
    pub(super) fn new([a, b]: [Vec2; 2], most: u32, smallest: f32) -> Self {
        let (p, r, q) = (a.x * a.x + b.x * b.x, a.y * a.y + b.y * b.y, a.x * a.y + b.x * b.y);
        let (middle, spread) = (0.5 * (p + r), (0.5 * (p - r)).hypot(q));
        let longer = (middle + spread).max(0.0).sqrt();
        // The product of both is the area.
        let shorter = if longer > 0.0 { a.perp_dot(b).abs() / longer } else { 0.0 };
        let along = Vec2::from_angle(0.5 * (2.0 * q).atan2(p - r)) * longer;
        let count = (longer / shorter.max(smallest)).ceil().clamp(1.0, most as f32);
        let step = along / count;
        Self { first: 0.5 * (step - along), step, count: count as u32, width: shorter.max(longer / count) }
    }

    /// Whether nothing is gained by filtering: it is no area, or no number.
    pub(super) fn is_point(axes: &[Vec2; 2], smallest: f32) -> bool {
        let size2 = axes[0].length_squared() + axes[1].length_squared();
        !(size2 > smallest * smallest && size2.is_finite())
    }

    /// The mean of what is looked up at the middles of all parts.
    pub(super) fn mean(&self, lookup: impl Fn(Vec2) -> Rgb) -> Rgb {
        self.offsets().map(lookup).sum::<Rgb>() / self.count as f32
    }

    /// The same of a number.
    pub(super) fn mean_number(&self, lookup: impl Fn(Vec2) -> f32) -> f32 {
        self.offsets().map(lookup).sum::<f32>() / self.count as f32
    }

    fn offsets(&self) -> impl Iterator<Item = Vec2> {
        (0..self.count).map(|i| self.first + self.step * i as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_stays_one_and_is_cut_along_its_longer_side() {
        let turn = Vec2::from_angle(0.4);
        for axes in [[Vec2::X * 8.0, Vec2::Y * 2.0], [Vec2::Y * 2.0, Vec2::X * 8.0]] {
            let probes = Probes::new(axes.map(|a| turn.rotate(a)), 16, 1.0);
            assert_eq!((probes.count, (probes.width * 1e4).round()), (4, 2e4));
            let ends = [0.0, 3.0].map(|i| probes.first + probes.step * i);
            assert!((ends[0].length() - 3.0).abs() < 1e-5 && (ends[0] + ends[1]).length() < 1e-5);
            assert!(ends[0].perp_dot(turn).abs() < 1e-5);
        }
        let probes = Probes::new([Vec2::X * 100.0, Vec2::Y], 10, 1.0);
        assert_eq!((probes.count, probes.width), (10, 10.0));
        assert_eq!(Probes::new([Vec2::X * 0.5, Vec2::ZERO], 10, 1.0).count, 1);
    }
}
