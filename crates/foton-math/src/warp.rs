//! Warps of the unit square to the domains that light transport samples, each with its pdf.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_4, PI};

use glam::{Vec2, Vec3};

/// Uniform on the unit disc, by the concentric map of Shirley and Chiu (1997): strata stay compact. `[SC97]`
#[must_use]
#[inline]
pub fn square_to_disc(u: Vec2) -> Vec2 {
    let p = u * 2.0 - 1.0;
    let along_x = p.x.abs() > p.y.abs();
    let (major, minor) = if along_x { (p.x, p.y) } else { (p.y, p.x) };
    // Any angle will do in the centre. No branch: loops over many points are compiled to work on several at once.
    let ratio = if major == 0.0 { 0.0 } else { minor / major };
    let (sin, cos) = sin_cos_eighth(FRAC_PI_4 * ratio);
    let (across, along) = (major * sin, major * cos);
    if along_x { Vec2::new(along, across) } else { Vec2::new(across, along) }
}

/// Sine and cosine of an angle within ±π/4, to single precision: Taylor's series up to x⁹, whose remainder is below 2⁻²⁷.
///
/// Only basic operations: the functions of a system's library may differ in the last bit from machine to machine.
#[inline]
fn sin_cos_eighth(x: f32) -> (f32, f32) {
    let x2 = x * x;
    let sin = 1.0
        - x2 * (1.0 / 6.0)
            * (1.0 - x2 * (1.0 / 20.0) * (1.0 - x2 * (1.0 / 42.0) * (1.0 - x2 * (1.0 / 72.0))));
    let cos =
        1.0 - x2 * 0.5 * (1.0 - x2 * (1.0 / 12.0) * (1.0 - x2 * (1.0 / 30.0) * (1.0 - x2 * (1.0 / 56.0))));
    (x * sin, cos)
}

/// Sine and cosine of `u` turns, `u` in [0, 1].
#[inline]
fn sin_cos_turns(u: f32) -> (f32, f32) {
    let quarter = (4.0 * u + 0.5) as u32;
    let (sin, cos) = sin_cos_eighth((u - 0.25 * quarter as f32) * (2.0 * PI));
    match quarter & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// The pdf of [`square_to_disc`] with respect to area.
#[must_use]
#[inline]
pub const fn square_to_disc_pdf() -> f32 {
    FRAC_1_PI
}

/// Cosine-distributed about +z, a unit vector.
#[must_use]
#[inline]
pub fn square_to_cosine_hemisphere(u: Vec2) -> Vec3 {
    let d = square_to_disc(u);
    d.extend((1.0 - d.length_squared()).max(0.0).sqrt())
}

/// The pdf of [`square_to_cosine_hemisphere`] with respect to solid angle.
#[must_use]
#[inline]
pub fn square_to_cosine_hemisphere_pdf(v: Vec3) -> f32 {
    v.z.max(0.0) * FRAC_1_PI
}

/// Uniform on the unit sphere.
#[must_use]
#[inline]
pub fn square_to_sphere(u: Vec2) -> Vec3 {
    let z = 1.0 - 2.0 * u.x;
    let r = 2.0 * (u.x * (1.0 - u.x)).max(0.0).sqrt();
    let (sin, cos) = sin_cos_turns(u.y);
    Vec3::new(r * cos, r * sin, z)
}

/// The pdf of [`square_to_sphere`] with respect to solid angle.
#[must_use]
#[inline]
pub const fn square_to_sphere_pdf() -> f32 {
    0.25 * FRAC_1_PI
}

/// Uniform in the cone of directions about +z whose half angle θ has `one_minus_cos = 1 − cos θ`.
///
/// The angle comes as 1 − cos θ because cos θ itself rounds to 1 for a small, distant emitter.
#[must_use]
#[inline]
pub fn square_to_cone(u: Vec2, one_minus_cos: f32) -> Vec3 {
    let h = u.x * one_minus_cos;
    let r = (h * (2.0 - h)).max(0.0).sqrt();
    let (sin, cos) = sin_cos_turns(u.y);
    Vec3::new(r * cos, r * sin, 1.0 - h)
}

/// The pdf of [`square_to_cone`] with respect to solid angle, inside the cone.
#[must_use]
#[inline]
pub fn square_to_cone_pdf(one_minus_cos: f32) -> f32 {
    1.0 / (2.0 * PI * one_minus_cos)
}

/// Barycentric coordinates (of the second and third vertex), uniform by area.
#[must_use]
#[inline]
pub fn square_to_triangle(u: Vec2) -> Vec2 {
    let s = u.x.sqrt();
    Vec2::new(1.0 - s, u.y * s)
}

/// The pdf of [`square_to_triangle`] with respect to the triangle's own area.
#[must_use]
#[inline]
pub fn square_to_triangle_pdf(area: f32) -> f32 {
    1.0 / area
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Purpose, Stream, cases};

    /// χ² statistic of `n` draws of `bin` against equal expectations.
    fn chi2(bins: usize, n: u32, mut bin: impl FnMut(&mut Stream) -> usize) -> f64 {
        let mut stream = Stream::new(11, Purpose::Test, 0, 0);
        let n = cases(n);
        let mut count = vec![0u32; bins];
        for _ in 0..n {
            count[bin(&mut stream).min(bins - 1)] += 1;
        }
        let expected = f64::from(n) / bins as f64;
        count.iter().map(|&c| (f64::from(c) - expected).powi(2) / expected).sum()
    }

    /// Bin of an azimuth among `n` equal ones.
    fn azimuth(x: f32, y: f32, n: usize) -> usize {
        (((y.atan2(x) / (2.0 * PI) + 0.5) * n as f32) as usize).min(n - 1)
    }

    /// Wilson–Hilferty bound of χ² with `dof` degrees of freedom at p = 0.001 (0.01 over the five tests here, and some).
    fn bound(dof: f64) -> f64 {
        let k = 2.0 / (9.0 * dof);
        dof * (1.0 - k + 3.1 * k.sqrt()).powi(3)
    }

    // Each warp is binned by its own cumulative distribution, so that all bins are equally likely if the pdf beside it is right.

    #[test]
    fn sines_and_cosines_are_right_to_single_precision_all_around() {
        let n = cases(100_000);
        for i in 0..=n {
            let u = i as f32 / n as f32;
            let (sin, cos) = sin_cos_turns(u);
            let (s, c) = (2.0 * std::f64::consts::PI * f64::from(u)).sin_cos();
            let worst = (f64::from(sin) - s).abs().max((f64::from(cos) - c).abs());
            assert!(worst < 3e-7, "{u}: {sin} {s}, {cos} {c}");
        }
    }

    #[test]
    fn discs_are_uniform_by_area() {
        let got = chi2(96, 192_000, |s| {
            let d = square_to_disc(s.next_2d());
            ((d.length_squared() * PI * square_to_disc_pdf() * 8.0) as usize).min(7) * 12
                + azimuth(d.x, d.y, 12)
        });
        assert!(got < bound(95.0), "{got}");
    }

    #[test]
    fn hemispheres_follow_the_cosine() {
        let got = chi2(96, 192_000, |s| {
            let v = square_to_cosine_hemisphere(s.next_2d());
            // The share of directions steeper than v is ∫ cos/π = sin²θ = 1 − (π pdf)².
            let share = 1.0 - (PI * square_to_cosine_hemisphere_pdf(v)).powi(2);
            ((share * 8.0) as usize).min(7) * 12 + azimuth(v.x, v.y, 12)
        });
        assert!(got < bound(95.0), "{got}");
    }

    #[test]
    fn spheres_are_uniform_by_solid_angle() {
        let got = chi2(96, 192_000, |s| {
            let v = square_to_sphere(s.next_2d());
            assert!((v.length() - 1.0).abs() < 1e-5);
            (((1.0 - v.z) * 2.0 * PI * square_to_sphere_pdf() * 8.0) as usize).min(7) * 12
                + azimuth(v.x, v.y, 12)
        });
        assert!(got < bound(95.0), "{got}");
    }

    #[test]
    fn cones_are_uniform_down_to_tiny_angles() {
        for one_minus_cos in [0.5f32, 1e-3, 1e-9] {
            let got = chi2(96, 192_000, |s| {
                let v = square_to_cone(s.next_2d(), one_minus_cos);
                // 1 − cos θ from the sine, which stays exact for tiny angles.
                let sin2 = v.x * v.x + v.y * v.y;
                let h = sin2 / (1.0 + v.z);
                let share = h * 2.0 * PI * square_to_cone_pdf(one_minus_cos);
                ((share * 8.0) as usize).min(7) * 12 + azimuth(v.x, v.y, 12)
            });
            assert!(got < bound(95.0), "{one_minus_cos}: {got}");
        }
    }

    #[test]
    fn triangles_are_uniform_by_area() {
        // Four congruent quarters, each cut into four again.
        let got = chi2(16, 64_000, |s| {
            let mut b = square_to_triangle(s.next_2d());
            assert!((square_to_triangle_pdf(0.5) - 2.0).abs() < 1e-6);
            let mut bin = 0;
            for _ in 0..2 {
                b *= 2.0;
                let quarter = if b.x >= 1.0 {
                    b.x -= 1.0;
                    1
                } else if b.y >= 1.0 {
                    b.y -= 1.0;
                    2
                } else if b.x + b.y <= 1.0 {
                    0
                } else {
                    b = 1.0 - b;
                    3
                };
                bin = bin * 4 + quarter;
            }
            bin
        });
        assert!(got < bound(15.0), "{got}");
    }
}
