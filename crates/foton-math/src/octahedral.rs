//! Unit vectors in few bits by the octahedral map.
//!
//! Source: Cigolle et al., "A Survey of Efficient Representations for Independent Unit Vectors" (2014). `[CDE14]`

use glam::{Vec2, Vec3};

#[inline]
fn fold(v: Vec2) -> Vec2 {
    (Vec2::ONE - Vec2::new(v.y.abs(), v.x.abs())) * Vec2::new(1f32.copysign(v.x), 1f32.copysign(v.y))
}

/// A unit vector in the low `2 × BITS` bits; the error is at most 4.25 / 2^BITS radians (3√2, measured).
#[must_use]
#[inline]
pub fn encode<const BITS: u32>(v: Vec3) -> u32 {
    let scale = ((1u32 << BITS) - 1) as f32;
    let p = Vec2::new(v.x, v.y) / (v.x.abs() + v.y.abs() + v.z.abs());
    let p = if v.z < 0.0 { fold(p) } else { p };
    let q = ((p * 0.5 + 0.5) * scale + 0.5).clamp(Vec2::ZERO, Vec2::splat(scale));
    (q.x as u32) | ((q.y as u32) << BITS)
}

/// The unit vector of [`encode`].
#[must_use]
#[inline]
pub fn decode<const BITS: u32>(code: u32) -> Vec3 {
    let mask = (1u32 << BITS) - 1;
    let scale = mask as f32;
    let p = Vec2::new((code & mask) as f32, ((code >> BITS) & mask) as f32) * (2.0 / scale) - 1.0;
    let z = 1.0 - p.x.abs() - p.y.abs();
    let p = if z < 0.0 { fold(p) } else { p };
    Vec3::new(p.x, p.y, z).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Purpose, Stream, cases, warp};

    #[test]
    fn decoding_gives_the_direction_back_within_the_stated_error() {
        let mut stream = Stream::new(1, Purpose::Test, 0, 0);
        for _ in 0..cases(20_000) {
            let v = warp::square_to_sphere(stream.next_2d());
            assert!(decode::<15>(encode::<15>(v)).distance(v) < 4.25 / 32768.0);
            assert!(decode::<8>(encode::<8>(v)).distance(v) < 4.25 / 256.0);
        }
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            assert!(decode::<15>(encode::<15>(-axis)).distance(-axis) < 1e-4);
            assert!(decode::<15>(encode::<15>(axis)).distance(axis) < 1e-4);
        }
    }
}
