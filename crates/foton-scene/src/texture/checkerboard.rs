//! The mean of a checkerboard over an area, in closed form.

use foton_math::glam::Vec2;

use super::filter::Probes;

/// A lookup has at most so many parts: each takes little.
const MOST_PROBES: u32 = 64;

/// How many parts of a unit of coordinates are told from each other where light is sampled by its radiance: edges of fields are sharp.
pub(super) const FIELDS: f32 = 32.0;

/// Footprints below this, in coordinates, are points: edges are sharp to that.
const SMALLEST: f32 = 1e-4;

/// The share of the first colour in the parallelogram around a point with these sides.
pub(super) fn share_of_first(uv: Vec2, axes: [Vec2; 2]) -> f32 {
    if Probes::is_point(&axes, SMALLEST) {
        let field = uv - uv.floor();
        return f32::from((field.x > 0.5) == (field.y > 0.5));
    }
    // Fields are 1 and −1, the product of two square waves.
    let probes = Probes::new(axes, MOST_PROBES, SMALLEST);
    let width = f64::from(probes.width);
    let wave = |x: f64| (integral(x + 0.5 * width) - integral(x - 0.5 * width)) / width;
    let mean = probes.mean_number(|offset| {
        let at = (uv + offset).as_dvec2();
        (wave(at.x) * wave(at.y)) as f32
    });
    0.5 + 0.5 * mean
}

/// The integral of the square wave that is 1 in the first half of each unit and −1 in the second.
fn integral(x: f64) -> f64 {
    let fraction = x - x.floor();
    fraction.min(1.0 - fraction)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_over_a_box_is_that_of_its_points() {
        for (centre, size) in [((0.3, 0.2), (0.4, 0.4)), ((0.5, 0.5), (0.7, 0.7)), ((7.1, -3.3), (2.3, 2.3))]
        {
            let (centre, size) = (Vec2::from(centre), Vec2::from(size));
            let n = 1000;
            let point = |i: i32| (i as f32 + 0.5) / n as f32 - 0.5;
            let is_first = |i: i32| {
                let p = centre + size * Vec2::new(point(i % n), point(i / n));
                let field = p - p.floor();
                (field.x > 0.5) == (field.y > 0.5)
            };
            let mean = (0..n * n).filter(|&i| is_first(i)).count() as f32 / (n * n) as f32;
            let found = share_of_first(centre, [Vec2::X * size.x, Vec2::Y * size.y]);
            assert!((found - mean).abs() < 2e-3, "{found} {mean}");
        }
        let far = share_of_first(Vec2::new(3.2, 9.1), [Vec2::new(70.0, 3.0), Vec2::new(1.0, 50.0)]);
        assert!((far - 0.5).abs() < 0.01, "{far}");
    }
}
