//! Rectangles, sampled uniformly in the solid angle under which they are seen. `[UFK13]`

use std::f64::consts::PI;

use foton_math::glam::{DVec3, Vec2, Vec3};

use crate::primitive::Primitive;

/// A rectangle whose diagonal is less than this share of its distance is sampled by area: it then looks the same from all of it.
const SMALL: f64 = 0.2;

/// Cosine up to which two sides count as at right angles.
const SQUARE: f64 = 1e-5;

/// A rectangle that emits on the side of its normal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rectangle {
    corner: DVec3,
    /// Unit sides and their lengths.
    sides: [DVec3; 2],
    lengths: [f64; 2],
    normal: DVec3,
}

/// A rectangle as a point sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen<'a> {
    rectangle: &'a Rectangle,
    /// The rectangle's two corners from there, along its sides, and how far in front of it that is.
    low: [f64; 2],
    high: [f64; 2],
    height: f64,
    /// cos of the angles between the plane and those through the lower and the upper side along x.
    bounds: [f64; 2],
    /// 2π less two of the angles of the spherical rectangle.
    offset: f64,
    solid_angle: f64,
}

impl Rectangle {
    /// The rectangle that two triangles make, if they do: they share the diagonal.
    pub(super) fn of(primitives: &[Primitive]) -> Option<Self> {
        let [Primitive::Triangle(first), Primitive::Triangle(second)] = *primitives else { return None };
        let apart = |of: [Vec3; 3], other: [Vec3; 3]| {
            let mut apart = (0..3).filter(|&i| !other.contains(&of[i]));
            apart.next().filter(|_| apart.next().is_none())
        };
        let (i, j) = (apart(first, second)?, apart(second, first)?);
        let [corner, a, b] = [first[i], first[(i + 1) % 3], first[(i + 2) % 3]].map(Vec3::as_dvec3);
        let across = second[j].as_dvec3();
        let (x, y) = (a - corner, b - corner);
        let lengths = [x.length(), y.length()];
        let normal = x.cross(y).try_normalize()?;
        // Both triangles wind the same way if the second has the diagonal in the other direction.
        let winds = second[(j + 1) % 3].as_dvec3() == b;
        let largest = first.iter().chain(&second).fold(0.0f32, |m, p| m.max(p.abs().max_element()));
        let rounding = 8.0 * f64::from(f32::EPSILON) * f64::from(largest);
        let is_square = x.dot(y).abs() <= SQUARE * lengths[0] * lengths[1];
        let closes = (a + b - corner).distance(across) <= rounding;
        (winds && is_square && closes).then(|| {
            let x = x / lengths[0];
            Self { corner, sides: [x, normal.cross(x)], lengths, normal }
        })
    }

    /// As it is seen from a point in front of it, unless that is so far away that its area does as well.
    pub(super) fn seen_from(&self, from: Vec3) -> Option<Seen<'_>> {
        let from = from.as_dvec3();
        let to_corner = self.corner - from;
        let height = -to_corner.dot(self.normal);
        let low = self.sides.map(|side| to_corner.dot(side));
        let high = [0, 1].map(|i| low[i] + self.lengths[i]);
        let middle = [0, 1].map(|i| 0.5 * (low[i] + high[i]));
        let distance2 = middle[0] * middle[0] + middle[1] * middle[1] + height * height;
        let diagonal2 = self.lengths[0] * self.lengths[0] + self.lengths[1] * self.lengths[1];
        let is_near = height > 0.0 && diagonal2 >= SMALL * SMALL * distance2;
        is_near.then(|| self.seen(low, high, height)).filter(|seen| seen.solid_angle > 0.0)
    }

    /// As it is seen from that height, with its corners there along its sides.
    fn seen(&self, low: [f64; 2], high: [f64; 2], height: f64) -> Seen<'_> {
        // Normals of the planes through the point and a side; only their parts along the rectangle's normal matter.
        let along_normal = |at: f64| at / (at * at + height * height).sqrt();
        let [y0, x1, y1, x0] = [-low[1], high[0], high[1], -low[0]].map(along_normal);
        let angle = |a: f64, b: f64| libm::acos(-a * b);
        let offset = 2.0 * PI - angle(y1, x0) - angle(x0, y0);
        let solid_angle = angle(y0, x1) + angle(x1, y1) - offset;
        Seen { rectangle: self, low, high, height, bounds: [y0, y1], offset, solid_angle }
    }
}

impl Seen<'_> {
    /// The solid angle.
    pub(super) const fn solid_angle(&self) -> f32 {
        self.solid_angle as f32
    }

    /// Unit direction and distance to the point of those coordinates in [0, 1)².
    pub(super) fn sample(&self, u: Vec2) -> (Vec3, f32) {
        let [b0, b1] = self.bounds;
        // Along x, where the part of the solid angle below has that share of all.
        let angle = f64::from(u.x) * self.solid_angle + self.offset;
        let slope = (libm::cos(angle) * b0 - b1) / libm::sin(angle);
        let cosine = (1.0 / (slope * slope + b0 * b0).sqrt()).copysign(slope).clamp(-1.0, 1.0);
        let x = cosine * self.height / (1.0 - cosine * cosine).sqrt();
        let x = if x.is_nan() { 0.0 } else { x }.clamp(self.low[0], self.high[0]);
        // Along y, uniform in the sine of the angle.
        let distance = (x * x + self.height * self.height).sqrt();
        let sine = |y: f64| y / (y * y + distance * distance).sqrt();
        let (low, high) = (sine(self.low[1]), sine(self.high[1]));
        let sine = low + f64::from(u.y) * (high - low);
        let y = (sine * distance / (1.0 - sine * sine).sqrt()).clamp(self.low[1], self.high[1]);
        let Rectangle { sides, normal, .. } = self.rectangle;
        let to = sides[0] * x + sides[1] * y - *normal * self.height;
        let length = to.length();
        ((to / length).as_vec3(), length as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foton_math::{Purpose, Stream};

    /// Of the plane z = 1, as the origin sees it from above.
    fn rectangle(low: [f32; 2], high: [f32; 2]) -> Rectangle {
        let [a, b, c, d] =
            [[low[0], low[1]], [high[0], low[1]], high, [low[0], high[1]]].map(|[x, y]| Vec3::new(x, y, 1.0));
        let triangles = [Primitive::Triangle([a, c, b]), Primitive::Triangle([d, c, a])];
        Rectangle::of(&triangles).expect("two triangles that share a diagonal")
    }

    fn seen(rectangle: &Rectangle, from: Vec3) -> Seen<'_> {
        rectangle.seen_from(from).expect("near, and in front of it")
    }

    #[test]
    fn a_face_of_a_cube_is_a_sixth_of_all_directions() {
        let face = rectangle([-1.0; 2], [1.0; 2]);
        let found = f64::from(seen(&face, Vec3::ZERO).solid_angle());
        assert!((found / (4.0 * PI / 6.0) - 1.0).abs() < 1e-6, "{found}");
        assert!(face.seen_from(Vec3::Z * 2.0).is_none(), "from behind");
        assert!(face.seen_from(Vec3::Z * -20.0).is_none(), "from afar");
    }

    #[test]
    fn samples_fall_on_each_part_in_proportion_to_its_solid_angle() {
        for (low, high) in [([-1.0, -2.0], [3.0, 0.5]), ([0.5, 0.1], [2.0, 4.0]), ([-9.0, -9.0], [9.0, 9.0])]
        {
            let whole = rectangle(low, high);
            let whole = seen(&whole, Vec3::ZERO);
            let (parts, n) = (4usize, 64_000u32);
            let mut counts = vec![0u32; parts * parts];
            let mut stream = Stream::new(1, Purpose::Test, 0, 0);
            let side = |i: usize| (high[i] - low[i]) / parts as f32;
            for _ in 0..n {
                let (direction, distance) = whole.sample(stream.next_2d());
                let p = direction * distance;
                assert!((p.z - 1.0).abs() < 1e-5 && (direction.length() - 1.0).abs() < 1e-6);
                let cell = |i: usize, x: f32| (((x - low[i]) / side(i)) as usize).min(parts - 1);
                counts[cell(0, p.x) * parts + cell(1, p.y)] += 1;
            }
            let chi2: f64 = (0..parts * parts)
                .map(|k| {
                    let corner = [k / parts, k % parts];
                    let at = |more: usize| [0, 1].map(|i| low[i] + side(i) * (corner[i] + more) as f32);
                    let part = rectangle(at(0), at(1));
                    let [x, y] = part.sides.map(|side| part.corner.dot(side));
                    let high = [x + part.lengths[0], y + part.lengths[1]];
                    let share = part.seen([x, y], high, 1.0).solid_angle / whole.solid_angle;
                    let expected = f64::from(n) * share;
                    (f64::from(counts[k]) - expected).powi(2) / expected
                })
                .sum();
            assert!(chi2 < 40.0, "χ² of 15 degrees of freedom: {chi2}");
        }
    }

    #[test]
    fn only_rectangles_are_rectangles() {
        let [a, b, c, d] = [Vec3::ZERO, Vec3::X * 2.0, Vec3::new(2.0, 1.0, 0.0), Vec3::Y];
        let of = |second: [Vec3; 3]| {
            Rectangle::of(&[Primitive::Triangle([a, b, c]), Primitive::Triangle(second)]).is_some()
        };
        assert!(of([a, c, d]) && of([c, d, a]) && of([d, a, c]));
        assert!(!of([c, a, d]), "it faces the other way");
        assert!(!of([a, c, d + Vec3::Z * 0.01]), "not flat");
        assert!(!of([a, c, d + Vec3::X * 0.01]), "not closed");
        assert!(!of([a, d, -Vec3::X]), "another side is shared");
        let skew = [a, b, c + Vec3::X].map(|p| p);
        let second = [a, c + Vec3::X, d + Vec3::X];
        assert!(Rectangle::of(&[Primitive::Triangle(skew), Primitive::Triangle(second)]).is_none());
    }
}
