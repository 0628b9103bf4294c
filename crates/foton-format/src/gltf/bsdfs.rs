//! How surfaces scatter: metallic-roughness and the extensions of it as foton's models.
//!
//! | material | model |
//! |---|---|
//! | metallic-roughness | `principled`; its facets' α is the square of the roughness in both |
//! | wholly transmitting, with a volume | `dielectric`, rough where the roughness is not 0 |
//! | the same without a volume, a sheet | `thindielectric`, or where it is rough `principledthin` |
//! | partly transmitting | `principled` with a volume, `principledthin` without |
//! | diffusely transmitting | `principledthin` |
//! | unlit | black, and emits its base colour |
//!
//! An index of refraction stands for what is reflected head-on, so the factor of `KHR_materials_specular` becomes another index. A
//! volume's absorption becomes a tint of its surface: half of what its thickness takes at each crossing.

use foton_math::Rgb;
use foton_scene::description::{
    Bsdf, Colour, Dielectric, MicrofacetDistribution, Microfacets, Number, Principled, PrincipledThin,
    ThinDielectric,
};

use super::json::At;
use super::reader::Reader;
use super::textures::Looked;
use super::wanted::Wanted;

const UNIT: (f64, f64) = (0.0, 1.0);

/// α of a clear coat at a gloss of 0 and of 1.
const COAT: [f32; 2] = [0.1, 0.001];

/// Head-on reflection above which a colour is that of a metal.
const METAL: f32 = 0.25;

/// The base of a material: what it scatters apart from extensions.
pub(super) struct Base<'a> {
    /// Its colour, without its texture.
    pub(super) factor: Rgb,
    /// Its opacity, without its texture.
    pub(super) alpha: f32,
    /// The texture of both.
    pub(super) texture: Option<At<'a>>,
    /// Its colour with its texture, or that of vertices.
    pub(super) colour: Colour,
}

impl<'a> Reader<'a> {
    /// A number that a channel of a texture multiplies.
    pub(super) fn textured(&mut self, owner: &At<'a>, key: &str, channel: usize, factor: f64) -> Number {
        let factor = factor as f32;
        let owner = Some(owner).filter(|_| factor > 0.0);
        self.textured_for(owner, key, Wanted::number(channel, factor), factor)
    }

    /// What comes of a texture, or another number where there is none.
    fn textured_for(&mut self, owner: Option<&At<'a>>, key: &str, wanted: Wanted, otherwise: f32) -> Number {
        let info = owner.and_then(|owner| owner.get(key));
        match info.and_then(|info| self.texture(&info, wanted, info.path())) {
            Some(Looked::Texture(index)) => Number::Texture(index),
            Some(Looked::Constant(c)) => Number::Constant(c.r),
            None => Number::Constant(otherwise),
        }
    }

    /// A factor between 0 and 1.
    fn factor(&mut self, owner: Option<&At<'_>>, key: &str, default: f64) -> f64 {
        owner.map_or(default, |owner| owner.number_in(key, UNIT, default, &mut self.report))
    }

    /// How a material scatters.
    pub(super) fn scattering(&mut self, material: &At<'a>, base: &Base<'a>) -> Bsdf {
        self.say_left_out(material);
        if let Some(glossy) = material.extension("KHR_materials_pbrSpecularGlossiness") {
            return self.glossy(&glossy, base);
        }
        let pbr = material.get("pbrMetallicRoughness");
        let metallic = self.factor(pbr.as_ref(), "metallicFactor", 1.0);
        let metallic = match &pbr {
            Some(pbr) => self.textured(pbr, "metallicRoughnessTexture", 2, metallic),
            None => Number::Constant(metallic as f32),
        };
        if let Some(glass) = material.extension("KHR_materials_transmission") {
            let factor = self.factor(Some(&glass), "transmissionFactor", 0.0);
            if factor > 0.0 && metallic.constant() != Some(1.0) {
                let transmission = self.textured(&glass, "transmissionTexture", 0, factor);
                return self.transmitting(material, base, metallic, transmission);
            }
        }
        let roughness = self.roughness(pbr.as_ref(), Wanted::Number);
        let eta = self.index(material, false);
        if let Some(leaf) = material.extension("KHR_materials_diffuse_transmission") {
            let factor = self.factor(Some(&leaf), "diffuseTransmissionFactor", 0.0);
            if factor > 0.0 {
                self.notice(
                    "diffuse transmission is that of a sheet without highlights, in the base colour",
                    &leaf,
                );
                return sheet(base.colour, roughness, 0.0.into(), (2.0 * factor as f32).into(), eta);
            }
        }
        self.coated(material, Principled { metallic, ..solid(base.colour, roughness, eta) })
    }

    /// The roughness of facets, or what is made of it.
    fn roughness(&mut self, pbr: Option<&At<'a>>, wanted: fn(usize, u32) -> Wanted) -> Number {
        let factor = self.factor(pbr, "roughnessFactor", 1.0) as f32;
        let wanted = wanted(1, factor.to_bits());
        let otherwise = if matches!(wanted, Wanted::Square(..)) { factor * factor } else { factor };
        self.textured_for(pbr.filter(|_| factor > 0.0), "metallicRoughnessTexture", wanted, otherwise)
    }

    /// How a material scatters that lets light through, all of it or a part.
    fn transmitting(
        &mut self,
        material: &At<'a>,
        base: &Base<'a>,
        metallic: Number,
        transmission: Number,
    ) -> Bsdf {
        let pbr = material.get("pbrMetallicRoughness");
        let eta = self.index(material, true);
        let volume = self.absorption(material);
        let is_clear = transmission.constant() == Some(1.0) && metallic.constant() == Some(0.0);
        if volume.is_none() || is_clear {
            self.without_coats(material);
        }
        if is_clear {
            let alpha =
                Some(self.roughness(pbr.as_ref(), Wanted::Square)).filter(|a| a.constant() != Some(0.0));
            let white = Colour::Constant(Rgb::WHITE);
            if let Some(tint) = volume {
                let facets = |alpha| Microfacets {
                    distribution: MicrofacetDistribution::Ggx,
                    alpha_u: alpha,
                    alpha_v: alpha,
                };
                return Bsdf::Dielectric(Dielectric {
                    int_ior: eta,
                    ext_ior: 1.0,
                    specular_reflectance: white,
                    specular_transmittance: self.tinted(base, tint),
                    roughness: alpha.map(facets),
                });
            }
            if alpha.is_none() {
                return Bsdf::ThinDielectric(ThinDielectric {
                    int_ior: eta,
                    ext_ior: 1.0,
                    specular_reflectance: white,
                    specular_transmittance: base.colour,
                });
            }
        }
        let roughness = self.roughness(pbr.as_ref(), Wanted::Number);
        if volume.is_none() {
            if metallic.constant() != Some(0.0) {
                self.notice("its metallic part is left out: it is a transparent sheet", material);
            }
            return sheet(base.colour, roughness, transmission, 0.0.into(), eta);
        }
        let model = solid(base.colour, roughness, eta);
        self.coated(material, Principled { metallic, spec_trans: transmission, ..model })
    }

    /// What stands for a material's reflection head-on: an index of refraction.
    fn index(&mut self, material: &At<'_>, is_clear: bool) -> f32 {
        let stated = material.extension("KHR_materials_ior").and_then(|e| e.number("ior", &mut self.report));
        let ior = stated.unwrap_or(1.5) as f32;
        let ior = if ior == 0.0 || ior >= 1.0 { ior } else { 1.0 };
        let Some(specular) = material.extension("KHR_materials_specular").filter(|_| !is_clear) else {
            return if ior == 0.0 { 20.0 } else { ior };
        };
        let factor = self.factor(Some(&specular), "specularFactor", 1.0) as f32;
        let colour = specular.numbers("specularColorFactor", &mut self.report).unwrap_or([1.0; 3]);
        let colour = Rgb::from_array(colour.map(|c| c as f32));
        if colour != Rgb::splat(colour.r) || specular.get("specularColorTexture").is_some() {
            self.notice("the colour of the specular reflection is left out, its luminance counts", &specular);
        }
        if specular.get("specularTexture").is_some() {
            self.notice("the texture of the specular reflection is left out", &specular);
        }
        let head_on = if ior == 0.0 { 1.0 } else { ((ior - 1.0) / (ior + 1.0)).powi(2) };
        index_of(head_on * factor * colour.luminance().max(0.0))
    }

    /// What light loses in a volume at each crossing of its surface; `None` for a sheet, which has no volume.
    fn absorption(&mut self, material: &At<'_>) -> Option<Rgb> {
        let volume = material.extension("KHR_materials_volume")?;
        let thickness = volume.number("thicknessFactor", &mut self.report).filter(|t| *t > 0.0)?;
        let distance = volume.number("attenuationDistance", &mut self.report).filter(|d| *d > 0.0);
        let colour = volume.numbers("attenuationColor", &mut self.report).unwrap_or([1.0; 3]);
        let (Some(distance), true) = (distance, colour != [1.0; 3]) else { return Some(Rgb::WHITE) };
        self.notice(
            "absorption in the volume is a tint of its surface, by \"thicknessFactor\": parts of other thickness have the same",
            &volume,
        );
        let half = 0.5 * thickness / distance;
        Some(Rgb::from_array(colour.map(|c| c.clamp(0.0, 1.0).powf(half) as f32)))
    }

    /// The colour of a base times a tint.
    fn tinted(&mut self, base: &Base<'a>, tint: Rgb) -> Colour {
        if tint == Rgb::WHITE {
            return base.colour;
        }
        match (&base.texture, base.colour) {
            (_, Colour::Constant(c)) => Colour::Constant(c * tint),
            (Some(info), _) => match self.texture(info, Wanted::colour(base.factor * tint), info.path()) {
                Some(Looked::Texture(index)) => Colour::Texture(index),
                Some(Looked::Constant(c)) => Colour::Constant(c),
                None => base.colour,
            },
            (None, colour) => colour,
        }
    }

    /// A model with the material's coat and sheen over it.
    fn coated(&mut self, material: &At<'a>, mut model: Principled) -> Bsdf {
        if let Some(coat) = material.extension("KHR_materials_clearcoat") {
            let factor = self.factor(Some(&coat), "clearcoatFactor", 0.0);
            model.clearcoat = self.textured(&coat, "clearcoatTexture", 0, factor);
            let roughness = self.factor(Some(&coat), "clearcoatRoughnessFactor", 0.0) as f32;
            let [dull, sharp] = COAT;
            let alpha = roughness * roughness;
            if factor > 0.0 && alpha > dull {
                self.notice("the clear coat is sharper than its roughness says: α is at most 0.1", &coat);
            }
            model.clearcoat_gloss = ((dull - alpha) / (dull - sharp)).clamp(0.0, 1.0).into();
            for key in ["clearcoatRoughnessTexture", "clearcoatNormalTexture"] {
                if let Some(texture) = coat.get(key).filter(|_| factor > 0.0) {
                    self.notice("this texture of the clear coat is left out", &texture);
                }
            }
        }
        if let Some(sheen) = material.extension("KHR_materials_sheen") {
            let colour = sheen.numbers("sheenColorFactor", &mut self.report).unwrap_or([0.0; 3]);
            let most = colour.into_iter().fold(0.0, f64::max).clamp(0.0, 1.0) as f32;
            if most > 0.0 {
                self.notice("sheen is Disney's: white, and as wide as that is", &sheen);
                model.sheen = most.into();
            }
        }
        Bsdf::Principled(model)
    }

    /// Says that what lies over a material is left out.
    fn without_coats(&mut self, material: &At<'_>) {
        for name in ["KHR_materials_clearcoat", "KHR_materials_sheen"] {
            if let Some(over) = material.extension(name) {
                self.notice("is left out over transparent materials", &over);
            }
        }
    }

    fn say_left_out(&mut self, material: &At<'_>) {
        for name in ["KHR_materials_anisotropy", "KHR_materials_iridescence", "KHR_materials_dispersion"] {
            if let Some(left_out) = material.extension(name) {
                self.notice("is left out", &left_out);
            }
        }
    }

    /// The older model, of a diffuse colour under a reflection that has one as well.
    fn glossy(&mut self, glossy: &At<'a>, base: &Base<'a>) -> Bsdf {
        self.notice(
            "specular-glossiness is taken as metallic-roughness: a bright specular colour is a metal's",
            glossy,
        );
        let specular = glossy.numbers("specularFactor", &mut self.report).unwrap_or([1.0; 3]);
        let specular = Rgb::from_array(specular.map(|c| c.clamp(0.0, 1.0) as f32));
        let gloss = self.factor(Some(glossy), "glossinessFactor", 1.0);
        let has_texture = glossy.get("specularGlossinessTexture").is_some();
        let wanted = Wanted::Rest(3, (gloss as f32).to_bits());
        let owner = Some(glossy).filter(|_| gloss > 0.0);
        let roughness = self.textured_for(owner, "specularGlossinessTexture", wanted, 1.0 - gloss as f32);
        if !has_texture && specular.max_component() > METAL {
            let model = solid(Colour::Constant(specular), roughness, 1.5);
            return Bsdf::Principled(Principled { metallic: 1.0.into(), ..model });
        }
        let head_on = if has_texture { 0.04 } else { specular.luminance() };
        Bsdf::Principled(solid(base.colour, roughness, index_of(head_on)))
    }
}

/// The index of refraction by which a share of light is reflected head-on.
fn index_of(head_on: f32) -> f32 {
    let root = head_on.clamp(0.0, 0.9).sqrt();
    // An index of exactly 1 is none for some readers.
    ((1.0 + root) / (1.0 - root)).max(1.001)
}

/// A closed body without anything over it.
fn solid(base_color: Colour, roughness: Number, eta: f32) -> Principled {
    let none = Number::Constant(0.0);
    Principled {
        base_color,
        roughness,
        anisotropic: none,
        metallic: none,
        spec_trans: none,
        eta,
        spec_tint: none,
        sheen: none,
        sheen_tint: none,
        flatness: none,
        clearcoat: none,
        clearcoat_gloss: none,
    }
}

/// A sheet that is the same from both sides.
fn sheet(base_color: Colour, roughness: Number, spec_trans: Number, diff_trans: Number, eta: f32) -> Bsdf {
    let none = Number::Constant(0.0);
    Bsdf::PrincipledThin(PrincipledThin {
        base_color,
        roughness,
        anisotropic: none,
        spec_trans,
        diff_trans,
        eta: eta.clamp(0.1, 10.0).into(),
        spec_tint: none,
        sheen: none,
        sheen_tint: none,
        flatness: none,
    })
}
