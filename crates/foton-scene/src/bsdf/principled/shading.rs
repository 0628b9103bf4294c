//! What the lobes of principled models are made of: the diffuse base, sheen, tints, Fresnel factors and facets.

use std::f32::consts::FRAC_1_PI;

use foton_math::Rgb;

use crate::bsdf::fresnel;
use crate::bsdf::microfacet::{MicrofacetDistribution, Microfacets};

/// The narrowest facets: Mitsuba takes a smaller α for this.
const MIN_ALPHA: f32 = 1e-3;

/// (1 − cos)⁵, Schlick's weight of the reflectance at grazing angles. `[BUR12]`
pub(super) fn grazing(cos: f32) -> f32 {
    let m = (1.0 - cos).clamp(0.0, 1.0);
    (m * m) * (m * m) * m
}

/// From `a` at `t` = 0 to `b` at 1.
pub(super) fn between(a: Rgb, b: Rgb, t: f32) -> Rgb {
    a + (b - a) * t
}

/// The hue of a base colour, of luminance 1; white for black.
pub(super) fn hue(base: Rgb) -> Rgb {
    let luminance = base.luminance();
    if luminance > 0.0 { base / luminance } else { Rgb::WHITE }
}

/// The facets of a roughness, α being its square, and of how much they are stretched along u. `[BUR12]`
pub(super) fn facets(roughness: f32, anisotropic: f32) -> Microfacets<f32> {
    let [alpha_u, alpha_v] = alphas(roughness, anisotropic);
    Microfacets { distribution: MicrofacetDistribution::Ggx, alpha_u, alpha_v }
}

/// α along u and v.
pub(super) fn alphas(roughness: f32, anisotropic: f32) -> [f32; 2] {
    let aspect = (1.0 - 0.9 * anisotropic).sqrt();
    let alpha = roughness * roughness;
    [alpha / aspect, alpha * aspect].map(|a| a.max(MIN_ALPHA))
}

/// π times the value of the diffuse base for a white one, by the cosines to the normal and that between a direction and the half
/// vector: Burley's, whose edges are darker where it is smooth and brighter where it is rough, or as far as `flatness` says, that of
/// a base which light enters a little way. `[BUR12]` section 5.3, `[BUR15]`
pub(super) fn diffuse(cos_o: f32, cos_i: f32, cos_half: f32, roughness: f32, flatness: f32) -> f32 {
    let (g_o, g_i) = (grazing(cos_o), grazing(cos_i));
    let retro = 2.0 * roughness * cos_half * cos_half;
    let dull = (1.0 - 0.5 * g_o) * (1.0 - 0.5 * g_i) + retro * (g_o + g_i + g_o * g_i * (retro - 1.0));
    if flatness == 0.0 {
        return dull;
    }
    let edge = |g: f32| 1.0 + (0.5 * retro - 1.0) * g;
    let flat = 1.25 * (edge(g_o) * edge(g_i) * (1.0 / (cos_o + cos_i) - 0.5) + 0.5);
    dull + (flat - dull) * flatness
}

/// The value of sheen of strength 1. `[BUR12]` section 5.2
pub(super) fn sheen(base: Rgb, tint: f32, cos_half: f32) -> Rgb {
    between(Rgb::WHITE, hue(base), tint) * grazing(cos_half)
}

/// About how much light sheen of strength 1 reflects.
pub(super) fn sheen_albedo(cos: f32) -> f32 {
    0.01 + 0.25 * (1.0 - cos).powi(3)
}

/// What a dielectric of index `eta` reflects, seen from outside: white light, tinted as far as `tint` says. `[BUR12]`
pub(super) fn dielectric(base: Rgb, eta: f32, tint: f32, cos: f32) -> Rgb {
    let exact = Rgb::splat(fresnel::reflectance(cos, 1.0, eta));
    if tint == 0.0 {
        return exact;
    }
    let root = (eta - 1.0) / (eta + 1.0);
    between(exact, between(hue(base) * (root * root), Rgb::WHITE, grazing(cos)), tint)
}

/// What a metal of this colour reflects.
pub(super) fn metal(base: Rgb, cos: f32) -> Rgb {
    between(base, Rgb::WHITE, grazing(cos))
}

/// A colour by a factor that is none of π.
pub(super) fn lambertian(base: Rgb, factor: f32) -> Rgb {
    base * (factor * FRAC_1_PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hue_of_a_colour_has_luminance_one_and_black_has_none() {
        let red = Rgb::new(0.4, 0.1, 0.05);
        assert!((hue(red).luminance() - 1.0).abs() < 1e-6 && (hue(red).r / hue(red).g - 4.0).abs() < 1e-5);
        assert_eq!(hue(Rgb::BLACK), Rgb::WHITE);
    }

    #[test]
    fn a_smooth_base_is_dark_at_its_edges_and_a_rough_one_bright() {
        // At grazing light and view, from the same side, the cosine to the half vector is 1.
        assert!(diffuse(0.05, 0.05, 1.0, 0.0, 0.0) < 0.5);
        assert!(diffuse(0.05, 0.05, 1.0, 1.0, 0.0) > 2.0);
        assert!((diffuse(1.0, 1.0, 1.0, 0.5, 0.0) - 1.0).abs() < 1e-6);
        // A flat base is never seen edge on: the two cosines' sum is its depth.
        assert!((diffuse(1.0, 1.0, 1.0, 0.5, 1.0) - 0.625).abs() < 1e-6);
    }

    #[test]
    fn stretched_facets_keep_their_area() {
        let r = facets(0.6, 0.8);
        assert!((r.alpha_u * r.alpha_v - 0.36 * 0.36).abs() < 1e-5 && r.alpha_u > r.alpha_v);
        assert_eq!(facets(0.0, 0.0).alpha_u, MIN_ALPHA);
    }
}
