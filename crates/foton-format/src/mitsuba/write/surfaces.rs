//! Materials and textures as the plugins of Mitsuba 3 that mean the same.

use foton_film::WriteError;
use foton_math::Rgb;
use foton_math::glam::{DAffine2, DAffine3, DMat3};
use foton_scene::bsdf::Microfacets;
use foton_scene::description::{
    Blend, Bsdf, Coating, Colour, Material, Number, Relief, ReliefKind, Texture, TextureKind, Wrap,
};
use foton_scene::parameter::{Binding, Kind, Slot};
use foton_scene::plugins::{textures, wrappers};

use super::Writer;
use super::xml::{colour, single};
use crate::mitsuba::read::textures::TURN;

impl Writer<'_> {
    /// Writes a texture and returns its id.
    pub(super) fn texture(&mut self, texture: &Texture) -> Result<String, WriteError> {
        let id = self.id(&texture.name);
        match &texture.kind {
            TextureKind::Bitmap { bitmap, wrap, bilinear } => {
                let filename = self.bitmap(bitmap, &id)?;
                let xml = &mut self.xml;
                xml.open("texture", &[("type", textures::BITMAP.name), ("id", &id)]);
                xml.value("string", textures::FILENAME.name, &filename);
                xml.value(
                    "string",
                    textures::FILTER_TYPE.name,
                    if *bilinear { "bilinear" } else { "nearest" },
                );
                let wrap = match wrap {
                    Wrap::Repeat => textures::WRAPS[0],
                    Wrap::Mirror => textures::WRAPS[1],
                    Wrap::Clamp => textures::WRAPS[2],
                };
                xml.value("string", textures::WRAP_MODE.name, wrap);
                // The description's v points up, Mitsuba's down.
                xml.transform(textures::TO_UV.name, &in_space(TURN * texture.to_uv));
            }
            TextureKind::Checkerboard { colours } => {
                let xml = &mut self.xml;
                xml.open("texture", &[("type", textures::CHECKERBOARD.name), ("id", &id)]);
                xml.transform(textures::TO_UV.name, &in_space(texture.to_uv));
                self.colour(textures::COLOR0.name, colours[0]);
                self.colour(textures::COLOR1.name, colours[1]);
            }
            TextureKind::Attribute { name, scale, .. } => {
                let xml = &mut self.xml;
                xml.open("texture", &[("type", textures::MESH_ATTRIBUTE.name), ("id", &id)]);
                xml.value("string", textures::NAME.name, name);
                xml.value("float", textures::ATTRIBUTE_SCALE.name, &single(*scale));
            }
        }
        self.xml.close("texture");
        Ok(id)
    }

    /// Writes a material and returns its id.
    pub(super) fn material(&mut self, material: &Material) -> String {
        let id = self.id(&material.name);
        self.blended(material, material.mixture.len(), &[("id", &id)]);
        id
    }

    /// Writes a material with the first of those that are blended with it.
    fn blended(&mut self, material: &Material, count: usize, attributes: &[(&str, &str)]) {
        let Some(last) = count.checked_sub(1) else { return self.component(material, attributes) };
        let Blend { material: other, weight } = material.mixture[last];
        let mut outer = vec![("type", wrappers::BLENDBSDF.name)];
        outer.extend(attributes);
        self.xml.open("bsdf", &outer);
        match weight {
            Number::Constant(weight) => self.xml.value("float", wrappers::WEIGHT.name, &single(weight)),
            Number::Texture(i) => self.colour(wrappers::WEIGHT.name, Colour::Texture(i)),
        }
        self.blended(material, last, &[]);
        let other = &self.description.materials[other];
        self.blended(other, other.mixture.len(), &[]);
        self.xml.close("bsdf");
    }

    /// Opens the element of a relief, if there is one. Whether it is to be closed.
    fn relief(&mut self, relief: Option<&Relief>, attributes: &mut Vec<(&str, &str)>) -> bool {
        let Some(Relief { texture, kind, .. }) = relief else { return false };
        let (plugin, name) = match kind {
            ReliefKind::Bump { .. } => (wrappers::BUMPMAP.name, "heights"),
            ReliefKind::Normal => (wrappers::NORMALMAP.name, wrappers::NORMALS.name),
        };
        let mut outer = vec![("type", plugin)];
        outer.append(attributes);
        self.xml.open("bsdf", &outer);
        self.colour(name, Colour::Texture(*texture));
        if let ReliefKind::Bump { scale } = kind {
            self.xml.value("float", wrappers::SCALE.name, &single(*scale));
        }
        // Mitsuba 3 darkens light at grazing angles unless told not to.
        self.xml.value("boolean", wrappers::SHADOWING.name, "false");
        true
    }

    /// Writes a material without those that are blended with it.
    fn component(&mut self, material: &Material, attributes: &[(&str, &str)]) {
        let mut attributes = attributes.to_vec();
        if let Some(opacity) = &material.opacity {
            let mut outer = vec![("type", wrappers::MASK.name)];
            outer.append(&mut attributes);
            self.xml.open("bsdf", &outer);
            match *opacity {
                Colour::Constant(share) => {
                    self.xml.value("float", wrappers::OPACITY.name, &single(mean(share)));
                }
                texture @ Colour::Texture(_) => self.colour(wrappers::OPACITY.name, texture),
            }
        }
        // A relief that is the same behind stands inside of both sides.
        let inner = material.relief.filter(|relief| relief.same_behind);
        let outer = self.relief(material.relief.filter(|r| !r.same_behind).as_ref(), &mut attributes);
        match material.back {
            Some(back) if !material.front.has_two_sides() => {
                let mut around = vec![("type", wrappers::TWOSIDED.name)];
                around.append(&mut attributes);
                self.xml.open("bsdf", &around);
                let [over_front, over_back] = material.coatings;
                self.side((&material.front, over_front), inner.as_ref(), Vec::new());
                if (back, over_back) != (material.front, over_front) {
                    self.side((&back, over_back), inner.as_ref(), Vec::new());
                }
                self.xml.close("bsdf");
            }
            _ => self.side((&material.front, material.coatings[0]), inner.as_ref(), attributes),
        }
        for _ in 0..usize::from(outer) + usize::from(material.opacity.is_some()) {
            self.xml.close("bsdf");
        }
    }

    /// Writes the BSDF of one side with its relief and its coating.
    fn side(
        &mut self,
        (bsdf, coating): (&Bsdf, Option<Coating>),
        relief: Option<&Relief>,
        mut attributes: Vec<(&str, &str)>,
    ) {
        let is_open = self.relief(relief, &mut attributes);
        if let Some(mut coating) = coating {
            let mut outer = vec![("type", coating.plugin())];
            outer.append(&mut attributes);
            self.xml.open("bsdf", &outer);
            self.parameters(coating.parameters());
        }
        self.bsdf(bsdf, &attributes);
        for _ in 0..usize::from(is_open) + usize::from(coating.is_some()) {
            self.xml.close("bsdf");
        }
    }

    fn bsdf(&mut self, bsdf: &Bsdf, more: &[(&str, &str)]) {
        let mut attributes = vec![("type", bsdf.plugin())];
        attributes.extend(more);
        self.xml.open("bsdf", &attributes);
        if let Some([tag, name, value]) = bsdf.info().stated {
            self.xml.value(tag, name, value);
        }
        let mut bsdf = *bsdf;
        self.parameters(bsdf.parameters());
        self.xml.close("bsdf");
    }

    fn parameters(&mut self, bindings: Vec<Binding<'_>>) {
        for binding in bindings {
            let parameter = &binding.parameters[0];
            match &binding.slot {
                // A factor need not stand where it changes nothing.
                Slot::Share(share) if parameter.default == 1.0 && **share == parameter.default_colour() => {}
                _ => {
                    for Stated { tag, name, text } in stated(&binding) {
                        self.xml.value(tag, name, &text);
                    }
                    for (name, texture) in textures_of(&binding) {
                        self.xml.leaf("ref", &[("name", name), ("id", &self.texture_ids[texture])]);
                    }
                }
            }
        }
    }

    pub(super) fn colour(&mut self, name: &str, value: Colour) {
        match value {
            Colour::Constant(c) => self.xml.value("rgb", name, &colour(c)),
            Colour::Texture(i) => self.xml.leaf("ref", &[("name", name), ("id", &self.texture_ids[i])]),
        }
    }
}

/// A value as it stands in a file.
#[derive(PartialEq)]
pub(crate) struct Stated {
    /// Its tag.
    pub(crate) tag: &'static str,
    /// Its name.
    pub(crate) name: &'static str,
    /// Its text.
    pub(crate) text: String,
}

/// The textures that stand for parameters of a BSDF, with their names.
pub(crate) fn textures_of(binding: &Binding<'_>) -> Vec<(&'static str, usize)> {
    let name = binding.parameters[0].name;
    let of = |name, number| if let Number::Texture(i) = number { Some((name, i)) } else { None };
    match &binding.slot {
        Slot::Share(Colour::Texture(i)) => vec![(name, *i)],
        Slot::Number(number) => of(name, **number).into_iter().collect(),
        Slot::Roughness(Some(r)) => {
            alphas(r).into_iter().filter_map(|(name, alpha)| of(name, alpha)).collect()
        }
        _ => Vec::new(),
    }
}

/// The roughness as files state it: once where it is the same along both axes.
fn alphas(r: &Microfacets) -> Vec<(&'static str, Number)> {
    if r.alpha_u == r.alpha_v {
        vec![("alpha", r.alpha_u)]
    } else {
        vec![("alpha_u", r.alpha_u), ("alpha_v", r.alpha_v)]
    }
}

/// What stands in a file for parameters of a BSDF; nothing for a texture, which stands elsewhere.
pub(crate) fn stated(binding: &Binding<'_>) -> Vec<Stated> {
    let name = binding.parameters[0].name;
    let of = |tag, name, text| Stated { tag, name, text };
    let number = |name, number: Number| number.constant().map(|x| of("float", name, single(x)));
    match &binding.slot {
        Slot::Share(Colour::Constant(c)) => vec![of("rgb", name, colour(*c))],
        Slot::Share(Colour::Texture(_)) | Slot::Roughness(None) => Vec::new(),
        Slot::Number(x) => number(name, **x).into_iter().collect(),
        Slot::Choice(i) => match binding.parameters[0].kind {
            Kind::Choice(words) => vec![of("string", name, words[**i].to_owned())],
            _ => Vec::new(),
        },
        Slot::Refraction(ior) | Slot::Reflectivity(ior) => vec![of("float", name, single(**ior))],
        Slot::Boolean(flag) => vec![of("boolean", name, flag.to_string())],
        Slot::Metal { eta, k } => vec![of("rgb", "eta", colour(**eta)), of("rgb", "k", colour(**k))],
        Slot::Roughness(Some(r)) => {
            let distribution = of("string", "distribution", r.distribution.name().to_owned());
            std::iter::once(distribution)
                .chain(alphas(r).into_iter().filter_map(|(n, x)| number(n, x)))
                .collect()
        }
    }
}

/// The mean channel; the channel itself where all are the same.
pub(crate) fn mean(c: Rgb) -> f32 {
    if c.r == c.g && c.g == c.b { c.r } else { c.mean() }
}

/// A transform of the plane as one of space.
fn in_space(t: DAffine2) -> DAffine3 {
    let m = t.matrix2;
    DAffine3::from_mat3_translation(
        DMat3::from_cols(m.x_axis.extend(0.0), m.y_axis.extend(0.0), foton_math::glam::DVec3::Z),
        t.translation.extend(0.0),
    )
}
