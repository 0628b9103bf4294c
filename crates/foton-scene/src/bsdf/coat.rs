//! What gets through a rough coat, integrated once when a scene is built and kept as a short series.
//!
//! Light that a facet refracts counts if it leaves the surface on the other side and is not hidden there; light that is lost
//! between facets stays lost, as in Mitsuba 3, whose rough plastic this follows.

use foton_math::Frame;
use foton_math::glam::{Vec2, Vec3};

use super::fresnel;
use super::microfacet::{MicrofacetDistribution, Microfacets};

/// Terms of the series. With eight the error is below 4·10⁻³ at a roughness of 0.05, below 2·10⁻³ from 0.1 on.
const TERMS: usize = 8;
/// Points at which the series is fitted.
const NODES: usize = 24;
/// Points of the integral over what comes from below: more, since total reflection begins at an angle.
const BELOW: usize = 96;
/// Points per axis of the square over which facets are sampled.
const FACETS: usize = 32;

/// Roughnesses at which a coat is integrated whose roughness a texture gives.
const ROUGHNESSES: usize = 12;
/// The last of them.
const ROUGHEST: f32 = 2.0;

/// A rough boundary of two dielectrics as the diffuse base below it sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coat {
    /// Chebyshev coefficients of the share that enters, over 2√cos − 1.
    series: [f32; TERMS],
    /// Share of diffuse light from below that the boundary sends back.
    pub(super) inside: f32,
}

impl Coat {
    /// Integrates a boundary of two indices of refraction.
    pub(super) fn new(r: &Microfacets<f32>, int_ior: f32, ext_ior: f32) -> Self {
        // The rest is kept by the boundary: 4 ∫ R(s²) s³ ds, with cos = s².
        let inside: f64 = (0..BELOW)
            .map(|i| (i as f64 + 0.5) / BELOW as f64)
            .map(|s| 4.0 * s.powi(3) * passage(r, s * s, ext_ior, int_ior).reflected / BELOW as f64)
            .sum();
        Self { series: fit(|cos| passage(r, cos, int_ior, ext_ior).transmitted), inside: inside as f32 }
    }

    /// Share of light at the cosine `cos` of incidence that enters, or of light from below that leaves there.
    pub(super) fn transmittance(&self, cos: f32) -> f32 {
        sum(&self.series, cos)
    }

    /// What gets through, in half the memory.
    pub(super) fn packed(&self) -> PackedCoat {
        PackedCoat(self.series.map(|c| (c / STEP).round() as i16))
    }
}

/// What gets through a rough coat, to 16 bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct PackedCoat([i16; TERMS]);

/// The steps of packed coefficients, which lie well between −2 and 2.
const STEP: f32 = 1.0 / 16_384.0;

impl PackedCoat {
    /// As [`Coat::transmittance`].
    pub(super) fn transmittance(&self, cos: f32) -> f32 {
        sum(&self.0.map(|c| f32::from(c) * STEP), cos)
    }
}

/// The series at a cosine, by Clenshaw's recurrence.
fn sum(series: &[f32; TERMS], cos: f32) -> f32 {
    let x = 2.0 * cos.clamp(0.0, 1.0).sqrt() - 1.0;
    let (mut b1, mut b2) = (0.0, 0.0);
    for c in series.iter().skip(1).rev() {
        (b1, b2) = (2.0 * x * b1 - b2 + c, b1);
    }
    (x * b1 - b2 + series[0]).clamp(0.0, 1.0)
}

/// The coats of a surface whose roughness lies between two ends: one where it is the same everywhere, or several in between.
#[derive(Clone, Debug)]
pub(crate) struct Coats {
    ends: [f32; 2],
    /// Evenly over the square root of α.
    coats: Vec<Coat>,
}

impl Coats {
    pub(super) fn new(
        distribution: MicrofacetDistribution,
        ends: [f32; 2],
        int_ior: f32,
        ext_ior: f32,
    ) -> Self {
        // Above 1 nothing changes much.
        let ends = if ends[0] < ends[1] { [ends[0].min(ROUGHEST), ends[1].min(ROUGHEST)] } else { ends };
        let count = if ends[0] < ends[1] { ROUGHNESSES } else { 1 };
        let [low, high] = ends.map(f32::sqrt);
        let coats = (0..count).map(|i| {
            let root = low + (high - low) * i as f32 / (ROUGHNESSES - 1) as f32;
            let alpha = if count == 1 { ends[0] } else { root * root };
            Coat::new(&Microfacets::isotropic(distribution, alpha), int_ior, ext_ior)
        });
        Self { ends, coats: coats.collect() }
    }

    /// The coat of a roughness, between its neighbours.
    pub(crate) fn at(&self, alpha: f32) -> Coat {
        let [first, .., last] = &self.coats[..] else { return self.coats[0] };
        let [low, high] = self.ends.map(f32::sqrt);
        let place = (alpha.sqrt() - low) / (high - low) * (self.coats.len() - 1) as f32;
        if place.is_nan() || place <= 0.0 {
            return *first;
        }
        let below = place as usize;
        let Some([a, b]) = self.coats.get(below..below + 2) else { return *last };
        let share = place - below as f32;
        let between = |a: f32, b: f32| a + (b - a) * share;
        Coat {
            series: std::array::from_fn(|i| between(a.series[i], b.series[i])),
            inside: between(a.inside, b.inside),
        }
    }
}

/// Shares of light that a rough boundary passes on.
#[derive(Default)]
struct Passage {
    reflected: f64,
    transmitted: f64,
}

/// Integrates over the facets that are seen at a cosine, `beyond` being the index on the other side.
fn passage(r: &Microfacets<f32>, cos: f64, beyond: f32, here: f32) -> Passage {
    let cos = cos.max(1e-6);
    let wo = Vec3::new((1.0 - cos * cos).sqrt() as f32, 0.0, cos as f32);
    let mut sum = Passage::default();
    let place = |i: usize| (i as f32 + 0.5) / FACETS as f32;
    for i in 0..FACETS * FACETS {
        let h = r.sample(wo, Vec2::new(place(i / FACETS), place(i % FACETS)));
        let share = f64::from(r.sample_weight(wo, h));
        let frame = Frame::from_normal(h);
        let boundary = fresnel::dielectric(frame.to_local(wo), beyond, here);
        let f = f64::from(boundary.reflectance);
        let mirrored = h * (2.0 * wo.dot(h)) - wo;
        if mirrored.z > 0.0 {
            sum.reflected += share * f * f64::from(r.visible(mirrored, h));
        }
        let refracted = boundary.refracted.map(|w| frame.to_outer(w)).filter(|w| w.z < 0.0);
        sum.transmitted += refracted.map_or(0.0, |w| share * (1.0 - f) * f64::from(r.visible(w, h)));
    }
    let count = (FACETS * FACETS) as f64;
    Passage { reflected: sum.reflected / count, transmitted: sum.transmitted / count }
}

/// The coefficients of f(cos) over 2√cos − 1.
fn fit(f: impl Fn(f64) -> f64) -> [f32; TERMS] {
    use std::f64::consts::PI;
    let mut series = [0.0f64; TERMS];
    for node in 0..NODES {
        let angle = PI * (node as f64 + 0.5) / NODES as f64;
        let value = f((0.5 + 0.5 * angle.cos()).powi(2));
        for (k, c) in series.iter_mut().enumerate() {
            let norm = if k == 0 { 1.0 } else { 2.0 };
            *c += norm * value * (k as f64 * angle).cos() / NODES as f64;
        }
    }
    series.map(|c| c as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::MicrofacetDistribution::{Beckmann, Ggx};

    fn plastic(facets: Microfacets<f32>) -> Coat {
        Coat::new(&facets, 1.5, 1.0)
    }

    #[test]
    fn the_series_is_the_integral() {
        for facets in [(Ggx, 0.1), (Ggx, 0.4), (Beckmann, 0.2), (Beckmann, 0.8)] {
            let facets = Microfacets::isotropic(facets.0, facets.1);
            let coat = plastic(facets);
            for i in 0..=100 {
                let cos = f64::from(i) / 100.0;
                let exact = passage(&facets, cos, 1.5, 1.0).transmitted;
                let got = f64::from(coat.transmittance(cos as f32));
                assert!((got - exact).abs() < 3e-3, "{facets:?} at {cos}: {got} {exact}");
                let packed = f64::from(coat.packed().transmittance(cos as f32));
                assert!((packed - got).abs() < 3e-4, "{facets:?} at {cos}: {packed} {got}");
            }
        }
    }

    #[test]
    fn coats_between_two_roughnesses_are_what_is_integrated_there() {
        for distribution in [Ggx, Beckmann] {
            let coats = Coats::new(distribution, [0.02, 0.9], 1.5, 1.0);
            for alpha in [0.01f32, 0.02, 0.05, 0.13, 0.4, 0.77, 0.9, 2.0] {
                let exact = plastic(Microfacets::isotropic(distribution, alpha.clamp(0.02, 0.9)));
                let got = coats.at(alpha);
                assert!((got.inside - exact.inside).abs() < 2e-3, "{distribution:?} {alpha}: {}", got.inside);
                for i in 0..=20 {
                    let cos = i as f32 / 20.0;
                    let (a, b) = (got.transmittance(cos), exact.transmittance(cos));
                    assert!((a - b).abs() < 6e-3, "{distribution:?} {alpha} at {cos}: {a} {b}");
                }
            }
        }
    }

    #[test]
    fn a_coat_becomes_smooth_as_its_roughness_vanishes() {
        let coat = plastic(Microfacets::isotropic(Ggx, 1e-3));
        for cos in [0.05f32, 0.2, 0.5, 1.0] {
            let wo = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
            let smooth = 1.0 - fresnel::dielectric(wo, 1.5, 1.0).reflectance;
            assert!((coat.transmittance(cos) - smooth).abs() < 3e-3, "{cos}");
        }
        assert!((coat.inside - fresnel::diffuse_reflectance(1.0 / 1.5)).abs() < 6e-3, "{}", coat.inside);
    }
}
