//! Models that add a glossy lobe to a diffuse base, neither of which knows of the other.
//!
//! Where both reflectances add up to more than 1 in a channel, both are scaled down at that point.

use std::f32::consts::{FRAC_1_PI, PI};

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Rgb, warp};

use super::flags::LobeFlags;
use super::lobe_sample::{BsdfSample, LobeSample, LobeSamples, Transport};
use super::model::Model;
use super::reflect::{cosine, same_side, upward};

/// A glossy lobe over a diffuse base. Directions are above the surface.
pub(super) trait Mixed {
    /// The lobes of all such models.
    const FLAGS: LobeFlags = LobeFlags::DIFFUSE.or(LobeFlags::GLOSSY).or(LobeFlags::REFLECTION);

    /// Shares of light that the base and the lobe reflect, as stated.
    fn reflectances(&self) -> [Rgb; 2];

    /// The roughness α of the lobe.
    fn width(&self) -> f32;

    /// The value (sr⁻¹) of a lobe that reflects all light.
    fn lobe(&self, wo: Vec3, wi: Vec3) -> f32;

    /// The pdf (sr⁻¹) of [`Mixed::direction`].
    fn density(&self, wo: Vec3, wi: Vec3) -> f32;

    /// A direction of the lobe, which may lie below the surface.
    fn direction(&self, wo: Vec3, u: Vec2) -> Vec3;
}

/// Shares of light that the base and the lobe reflect.
fn shares(model: &impl Mixed) -> [Rgb; 2] {
    let [base, gloss] = model.reflectances();
    let most = (base + gloss).max_component();
    let scale = if most > 1.0 { 1.0 / most } else { 1.0 };
    [base * scale, gloss * scale]
}

/// The probability of sampling the lobe rather than the base.
fn gloss_probability([base, gloss]: [Rgb; 2]) -> f32 {
    let sum = base.mean() + gloss.mean();
    if sum > 0.0 { gloss.mean() / sum } else { 0.0 }
}

/// A direction of the lobe on `wo`'s side with its value times cosine over density; `None` where it would leave below.
fn gloss_sample(model: &impl Mixed, wo: Vec3, u: Vec2) -> Option<(Vec3, f32)> {
    let up = upward(wo);
    let wi = model.direction(up, u);
    let pdf = model.density(up, wi);
    (wi.z > 0.0 && pdf > 0.0).then(|| (wi * 1f32.copysign(wo.z), model.lobe(up, wi) * wi.z / pdf))
}

impl<M: Mixed> Model for M {
    fn flags(&self) -> LobeFlags {
        M::FLAGS
    }

    fn gloss(&self) -> Option<f32> {
        Some(self.width())
    }

    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeFlags) -> Rgb {
        if !same_side(wo, wi) {
            return Rgb::BLACK;
        }
        let [base, gloss] = shares(self);
        let base = if lobes.intersects(LobeFlags::DIFFUSE) { base * FRAC_1_PI } else { Rgb::BLACK };
        if lobes.intersects(LobeFlags::GLOSSY) {
            base + gloss * self.lobe(upward(wo), upward(wi))
        } else {
            base
        }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if !same_side(wo, wi) {
            return 0.0;
        }
        let probability = gloss_probability(shares(self));
        let base = warp::square_to_cosine_hemisphere_pdf(wi.abs());
        probability * self.glossy_pdf(wo, wi) + (1.0 - probability) * base
    }

    fn glossy_pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if same_side(wo, wi) { self.density(upward(wo), upward(wi)) } else { 0.0 }
    }

    fn lobes(&self, wo: Vec3, _: Transport, u: Vec2, lobes: LobeFlags) -> LobeSamples {
        let sample = if lobes.intersects(LobeFlags::GLOSSY) { gloss_sample(self, wo, u) } else { None };
        let [_, gloss] = shares(self);
        [sample.map(|(wi, weight)| LobeSample::only(wi, gloss * weight)), None, None, None]
    }

    fn sample(&self, wo: Vec3, _: Transport, u_lobe: f32, u: Vec2, apart: LobeFlags) -> Option<BsdfSample> {
        let [base, gloss] = shares(self);
        let probability = gloss_probability([base, gloss]);
        let is_gloss = u_lobe < probability;
        if apart.intersects(LobeFlags::GLOSSY) {
            if !is_gloss {
                let weight = base / (1.0 - probability);
                let lobe = LobeFlags::DIFFUSE | LobeFlags::REFLECTION;
                return Some(BsdfSample { wi: cosine(wo, u), weight, lobe });
            }
            let (wi, weight) = gloss_sample(self, wo, u)?;
            let lobe = LobeFlags::GLOSSY | LobeFlags::REFLECTION;
            return Some(BsdfSample { wi, weight: gloss * (weight / probability), lobe });
        }
        let wi = if is_gloss { gloss_sample(self, wo, u)?.0 } else { cosine(wo, u) };
        let (up, its_up) = (upward(wo), upward(wi));
        let pdf = probability * self.density(up, its_up) + (1.0 - probability) * its_up.z / PI;
        let weight = (base * FRAC_1_PI + gloss * self.lobe(up, its_up)) * (its_up.z / pdf);
        (pdf > 0.0 && its_up.z > 0.0).then_some(BsdfSample { wi, weight, lobe: M::FLAGS })
    }
}
