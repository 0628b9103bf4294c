//! The modified Phong model: a diffuse base and a lobe around the mirror direction.
//!
//! After Lafortune and Willems `[LW94]`, who made it reciprocal and keep its energy: f = ρ_d/π + ρ_s (n + 2)/(2π) cosⁿ of the angle from
//! the mirror direction. Where both reflectances add up to more than 1 in a channel, both are scaled down.

use std::f32::consts::{FRAC_1_PI, PI};

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Frame, Rgb};

use super::flags::LobeFlags;
use super::info::{BsdfInfo, Described};
use super::mixed::Mixed;
use super::reflect::mirrored;
use crate::description::{Colour, Number};
use crate::parameter::{Binding, Parameter, Role, Slot};

/// A diffuse base and a lobe around the mirror direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phong<C = Colour, N = Number> {
    /// How narrow the lobe is, from 0.
    pub exponent: N,
    /// Share of light that the lobe reflects.
    pub specular_reflectance: C,
    /// Share of light that the base reflects.
    pub diffuse_reflectance: C,
}

const EXPONENT: Parameter = Parameter::number("exponent", 30.0, (0.0, 1e8))
    .label("Exponent")
    .help("How narrow the highlight is; a roughness of √(2 / (exponent + 2)). From 198 on eye paths follow the lobe.")
    .slider(1.0, 10_000.0, true)
    .textured();

pub(super) const SPECULAR_REFLECTANCE: Parameter = Parameter::share("specular_reflectance", 0.2)
    .label("Highlight")
    .help("Share of light reflected by the highlight, by channel.");

pub(super) const DIFFUSE_REFLECTANCE: Parameter = Parameter::share("diffuse_reflectance", 0.5)
    .label("Base colour")
    .help("Share of light reflected in all directions, by channel.")
    .role(Role::BaseColour);

impl Described for Phong {
    const INFO: BsdfInfo = BsdfInfo {
        label: "Phong",
        help: "A diffuse base and a lobe around the mirror direction; for old scenes: rough plastic is closer to what is real.",
        plugin: "phong",
        rough_plugin: None,
        stated: None,
        is_of_mitsuba_3: false,
    };

    fn default(_: bool) -> Self {
        Self {
            exponent: EXPONENT.default_number().into(),
            specular_reflectance: SPECULAR_REFLECTANCE.default_colour(),
            diffuse_reflectance: DIFFUSE_REFLECTANCE.default_colour(),
        }
    }

    fn preset() -> Self {
        Described::default(false)
    }

    fn parameters(&mut self) -> Vec<Binding<'_>> {
        vec![
            Binding::new(&[EXPONENT], Slot::Number(&mut self.exponent)),
            Binding::new(&[DIFFUSE_REFLECTANCE], Slot::Share(&mut self.diffuse_reflectance)),
            Binding::new(&[SPECULAR_REFLECTANCE], Slot::Share(&mut self.specular_reflectance)),
        ]
    }
}

impl<C: Copy, N: Copy> Phong<C, N> {
    #[inline(always)]
    pub(super) fn map<D, M>(
        &self,
        mut colours: impl FnMut(C) -> D,
        mut numbers: impl FnMut(N, [f32; 2]) -> M,
    ) -> Phong<D, M> {
        let Self { exponent, specular_reflectance, diffuse_reflectance } = *self;
        Phong {
            exponent: numbers(exponent, EXPONENT.limits()),
            specular_reflectance: colours(specular_reflectance),
            diffuse_reflectance: colours(diffuse_reflectance),
        }
    }

    pub(super) const fn flags(&self) -> LobeFlags {
        LobeFlags::DIFFUSE.or(LobeFlags::GLOSSY).or(LobeFlags::REFLECTION)
    }
}

impl Phong<Rgb, f32> {
    /// cosⁿ of the angle between `wi` and where a mirror would send `wo`, both above.
    fn power(&self, wo: Vec3, wi: Vec3) -> f32 {
        let mirror = mirrored(wo);
        let cos = mirror.dot(wi);
        if cos <= 0.0 {
            return 0.0;
        }
        // cos² = 1 − sin², by the cross product: n may be so large that the rounding of the cosine would count.
        let sin2 = mirror.cross(wi).length_squared().min(1.0 - f32::EPSILON);
        (0.5 * self.exponent * (-sin2).ln_1p()).exp()
    }
}

impl Mixed for Phong<Rgb, f32> {
    fn reflectances(&self) -> [Rgb; 2] {
        [self.diffuse_reflectance, self.specular_reflectance]
    }

    /// That of the microfacets that would be as wide around the normal. `[WML07]`
    fn width(&self) -> f32 {
        (2.0 / (self.exponent + 2.0)).sqrt()
    }

    fn lobe(&self, wo: Vec3, wi: Vec3) -> f32 {
        (self.exponent + 2.0) * 0.5 * FRAC_1_PI * self.power(wo, wi)
    }

    fn density(&self, wo: Vec3, wi: Vec3) -> f32 {
        (self.exponent + 1.0) * 0.5 * FRAC_1_PI * self.power(wo, wi)
    }

    fn direction(&self, wo: Vec3, u: Vec2) -> Vec3 {
        // cos = u^{1/(n+1)}; sin² = 1 − cos² by its logarithm, since the cosine is rounded to 1 for large n.
        let log = u.x.max(f32::MIN_POSITIVE).ln() / (self.exponent + 1.0);
        let (cos, sin) = (log.exp(), (-(2.0 * log).exp_m1()).max(0.0).sqrt());
        let (sin_phi, cos_phi) = (2.0 * PI * u.y).sin_cos();
        Frame::from_normal(mirrored(wo)).to_outer(Vec3::new(sin * cos_phi, sin * sin_phi, cos)).normalize()
    }
}
