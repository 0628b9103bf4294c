//! Models that Mitsuba 3 does not have: their values against the published formulas, from angles and in double precision, and what
//! they return of the light in a white furnace, by numerical integration.

use std::f64::consts::PI;

use super::*;

/// Directions by their angle from the normal and their azimuth, in degrees.
pub(super) const DIRECTIONS: [[f64; 2]; 7] =
    [[0.0, 0.0], [8.0, 30.0], [25.0, 100.0], [44.0, 170.0], [61.0, 260.0], [77.0, 300.0], [86.0, 10.0]];

pub(super) fn direction([theta, phi]: [f64; 2]) -> Vec3 {
    let ((st, ct), (sp, cp)) = (theta.to_radians().sin_cos(), phi.to_radians().sin_cos());
    Vec3::new((st * cp) as f32, (st * sp) as f32, ct as f32)
}

/// Compares the green values of a BSDF with a formula of the polar angles of `wo` and `wi` in radians and their azimuths.
fn assert_values(bsdf: Bsdf<Rgb, f32>, formula: impl Fn([f64; 2], [f64; 2]) -> f64) {
    for o in DIRECTIONS {
        for i in DIRECTIONS {
            let value = f64::from(at(bsdf).eval(direction(o), direction(i), ALL).g);
            let wanted = formula(o.map(f64::to_radians), i.map(f64::to_radians));
            assert!((value - wanted).abs() < 2e-4 * wanted + 1e-6, "{bsdf:?} {o:?} {i:?}: {value} {wanted}");
        }
    }
}

/// The green share of light from `wo` that a BSDF returns, by quadrature over the sphere.
pub(super) fn albedo(s: &Scattering, wo: Vec3) -> f64 {
    let (rows, columns) = (400, 400);
    let mut sum = 0.0;
    for i in 0..rows {
        let theta = PI * (f64::from(i) + 0.5) / f64::from(rows);
        for j in 0..columns {
            let phi = 2.0 * PI * (f64::from(j) + 0.5) / f64::from(columns);
            let (sine, cosine) = theta.sin_cos();
            let w = Vec3::new((sine * phi.cos()) as f32, (sine * phi.sin()) as f32, cosine as f32);
            sum += f64::from(s.eval(wo, w, ALL).g) * cosine.abs() * sine;
        }
    }
    sum * PI / f64::from(rows) * 2.0 * PI / f64::from(columns)
}

/// The same by sampling.
pub(super) fn sampled_albedo(s: &Scattering, wo: Vec3) -> f64 {
    let mut stream = Stream::new(37, Purpose::Test, 0, 0);
    let n = 200_000;
    let weights = (0..n)
        .filter_map(|_| s.sample(wo, Transport::Importance, stream.next_1d(), stream.next_2d(), TOGETHER));
    weights.map(|x| f64::from(x.weight.g)).sum::<f64>() / f64::from(n)
}

/// Asserts that a BSDF returns of a white furnace what sampling says, and no more than `most`.
fn assert_furnace(bsdf: Bsdf<Rgb, f32>, most: f64) -> Vec<f64> {
    let s = at(bsdf);
    let shares = [2.0, 30.0, 55.0, 70.0, 80.0].map(|theta| {
        let wo = direction([theta, 20.0]);
        let (exact, sampled) = (albedo(&s, wo), sampled_albedo(&s, wo));
        assert!((exact - sampled).abs() < 8e-3, "{bsdf:?} at {theta}°: {exact}, {sampled} by sampling");
        assert!(exact < most, "{bsdf:?} at {theta}°: {exact}");
        exact
    });
    shares.to_vec()
}

#[test]
fn roughdiffuse_has_the_values_of_its_formula() {
    for (alpha, fast) in [(0.1, false), (0.3, false), (1.0, false), (0.4, true)] {
        let rho = 0.5;
        let sigma2 = f64::from(alpha as f32).powi(2) / 2.0;
        assert_values(rough_diffuse(alpha as f32, fast), |[o, phi_o], [i, phi_i]| {
            let (large, small, cos_phi) = (o.max(i), o.min(i), (phi_o - phi_i).cos());
            let (b, c) = (sigma2 / (sigma2 + 0.09), sigma2 / (sigma2 + 0.13));
            let c1 = 1.0 - 0.5 * sigma2 / (sigma2 + 0.33);
            // At the normal no azimuth counts.
            if small == 0.0 {
                let c3 = 0.0;
                let one = c1 + c3;
                return if fast { rho * c1 / PI } else { rho * one / PI + 0.17 * rho * rho * c / PI };
            }
            if fast {
                return rho / PI * (c1 + 0.45 * b * cos_phi.max(0.0) * large.sin() * small.tan());
            }
            let bend = if cos_phi >= 0.0 { 0.0 } else { (2.0 * small / PI).powi(3) };
            let c2 = 0.45 * b * (large.sin() - bend);
            let c3 = 0.125 * b * (4.0 * large * small / (PI * PI)).powi(2);
            let once =
                c1 + cos_phi * c2 * small.tan() + (1.0 - cos_phi.abs()) * c3 * ((large + small) / 2.0).tan();
            let twice = 0.17 * c * (1.0 - cos_phi * (2.0 * small / PI).powi(2));
            rho / PI * once + rho * rho / PI * twice
        });
    }
}

#[test]
fn roughdiffuse_returns_no_more_than_it_gets() {
    for alpha in [0.0, 0.2, 0.5, 1.0] {
        for use_fast_approx in [false, true] {
            let white = Bsdf::RoughDiffuse(RoughDiffuse { reflectance: Rgb::WHITE, alpha, use_fast_approx });
            // The fit is up to 1.5 % above at grazing angles.
            let shares = assert_furnace(white, 1.02);
            assert!(alpha > 0.0 || shares.iter().all(|a| (a - 1.0).abs() < 1e-3), "Lambertian: {shares:?}");
        }
    }
}

#[test]
fn phong_has_the_values_of_its_formula() {
    for exponent in [0.0f32, 5.0, 60.0] {
        let n = f64::from(exponent);
        assert_values(phong(exponent), |[o, phi_o], [i, phi_i]| {
            let cos = o.cos() * i.cos() - o.sin() * i.sin() * (phi_o - phi_i).cos();
            0.5 / PI + 0.4 * (n + 2.0) / (2.0 * PI) * if cos > 0.0 { cos.powf(n) } else { 0.0 }
        });
    }
}

#[test]
fn phong_returns_no_more_than_it_gets() {
    for exponent in [0.0, 10.0, 100.0] {
        let shares = assert_furnace(phong(exponent), 0.9 + 1e-3);
        assert!((shares[0] - 0.9).abs() < 5e-3, "all of the lobe leaves near the normal: {shares:?}");
        // More than all is scaled down.
        let (specular_reflectance, diffuse_reflectance) = (Rgb::WHITE, Rgb::splat(0.5));
        assert_furnace(Bsdf::Phong(Phong { exponent, specular_reflectance, diffuse_reflectance }), 1.001);
    }
}

#[test]
fn ward_has_the_values_of_its_formula() {
    for variant in 0..3 {
        for (u, v) in [(0.3f32, 0.3f32), (0.2, 0.6)] {
            let (a, b) = (f64::from(u), f64::from(v));
            assert_values(ward(variant, u, v), |[o, phi_o], [i, phi_i]| {
                let sum = [
                    o.sin() * phi_o.cos() + i.sin() * phi_i.cos(),
                    o.sin() * phi_o.sin() + i.sin() * phi_i.sin(),
                    o.cos() + i.cos(),
                ];
                let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
                let (delta, phi_h) = ((sum[2] / length).acos(), sum[1].atan2(sum[0]));
                let spread = (phi_h.cos() / a).powi(2) + (phi_h.sin() / b).powi(2);
                let gauss = (-delta.tan().powi(2) * spread).exp() / (4.0 * PI * a * b);
                // 4 h²/(h · n)⁴ is 1/((o · ĥ)² cos⁴ δ), ĥ being the half vector's direction.
                let along = length / 2.0;
                let scale = match ward::VARIANTS[variant] {
                    "ward" => 1.0 / (o.cos() * i.cos()).sqrt(),
                    "ward-duer" => 1.0 / (o.cos() * i.cos()),
                    _ => 1.0 / (along.powi(2) * delta.cos().powi(4)),
                };
                0.5 / PI + 0.3 * gauss * scale
            });
        }
    }
}

#[test]
fn ward_returns_no_more_than_it_gets() {
    for (u, v) in [(0.2, 0.2), (0.2, 0.5)] {
        let of = |variant| {
            let (specular_reflectance, diffuse_reflectance) = (Rgb::WHITE, Rgb::BLACK);
            Bsdf::Ward(Ward { variant, alpha_u: u, alpha_v: v, specular_reflectance, diffuse_reflectance })
        };
        // The other two are known not to keep their energy at grazing angles.
        assert_furnace(of(0), 1.001);
        assert_furnace(of(1), 1.2);
        assert_furnace(of(2), 2.0);
    }
}

#[test]
fn difftrans_has_the_values_of_its_formula_and_returns_what_it_lets_through() {
    let transmittance = Rgb::new(0.2, 0.5, 0.8);
    let s = at(Bsdf::DiffuseTransmitter(DiffuseTransmitter { transmittance }));
    for wo in DIRECTIONS.map(direction) {
        for wi in DIRECTIONS.map(direction) {
            assert_eq!(s.eval(wo, wi, ALL), Rgb::BLACK);
            for (wo, wi) in [(wo, -wi), (-wo, wi)] {
                assert!((f64::from(s.eval(wo, wi, ALL).g) - 0.5 / PI).abs() < 1e-7);
            }
        }
        assert!((albedo(&s, wo) - 0.5).abs() < 1e-3 && (sampled_albedo(&s, wo) - 0.5).abs() < 1e-6);
    }
}

#[test]
fn distribution_phong_has_the_values_of_its_formula() {
    // A metal that reflects everything: D G / (4 cos cos), G by Beckmann's Λ.
    for (u, v) in [(0.3f32, 0.3f32), (0.2, 0.5)] {
        let (a, b) = (f64::from(u), f64::from(v));
        let roughness = Some(Microfacets { distribution: Distribution::Phong, alpha_u: u, alpha_v: v });
        let white = Rgb::WHITE;
        let metal = Conductor { eta: Rgb::BLACK, k: white, specular_reflectance: white, roughness };
        assert_values(Bsdf::Conductor(metal), |[o, phi_o], [i, phi_i]| {
            let of = |t: f64, p: f64| [t.sin() * p.cos(), t.sin() * p.sin(), t.cos()];
            let (wo, wi) = (of(o, phi_o), of(i, phi_i));
            let sum: [f64; 3] = std::array::from_fn(|k| wo[k] + wi[k]);
            let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
            let (cos, phi) = (sum[2] / length, sum[1].atan2(sum[0]));
            let exponents = [a, b].map(|alpha| 2.0 / (alpha * alpha) - 2.0);
            let exponent = exponents[0] * phi.cos().powi(2) + exponents[1] * phi.sin().powi(2);
            let d = ((exponents[0] + 2.0) * (exponents[1] + 2.0)).sqrt() / (2.0 * PI) * cos.powf(exponent);
            let seen = |w: [f64; 3]| {
                let across = ((a * w[0]).powi(2) + (b * w[1]).powi(2)).sqrt() / w[2];
                if across == 0.0 {
                    return 1.0;
                }
                let x = 1.0 / across;
                let lambda = 0.5 * ((-x * x).exp() / (x * PI.sqrt()) - libm::erfc(x));
                1.0 / (1.0 + lambda)
            };
            d * seen(wo) * seen(wi) / (4.0 * wo[2] * wi[2])
        });
    }
}

#[test]
fn distribution_phong_returns_no_more_than_it_gets() {
    for alpha in [0.1, 0.3, 0.7] {
        let roughness = rough(Distribution::Phong, alpha);
        let white = Rgb::WHITE;
        let metal = Conductor { eta: Rgb::BLACK, k: white, specular_reflectance: white, roughness };
        // Very rough facets hide more of each other at grazing angles than Beckmann's do.
        assert_furnace(Bsdf::Conductor(metal), if alpha > 0.5 { 1.05 } else { 1.001 });
    }
}
