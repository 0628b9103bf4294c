//! A BSDF at a point of a surface: the model that counts there, holes, and what gets through a rough coat.

use foton_math::Rgb;
use foton_math::glam::{Vec2, Vec3};

use super::coat::Coat;
use super::flags::LobeFlags;
use super::layer::{Layer, Under};
use super::lobe_sample::{BsdfSample, LobeSample, LobeSamples, Transport};
use super::model::{Model, choose};
use super::{Bsdf, each};

/// A BSDF at a point of a surface: colours looked up, and how much of the surface is there.
///
/// Directions are local: z is the shading normal on the outside, `wo` points to where the path came from, `wi` to where it goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattering {
    /// The BSDF.
    pub bsdf: Bsdf<Rgb, f32>,
    /// Share of light that meets the surface; the rest passes straight through.
    pub opacity: f32,
    /// What covers it, where that is more than its parameters say.
    pub coat: Option<Cover>,
}

/// What covers a BSDF at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cover {
    /// What gets through its own coat, where that is rough.
    Coat(Coat),
    /// A coating.
    Layer(Layer),
}

/// Evaluates an expression of the model that a [`Scattering`] has, with what covers it.
macro_rules! model {
    ($scattering:expr, $model:ident => $result:expr) => {
        match &$scattering.coat {
            Some(Cover::Layer(layer)) => $scattering.covered(layer, |$model| $result),
            Some(Cover::Coat(coat)) => each!(&$scattering.bsdf, $model => $result, plastic => {
                let $model = &plastic.under(Some(coat));
                $result
            }),
            None => each!(&$scattering.bsdf, $model => $result, plastic => {
                let $model = &plastic.under(None);
                $result
            }),
        }
    };
}

impl Scattering {
    /// Evaluates a function of the base under a coating. What gets through a rough coat of the base's own counts as through a smooth one.
    #[cold]
    #[inline(never)]
    fn covered<R>(&self, layer: &Layer, f: impl FnOnce(&Under<'_>) -> R) -> R {
        let plastic_under;
        let base: &dyn Model = each!(&self.bsdf, model => model, plastic => {
            plastic_under = plastic.under(None);
            &plastic_under
        });
        f(&Under { layer, base })
    }

    /// The lobes that it has.
    #[must_use]
    #[inline(always)]
    pub fn flags(&self) -> LobeFlags {
        match &self.coat {
            Some(Cover::Layer(layer)) => layer.over(self.bsdf.flags(), self.bsdf.gloss()).0,
            _ => self.bsdf.flags(),
        }
    }

    /// The larger roughness α of its glossy lobes, if it has any.
    #[must_use]
    #[inline(always)]
    pub fn gloss(&self) -> Option<f32> {
        match &self.coat {
            Some(Cover::Layer(layer)) => layer.over(self.bsdf.flags(), self.bsdf.gloss()).1,
            _ => self.bsdf.gloss(),
        }
    }

    /// `π f` if it is Lambertian and nothing else, but for holes.
    #[must_use]
    pub fn lambertian(&self) -> Option<Rgb> {
        if matches!(self.coat, Some(Cover::Layer(_))) {
            return None;
        }
        self.bsdf.lambertian().map(|reflectance| reflectance * self.opacity)
    }

    /// The value `f(wo, wi)` of `lobes`, delta ones left out, without the cosine (sr⁻¹).
    #[must_use]
    pub fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeFlags) -> Rgb {
        if wo.z == 0.0 || wi.z == 0.0 {
            return Rgb::BLACK;
        }
        model!(self, model => model.eval(wo, wi, lobes)) * self.opacity
    }

    /// The pdf (sr⁻¹) of all lobes but delta ones in [`Scattering::sample`], the probability of lobes included.
    #[must_use]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if wo.z == 0.0 || wi.z == 0.0 {
            return 0.0;
        }
        model!(self, model => model.pdf(wo, wi)) * self.opacity
    }

    /// The pdf (sr⁻¹) of `wi` in [`Scattering::lobes`] for a glossy reflection; 0 for delta lobes, and for rough glass.
    #[must_use]
    pub fn glossy_pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        model!(self, model => model.glossy_pdf(wo, wi))
    }

    /// One direction of each delta or glossy lobe among `lobes`, chosen by `u` for glossy ones, and straight on through holes.
    /// Absent ones are `None`.
    #[must_use]
    pub fn lobes(&self, wo: Vec3, transport: Transport, u: Vec2, lobes: LobeFlags) -> LobeSamples {
        let mut found = model!(self, model => model.lobes(wo, transport, u, lobes));
        if self.opacity < 1.0 {
            for lobe in found.iter_mut().flatten() {
                lobe.weight *= self.opacity;
                lobe.probability *= self.opacity;
            }
            found[2] = Some(self.with_hole(wo, found[2]));
        }
        found
    }

    /// What passes straight on by the model, already weighted by the opacity, and through holes.
    fn with_hole(&self, wo: Vec3, straight: Option<LobeSample>) -> LobeSample {
        let through = 1.0 - self.opacity;
        let (weight, probability) = straight.map_or((Rgb::BLACK, 0.0), |l| (l.weight, l.probability));
        LobeSample { wi: -wo, weight: weight + Rgb::splat(through), probability: probability + through }
    }

    /// One of the delta or glossy lobes among `lobes`, chosen by `u_lobe` in [0, 1) with their probabilities; its weight is not
    /// divided by its probability. `None` with the probability of lobes that are absent: glossy ones that would leave below the
    /// surface.
    #[must_use]
    pub fn choose_lobe(
        &self,
        wo: Vec3,
        transport: Transport,
        u_lobe: f32,
        u: Vec2,
        lobes: LobeFlags,
    ) -> Option<LobeSample> {
        choose(&self.lobes(wo, transport, u, lobes), self.flags(), u_lobe).map(|(_, lobe)| lobe)
    }

    /// The share of light from `wo` that passes straight on, as if there were no surface.
    #[must_use]
    pub fn straight(&self, wo: Vec3) -> Rgb {
        let mut straight = model!(self, model => model.straight(wo));
        if self.opacity < 1.0 {
            if let Some(lobe) = &mut straight {
                lobe.weight *= self.opacity;
            }
            straight = Some(self.with_hole(wo, straight));
        }
        straight.map_or(Rgb::BLACK, |lobe| lobe.weight)
    }

    /// Chooses a direction among all lobes; `None` where nothing is scattered. Lobes in `apart` are not weighted together with
    /// others that overlap them: the sample then tells which of the two it is of.
    #[must_use]
    #[inline(always)]
    pub fn sample(
        &self,
        wo: Vec3,
        transport: Transport,
        u_lobe: f32,
        u: Vec2,
        apart: LobeFlags,
    ) -> Option<BsdfSample> {
        if self.opacity >= 1.0 {
            return model!(self, model => model.sample(wo, transport, u_lobe, u, apart));
        }
        if u_lobe < self.opacity {
            return model!(self, model => model.sample(wo, transport, u_lobe / self.opacity, u, apart));
        }
        let lobe = LobeFlags::DELTA | LobeFlags::TRANSMISSION | LobeFlags::STRAIGHT;
        Some(BsdfSample { wi: -wo, weight: Rgb::WHITE, lobe })
    }
}
