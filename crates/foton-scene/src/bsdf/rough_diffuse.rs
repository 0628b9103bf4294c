//! A rough diffuse surface: Lambertian facets that shadow, hide and light each other.
//!
//! The model of Oren and Nayar `[ON94]`: grooves of Lambertian walls with Gaussian slopes of standard deviation σ, fitted by closed
//! forms. Files state the root mean square slope α of Beckmann facets, for which σ = α/√2, as in Mitsuba 0.6.

use std::f32::consts::{FRAC_1_PI, FRAC_1_SQRT_2, PI};

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Rgb, warp};

use super::flags::LobeFlags;
use super::info::{BsdfInfo, Described};
use super::lobe_sample::{BsdfSample, Transport};
use super::model::Model;
use super::reflect::{cosine, same_side, upward};
use crate::description::{Colour, Number};
use crate::parameter::{Binding, Parameter, Role, Slot};

/// A rough diffuse surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughDiffuse<C = Colour, N = Number> {
    /// Share of light that each facet reflects, in [0, 1].
    pub reflectance: C,
    /// Root mean square slope of the facets.
    pub alpha: N,
    /// Whether light between facets is left out and the rest is a simpler fit.
    pub use_fast_approx: bool,
}

const REFLECTANCE: Parameter = Parameter::share("reflectance", 0.5)
    .once(&["diffuse_reflectance"])
    .label("Colour")
    .help("Share of light that each facet reflects, by channel.")
    .role(Role::BaseColour);

const ALPHA: Parameter = Parameter::number("alpha", 0.2, (0.0, 10.0))
    .label("Roughness")
    .help("Root mean square slope of the facets; 0 is Lambertian.")
    .slider(0.0, 1.0, false)
    .textured();

const USE_FAST_APPROX: Parameter = Parameter::boolean("use_fast_approx")
    .label("Fast approximation")
    .help("Leaves out light between facets and takes a simpler fit.");

impl Described for RoughDiffuse {
    const INFO: BsdfInfo = BsdfInfo {
        label: "Rough diffuse",
        help: "Lambertian facets that shadow, hide and light each other (Oren and Nayar): plaster, sand, the moon.",
        plugin: "roughdiffuse",
        rough_plugin: None,
        stated: None,
        is_of_mitsuba_3: false,
    };

    fn default(_: bool) -> Self {
        Self {
            reflectance: REFLECTANCE.default_colour(),
            alpha: ALPHA.default_number().into(),
            use_fast_approx: false,
        }
    }

    fn preset() -> Self {
        Self { reflectance: Rgb::splat(0.8).into(), alpha: 0.5.into(), use_fast_approx: false }
    }

    fn parameters(&mut self) -> Vec<Binding<'_>> {
        vec![
            Binding::new(&[REFLECTANCE], Slot::Share(&mut self.reflectance)),
            Binding::new(&[ALPHA], Slot::Number(&mut self.alpha)),
            Binding::new(&[USE_FAST_APPROX], Slot::Boolean(&mut self.use_fast_approx)),
        ]
    }
}

impl<C: Copy, N: Copy> RoughDiffuse<C, N> {
    #[inline(always)]
    pub(super) fn map<D, M>(
        &self,
        mut colours: impl FnMut(C) -> D,
        mut numbers: impl FnMut(N, [f32; 2]) -> M,
    ) -> RoughDiffuse<D, M> {
        let Self { reflectance, alpha, use_fast_approx } = *self;
        RoughDiffuse {
            reflectance: colours(reflectance),
            alpha: numbers(alpha, ALPHA.limits()),
            use_fast_approx,
        }
    }

    pub(super) const fn flags(&self) -> LobeFlags {
        LobeFlags::DIFFUSE.or(LobeFlags::REFLECTION)
    }
}

impl RoughDiffuse<Rgb, f32> {
    /// `f(wo, wi)` of two directions above: the sum of light that met one facet and of light that met two, or the paper's qualitative
    /// model.
    fn value(&self, wo: Vec3, wi: Vec3) -> Rgb {
        let rho = self.reflectance;
        let sigma = self.alpha * FRAC_1_SQRT_2;
        let sigma2 = sigma * sigma;
        let (steep, flat) = if wo.z < wi.z { (wo, wi) } else { (wi, wo) };
        let sine = |w: Vec3| w.x.hypot(w.y);
        let across = sine(wo) * sine(wi);
        let cos_phi =
            if across > 1e-12 { ((wo.x * wi.x + wo.y * wi.y) / across).clamp(-1.0, 1.0) } else { 0.0 };
        // The larger angle from the normal is α, the smaller one β.
        let (sin_alpha, tan_beta) = (sine(steep), sine(flat) / flat.z);
        let c1 = 1.0 - 0.5 * sigma2 / (sigma2 + 0.33);
        let c2 = 0.45 * sigma2 / (sigma2 + 0.09);
        if self.use_fast_approx {
            return rho * ((c1 + c2 * cos_phi.max(0.0) * sin_alpha * tan_beta) * FRAC_1_PI);
        }
        let (alpha, beta) = (sine(steep).atan2(steep.z), sine(flat).atan2(flat.z));
        let c2 = if cos_phi >= 0.0 { c2 * sin_alpha } else { c2 * (sin_alpha - (2.0 * beta / PI).powi(3)) };
        let c3 = 0.125 * sigma2 / (sigma2 + 0.09) * (4.0 * alpha * beta / (PI * PI)).powi(2);
        let once = c1 + cos_phi * c2 * tan_beta + (1.0 - cos_phi.abs()) * c3 * (0.5 * (alpha + beta)).tan();
        let twice = 0.17 * sigma2 / (sigma2 + 0.13) * (1.0 - cos_phi * (2.0 * beta / PI).powi(2));
        (rho * once.max(0.0) + rho * rho * twice) * FRAC_1_PI
    }
}

impl Model for RoughDiffuse<Rgb, f32> {
    fn flags(&self) -> LobeFlags {
        Self::flags(self)
    }

    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeFlags) -> Rgb {
        if same_side(wo, wi) && lobes.intersects(LobeFlags::DIFFUSE) {
            self.value(upward(wo), upward(wi))
        } else {
            Rgb::BLACK
        }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if same_side(wo, wi) { warp::square_to_cosine_hemisphere_pdf(wi.abs()) } else { 0.0 }
    }

    fn sample(&self, wo: Vec3, _: Transport, _: f32, u: Vec2, _: LobeFlags) -> Option<BsdfSample> {
        let wi = cosine(wo, u);
        let weight = self.eval(wo, wi, LobeFlags::DIFFUSE) * PI;
        (wi.z != 0.0).then_some(BsdfSample { wi, weight, lobe: Model::flags(self) })
    }
}
