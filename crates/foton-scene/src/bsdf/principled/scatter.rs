//! What the principled surface of a closed body does with light.

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Frame, Rgb, warp};

use super::clear_coat::ClearCoat;
use super::shading::{self, dielectric, facets, metal, sheen, sheen_albedo};
use super::solid::Principled;
use crate::bsdf::dielectric::GlassFacet;
use crate::bsdf::flags::LobeFlags;
use crate::bsdf::fresnel;
use crate::bsdf::lobe_sample::{BsdfSample, LobeSample, LobeSamples, Transport};
use crate::bsdf::microfacet::Microfacets;
use crate::bsdf::model::Model;
use crate::bsdf::reflect::{cosine, same_side, upward};

/// The main highlight is sampled as if it reflected this much at least: at grazing facets it reflects more than at the normal.
const LEAST: f32 = 0.02;

/// The index of refraction for one of exactly 1 where light passes, that of a `specular` of 0.001: facets would bend nothing.
const NEXT_TO_ONE: f32 = 1.018_050_8;

/// Probabilities of lobes, which sum to 1.
#[derive(Clone, Copy)]
struct Chances {
    /// The diffuse base and sheen.
    base: f32,
    /// The facets of the main highlight, which reflect or refract.
    main: f32,
    /// The clear coat.
    coat: f32,
}

impl Chances {
    /// In proportion to what lobes reflect.
    fn of(base: f32, main: f32, coat: f32) -> Self {
        let sum = base + main + coat;
        if sum > 0.0 {
            Self { base: base / sum, main: main / sum, coat: coat / sum }
        } else {
            Self { base, main, coat }
        }
    }
}

impl Principled<Rgb, f32> {
    /// Share of light that meets the clear base.
    fn clear(&self) -> f32 {
        (1.0 - self.metallic) * self.spec_trans
    }

    fn ior(&self) -> f32 {
        if self.eta == 1.0 && self.spec_trans > 0.0 { NEXT_TO_ONE } else { self.eta }
    }

    fn facets(&self) -> Microfacets<f32> {
        facets(self.roughness, self.anisotropic)
    }

    fn coat(&self) -> ClearCoat {
        ClearCoat::new(self.clearcoat_gloss)
    }

    /// Whether a direction is on the side that has all lobes. A reflector's other side is turned around before it gets here.
    fn is_outside(&self, wo: Vec3) -> bool {
        wo.z > 0.0 || self.clear() <= 0.0
    }

    /// How the main highlight counts.
    fn main_kind(&self) -> LobeFlags {
        if self.main_is_gathered() { LobeFlags::DIFFUSE } else { LobeFlags::GLOSSY }
    }

    /// What a facet reflects at this cosine.
    fn reflected(&self, cos: f32, outside: bool) -> Rgb {
        if !outside {
            return Rgb::splat(self.clear() * fresnel::reflectance(cos, self.ior(), 1.0));
        }
        metal(self.base_color, cos) * self.metallic
            + dielectric(self.base_color, self.ior(), self.spec_tint, cos) * (1.0 - self.metallic)
    }

    /// What a facet refracts that reflects this share of light.
    fn refracted(&self, reflectance: f32) -> Rgb {
        self.base_color.map(f32::sqrt) * (self.clear() * (1.0 - reflectance))
    }

    /// The probability with which a facet reflects rather than refracts, at this cosine.
    fn reflects(&self, cos: f32, outside: bool) -> f32 {
        if self.clear() <= 0.0 {
            return 1.0;
        }
        let [here, beyond] = if outside { [1.0, self.ior()] } else { [self.ior(), 1.0] };
        let refracted = self.refracted(fresnel::reflectance(cos, here, beyond)).mean();
        let reflected = self.reflected(cos, outside).mean();
        if refracted > 0.0 { reflected / (reflected + refracted) } else { 1.0 }
    }

    fn chances(&self, cos: f32, outside: bool) -> Chances {
        if !outside {
            return Chances { base: 0.0, main: 1.0, coat: 0.0 };
        }
        let base = (1.0 - self.spec_trans) * self.base_color.mean() + self.sheen * sheen_albedo(cos);
        let passes = self.refracted(fresnel::reflectance(cos, 1.0, self.ior()));
        let main = (self.reflected(cos, true) + passes).mean().max(LEAST);
        Chances::of((1.0 - self.metallic) * base, main, self.clearcoat * ClearCoat::reflectance(cos))
    }

    /// Those of glossy lobes among themselves.
    fn glossy_chances(&self, cos: f32, outside: bool) -> Chances {
        let Chances { main, coat, .. } = self.chances(cos, outside);
        Chances::of(0.0, if self.main_is_gathered() { 0.0 } else { main }, coat)
    }

    /// The value of `lobes` for two directions above, without the cosine.
    fn reflection(&self, wo: Vec3, wi: Vec3, outside: bool, lobes: LobeFlags) -> Rgb {
        let h = (wo + wi).normalize();
        let mut sum = Rgb::BLACK;
        if outside && lobes.intersects(LobeFlags::DIFFUSE) {
            let dull = shading::diffuse(wo.z, wi.z, wi.dot(h), self.roughness, self.flatness);
            sum +=
                shading::lambertian(self.base_color, dull * (1.0 - self.spec_trans) * (1.0 - self.metallic));
            if self.sheen > 0.0 {
                let strength = self.sheen * (1.0 - self.metallic);
                sum += sheen(self.base_color, self.sheen_tint, wi.dot(h)) * strength;
            }
        }
        if lobes.intersects(self.main_kind()) {
            sum += self.facets().reflect(wo, wi, |cos| self.reflected(cos, outside));
        }
        if outside && self.clearcoat > 0.0 && lobes.intersects(LobeFlags::GLOSSY) {
            sum += Rgb::splat(self.clearcoat * self.coat().eval(wo, wi, h));
        }
        sum
    }

    /// The pdf (sr⁻¹) of `wi` by lobes that are chosen with these probabilities; both directions above.
    fn reflection_pdf(&self, wo: Vec3, wi: Vec3, outside: bool, chances: &Chances, always: bool) -> f32 {
        let h = (wo + wi).normalize();
        let mut pdf = chances.base * warp::square_to_cosine_hemisphere_pdf(wi);
        if chances.main > 0.0 {
            let chance = if always { 1.0 } else { self.reflects(wo.dot(h), outside) };
            pdf += chances.main * chance * self.facets().reflect_pdf(wo, h);
        }
        if chances.coat > 0.0 {
            pdf += chances.coat * self.coat().pdf(wo, h);
        }
        pdf
    }

    /// The value of light that passes, as radiance: that of rough glass. `[WML07]` equation 21
    fn transmission(&self, wo: Vec3, wi: Vec3) -> Rgb {
        let Some(facet) = GlassFacet::between(wo, wi, self.ior(), 1.0) else { return Rgb::BLACK };
        let r = self.facets();
        let seen = r.density(facet.normal) * r.visible(wo, facet.normal) * r.visible(wi, facet.normal);
        let jacobian =
            (wo.dot(facet.normal) * wi.dot(facet.normal)).abs() / facet.denominator(wo, wi).powi(2);
        let scale = seen * jacobian * facet.eta * facet.eta / (wo.z * wi.z).abs();
        self.refracted(facet.reflectance) * scale
    }

    fn transmission_pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let Some(facet) = GlassFacet::between(wo, wi, self.ior(), 1.0) else { return 0.0 };
        let outside = self.is_outside(wo);
        let chance = self.chances(wo.z.abs(), outside).main
            * (1.0 - self.reflects(wo.dot(facet.normal).abs(), outside));
        let seen = self.facets().pdf(upward(wo), facet.normal);
        chance * seen * wi.dot(facet.normal).abs() / facet.denominator(wo, wi).powi(2)
    }

    /// `wo` refracted by a facet whose outer normal is `h`, with the weight of that lobe alone.
    fn refraction(&self, wo: Vec3, h: Vec3, transport: Transport) -> Option<(Vec3, Rgb)> {
        let frame = Frame::from_normal(h);
        let boundary = fresnel::dielectric(frame.to_local(wo), self.ior(), 1.0);
        let wi = frame.to_outer(boundary.refracted?);
        if same_side(wo, wi) {
            return None;
        }
        let spread = match transport {
            Transport::Radiance => boundary.relative_ior * boundary.relative_ior,
            Transport::Importance => 1.0,
        };
        let weight = self.refracted(boundary.reflectance) * (self.facets().visible(wi, h) * spread);
        (!weight.is_black()).then_some((wi, weight))
    }

    /// One direction of the glossy reflections, both weighted together; `wo` above.
    fn glossy_reflection(&self, wo: Vec3, outside: bool, u: Vec2) -> Option<(Vec3, Rgb)> {
        let chances = self.glossy_chances(wo.z, outside);
        let wi = if u.x < chances.main {
            let h = self.facets().sample(wo, Vec2::new(u.x / chances.main, u.y));
            h * (2.0 * wo.dot(h)) - wo
        } else {
            self.coat().sample(wo, Vec2::new((u.x - chances.main) / (1.0 - chances.main), u.y))?
        };
        if wi.z <= 0.0 {
            return None;
        }
        let pdf = self.reflection_pdf(wo, wi, outside, &chances, true);
        let weight = self.reflection(wo, wi, outside, LobeFlags::GLOSSY) * (wi.z / pdf);
        (pdf > 0.0 && !weight.is_black()).then_some((wi, weight))
    }
}

// Never inlined, so that what decides between models stays small.
impl Model for Principled<Rgb, f32> {
    fn flags(&self) -> LobeFlags {
        Self::flags(self)
    }

    fn gloss(&self) -> Option<f32> {
        let [main, coat] = [self.facets().widest(), self.coat().alpha];
        Some(if self.clearcoat <= 0.0 {
            main
        } else if self.main_is_gathered() {
            coat
        } else {
            main.max(coat)
        })
    }

    #[inline(never)]
    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeFlags) -> Rgb {
        if same_side(wo, wi) {
            return self.reflection(upward(wo), upward(wi), self.is_outside(wo), lobes);
        }
        if self.clear() > 0.0 && lobes.intersects(LobeFlags::GLOSSY) {
            self.transmission(wo, wi)
        } else {
            Rgb::BLACK
        }
    }

    #[inline(never)]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if same_side(wo, wi) {
            let outside = self.is_outside(wo);
            let (wo, wi) = (upward(wo), upward(wi));
            return self.reflection_pdf(wo, wi, outside, &self.chances(wo.z, outside), false);
        }
        if self.clear() > 0.0 { self.transmission_pdf(wo, wi) } else { 0.0 }
    }

    fn glossy_pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if !same_side(wo, wi) {
            return 0.0;
        }
        let outside = self.is_outside(wo);
        let (wo, wi) = (upward(wo), upward(wi));
        self.reflection_pdf(wo, wi, outside, &self.glossy_chances(wo.z, outside), true)
    }

    #[inline(never)]
    fn lobes(&self, wo: Vec3, transport: Transport, u: Vec2, lobes: LobeFlags) -> LobeSamples {
        if !lobes.intersects(LobeFlags::GLOSSY) {
            return [None; 4];
        }
        let (outside, side, up) = (self.is_outside(wo), 1f32.copysign(wo.z), upward(wo));
        let reflection = self.glossy_reflection(up, outside, u).map(|(wi, weight)| (wi * side, weight));
        let refraction = if self.clear() > 0.0 {
            self.refraction(wo, self.facets().sample(up, u), transport)
        } else {
            None
        };
        // Both are known: who follows one alone chooses by their weights.
        let [a, b] = [reflection, refraction].map(|lobe| lobe.map_or(0.0, |(_, weight)| weight.mean()));
        let lobe =
            |(wi, weight): (Vec3, Rgb)| LobeSample { wi, weight, probability: weight.mean() / (a + b) };
        [reflection.map(lobe), refraction.map(lobe), None, None]
    }

    #[inline(never)]
    fn sample(
        &self,
        wo: Vec3,
        transport: Transport,
        u_lobe: f32,
        u: Vec2,
        apart: LobeFlags,
    ) -> Option<BsdfSample> {
        let (outside, side, up) = (self.is_outside(wo), 1f32.copysign(wo.z), upward(wo));
        let chances = self.chances(up.z, outside);
        let (kind, wi) = if u_lobe < chances.base {
            (LobeFlags::DIFFUSE, cosine(up, u))
        } else if u_lobe < chances.base + chances.coat {
            (LobeFlags::GLOSSY, self.coat().sample(up, u)?)
        } else {
            let h = self.facets().sample(up, u);
            let reflects = self.reflects(up.dot(h), outside);
            let u_facet = (u_lobe - chances.base - chances.coat) / chances.main;
            if u_facet >= reflects && reflects < 1.0 {
                let (wi, weight) = self.refraction(wo, h, transport)?;
                let lobe = LobeFlags::GLOSSY | LobeFlags::TRANSMISSION;
                return Some(BsdfSample { wi, weight: weight / (chances.main * (1.0 - reflects)), lobe });
            }
            (self.main_kind(), h * (2.0 * up.dot(h)) - up)
        };
        if wi.z <= 0.0 {
            return None;
        }
        let kinds = if apart.intersects(LobeFlags::GLOSSY) { kind } else { self.flags().spreading() };
        let pdf = self.reflection_pdf(up, wi, outside, &self.only(chances, kinds), false);
        let weight = self.reflection(up, wi, outside, kinds) * (wi.z / pdf);
        (pdf > 0.0).then_some(BsdfSample { wi: wi * side, weight, lobe: kinds | LobeFlags::REFLECTION })
    }
}

impl Principled<Rgb, f32> {
    /// Of the probabilities, those of lobes of some kinds.
    fn only(&self, all: Chances, kinds: LobeFlags) -> Chances {
        let when = |kind, chance| if kinds.intersects(kind) { chance } else { 0.0 };
        Chances {
            base: when(LobeFlags::DIFFUSE, all.base),
            main: when(self.main_kind(), all.main),
            coat: when(LobeFlags::GLOSSY, all.coat),
        }
    }
}
