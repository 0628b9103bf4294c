//! The principled surface of a thin sheet, such as a leaf, paper or a pane.

use foton_math::Rgb;
use foton_math::glam::{Vec2, Vec3};
use foton_math::warp;

use super::parameters::{
    ANISOTROPIC, BASE_COLOR, DIFF_TRANS, FACTOR, FLATNESS, ROUGHNESS, SHEEN, SHEEN_TINT, SPEC_TINT,
    SPEC_TRANS, UNIT, rate,
};
use super::shading::{self, dielectric, facets, sheen, sheen_albedo};
use crate::bsdf::flags::LobeFlags;
use crate::bsdf::fresnel;
use crate::bsdf::info::{BsdfInfo, Described};
use crate::bsdf::lobe_sample::{BsdfSample, LobeSample, LobeSamples, Transport};
use crate::bsdf::microfacet::Microfacets;
use crate::bsdf::model::Model;
use crate::bsdf::reflect::{cosine, same_side};
use crate::description::{Amount, Colour, Number};
use crate::parameter::{Binding, Parameter, Slot};

/// A thin sheet, the same from both sides: light that its diffuse base takes in leaves on either, and what its clear part lets
/// through goes on in the direction that it had, spread by facets.
///
/// Its highlight is its clear part's: without transmission there is none. As in Mitsuba 3, the highlight behind the sheet ends where
/// light leaves flatter than facets turned to it would let pass, so that transmission differs a little between two directions and
/// the same two reversed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipledThin<C = Colour, N = Number> {
    /// Colour of the diffuse base and of what passes through.
    pub base_color: C,
    /// The square root of the facets' α. Those that light passes have another one, by the index.
    pub roughness: N,
    /// How much the facets are stretched along u.
    pub anisotropic: N,
    /// Share of the sheet that is clear.
    pub spec_trans: N,
    /// Twice the share of the diffuse base's light that passes to the other side.
    pub diff_trans: N,
    /// Index of refraction, relative to the outside.
    pub eta: N,
    /// How far the highlight is tinted.
    pub spec_tint: N,
    /// Strength of the sheen.
    pub sheen: N,
    /// How far it is tinted.
    pub sheen_tint: N,
    /// How far the diffuse base looks like one that light enters.
    pub flatness: N,
}

/// Indices of refraction that a texture may give.
const INDICES: [f32; 2] = [0.1, 10.0];

const ETA: Parameter = Parameter::number("eta", 1.5, (0.1, 10.0))
    .textured()
    .label("Index of refraction")
    .help("Of the sheet, relative to the outside. Larger reflects more.")
    .slider(1.0, 4.0, false);

const DIFF_TRANS_AND_RATES: &[Parameter] = &[
    DIFF_TRANS,
    rate("specular_reflectance_sampling_rate"),
    rate("specular_transmittance_sampling_rate"),
    rate("diffuse_reflectance_sampling_rate"),
    rate("diffuse_transmittance_sampling_rate"),
];

impl Described for PrincipledThin {
    const INFO: BsdfInfo = BsdfInfo {
        label: "Thin principled",
        help: "Disney's model of thin sheets: leaves, paper, panes.",
        plugin: "principledthin",
        rough_plugin: None,
        stated: None,
        is_of_mitsuba_3: true,
    };

    fn default(_: bool) -> Self {
        let number = |p: Parameter| Number::Constant(p.default_number());
        Self {
            base_color: BASE_COLOR.default_colour(),
            roughness: number(ROUGHNESS),
            anisotropic: number(ANISOTROPIC),
            spec_trans: number(SPEC_TRANS),
            diff_trans: number(DIFF_TRANS),
            eta: number(ETA),
            spec_tint: number(SPEC_TINT),
            sheen: number(SHEEN),
            sheen_tint: number(SHEEN_TINT),
            flatness: number(FLATNESS),
        }
    }

    fn preset() -> Self {
        Self { base_color: Rgb::splat(0.8).into(), diff_trans: 1.0.into(), ..Described::default(false) }
    }

    fn parameters(&mut self) -> Vec<Binding<'_>> {
        vec![
            Binding::new(&[BASE_COLOR], Slot::Share(&mut self.base_color)),
            Binding::new(&[ROUGHNESS], Slot::Number(&mut self.roughness)),
            Binding::new(&[SPEC_TRANS], Slot::Number(&mut self.spec_trans)),
            Binding::new(DIFF_TRANS_AND_RATES, Slot::Number(&mut self.diff_trans)),
            Binding::new(&[ETA], Slot::Number(&mut self.eta)),
            Binding::new(&[SHEEN], Slot::Number(&mut self.sheen)),
            Binding::new(&[SHEEN_TINT], Slot::Number(&mut self.sheen_tint)),
            Binding::new(&[SPEC_TINT], Slot::Number(&mut self.spec_tint)),
            Binding::new(&[ANISOTROPIC], Slot::Number(&mut self.anisotropic)),
            Binding::new(&[FLATNESS], Slot::Number(&mut self.flatness)),
        ]
    }
}

impl<C: Copy, N: Amount> PrincipledThin<C, N> {
    #[inline(always)]
    pub(in crate::bsdf) fn map<D, M>(
        &self,
        mut colours: impl FnMut(C) -> D,
        mut numbers: impl FnMut(N, [f32; 2]) -> M,
    ) -> PrincipledThin<D, M> {
        PrincipledThin {
            base_color: colours(self.base_color),
            roughness: numbers(self.roughness, UNIT),
            anisotropic: numbers(self.anisotropic, UNIT),
            spec_trans: numbers(self.spec_trans, UNIT),
            diff_trans: numbers(self.diff_trans, [0.0, 2.0]),
            eta: numbers(self.eta, INDICES),
            spec_tint: numbers(self.spec_tint, UNIT),
            sheen: numbers(self.sheen, FACTOR),
            sheen_tint: numbers(self.sheen_tint, UNIT),
            flatness: numbers(self.flatness, UNIT),
        }
    }

    /// The lobes that it has; in a description, those that it may have anywhere.
    pub(in crate::bsdf) fn flags(&self) -> LobeFlags {
        let mut flags = LobeFlags::REFLECTION;
        if self.spec_trans.least() < 1.0 {
            flags = flags | LobeFlags::DIFFUSE;
            if self.diff_trans.most() > 0.0 {
                flags = flags | LobeFlags::TRANSMISSION;
            }
        }
        if self.spec_trans.most() > 0.0 {
            flags = flags | LobeFlags::GLOSSY | LobeFlags::TRANSMISSION;
        }
        flags
    }
}

/// Probabilities of lobes, which sum to 1, or of some of them.
#[derive(Clone, Copy, Default)]
struct Chances {
    /// The diffuse base and sheen, on the side of the light.
    base: f32,
    /// The diffuse base on the other side.
    behind: f32,
    /// Facets that reflect.
    reflection: f32,
    /// Facets that light passes.
    passage: f32,
}

/// A direction as the light or the view above the sheet sees it: turned upwards where it is below.
fn mirrored(w: Vec3) -> Vec3 {
    Vec3::new(w.x, w.y, w.z.abs())
}

/// Whether light from behind the sheet is seen in its highlight: whether facets that would mirror its mirror image face it.
fn passes(light: Vec3, view: Vec3) -> bool {
    let h = mirrored(light) + mirrored(view);
    light.truncate().dot(h.truncate()) < light.z.abs() * h.z
}

impl PrincipledThin<Rgb, f32> {
    fn facets(&self) -> Microfacets<f32> {
        facets(self.roughness, self.anisotropic)
    }

    /// Facets that light passes: two boundaries, which bend it less than one where the index is small. `[BUR15]`
    fn passed_facets(&self) -> Microfacets<f32> {
        facets(self.roughness * (0.65 * self.eta - 0.35).max(0.0), self.anisotropic)
    }

    fn reflected(&self, cos: f32) -> Rgb {
        dielectric(self.base_color, self.eta, self.spec_tint, cos) * self.spec_trans
    }

    fn passed(&self, cos: f32) -> Rgb {
        self.base_color * (self.spec_trans * (1.0 - fresnel::reflectance(cos, 1.0, self.eta)))
    }

    /// Shares of the diffuse base's light that stay on its side and that pass to the other.
    fn diffuse_shares(&self) -> [f32; 2] {
        let behind = 0.5 * self.diff_trans;
        [1.0 - behind, behind].map(|share| share * (1.0 - self.spec_trans))
    }

    fn chances(&self, cos: f32) -> Chances {
        // Neither side of the highlight is left to the few samples that its share at the normal would give it.
        const LEAST: f32 = 0.1;
        let [stays, leaves] = self.diffuse_shares();
        let albedo = self.base_color.mean();
        let base = stays * (albedo + self.sheen * sheen_albedo(cos));
        let [reflection, passage] = [self.reflected(cos), self.passed(cos)].map(Rgb::mean);
        let highlight = reflection + passage;
        let sum = base + leaves * albedo + highlight;
        if sum <= 0.0 {
            return Chances { base: 1.0, ..Chances::default() };
        }
        let [reflection, passage] =
            [reflection, passage].map(|part| LEAST * highlight + (1.0 - 2.0 * LEAST) * part);
        Chances {
            base: base / sum,
            behind: leaves * albedo / sum,
            reflection: reflection / sum,
            passage: passage / sum,
        }
    }

    /// The value of `lobes` on the side of `wo`, both directions above.
    fn reflection(&self, wo: Vec3, wi: Vec3, lobes: LobeFlags) -> Rgb {
        let mut sum = Rgb::BLACK;
        if lobes.intersects(LobeFlags::DIFFUSE) {
            let [share, _] = self.diffuse_shares();
            let cos_half = wi.dot((wo + wi).normalize());
            let dull = shading::diffuse(wo.z, wi.z, cos_half, self.roughness, self.flatness);
            sum += shading::lambertian(self.base_color, dull * share);
            if self.sheen > 0.0 {
                sum += sheen(self.base_color, self.sheen_tint, cos_half) * (self.sheen * share);
            }
        }
        if self.spec_trans > 0.0 && lobes.intersects(LobeFlags::GLOSSY) {
            sum += self.facets().reflect(wo, wi, |cos| self.reflected(cos));
        }
        sum
    }

    /// The value of `lobes` on the other side: `view` and `light` are as paths meet them, one above and one below.
    fn transmission(&self, view: Vec3, light: Vec3, lobes: LobeFlags) -> Rgb {
        let mut sum = Rgb::BLACK;
        if lobes.intersects(LobeFlags::DIFFUSE) {
            sum += shading::lambertian(self.base_color, self.diffuse_shares()[1]);
        }
        if self.spec_trans > 0.0 && lobes.intersects(LobeFlags::GLOSSY) && passes(light, view) {
            sum += self.passed_facets().reflect(mirrored(view), mirrored(light), |cos| self.passed(cos));
        }
        sum
    }

    /// The value of `lobes` on either side for light that flows as `transport` says.
    fn value(&self, wo: Vec3, wi: Vec3, transport: Transport, lobes: LobeFlags) -> Rgb {
        if same_side(wo, wi) {
            return self.reflection(mirrored(wo), mirrored(wi), lobes);
        }
        match transport {
            Transport::Radiance => self.transmission(wo, wi, lobes),
            Transport::Importance => self.transmission(wi, wo, lobes),
        }
    }

    fn pdf_of(&self, wo: Vec3, wi: Vec3, chances: &Chances) -> f32 {
        let reflects = same_side(wo, wi);
        let (wo, wi) = (mirrored(wo), mirrored(wi));
        let (base, glossy, r) = if reflects {
            (chances.base, chances.reflection, self.facets())
        } else {
            (chances.behind, chances.passage, self.passed_facets())
        };
        let mut pdf = base * warp::square_to_cosine_hemisphere_pdf(wi);
        if glossy > 0.0 {
            pdf += glossy * r.reflect_pdf(wo, (wo + wi).normalize());
        }
        pdf
    }

    /// `wo` reflected by facets that it sees, or mirrored once more to pass through; `None`: it would end on the wrong side.
    fn by_facet(&self, wo: Vec3, u: Vec2, passes: bool) -> Option<Vec3> {
        let r = if passes { self.passed_facets() } else { self.facets() };
        let up = mirrored(wo);
        let h = r.sample(up, u);
        let wi = h * (2.0 * up.dot(h)) - up;
        let side = if passes { -wo.z } else { wo.z };
        (wi.z > 0.0).then(|| Vec3::new(wi.x, wi.y, wi.z.copysign(side)))
    }
}

// Never inlined, so that what decides between models stays small.
impl Model for PrincipledThin<Rgb, f32> {
    fn flags(&self) -> LobeFlags {
        Self::flags(self)
    }

    fn gloss(&self) -> Option<f32> {
        (self.spec_trans > 0.0).then(|| self.facets().widest())
    }

    #[inline(never)]
    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeFlags) -> Rgb {
        self.value(wo, wi, Transport::Radiance, lobes)
    }

    #[inline(never)]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.pdf_of(wo, wi, &self.chances(wo.z.abs()))
    }

    fn glossy_pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if self.spec_trans > 0.0 && same_side(wo, wi) {
            self.pdf_of(wo, wi, &Chances { reflection: 1.0, ..Chances::default() })
        } else {
            0.0
        }
    }

    #[inline(never)]
    fn lobes(&self, wo: Vec3, transport: Transport, u: Vec2, lobes: LobeFlags) -> LobeSamples {
        if self.spec_trans <= 0.0 || !lobes.intersects(LobeFlags::GLOSSY) {
            return [None; 4];
        }
        let sampled = [false, true].map(|passes| {
            let chances = if passes {
                Chances { passage: 1.0, ..Chances::default() }
            } else {
                Chances { reflection: 1.0, ..Chances::default() }
            };
            let wi = self.by_facet(wo, u, passes)?;
            let pdf = self.pdf_of(wo, wi, &chances);
            let weight = self.value(wo, wi, transport, LobeFlags::GLOSSY) * (wi.z.abs() / pdf);
            (pdf > 0.0 && !weight.is_black()).then_some((wi, weight))
        });
        let sum: f32 = sampled.iter().flatten().map(|(_, weight)| weight.mean()).sum();
        let [reflection, passage] = sampled
            .map(|lobe| lobe.map(|(wi, weight)| LobeSample { wi, weight, probability: weight.mean() / sum }));
        [reflection, passage, None, None]
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
        let all = self.chances(wo.z.abs());
        let diffuse = all.base + all.behind;
        let (kind, wi) = if u_lobe < all.base {
            (LobeFlags::DIFFUSE, cosine(wo, u))
        } else if u_lobe < diffuse {
            (LobeFlags::DIFFUSE, cosine(-wo, u))
        } else {
            (LobeFlags::GLOSSY, self.by_facet(wo, u, u_lobe >= diffuse + all.reflection)?)
        };
        let kinds = if apart.intersects(LobeFlags::GLOSSY) { kind } else { self.flags().spreading() };
        let when = |kind, chance| if kinds.intersects(kind) { chance } else { 0.0 };
        let chances = Chances {
            base: when(LobeFlags::DIFFUSE, all.base),
            behind: when(LobeFlags::DIFFUSE, all.behind),
            reflection: when(LobeFlags::GLOSSY, all.reflection),
            passage: when(LobeFlags::GLOSSY, all.passage),
        };
        let pdf = self.pdf_of(wo, wi, &chances);
        let weight = self.value(wo, wi, transport, kinds) * (wi.z.abs() / pdf);
        let side = if same_side(wo, wi) { LobeFlags::REFLECTION } else { LobeFlags::TRANSMISSION };
        (pdf > 0.0).then_some(BsdfSample { wi, weight, lobe: kinds | side })
    }
}
