//! Materials: what their directives define, and what of that stands in the description.

use std::rc::Rc;

use foton_input::quoted;
use foton_math::Rgb;
use foton_math::glam::DAffine2;
use foton_scene::description::{Blend, Colour, Material, Number, Relief, ReliefKind, Wrap};

use super::colours::Meaning;
use super::made::Coordinates;
use super::parameters::{COLOURS, Kind, Parameters};
use super::pictures::Wanted;
use super::reader::Reader;
use super::state::Definition;
use super::texture::{ImageFile, Picture};
use super::tokens::{Fault, Tokens};
use crate::image::{Curve, Purpose};
use crate::mitsuba::read::known::Sides;
use crate::mitsuba::read::properties::Located;
use crate::spelling::did_you_mean;

/// Materials of both versions.
const MATERIALS: [&str; 26] = [
    "matte",
    "plastic",
    "metal",
    "glass",
    "mirror",
    "uber",
    "substrate",
    "translucent",
    "mix",
    "disney",
    "fourier",
    "hair",
    "subsurface",
    "kdsubsurface",
    "none",
    "diffuse",
    "coateddiffuse",
    "coatedconductor",
    "conductor",
    "dielectric",
    "thindielectric",
    "diffusetransmission",
    "interface",
    "measured",
    "shinymetal",
    "rough",
];

/// The most materials that one is mixed of.
const MOST_PARTS: usize = 64;

impl Reader<'_> {
    /// `Material`, `MakeNamedMaterial` and `NamedMaterial`.
    pub(crate) fn material_directive(&mut self, word: &str, tokens: &mut Tokens<'_>) -> Result<(), Fault> {
        let first =
            tokens.text(if word == "Material" { "a name of a plugin" } else { "a name of a material" })?;
        match word {
            "Material" => {
                let list = tokens.parameters(&mut self.report);
                let p = Parameters::new(first.value, first.place, list);
                let name =
                    format!("{}-{}", if p.plugin.is_empty() { "none" } else { &p.plugin }, self.definitions);
                self.state.material = self.define_material(name, p)?;
            }
            "MakeNamedMaterial" => {
                let list = tokens.parameters(&mut self.report);
                let mut p = Parameters::new(String::new(), first.place, list);
                let Some(kind) = p.text("type", &mut self.report) else {
                    return Err((first.place, "a named material needs its \"string type\"".to_owned()));
                };
                (p.plugin, p.place) = (kind.value, kind.place);
                let definition = self.define_material(first.value.clone(), p)?;
                self.materials.define(first.value, definition);
            }
            _ => self.state.material = self.material_named(&first)?,
        }
        Ok(())
    }

    fn material_named(&mut self, name: &Located<String>) -> Result<Rc<Definition>, Fault> {
        if let Some(known) = self.materials.find(&name.value) {
            return Ok(Rc::clone(known));
        }
        let hint = self.report.did_you_mean(&name.value, self.materials.all());
        Err((name.place, format!("there is no material {}{hint}", quoted(&name.value))))
    }

    fn define_material(&mut self, name: String, mut p: Parameters) -> Result<Rc<Definition>, Fault> {
        self.finish_list("material", &mut p);
        let parts = if p.plugin == "mix" { self.parts(&p)? } else { Vec::new() };
        let size = 1 + parts.iter().map(|part| part.size).sum::<usize>();
        if size > MOST_PARTS {
            return Err((p.place, format!("this is mixed of more than {MOST_PARTS} materials")));
        }
        let number = self.definitions;
        self.definitions += 1;
        Ok(Rc::new(Definition { number, name, parameters: p, parts, size }))
    }

    /// What a mixture is mixed of.
    fn parts(&mut self, p: &Parameters) -> Result<Vec<Rc<Definition>>, Fault> {
        let names: Vec<Located<String>> = match p.find("materials", &[Kind::Text], &mut self.report) {
            Some(parameter) => match &parameter.values {
                super::parameters::Values::Texts(texts) => texts.clone(),
                _ => Vec::new(),
            },
            None => ["namedmaterial1", "namedmaterial2"]
                .into_iter()
                .filter_map(|name| p.text(name, &mut self.report))
                .collect(),
        };
        if names.len() != 2 {
            return Err((p.place, format!("a mix is of two materials, not {}", names.len())));
        }
        names.iter().map(|name| self.material_named(name)).collect()
    }

    /// The index of a material in the description, on surfaces of such coordinates.
    pub(crate) fn material(
        &mut self,
        definition: &Rc<Definition>,
        coordinates: Coordinates,
        opacity: Option<&Rc<Picture>>,
    ) -> Option<usize> {
        let key = (definition.number, coordinates, opacity.map(Rc::as_ptr));
        if let Some(known) = self.made_materials.indices.get(&key) {
            return *known;
        }
        let made = self.sides(definition, coordinates).map(|mut sides| {
            if let Some(opacity) = opacity {
                let share = self.share(opacity, 1.0, coordinates, definition.parameters.place);
                let _ = sides.for_each(&mut |sides| {
                    sides.opacity = Some(match (share, sides.opacity) {
                        (Colour::Constant(a), Some(Colour::Constant(b))) => Colour::Constant(a * b),
                        (share, _) => share,
                    });
                    Ok::<_, ()>(())
                });
                self.made_materials.opacities.push(Rc::clone(opacity));
            }
            self.remember(&definition.name, definition.parameters.place);
            self.enter(definition.name.clone(), sides)
        });
        self.made_materials.indices.insert(key, made);
        made
    }

    /// Puts a material into the description, and behind it those that are blended with it.
    fn enter(&mut self, name: String, sides: Sides) -> usize {
        let Sides { front, back, coatings, opacity, relief, mixture, .. } = sides;
        let index = self.description.materials.len();
        let material =
            Material { name: name.clone(), front, back, coatings, opacity, relief, mixture: Vec::new() };
        self.description.materials.push(material);
        let blends = mixture.into_iter().enumerate().map(|(i, (other, weight))| {
            let material = self.enter(format!("{name}/{}", i + 2), other);
            Blend { material, weight }
        });
        let blends = blends.collect();
        self.description.materials[index].mixture = blends;
        index
    }

    /// What a definition says.
    pub(super) fn sides(&mut self, definition: &Definition, coordinates: Coordinates) -> Option<Sides> {
        let p = &definition.parameters;
        let sides = match p.plugin.as_str() {
            "mix" => self.mix(definition, coordinates),
            "matte" | "plastic" | "metal" | "glass" | "mirror" | "uber" | "substrate" | "translucent"
            | "disney" => self.old_material(p, coordinates),
            "diffuse"
            | "coateddiffuse"
            | "coatedconductor"
            | "conductor"
            | "dielectric"
            | "thindielectric"
            | "diffusetransmission"
            | "interface"
            | "none"
            | "" => self.new_material(p, coordinates),
            "hair" | "subsurface" | "kdsubsurface" | "fourier" | "measured" => {
                self.substitute(p, coordinates)
            }
            other => {
                let hint = did_you_mean(other, MATERIALS);
                self.report.error(p.place, format!("unknown material {}{hint}", quoted(other)));
                p.ignore_rest();
                None
            }
        };
        let relief = self.relief(p, coordinates);
        p.finish(&mut self.report);
        let mut sides = sides?;
        if relief.is_some() {
            let _ = sides.for_each(&mut |sides| {
                sides.relief = relief;
                Ok::<_, ()>(())
            });
        }
        Some(sides)
    }

    fn mix(&mut self, definition: &Definition, coordinates: Coordinates) -> Option<Sides> {
        let p = &definition.parameters;
        let kinds = [COLOURS, &[Kind::Float, Kind::Texture]].concat();
        let amount = match p.find("amount", &kinds, &mut self.report).map(|found| found.kind) {
            Some(Kind::Float) => self.number_picture(p, "amount"),
            Some(_) => self.picture_of(p, "amount", Meaning::Share),
            None => None,
        };
        let weight = match amount {
            Some(amount) => self.number(&amount, coordinates, p.place),
            None => Number::Constant(0.5),
        };
        // Version 3 gives the amount to the first of both, version 4 to the second.
        let is_old = p.has("namedmaterial1");
        let [first, second] = [0, 1].map(|i| self.sides(&definition.parts[i], coordinates));
        let (mut base, other) = if is_old { (second?, first?) } else { (first?, second?) };
        let weight = match weight {
            Number::Constant(share) => Number::Constant(share.clamp(0.0, 1.0)),
            texture @ Number::Texture(_) => texture,
        };
        base.mixture.push((other, weight));
        Some(base)
    }

    /// What perturbs the normals of a surface.
    fn relief(&mut self, p: &Parameters, coordinates: Coordinates) -> Option<Relief> {
        if let Some(filename) = p.text("normalmap", &mut self.report) {
            let file = ImageFile {
                filename,
                curve: Curve::Power(1.0),
                scale: 1.0,
                invert: false,
                wrap: Wrap::Repeat,
                bilinear: true,
                to_st: DAffine2::IDENTITY,
            };
            let picture = Rc::new(Picture::Image(file));
            let wanted = Wanted { purpose: Purpose::Number, factor: Rgb::WHITE, coordinates, place: p.place };
            let Some(Colour::Texture(texture)) = self.made(&picture, wanted) else { return None };
            return Some(Relief { texture, kind: ReliefKind::Normal, same_behind: false });
        }
        let name = if p.has("bumpmap") { "bumpmap" } else { "displacement" };
        let heights = self.number_picture(p, name)?;
        match self.number(&heights, coordinates, p.place) {
            Number::Texture(texture) => {
                Some(Relief { texture, kind: ReliefKind::Bump { scale: 1.0 }, same_behind: false })
            }
            Number::Constant(_) => None,
        }
    }
}
