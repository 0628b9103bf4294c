//! Every BSDF against the same laws: sampling follows its density, weights are value × cosine / density, energy is not made,
//! light paths can be reversed.

use super::MicrofacetDistribution::{self as Distribution, Beckmann, Ggx};
use super::*;
use foton_math::glam::{Vec2, Vec3};
use foton_math::{Purpose, Rgb, Stream, warp};

mod coatings;
mod published;
mod sampling;

const ALL: LobeFlags = LobeFlags::ALL;
const TOGETHER: LobeFlags = LobeFlags::NONE;

fn at(bsdf: Bsdf<Rgb, f32>) -> Scattering {
    let coats =
        Bsdf::map(&bsdf, |c| c.into(), |n, _| n.into()).rough_coats(|n, _| [n.constant().unwrap_or(0.0); 2]);
    Scattering { bsdf, opacity: 1.0, coat: coats.map(|c| Cover::Coat(c.at(0.0))) }
}

fn glass(roughness: Option<Microfacets<f32>>) -> Bsdf<Rgb, f32> {
    let (specular_reflectance, specular_transmittance) = (Rgb::WHITE, Rgb::WHITE);
    Bsdf::Dielectric(Dielectric {
        int_ior: 1.5,
        ext_ior: 1.0,
        specular_reflectance,
        specular_transmittance,
        roughness,
    })
}

fn rough(distribution: MicrofacetDistribution, alpha: f32) -> Option<Microfacets<f32>> {
    Some(Microfacets::isotropic(distribution, alpha))
}

fn gold(roughness: Option<Microfacets<f32>>) -> Bsdf<Rgb, f32> {
    let (eta, k) = (Rgb::new(0.143, 0.375, 1.442), Rgb::new(3.983, 2.386, 1.603));
    Bsdf::Conductor(Conductor { eta, k, specular_reflectance: Rgb::WHITE, roughness })
}

fn plastic(nonlinear: bool, roughness: Option<Microfacets<f32>>) -> Bsdf<Rgb, f32> {
    Bsdf::Plastic(Plastic {
        int_ior: 1.49,
        ext_ior: 1.0,
        diffuse_reflectance: Rgb::new(0.2, 0.5, 0.9),
        specular_reflectance: Rgb::WHITE,
        nonlinear,
        roughness,
    })
}

fn rough_diffuse(alpha: f32, use_fast_approx: bool) -> Bsdf<Rgb, f32> {
    Bsdf::RoughDiffuse(RoughDiffuse { reflectance: Rgb::new(0.2, 0.5, 0.8), alpha, use_fast_approx })
}

fn phong(exponent: f32) -> Bsdf<Rgb, f32> {
    let (specular_reflectance, diffuse_reflectance) = (Rgb::splat(0.4), Rgb::new(0.2, 0.5, 0.6));
    Bsdf::Phong(Phong { exponent, specular_reflectance, diffuse_reflectance })
}

fn ward(variant: usize, alpha_u: f32, alpha_v: f32) -> Bsdf<Rgb, f32> {
    let (specular_reflectance, diffuse_reflectance) = (Rgb::splat(0.3), Rgb::new(0.2, 0.5, 0.6));
    Bsdf::Ward(Ward { variant, alpha_u, alpha_v, specular_reflectance, diffuse_reflectance })
}

impl Scattering {
    /// The smallest roughness of its glossy lobes, infinite without any.
    fn narrowest(&self) -> f32 {
        let base = self.bsdf.gloss();
        let own = if let Some(Cover::Layer(layer)) = self.coat {
            layer.roughness.map(|r| r.widest())
        } else {
            None
        };
        base.into_iter().chain(own).fold(f32::INFINITY, f32::min)
    }
}

fn all() -> Vec<Scattering> {
    let stretched = Some(Microfacets { distribution: Ggx, alpha_u: 0.1, alpha_v: 0.4 });
    let mut all: Vec<Scattering> = [
        Bsdf::Diffuse(Diffuse { reflectance: Rgb::new(0.2, 0.5, 0.8) }),
        Bsdf::Mirror(Mirror { reflectance: Rgb::splat(0.9) }),
        Bsdf::Null(Null),
        Bsdf::ThinDielectric(ThinDielectric {
            int_ior: 1.5,
            ext_ior: 1.0,
            specular_reflectance: Rgb::WHITE,
            specular_transmittance: Rgb::WHITE,
        }),
        glass(None),
        glass(rough(Beckmann, 0.3)),
        glass(rough(Ggx, 0.08)),
        glass(stretched),
        gold(None),
        gold(rough(Beckmann, 0.25)),
        gold(rough(Ggx, 0.05)),
        gold(stretched),
        plastic(false, None),
        plastic(true, rough(Ggx, 0.05)),
        plastic(true, rough(Beckmann, 0.3)),
        glass(rough(Distribution::Phong, 0.3)),
        gold(rough(Distribution::Phong, 0.25)),
        gold(Some(Microfacets { distribution: Distribution::Phong, alpha_u: 0.1, alpha_v: 0.4 })),
        plastic(false, rough(Distribution::Phong, 0.3)),
        rough_diffuse(0.3, false),
        rough_diffuse(0.9, true),
        phong(12.0),
        phong(400.0),
        ward(0, 0.3, 0.3),
        ward(1, 0.15, 0.4),
        ward(2, 0.3, 0.2),
        Bsdf::DiffuseTransmitter(DiffuseTransmitter { transmittance: Rgb::new(0.2, 0.5, 0.8) }),
    ]
    .map(at)
    .to_vec();
    all.push(Scattering { opacity: 0.4, ..all[0] });
    all.extend(coatings::coated());
    all
}

fn views() -> [Vec3; 5] {
    [
        Vec3::Z,
        Vec3::new(0.6, 0.1, 0.7),
        Vec3::new(-0.9, 0.3, 0.3),
        Vec3::new(0.2, -0.5, -0.6),
        Vec3::new(0.9, 0.1, -0.2),
    ]
    .map(Vec3::normalize)
}

/// Whether light arrives at all on that side of a one-sided reflector.
fn is_lit(s: &Scattering, wo: Vec3) -> bool {
    wo.z > 0.0 || s.bsdf.transmits()
}

#[test]
fn weights_are_value_times_cosine_over_density() {
    let mut stream = Stream::new(31, Purpose::Test, 0, 0);
    for s in all() {
        for wo in views().into_iter().filter(|&w| is_lit(&s, w)) {
            for _ in 0..2000 {
                let sample = s.sample(wo, Transport::Radiance, stream.next_1d(), stream.next_2d(), TOGETHER);
                let Some(sample) = sample else { continue };
                assert!((sample.wi.length() - 1.0).abs() < 1e-4 && sample.weight.is_finite(), "{s:?} {wo}");
                // Lobes of a smooth coat and its base are weighted apart, and so are those of a thin layer of opacity.
                let smooth_coat = matches!(s.bsdf, Bsdf::Plastic(Plastic { roughness: None, .. }));
                if sample.lobe.intersects(LobeFlags::DELTA) || s.opacity < 1.0 || smooth_coat {
                    continue;
                }
                if sample.wi.z.abs() < 1e-3 {
                    continue;
                }
                let expected = s.eval(wo, sample.wi, ALL) * (sample.wi.z.abs() / s.pdf(wo, sample.wi));
                let error = (expected - sample.weight).map(f32::abs).max_component();
                assert!(
                    error <= 2e-2 * sample.weight.max_component().max(1e-3),
                    "{s:?} {wo} {sample:?} {expected:?}"
                );
            }
        }
    }
}

#[test]
fn sampling_brings_the_light_that_the_value_says() {
    // E[weight · g(wi)] by sampling the BSDF = ∫ f cos g by sampling the sphere, for a g that tells directions apart; delta
    // lobes are added from their own list.
    let g = |w: Vec3| 1.0 + 0.5 * w.x + 0.3 * w.y * w.z + if w.z > 0.0 { 0.7 } else { 0.0 };
    let mut stream = Stream::new(32, Purpose::Test, 0, 0);
    for s in all() {
        // Narrow lobes would need far more points on the sphere.
        if s.narrowest() < 0.2 {
            continue;
        }
        for wo in views().into_iter().filter(|&w| is_lit(&s, w)) {
            let n = 200_000;
            let (mut a, mut a2, mut b, mut b2) = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
            for _ in 0..n {
                let sample = s.sample(wo, Transport::Radiance, stream.next_1d(), stream.next_2d(), TOGETHER);
                let x = sample.map_or(0.0, |x| f64::from(x.weight.g * g(x.wi)));
                let w = warp::square_to_sphere(stream.next_2d());
                let y = f64::from(s.eval(wo, w, ALL).g * w.z.abs() * g(w) / warp::square_to_sphere_pdf());
                (a, a2, b, b2) = (a + x, a2 + x * x, b + y, b2 + y * y);
            }
            let count = f64::from(n);
            {
                let lobes = s.lobes(wo, Transport::Radiance, Vec2::splat(0.5), LobeFlags::DELTA);
                b += lobes.iter().flatten().map(|l| f64::from(l.weight.g * g(l.wi))).sum::<f64>() * count;
            }
            let sigma = ((a2 + b2) / count).sqrt() / count.sqrt();
            assert!((a - b).abs() / count < 4.5 * sigma, "{s:?} {wo}: {} {} ± {sigma}", a / count, b / count);
        }
    }
}

#[test]
fn densities_integrate_to_the_chance_of_scattering() {
    let mut stream = Stream::new(33, Purpose::Test, 0, 0);
    for s in all().into_iter().filter(|s| s.flags().intersects(LobeFlags::GLOSSY) && s.narrowest() > 0.2) {
        for wo in views().into_iter().filter(|&w| is_lit(&s, w)) {
            let n = 400_000;
            let (mut p, mut p2) = (0.0, 0.0);
            for _ in 0..n {
                let w = warp::square_to_sphere(stream.next_2d());
                let x = f64::from(s.pdf(wo, w) / warp::square_to_sphere_pdf());
                (p, p2) = (p + x, p2 + x * x);
            }
            let (mean, sigma) = (p / f64::from(n), (p2.sqrt()) / f64::from(n));
            // Facets may send light below the surface; those samples are lost. Under a coating light may be reflected totally, and a
            // smooth one mirrors a share.
            let least = match s.coat {
                // From inside, what the base lets through at an angle does not leave the coating.
                Some(Cover::Layer(_)) if s.flags().intersects(LobeFlags::TRANSMISSION) => 0.03,
                Some(Cover::Layer(_)) => 0.3,
                _ => 0.6,
            };
            assert!(mean < 1.0 + 4.0 * sigma && mean > least, "{s:?} {wo}: {mean} ± {sigma}");
        }
    }
}

#[test]
fn no_bsdf_makes_energy() {
    let mut stream = Stream::new(34, Purpose::Test, 0, 0);
    for s in all() {
        for wo in views().into_iter().filter(|&w| is_lit(&s, w)) {
            let n = 40_000;
            let sum: f64 = (0..n)
                .filter_map(|_| {
                    s.sample(wo, Transport::Importance, stream.next_1d(), stream.next_2d(), TOGETHER)
                })
                .map(|x| f64::from(x.weight.max_component()))
                .sum();
            assert!(sum / f64::from(n) < 1.0 + 0.02, "{s:?} {wo}: {}", sum / f64::from(n));
        }
    }
}

#[test]
fn reflection_is_reciprocal_and_refraction_up_to_the_squared_index() {
    let mut stream = Stream::new(35, Purpose::Test, 0, 0);
    for s in all() {
        for _ in 0..2000 {
            let (a, b) = (warp::square_to_sphere(stream.next_2d()), warp::square_to_sphere(stream.next_2d()));
            let forth = s.eval(a, b, ALL).g;
            let mut back = s.eval(b, a, ALL).g;
            if let (Bsdf::Dielectric(Dielectric { int_ior, ext_ior, .. }), true) = (s.bsdf, a.z * b.z < 0.0) {
                // f(a, b)/η_a² = f(b, a)/η_b².
                let ior = |w: Vec3| if w.z > 0.0 { ext_ior } else { int_ior };
                back *= (ior(a) / ior(b)).powi(2);
            }
            assert!((forth - back).abs() <= 2e-3 * forth.abs().max(1e-3), "{s:?} {a} {b}: {forth} {back}");
        }
    }
}

#[test]
fn glass_loses_no_power_and_radiance_through_both_faces_is_unscaled() {
    let mut stream = Stream::new(2, Purpose::Test, 0, 0);
    let s = at(glass(None));
    for _ in 0..2000 {
        let wo = warp::square_to_sphere(stream.next_2d());
        let sum: f32 =
            s.lobes(wo, Transport::Importance, Vec2::ZERO, ALL).iter().flatten().map(|l| l.weight.r).sum();
        assert!((sum - 1.0).abs() < 1e-6, "{wo}");
        let [_, Some(entry), ..] = s.lobes(wo, Transport::Radiance, Vec2::ZERO, ALL) else { continue };
        let [_, back, ..] = s.lobes(entry.wi, Transport::Radiance, Vec2::ZERO, ALL);
        let back = back.expect("what came in can go out");
        assert!(back.wi.distance(wo) < 2e-4 / wo.z.abs().max(1e-2), "{wo}: {}", back.wi);
        // (1−F)·(η₁/η₂)² on the way in times (1−F)·(η₂/η₁)² on the way out.
        let through = entry.weight.r * back.weight.r;
        assert!((through - entry.probability * back.probability).abs() < 1e-5, "{wo}");
    }
}

#[test]
fn photons_choose_glass_lobes_in_proportion_to_fresnel() {
    let s = at(glass(None));
    let wo = Vec3::new(0.9, 0.0, 0.19f32.sqrt());
    let [Some(reflection), ..] = s.lobes(wo, Transport::Importance, Vec2::ZERO, ALL) else {
        panic!("reflects")
    };
    let mut stream = Stream::new(9, Purpose::Test, 0, 0);
    let n = 100_000;
    let reflected = (0..n)
        .filter(|_| {
            let x = s
                .sample(wo, Transport::Importance, stream.next_1d(), Vec2::ZERO, TOGETHER)
                .expect("scatters");
            assert!((x.weight.r - 1.0).abs() < 1e-6);
            x.wi.z > 0.0
        })
        .count() as f32;
    let p = reflection.probability;
    assert!((reflected - p * n as f32).abs() < 4.0 * (p * (1.0 - p) * n as f32).sqrt());
}

#[test]
fn rough_lobes_become_smooth_ones_as_roughness_vanishes() {
    let wo = Vec3::new(0.5, 0.2, 0.7).normalize();
    for (smooth, nearly) in
        [(glass(None), glass(rough(Ggx, 1e-4))), (gold(None), gold(rough(Beckmann, 1e-4)))]
    {
        let a = at(smooth).lobes(wo, Transport::Radiance, Vec2::splat(0.4), ALL);
        let b = at(nearly).lobes(wo, Transport::Radiance, Vec2::splat(0.4), ALL);
        for (a, b) in a.iter().zip(&b) {
            match (a, b) {
                (Some(a), Some(b)) => {
                    assert!(a.wi.distance(b.wi) < 1e-3 && (a.weight.r - b.weight.r).abs() < 1e-3);
                }
                (None, None) => {}
                _ => panic!("{a:?} {b:?}"),
            }
        }
    }
}

/// What a white rough metal reflects, by quadrature over its facets, where light comes from the true surface's side alone and that is
/// tilted against the shading normal: no more than arrives. What photons gain there is their adjoint's.
#[test]
fn rough_metal_reflects_no_more_than_arrives_whatever_its_shading_normal() {
    let (rings, sectors) = (1200, 256);
    for distribution in [Ggx, Beckmann] {
        for alpha in [0.11f32, 0.3, 0.9] {
            let scattering = Scattering {
                bsdf: Bsdf::Conductor(Conductor {
                    eta: Rgb::BLACK,
                    k: Rgb::WHITE,
                    specular_reflectance: Rgb::WHITE,
                    roughness: Some(Microfacets::isotropic(distribution, alpha)),
                }),
                opacity: 1.0,
                coat: None,
            };
            for wo in [Vec3::Z, Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.96, 0.1, 0.15)].map(Vec3::normalize) {
                for true_normal in [Vec3::Z, Vec3::new(0.26, 0.0, 0.96), Vec3::new(-0.2, 0.4, 0.9)] {
                    let mut sum = 0.0;
                    for i in 0..rings {
                        let t = (f64::from(i) + 0.5) / f64::from(rings);
                        let slope = f64::from(alpha) * t / (1.0 - t);
                        let ring = slope * f64::from(alpha) / (1.0 - t).powi(2) / f64::from(rings);
                        for j in 0..sectors {
                            let phi = 2.0 * std::f64::consts::PI * (f64::from(j) + 0.5) / f64::from(sectors);
                            let h = Vec3::new((-slope * phi.cos()) as f32, (-slope * phi.sin()) as f32, 1.0)
                                .normalize();
                            let wi = h * (2.0 * wo.dot(h)) - wo;
                            if wo.dot(h) <= 0.0 || wi.z <= 0.0 || wi.dot(true_normal) <= 0.0 {
                                continue;
                            }
                            let value = scattering.eval(wo, wi, ALL).g * wi.z * 4.0 * wo.dot(h);
                            // dω of a normal is cos³ of its slopes' area.
                            let solid = f64::from(h.z).powi(3) * ring * 2.0 * std::f64::consts::PI;
                            sum += f64::from(value) * solid / f64::from(sectors);
                        }
                    }
                    assert!(sum <= 1.0 + 1e-4, "{distribution:?} {alpha} {wo} {true_normal}: {sum}");
                    assert!(alpha > 0.2 || true_normal != Vec3::Z || wo.z < 0.5 || sum > 0.98, "{sum}");
                }
            }
        }
    }
}
