//! Materials: colours, opacity, relief and emission. How they scatter is in `bsdfs`.
//!
//! All surfaces are seen from both sides, `doubleSided` or not: a renderer that leaves out back faces would let light through walls.
//! Emission leaves the front alone. Occlusion textures are left out, since light is traced.

use foton_math::Rgb;
use foton_math::glam::DAffine2;
use foton_scene::description::{Bsdf, Colour, Diffuse, Material, Relief, ReliefKind, Texture, TextureKind};
use serde_json::Value;

use super::bsdfs::Base;
use super::json::At;
use super::reader::{Painted, Reader, Surface};
use super::textures::Looked;
use super::wanted::Wanted;

/// Attributes of meshes whose vertices have colours or opacities.
pub(super) const COLOURS: &str = "vertex_color";
pub(super) const OPACITIES: &str = "vertex_opacity";

/// A material that says nothing.
static NOTHING: Value = Value::Null;

/// Textures by where they stand in a material: the first that is there says which coordinates are taken.
const TEXTURES: [&[&str]; 7] = [
    &["pbrMetallicRoughness", "baseColorTexture"],
    &["extensions", "KHR_materials_pbrSpecularGlossiness", "diffuseTexture"],
    &["normalTexture"],
    &["pbrMetallicRoughness", "metallicRoughnessTexture"],
    &["emissiveTexture"],
    &["extensions", "KHR_materials_transmission", "transmissionTexture"],
    &["extensions", "KHR_materials_clearcoat", "clearcoatTexture"],
];

impl<'a> Reader<'a> {
    /// The material of that number, or the one of parts that name none.
    fn material_at(&mut self, index: Option<usize>) -> At<'a> {
        let found = index.and_then(|i| self.root.get("materials").and_then(|all| all.item(i)));
        found.unwrap_or_else(|| At::root(&NOTHING))
    }

    /// The base of a material as it is stated: its place, colour, opacity and texture.
    fn base_of(&mut self, material: &At<'a>) -> (Rgb, f32, Option<At<'a>>) {
        let glossy = material.extension("KHR_materials_pbrSpecularGlossiness");
        let (owner, factor, texture) = match glossy {
            Some(glossy) => (Some(glossy), "diffuseFactor", "diffuseTexture"),
            None => (material.get("pbrMetallicRoughness"), "baseColorFactor", "baseColorTexture"),
        };
        let Some(owner) = owner else { return (Rgb::WHITE, 1.0, None) };
        let [r, g, b, a] = owner.numbers(factor, &mut self.report).unwrap_or([1.0; 4]);
        let cut = [r, g, b, a].map(|x| x.clamp(0.0, 1.0) as f32);
        if [r, g, b, a].into_iter().any(|x| !(0.0..=1.0).contains(&x)) {
            self.notice("a base colour is cut to 0 to 1", &owner);
        }
        (Rgb::new(cut[0], cut[1], cut[2]), cut[3], owner.get(texture))
    }

    /// Whether colours of vertices can be shown on a material, and whether their opacities can.
    pub(super) fn takes_colours(&mut self, index: Option<usize>) -> (bool, bool) {
        let material = self.material_at(index);
        let (_, _, texture) = self.base_of(&material);
        let is_opaque = self.alpha_mode(&material) == "OPAQUE";
        (texture.is_none(), texture.is_none() && !is_opaque)
    }

    /// The base colour of a material and its opacity, without textures.
    pub(super) fn base_factor(&mut self, index: Option<usize>) -> (Rgb, f32) {
        let material = self.material_at(index);
        let (factor, alpha, _) = self.base_of(&material);
        (factor, alpha)
    }

    /// Whether a material has a texture.
    pub(super) fn has_textures(&mut self, index: Option<usize>) -> bool {
        let material = self.material_at(index);
        TEXTURES.iter().any(|path| path.iter().try_fold(material.clone(), |at, key| at.get(key)).is_some())
    }

    /// The set of texture coordinates that a material takes.
    pub(super) fn set_of_material(&mut self, index: Option<usize>) -> usize {
        let material = self.material_at(index);
        let first =
            TEXTURES.iter().find_map(|path| path.iter().try_fold(material.clone(), |at, key| at.get(key)));
        first.map_or(0, |info| self.set_of(&info))
    }

    /// Whether a material has a normal map.
    pub(super) fn has_relief(&mut self, index: Option<usize>) -> bool {
        self.material_at(index).get("normalTexture").is_some()
    }

    /// The material of that number, with what the vertices of a part add to it.
    pub(super) fn surface(&mut self, index: Option<usize>, painted: Painted) -> Surface {
        if let Some(known) = self.made.surfaces.get(&(index, painted)) {
            return *known;
        }
        let at = self.material_at(index);
        self.made.set = self.set_of_material(index);
        let stated = at.text("name", &mut self.report);
        let name = match (stated, index) {
            (Some(name), _) if !name.is_empty() => name.to_owned(),
            (_, Some(index)) => format!("material-{index}"),
            (_, None) => "default-material".to_owned(),
        };
        let name = self.unique_material(&name);
        let (material, radiance) = self.describe(&at, name, painted);
        let surface = Surface { material: self.description.materials.len(), radiance };
        self.description.materials.push(material);
        self.made.surfaces.insert((index, painted), surface);
        surface
    }

    fn describe(&mut self, at: &At<'a>, name: String, painted: Painted) -> (Material, Option<Colour>) {
        let (mut factor, mut alpha, texture) = self.base_of(at);
        if let Some(shared) = painted.shared {
            let [r, g, b, a] = shared.map(f32::from_bits);
            factor *= Rgb::new(r, g, b);
            alpha *= a;
        }
        let colour = match &texture {
            Some(info) => self.coloured(info, Wanted::colour(factor), factor),
            None if painted.colours => Colour::Texture(self.attribute(COLOURS)),
            None => Colour::Constant(factor),
        };
        let base = Base { factor, alpha, texture, colour };
        let opacity = self.opacity(at, &base, painted);
        let mut radiance = self.emission(at);
        let front = if at.extension("KHR_materials_unlit").is_some() {
            self.notice("is unlit: it emits its base colour, which lights the scene as well", at);
            radiance = Some(base.colour);
            Bsdf::Diffuse(Diffuse { reflectance: Rgb::BLACK.into() })
        } else {
            self.scattering(at, &base)
        };
        if radiance.is_some() && at.is("doubleSided", &mut self.report) {
            self.notice("emits from its front alone, although it is double-sided", at);
        }
        let relief = self.relief(at, painted.mirrored);
        let back = Some(front).filter(|front| !front.has_two_sides());
        (Material { name, front, back, opacity, relief, ..Material::default() }, radiance)
    }

    fn coloured(&mut self, info: &At<'a>, wanted: Wanted, otherwise: Rgb) -> Colour {
        match self.texture(info, wanted, info.path()) {
            Some(Looked::Texture(index)) => Colour::Texture(index),
            Some(Looked::Constant(c)) => Colour::Constant(c),
            None => Colour::Constant(otherwise),
        }
    }

    /// The texture that shows what vertices have.
    fn attribute(&mut self, name: &str) -> usize {
        let is_it = |t: &Texture| matches!(&t.kind, TextureKind::Attribute { name: of, .. } if of == name);
        let textures = &mut self.description.textures;
        textures.iter().position(is_it).unwrap_or_else(|| {
            let kind = TextureKind::Attribute { name: name.to_owned(), scale: 1.0, most: 1.0 };
            textures.push(Texture { name: name.to_owned(), to_uv: DAffine2::IDENTITY, kind });
            textures.len() - 1
        })
    }

    fn alpha_mode(&mut self, at: &At<'a>) -> &'a str {
        let mode = at.text("alphaMode", &mut self.report).unwrap_or("OPAQUE");
        if !["OPAQUE", "MASK", "BLEND"].contains(&mode) {
            at.error(&mut self.report, "\"alphaMode\" must be OPAQUE, MASK or BLEND");
            return "OPAQUE";
        }
        mode
    }

    /// The share of light that meets the surface; `None`: all of it.
    fn opacity(&mut self, at: &At<'a>, base: &Base<'a>, painted: Painted) -> Option<Colour> {
        let mode = self.alpha_mode(at);
        if mode == "OPAQUE" {
            return None;
        }
        if painted.opacities {
            return Some(Colour::Texture(self.attribute(OPACITIES)));
        }
        let threshold = self.cutoff(at);
        let is_mask = mode == "MASK";
        let alpha = base.alpha;
        let otherwise = if is_mask { f32::from(u8::from(alpha >= threshold)) } else { alpha };
        let wanted = if is_mask {
            Wanted::Cutout(alpha.to_bits(), threshold.to_bits())
        } else {
            Wanted::Opacity(alpha.to_bits())
        };
        let opacity = match &base.texture {
            Some(info) => self.coloured(info, wanted, Rgb::splat(otherwise)),
            None => Colour::Constant(Rgb::splat(otherwise)),
        };
        Some(opacity).filter(|opacity| *opacity != Colour::Constant(Rgb::WHITE))
    }

    /// The opacity from which a masked material is there.
    fn cutoff(&mut self, at: &At<'_>) -> f32 {
        at.number_in("alphaCutoff", (0.0, f64::INFINITY), 0.5, &mut self.report) as f32
    }

    /// What the opacity of a vertex becomes.
    pub(super) fn vertex_opacity(&mut self, index: Option<usize>) -> impl Fn(f32) -> f32 + use<> {
        let at = self.material_at(index);
        let (_, alpha) = self.base_factor(index);
        let threshold = (self.alpha_mode(&at) == "MASK").then(|| self.cutoff(&at));
        move |of_vertex| {
            let opacity = of_vertex * alpha;
            threshold.map_or(opacity, |threshold| f32::from(u8::from(opacity >= threshold)))
        }
    }

    /// Emitted radiance (W·m⁻²·sr⁻¹).
    fn emission(&mut self, at: &At<'a>) -> Option<Colour> {
        let factor = at.numbers("emissiveFactor", &mut self.report).unwrap_or([0.0; 3]);
        let strength = at.extension("KHR_materials_emissive_strength");
        let range = (0.0, f64::INFINITY);
        let strength =
            strength.map_or(1.0, |e| e.number_in("emissiveStrength", range, 1.0, &mut self.report));
        let factor = Rgb::from_array(factor.map(|c| (c.max(0.0) * strength) as f32));
        if factor.is_black() {
            return None;
        }
        let radiance = match at.get("emissiveTexture") {
            Some(info) => self.coloured(&info, Wanted::light(factor), factor),
            None => Colour::Constant(factor),
        };
        Some(radiance).filter(|radiance| *radiance != Colour::Constant(Rgb::BLACK))
    }

    fn relief(&mut self, at: &At<'a>, is_mirrored: bool) -> Option<Relief> {
        let info = at.get("normalTexture")?;
        let scale = info.number("scale", &mut self.report).unwrap_or(1.0) as f32;
        let wanted = Wanted::Normal(scale.to_bits(), is_mirrored);
        match self.texture(&info, wanted, info.path())? {
            Looked::Texture(texture) => Some(Relief { texture, kind: ReliefKind::Normal, same_behind: true }),
            // The same everywhere, it is flat as a rule.
            Looked::Constant(_) => None,
        }
    }
}
