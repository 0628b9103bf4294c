//! Each warp against its pdf, by χ².

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
        ((d.length_squared() * PI * square_to_disc_pdf() * 8.0) as usize).min(7) * 12 + azimuth(d.x, d.y, 12)
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
        (((1.0 - v.z) * 2.0 * PI * square_to_sphere_pdf() * 8.0) as usize).min(7) * 12 + azimuth(v.x, v.y, 12)
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
