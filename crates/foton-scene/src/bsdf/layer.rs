//! A base under a coating at a point: values, pdfs and sampling. The model is stated in `coating.rs`.

use foton_math::Rgb;
use foton_math::glam::{Vec2, Vec3};

use super::coat::PackedCoat;
use super::flags::LobeFlags;
use super::fresnel;
use super::lobe_sample::{BsdfSample, LobeSample, LobeSamples, Transport};
use super::microfacet::Microfacets;
use super::model::Model;
use super::reflect::{facet_pdf, mirrored, reflect_by_facet, same_side, upward};

/// A glossy lobe of the base that is rougher than this is wide.
const NARROW: f32 = 0.1;

/// A coating at a point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// Its index of refraction, relative to the outside.
    pub(super) eta: f32,
    /// What it absorbs along its thickness.
    pub(super) absorption: Rgb,
    /// Factor on light that it reflects.
    pub(super) reflectance: Rgb,
    /// `None`: smooth.
    pub(super) roughness: Option<Microfacets<f32>>,
    /// What gets through, where it is rough.
    pub(super) through: PackedCoat,
}

impl Layer {
    /// Its own lobes.
    const fn flags(&self) -> LobeFlags {
        let spreads = if self.roughness.is_some() { LobeFlags::GLOSSY } else { LobeFlags::DELTA };
        spreads.or(LobeFlags::REFLECTION)
    }

    /// The lobes of a base under it, and the roughness of the glossy ones.
    pub(super) fn over(&self, base: LobeFlags, gloss: Option<f32>) -> (LobeFlags, Option<f32>) {
        let own = self.roughness.map(|r| r.widest());
        if self.takes_gloss(base, gloss) {
            (self.flags() | base.without(LobeFlags::GLOSSY) | LobeFlags::DIFFUSE, own)
        } else {
            (self.flags() | base, own.into_iter().chain(gloss).reduce(f32::max))
        }
    }

    /// Whether a wide glossy lobe of the base counts as a diffuse one, since the glossy lobe is that of the layer.
    fn takes_gloss(&self, base: LobeFlags, gloss: Option<f32>) -> bool {
        let is_glass = base.intersects(LobeFlags::TRANSMISSION);
        self.roughness.is_some() && !is_glass && gloss.is_some_and(|alpha| alpha > NARROW)
    }

    /// Share of light at the cosine of incidence that gets through, from outside or to there.
    fn passes(&self, cos: f32) -> f32 {
        match self.roughness {
            Some(_) => self.through.transmittance(cos),
            None => 1.0 - self.fresnel(cos),
        }
    }

    fn fresnel(&self, cos: f32) -> f32 {
        fresnel::reflectance(cos, 1.0, self.eta)
    }

    /// A direction outside as it is inside; `None`: it is reflected totally.
    fn inside(&self, w: Vec3) -> Option<Vec3> {
        refracted(w, 1.0 / self.eta)
    }

    /// A direction inside as it is outside.
    fn outside(&self, w: Vec3) -> Option<Vec3> {
        refracted(w, self.eta)
    }

    /// Share of light that is not absorbed between two directions inside.
    fn clear(&self, a: Vec3, b: Vec3) -> Rgb {
        if self.absorption.is_black() {
            return Rgb::WHITE;
        }
        let path = 1.0 / a.z.abs() + 1.0 / b.z.abs();
        self.absorption.map(|sigma| (-sigma * path).exp())
    }

    /// The share of light that the base scatters from and to directions outside which are `wo` and `wi` there.
    fn attenuation(&self, [wo, inner_wo]: [Vec3; 2], [wi, inner_wi]: [Vec3; 2]) -> Rgb {
        self.clear(inner_wo, inner_wi) * (self.passes(wo.z.abs()) * self.passes(wi.z.abs()))
    }

    /// The probability of sampling the layer rather than the base.
    fn chance(&self, wo: Vec3) -> f32 {
        let passes = if self.inside(wo).is_some() { self.passes(wo.z.abs()) } else { 0.0 };
        let base = passes * self.absorption.map(|sigma| (-2.0 * sigma).exp()).mean();
        let own = (1.0 - passes) * self.reflectance.mean();
        if own + base > 0.0 { own / (own + base) } else { 0.0 }
    }

    /// One direction of the layer's lobe.
    fn sampled(&self, wo: Vec3, u: Vec2) -> Option<LobeSample> {
        let reflected = |cos: f32| self.reflectance * self.fresnel(cos);
        match &self.roughness {
            None => Some(LobeSample::only(mirrored(wo), reflected(wo.z.abs()))),
            Some(r) => reflect_by_facet(r, wo, u, reflected),
        }
    }
}

/// Snell's law for a direction that stays on its side of the surface, its sine scaled by `eta`.
fn refracted(w: Vec3, eta: f32) -> Option<Vec3> {
    let (x, y) = (w.x * eta, w.y * eta);
    let cos2 = 1.0 - x * x - y * y;
    (cos2 > 0.0).then(|| Vec3::new(x, y, cos2.sqrt().copysign(w.z)))
}

/// A base under a layer.
pub(super) struct Under<'a> {
    pub(super) layer: &'a Layer,
    pub(super) base: &'a dyn Model,
}

impl Under<'_> {
    fn takes_gloss(&self) -> bool {
        self.layer.takes_gloss(self.base.flags(), self.base.gloss())
    }

    /// The lobes of the base that are meant by lobes of both.
    fn of_base(&self, lobes: LobeFlags) -> LobeFlags {
        match (self.takes_gloss(), lobes.intersects(LobeFlags::DIFFUSE)) {
            (true, true) => lobes | LobeFlags::GLOSSY,
            (true, false) => lobes.without(LobeFlags::GLOSSY),
            (false, _) => lobes,
        }
    }

    /// What a lobe of the base is called from outside.
    fn name_of(&self, lobe: LobeFlags) -> LobeFlags {
        if self.takes_gloss() && lobe.intersects(LobeFlags::GLOSSY) {
            lobe.without(LobeFlags::GLOSSY) | LobeFlags::DIFFUSE
        } else {
            lobe
        }
    }

    /// Both directions inside, where both get there.
    fn inside(&self, wo: Vec3, wi: Vec3) -> Option<[Vec3; 2]> {
        Some([self.layer.inside(wo)?, self.layer.inside(wi)?])
    }

    /// The pdf of the base's density at a direction inside, per solid angle outside.
    fn compressed(&self, pdf: f32, wi: Vec3, inner: Vec3) -> f32 {
        pdf * wi.z.abs() / (self.layer.eta * self.layer.eta * inner.z.abs())
    }

    /// The glossy lobe of the layer: its value and pdf.
    fn own(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        match &self.layer.roughness {
            Some(r) if same_side(wo, wi) => {
                let (wo, wi) = (upward(wo), upward(wi));
                let fresnel = |cos: f32| self.layer.reflectance * self.layer.fresnel(cos);
                (r.reflect(wo, wi, fresnel), facet_pdf(r, wo, wi))
            }
            _ => (Rgb::BLACK, 0.0),
        }
    }

    /// A direction of which lobes that are weighted together may each be the origin.
    fn together(&self, wo: Vec3, wi: Vec3, lobes: LobeFlags) -> Option<BsdfSample> {
        let pdf = self.pdf(wo, wi);
        let weight = self.eval(wo, wi, lobes) * (wi.z.abs() / pdf);
        let side = if same_side(wo, wi) { LobeFlags::REFLECTION } else { LobeFlags::TRANSMISSION };
        (pdf > 0.0 && weight.is_finite()).then_some(BsdfSample { wi, weight, lobe: lobes | side })
    }
}

impl Model for Under<'_> {
    fn flags(&self) -> LobeFlags {
        self.layer.over(self.base.flags(), self.base.gloss()).0
    }

    fn gloss(&self) -> Option<f32> {
        self.layer.over(self.base.flags(), self.base.gloss()).1
    }

    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeFlags) -> Rgb {
        let own = if lobes.intersects(LobeFlags::GLOSSY) { self.own(wo, wi).0 } else { Rgb::BLACK };
        let Some([inner_wo, inner_wi]) = self.inside(wo, wi) else { return own };
        let base = self.base.eval(inner_wo, inner_wi, self.of_base(lobes));
        if base.is_black() {
            return own;
        }
        let attenuation = self.layer.attenuation([wo, inner_wo], [wi, inner_wi]);
        own + base * attenuation / (self.layer.eta * self.layer.eta)
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let chance = self.layer.chance(wo);
        let base = self.inside(wo, wi).map_or(0.0, |[inner_wo, inner_wi]| {
            self.compressed(self.base.pdf(inner_wo, inner_wi), wi, inner_wi)
        });
        chance * self.own(wo, wi).1 + (1.0 - chance) * base
    }

    fn glossy_pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        // A smooth layer sends light in the middle of the base's glossy lobe, and what lobe a direction came from is not told.
        if self.layer.roughness.is_none() || !same_side(wo, wi) {
            return 0.0;
        }
        let own = self.own(wo, wi).1;
        if self.takes_gloss() {
            return own;
        }
        let base = self.inside(wo, wi).map_or(0.0, |[inner_wo, inner_wi]| {
            self.compressed(self.base.glossy_pdf(inner_wo, inner_wi), wi, inner_wi)
        });
        own + base
    }

    fn lobes(&self, wo: Vec3, transport: Transport, u: Vec2, lobes: LobeFlags) -> LobeSamples {
        let asked = if self.takes_gloss() { lobes.without(LobeFlags::GLOSSY) } else { lobes };
        let inner_wo = self.layer.inside(wo);
        let mut found = inner_wo.map_or([None; 4], |w| self.base.lobes(w, transport, u, asked));
        let chance = if found.iter().any(Option::is_some) { self.layer.chance(wo) } else { 1.0 };
        for lobe in &mut found {
            *lobe = lobe.zip(inner_wo).and_then(|(lobe, inner_wo)| {
                let wi = if lobe.wi == -inner_wo { -wo } else { self.layer.outside(lobe.wi)? };
                let weight = lobe.weight * self.layer.attenuation([wo, inner_wo], [wi, lobe.wi]);
                Some(LobeSample { wi, weight, probability: lobe.probability * (1.0 - chance) })
            });
        }
        if !lobes.intersects(self.layer.flags().spreading()) {
            return found;
        }
        let own = self.layer.sampled(wo, u).map(|own| LobeSample { probability: chance, ..own });
        match (&mut found[0], own) {
            // Both mirror.
            (Some(base), Some(own))
                if self.flags().spreading().without(LobeFlags::DIFFUSE) == LobeFlags::DELTA =>
            {
                base.weight += own.weight;
                base.probability += own.probability;
            }
            _ => found[3] = own,
        }
        found
    }

    fn straight(&self, wo: Vec3) -> Option<LobeSample> {
        let inner_wo = self.layer.inside(wo)?;
        let lobe = self.base.straight(inner_wo)?;
        let weight = lobe.weight * self.layer.attenuation([wo, inner_wo], [wo, inner_wo]);
        Some(LobeSample { wi: -wo, weight, probability: lobe.probability * (1.0 - self.layer.chance(wo)) })
    }

    fn sample(
        &self,
        wo: Vec3,
        transport: Transport,
        u_lobe: f32,
        u: Vec2,
        apart: LobeFlags,
    ) -> Option<BsdfSample> {
        let chance = self.layer.chance(wo);
        let spreads = self.layer.roughness.is_some();
        // Glossy and diffuse lobes of which photons are gathered alike are weighted together.
        let joined = spreads && !apart.intersects(LobeFlags::GLOSSY);
        let joint = self.flags().spreading().without(LobeFlags::DELTA);
        if u_lobe < chance {
            let own = self.layer.sampled(wo, u)?;
            if joined {
                return self.together(wo, own.wi, joint);
            }
            return Some(BsdfSample { wi: own.wi, weight: own.weight / chance, lobe: self.layer.flags() });
        }
        let inner_wo = self.layer.inside(wo)?;
        let u_lobe = ((u_lobe - chance) / (1.0 - chance)).min(1.0 - f32::EPSILON);
        let of_base = if self.takes_gloss() { LobeFlags::NONE } else { apart };
        let base = self.base.sample(inner_wo, transport, u_lobe, u, of_base)?;
        let is_straight = base.lobe.intersects(LobeFlags::STRAIGHT);
        let wi = if is_straight { -wo } else { self.layer.outside(base.wi)? };
        if joined && base.lobe.spreads() {
            return self.together(wo, wi, joint);
        }
        let attenuation = self.layer.attenuation([wo, inner_wo], [wi, base.wi]);
        Some(BsdfSample {
            wi,
            weight: base.weight * attenuation / (1.0 - chance),
            lobe: self.name_of(base.lobe),
        })
    }
}
