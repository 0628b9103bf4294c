//! Distributions of microfacet normals: they cover the surface, and normals are sampled as they are seen.

use super::*;
use foton_math::{Purpose, Stream};

fn all() -> Vec<Microfacets<f32>> {
    let isotropic = [0.05, 0.3, 0.9]
        .into_iter()
        .flat_map(|a| MicrofacetDistribution::ALL.map(|d| Microfacets::isotropic(d, a)));
    let stretched = MicrofacetDistribution::ALL.map(|distribution| Microfacets {
        distribution,
        alpha_u: 0.15,
        alpha_v: 0.6,
    });
    isotropic.chain(stretched).collect()
}

fn views() -> [Vec3; 4] {
    [Vec3::Z, Vec3::new(0.5, 0.2, 0.8), Vec3::new(-0.9, 0.3, 0.25), Vec3::new(0.1, -1.0, 0.08)]
        .map(Vec3::normalize)
}

/// ∫ f over normals, in slope space where the densities are smooth.
fn integrate(m: &Microfacets<f32>, mut f: impl FnMut(Vec3) -> f64) -> f64 {
    // x = α tan: the plane mapped from polar coordinates, radius r/(1−r).
    let (rings, sectors) = (1500, 128);
    let mut sum = 0.0;
    for i in 0..rings {
        let t = (f64::from(i) + 0.5) / f64::from(rings);
        let radius = 3.0 * t / (1.0 - t);
        let measure = radius * 3.0 / ((1.0 - t) * (1.0 - t)) / f64::from(rings);
        for j in 0..sectors {
            let phi = 2.0 * std::f64::consts::PI * (f64::from(j) + 0.5) / f64::from(sectors);
            let (x, y) =
                (radius * phi.cos() * f64::from(m.alpha_u), radius * phi.sin() * f64::from(m.alpha_v));
            let h = Vec3::new(-x as f32, -y as f32, 1.0).normalize();
            // dω = cos³ dx dy.
            let solid = f64::from(h.z).powi(3) * f64::from(m.alpha_u * m.alpha_v);
            sum += f(h) * solid * measure * 2.0 * std::f64::consts::PI / f64::from(sectors);
        }
    }
    sum
}

#[test]
fn facets_cover_the_surface_once_and_fill_what_each_view_sees() {
    for m in all() {
        let cover = integrate(&m, |h| f64::from(m.density(h) * h.z));
        assert!((cover - 1.0).abs() < 2e-3, "{m:?}: {cover}");
        for v in views() {
            let seen = integrate(&m, |h| f64::from(m.visible(v, h) * v.dot(h).max(0.0) * m.density(h)));
            // Phong's facets hide each other as Beckmann's do, which is not quite right.
            let bound = match (m.distribution, m.widest() > 0.6) {
                (MicrofacetDistribution::Phong, is_very_rough) => {
                    if is_very_rough {
                        2.0
                    } else {
                        0.1
                    }
                }
                _ => 1e-2,
            };
            assert!((seen / f64::from(v.z) - 1.0).abs() < bound, "{m:?} {v}: {seen}");
        }
    }
}

#[test]
fn sampled_normals_follow_their_density() {
    // χ² over 8 × 8 bins of slope direction and steepness, expectations by quadrature.
    let mut stream = Stream::new(21, Purpose::Test, 0, 0);
    for m in all() {
        for v in views() {
            let bin = |h: Vec3| {
                let (x, y) = (h.x / h.z / m.alpha_u, h.y / h.z / m.alpha_v);
                let steep = ((x.hypot(y) / (1.0 + x.hypot(y))) * 8.0) as usize;
                let azimuth = ((y.atan2(x) / (2.0 * PI) + 0.5) * 8.0) as usize;
                steep.min(7) * 8 + azimuth.min(7)
            };
            let n = 40_000;
            let mut expected = [0.0f64; 64];
            integrate(&m, |h| {
                let p = f64::from(m.pdf(v, h));
                let (x, y) = (h.x / h.z / m.alpha_u, h.y / h.z / m.alpha_v);
                let radius = f64::from(x.hypot(y));
                let t = radius / (3.0 + radius);
                let solid = f64::from(h.z).powi(3) * f64::from(m.alpha_u * m.alpha_v);
                let measure = radius * 3.0 / ((1.0 - t) * (1.0 - t)) / 1500.0;
                expected[bin(h)] += p * solid * measure * 2.0 * std::f64::consts::PI / 128.0 * f64::from(n);
                0.0
            });
            let mut count = [0.0f64; 64];
            for _ in 0..n {
                count[bin(m.sample(v, stream.next_2d()))] += 1.0;
            }
            let (mut chi2, mut dof, mut rest) = (0.0, -1.0, (0.0, 0.0));
            for (c, e) in count.iter().zip(expected) {
                if e < 10.0 {
                    rest = (rest.0 + c, rest.1 + e);
                } else {
                    chi2 += (c - e).powi(2) / e;
                    dof += 1.0;
                }
            }
            if rest.1 > 10.0 {
                chi2 += (rest.0 - rest.1).powi(2) / rest.1;
                dof += 1.0;
            }
            // Wilson–Hilferty at p = 2·10⁻⁴ (Šidák for 32 tests at 0.01 is 3·10⁻⁴).
            let k: f64 = 2.0 / (9.0 * dof);
            let bound = dof * (1.0 - k + 3.55 * k.sqrt()).powi(3);
            assert!(chi2 < bound, "{m:?} {v}: χ² {chi2}, bound {bound} ({dof} dof)");
        }
    }
}

#[test]
fn the_inverse_error_function_inverts() {
    let mut stream = Stream::new(3, Purpose::Test, 0, 0);
    for _ in 0..1000 {
        let y = f64::from(2.0 * stream.next_1d() - 1.0) * 0.999_999;
        assert!((libm::erf(inverse_erf(y)) - y).abs() < 1e-12, "{y}");
    }
}
