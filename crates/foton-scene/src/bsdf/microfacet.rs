//! Distributions of microfacet normals: how dense, how much hidden, and sampled as they are seen.
//!
//! Directions are local with +z the surface's normal. Sources: Walter et al. 2007 `[WML07]`, Heitz 2014 `[HEI14]`; GGX sampling
//! after Heitz 2018 `[HEI18]`; Beckmann sampling by inverting the distribution of visible slopes numerically.

use std::f32::consts::PI;

use foton_math::Rgb;
use foton_math::glam::{Vec2, Vec3};

use crate::description::Number;
use crate::parameter::{Parameter, Role};

/// A distribution of microfacet normals, over numbers `N`: [`Number`] in a description, [`f32`] at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Microfacets<N = Number> {
    /// Its shape.
    pub distribution: MicrofacetDistribution,
    /// Roughness α along the texture's u, above 0.
    pub alpha_u: N,
    /// Roughness α along the texture's v, above 0.
    pub alpha_v: N,
}

/// The shape of a distribution of microfacet normals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MicrofacetDistribution {
    /// Gaussian slopes.
    #[default]
    Beckmann,
    /// Longer tails; also known as Trowbridge–Reitz.
    Ggx,
    /// A power of the cosine, 2/α² − 2, which may differ along u and v. `[AS00]`
    Phong,
}

impl MicrofacetDistribution {
    /// All of them, in the order of their names in files.
    pub const ALL: [Self; 3] = [Self::Beckmann, Self::Ggx, Self::Phong];

    /// Its name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        DISTRIBUTIONS[self as usize]
    }

    /// Its name in the window.
    #[must_use]
    pub const fn label(self) -> &'static str {
        match self {
            Self::Beckmann => "Beckmann",
            Self::Ggx => "GGX",
            Self::Phong => "Phong",
        }
    }
}

/// The names of distributions in files.
const DISTRIBUTIONS: &[&str] = &["beckmann", "ggx", "phong"];

const DISTRIBUTION: Parameter = Parameter::choice("distribution", DISTRIBUTIONS)
    .label("Distribution")
    .help("GGX has longer highlight tails; Phong is for files of Mitsuba 0.6.");

const ALPHA: Parameter = Parameter::number("alpha", 0.1, (0.0, 1e6))
    .label("Roughness")
    .help("Spread of the surface's slopes. Up to 0.1 eye paths follow the lobe; above that, gathered photons do.")
    .slider(0.001, 1.0, true)
    .textured()
    .role(Role::Roughness);

/// What a texture's roughness is brought into. Mitsuba takes smaller values for the lower end.
pub(super) const ALPHAS: [f32; 2] = [1e-4, 1e6];

const SAMPLE_VISIBLE: Parameter = Parameter::ignored("sample_visible", "Visible normals are always sampled.");

/// What files say of microfacets that may be stretched. That a surface is rough at all is said by its plugin.
pub const ROUGHNESS: &[Parameter] = &[
    ALPHA,
    Parameter {
        name: "alpha_u",
        label: "Roughness along u",
        excludes: &["alpha"],
        default_text: "`alpha`",
        ..ALPHA
    },
    Parameter {
        name: "alpha_v",
        label: "Roughness along v",
        excludes: &["alpha"],
        default_text: "`alpha`",
        ..ALPHA
    },
    DISTRIBUTION,
    SAMPLE_VISIBLE,
];

/// What files say of microfacets that are the same all around.
pub const ISOTROPIC_ROUGHNESS: &[Parameter] = &[ALPHA, DISTRIBUTION, SAMPLE_VISIBLE];

impl Microfacets {
    /// Those of a rough surface in a file that says nothing else.
    pub const DEFAULT: Self = Self::stated(MicrofacetDistribution::Beckmann);
    /// Those of a surface that is made rough in the window.
    pub const PRESET: Self = Self::stated(MicrofacetDistribution::Ggx);

    /// Of the roughness in a file that says nothing else.
    const fn stated(distribution: MicrofacetDistribution) -> Self {
        let alpha = Number::Constant(ALPHA.default_number());
        Self { distribution, alpha_u: alpha, alpha_v: alpha }
    }
}

impl<N: Copy> Microfacets<N> {
    /// The same roughness along both axes.
    #[must_use]
    pub fn isotropic(distribution: MicrofacetDistribution, alpha: f32) -> Self
    where
        N: From<f32>,
    {
        Self { distribution, alpha_u: alpha.into(), alpha_v: alpha.into() }
    }

    /// The same with its numbers replaced, by what they are and the range that they may have.
    #[inline(always)]
    pub(super) fn map<M>(&self, mut numbers: impl FnMut(N, [f32; 2]) -> M) -> Microfacets<M> {
        let Self { distribution, alpha_u, alpha_v } = *self;
        Microfacets { distribution, alpha_u: numbers(alpha_u, ALPHAS), alpha_v: numbers(alpha_v, ALPHAS) }
    }
}

impl Microfacets<f32> {
    /// The larger roughness.
    #[must_use]
    pub const fn widest(&self) -> f32 {
        self.alpha_u.max(self.alpha_v)
    }

    /// Density of normals D(h) per unit solid angle of h, per unit area of the surface; ∫ D cos = 1.
    pub(crate) fn density(&self, h: Vec3) -> f32 {
        if h.z <= 0.0 {
            return 0.0;
        }
        if self.distribution == MicrofacetDistribution::Phong {
            return self.phong_density(h);
        }
        let cos2 = h.z * h.z;
        let (x, y) = (h.x / self.alpha_u, h.y / self.alpha_v);
        let slope2 = (x * x + y * y) / cos2;
        let area = PI * self.alpha_u * self.alpha_v * cos2 * cos2;
        match self.distribution {
            MicrofacetDistribution::Beckmann | MicrofacetDistribution::Phong => (-slope2).exp() / area,
            MicrofacetDistribution::Ggx => 1.0 / (area * (1.0 + slope2) * (1.0 + slope2)),
        }
    }

    /// Smith's Λ: hidden over visible area, seen from `v`.
    fn lambda(&self, v: Vec3) -> f32 {
        let (x, y) = (self.alpha_u * v.x, self.alpha_v * v.y);
        let alpha_tan = (x * x + y * y).sqrt() / v.z.abs();
        if alpha_tan == 0.0 {
            return 0.0;
        }
        match self.distribution {
            MicrofacetDistribution::Ggx => 0.5 * ((1.0 + alpha_tan * alpha_tan).sqrt() - 1.0),
            // Phong's has no closed form and is nearly the same. `[WML07]`
            MicrofacetDistribution::Beckmann | MicrofacetDistribution::Phong => {
                let a = f64::from(1.0 / alpha_tan);
                let tail = (-a * a).exp() / (a * std::f64::consts::PI.sqrt());
                (0.5 * (tail - libm::erfc(a))) as f32
            }
        }
    }

    /// Share of the facets facing `v` (on `h`'s side) that is not hidden from it.
    pub(crate) fn visible(&self, v: Vec3, h: Vec3) -> f32 {
        if v.dot(h) * v.z <= 0.0 { 0.0 } else { 1.0 / (1.0 + self.lambda(v)) }
    }

    /// Phong's density: √((e_u + 2)(e_v + 2))/(2π) cosᵉ with the exponent e between e_u and e_v by the azimuth of `h`.
    fn phong_density(&self, h: Vec3) -> f32 {
        let [e_u, e_v] = [self.alpha_u, self.alpha_v].map(phong_exponent);
        let sin2 = h.x * h.x + h.y * h.y;
        let exponent = if sin2 > 0.0 { (e_u * h.x * h.x + e_v * h.y * h.y) / sin2 } else { e_u };
        // cosᵉ by the sine: e may be so large that the rounding of the cosine would count.
        let log_cos = if sin2 < 0.5 { 0.5 * (-sin2).ln_1p() } else { h.z.ln() };
        ((e_u + 2.0) * (e_v + 2.0)).sqrt() / (2.0 * PI) * (exponent * log_cos).exp()
    }

    /// The distribution by which normals are sampled. Those that are visible of Phong's have no closed form: GGX is as high at its peak
    /// and nowhere much lower.
    fn sampled(&self) -> Self {
        match self.distribution {
            MicrofacetDistribution::Beckmann | MicrofacetDistribution::Ggx => *self,
            MicrofacetDistribution::Phong => Self {
                distribution: MicrofacetDistribution::Ggx,
                alpha_u: self.alpha_u.min(1.0),
                alpha_v: self.alpha_v.min(1.0),
            },
        }
    }

    /// What a normal counts that [`Microfacets::sample`] chose: how many more `wo` sees of it than are sampled.
    pub(crate) fn sample_weight(&self, wo: Vec3, h: Vec3) -> f32 {
        if self.distribution != MicrofacetDistribution::Phong {
            return 1.0;
        }
        let sampled = self.sampled();
        let there = sampled.visible(wo, h) * sampled.density(h);
        if there > 0.0 { self.visible(wo, h) * self.density(h) / there } else { 0.0 }
    }

    /// Density of [`Microfacets::sample`] per unit solid angle of h.
    pub(crate) fn pdf(&self, wo: Vec3, h: Vec3) -> f32 {
        self.sampled().visible_pdf(wo, h)
    }

    /// Density of the normals that are visible from `wo`.
    fn visible_pdf(&self, wo: Vec3, h: Vec3) -> f32 {
        self.visible(wo, h) * wo.dot(h).abs() * self.density(h) / wo.z.abs()
    }

    /// A normal of the facets as `wo` (with `wo.z > 0`) sees them.
    pub(crate) fn sample(&self, wo: Vec3, u: Vec2) -> Vec3 {
        let stretched = Vec3::new(self.alpha_u * wo.x, self.alpha_v * wo.y, wo.z).normalize();
        let slope = match self.distribution {
            MicrofacetDistribution::Ggx => return self.sample_ggx(stretched, u),
            MicrofacetDistribution::Beckmann => visible_beckmann_slope(stretched, u),
            MicrofacetDistribution::Phong => return self.sampled().sample(wo, u),
        };
        Vec3::new(-self.alpha_u * slope.x, -self.alpha_v * slope.y, 1.0).normalize()
    }

    fn sample_ggx(&self, v: Vec3, u: Vec2) -> Vec3 {
        let across = v.x * v.x + v.y * v.y;
        let t1 = if across > 0.0 { Vec3::new(-v.y, v.x, 0.0) / across.sqrt() } else { Vec3::X };
        let t2 = v.cross(t1);
        let (r, phi) = (u.x.sqrt(), 2.0 * PI * u.y);
        let p1 = r * phi.cos();
        let s = 0.5 * (1.0 + v.z);
        let p2 = (1.0 - s) * (1.0 - p1 * p1).max(0.0).sqrt() + s * r * phi.sin();
        let n = t1 * p1 + t2 * p2 + v * (1.0 - p1 * p1 - p2 * p2).max(0.0).sqrt();
        Vec3::new(self.alpha_u * n.x, self.alpha_v * n.y, n.z.max(1e-6)).normalize()
    }

    /// The pdf of a reflection of `wo`, above, by a facet of normal `h` that [`Microfacets::sample`] chose, per unit solid angle of
    /// the reflected direction.
    pub(crate) fn reflect_pdf(&self, wo: Vec3, h: Vec3) -> f32 {
        self.pdf(wo, h) / (4.0 * wo.dot(h)).max(f32::MIN_POSITIVE)
    }

    /// D G F / (4 cos cos) for a reflection, F given: the value of a rough reflecting lobe.
    pub(crate) fn reflect(&self, wo: Vec3, wi: Vec3, fresnel: impl FnOnce(f32) -> Rgb) -> Rgb {
        self.reflect_with_pdf(wo, wi, fresnel).0
    }

    /// [`Microfacets::reflect`] and [`Microfacets::reflect_pdf`], which have most of their work in common.
    #[inline(always)]
    pub(crate) fn reflect_with_pdf(
        &self,
        wo: Vec3,
        wi: Vec3,
        fresnel: impl FnOnce(f32) -> Rgb,
    ) -> (Rgb, f32) {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return (Rgb::BLACK, 0.0);
        }
        let h = (wo + wi).normalize();
        let (seen, density, along) = (self.visible(wo, h), self.density(h), wo.dot(h));
        let value = fresnel(along) * (density * (seen * self.visible(wi, h)) / (4.0 * wo.z * wi.z));
        if self.distribution == MicrofacetDistribution::Phong {
            return (value, self.reflect_pdf(wo, h));
        }
        (value, seen * along.abs() * density / wo.z / (4.0 * along).max(f32::MIN_POSITIVE))
    }
}

/// The power of the cosine by which Phong's normals fall off, never below 0.
fn phong_exponent(alpha: f32) -> f32 {
    (2.0 / (alpha * alpha) - 2.0).max(0.0)
}

/// A slope of the facets of roughness 1 as the unit vector `v` sees them.
///
/// With c = cot θ, slopes towards the viewer have density ∝ (c − x) e^{−x²} for x < c (x being the slope away from it), whose
/// integral c √π/2 (1 + erf x) + e^{−x²}/2 is inverted by Newton's method within a bracket. Slopes across are Gaussian.
fn visible_beckmann_slope(v: Vec3, u: Vec2) -> Vec2 {
    let sin = f64::from(v.x.hypot(v.y));
    let root_pi = std::f64::consts::PI.sqrt();
    let across = inverse_erf(2.0 * f64::from(u.y) - 1.0);
    let along = if sin < 1e-6 {
        inverse_erf(2.0 * f64::from(u.x) - 1.0)
    } else {
        let cot = f64::from(v.z) / sin;
        // Divided by the larger of c and 1, so that steep and grazing views are both well scaled.
        let scale = 1.0 / cot.max(1.0);
        let cdf = |x: f64| (cot * root_pi * 0.5 * libm::erfc(-x) + 0.5 * (-x * x).exp()) * scale;
        let (mut low, mut high) = (-6.0, cot.min(6.0));
        let goal = f64::from(u.x) * cdf(high);
        let mut x = 0.5 * (low + high);
        for _ in 0..40 {
            let excess = cdf(x) - goal;
            if excess > 0.0 {
                high = x;
            } else {
                low = x;
            }
            let slope = (cot - x) * (-x * x).exp() * scale;
            let newton = x - excess / slope;
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if (next - x).abs() < 1e-9 {
                break;
            }
            x = next;
        }
        x
    };
    // In the frame of the view's azimuth, then back. A slope x away from the viewer tilts the normal towards it by −x.
    let (cos_phi, sin_phi) =
        if sin < 1e-6 { (1.0, 0.0) } else { (f64::from(v.x) / sin, f64::from(v.y) / sin) };
    Vec2::new((cos_phi * along - sin_phi * across) as f32, (sin_phi * along + cos_phi * across) as f32)
}

/// The inverse of the error function on (−1, 1): Winitzki's approximation (2008), polished by Newton's method.
fn inverse_erf(y: f64) -> f64 {
    const A: f64 = 0.147;
    let y = y.clamp(-1.0 + 1e-7, 1.0 - 1e-7);
    let log = ((1.0 - y) * (1.0 + y)).ln();
    let t = 2.0 / (std::f64::consts::PI * A) + 0.5 * log;
    let mut x = ((t * t - log / A).sqrt() - t).max(0.0).sqrt().copysign(y);
    for _ in 0..3 {
        let derivative = 2.0 / std::f64::consts::PI.sqrt() * (-x * x).exp();
        x -= (libm::erf(x) - y) / derivative;
    }
    x
}

#[cfg(test)]
mod tests;
