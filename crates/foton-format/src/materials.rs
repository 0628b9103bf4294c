//! `<bsdf>` elements to materials: diffuse, dielectric, conductor without a metal, and two sides of these.
//!
//! A material that several shapes refer to is read once and stands once in the description.

use std::collections::HashMap;

use foton_math::Rgb;
use foton_scene::description::{Bsdf, Material};

use crate::diagnostic::Place;
use crate::document::NodeId;
use crate::names::{BSDFS, REFRACTION, did_you_mean};
use crate::properties::{Object, Properties};
use crate::reader::Reader;

/// References from one BSDF to another may be this long.
const LONGEST_CHAIN: usize = 16;

/// Materials read so far.
#[derive(Default)]
pub(crate) struct Materials {
    /// What a BSDF's element says; `None` if that is not valid.
    sides: HashMap<NodeId, Option<Sides>>,
    /// The BSDF's place in the description.
    indices: HashMap<NodeId, usize>,
    /// Materials of shapes that name none: grey, and black for emitters.
    defaults: [Option<usize>; 2],
    /// BSDFs being read, outermost first.
    open: Vec<NodeId>,
}

#[derive(Clone, Copy)]
struct Sides {
    front: Bsdf,
    back: Option<Bsdf>,
}

impl Sides {
    fn one(front: Bsdf) -> Self {
        Self { front, back: None }
    }
}

impl Reader<'_> {
    /// The index of the material that a `<bsdf>` describes.
    pub(crate) fn material(&mut self, node: NodeId) -> Option<usize> {
        if let Some(&index) = self.materials.indices.get(&node) {
            return Some(index);
        }
        let Sides { front, back } = self.sides(node)?;
        let element = self.document.element(node)?;
        let index = self.description.materials.len();
        let kind = element.attribute("type").map_or("bsdf", |t| &t.value);
        let name = self.name(element, kind, index + 1);
        self.description.materials.push(Material { name, front, back });
        self.materials.indices.insert(node, index);
        Some(index)
    }

    /// The material of a shape that names none. Mitsuba 3 takes 50 % grey, and black if the shape emits.
    pub(crate) fn default_material(&mut self, emits: bool) -> usize {
        let slot = usize::from(emits);
        if let Some(index) = self.materials.defaults[slot] {
            return index;
        }
        let index = self.description.materials.len();
        let (name, reflectance) =
            if emits { ("default-black", Rgb::BLACK) } else { ("default-grey", Rgb::splat(0.5)) };
        let front = Bsdf::Diffuse { reflectance };
        self.description.materials.push(Material { name: name.to_owned(), front, back: None });
        self.materials.defaults[slot] = Some(index);
        index
    }

    fn sides(&mut self, node: NodeId) -> Option<Sides> {
        if let Some(&known) = self.materials.sides.get(&node) {
            return known;
        }
        self.materials.open.push(node);
        let sides = self.read_bsdf(node);
        self.materials.open.pop();
        self.materials.sides.insert(node, sides);
        sides
    }

    fn read_bsdf(&mut self, node: NodeId) -> Option<Sides> {
        let element = self.document.element(node)?;
        let plugin = self.plugin(element, &BSDFS)?;
        let mut p = self.properties(node, plugin);
        let sides = match plugin {
            "diffuse" => {
                let reflectance = p.reflectance("reflectance", &mut self.report).unwrap_or(Rgb::splat(0.5));
                Some(Sides::one(Bsdf::Diffuse { reflectance }))
            }
            "dielectric" => self.dielectric(&mut p),
            "conductor" => self.conductor(&mut p),
            _ => self.twosided(&mut p),
        };
        p.finish(&mut self.report);
        sides
    }

    fn dielectric(&mut self, p: &mut Properties<'_>) -> Option<Sides> {
        let int_ior = self.refraction(p, "int_ior", 1.5046);
        let ext_ior = self.refraction(p, "ext_ior", 1.000_277);
        let mut factor = |name| p.reflectance(name, &mut self.report).unwrap_or(Rgb::WHITE);
        let specular_reflectance = factor("specular_reflectance");
        let specular_transmittance = factor("specular_transmittance");
        let (int_ior, ext_ior) = int_ior.zip(ext_ior)?;
        Some(Sides::one(Bsdf::Dielectric { int_ior, ext_ior, specular_reflectance, specular_transmittance }))
    }

    /// An index of refraction, a number or the name of a substance.
    #[allow(clippy::cast_possible_truncation, reason = "optics is single precision")]
    fn refraction(&mut self, p: &mut Properties<'_>, name: &'static str, default: f32) -> Option<f32> {
        if p.is_string(name) {
            let substance = p.string(name, &mut self.report)?;
            let lower = substance.value.to_lowercase();
            let found = REFRACTION.iter().find(|(known, _)| *known == lower);
            if found.is_none() {
                let hint = did_you_mean(&lower, REFRACTION.iter().map(|(known, _)| *known));
                let message = format!("no index of refraction is known for \"{}\"{hint}", substance.value);
                self.report.error(substance.place, message);
            }
            return found.map(|(_, ior)| *ior);
        }
        let Some(ior) = p.number(name, &mut self.report) else { return Some(default) };
        let single = ior.value as f32;
        if single.is_normal() && single > 0.0 {
            return Some(single);
        }
        self.report.error(ior.place, "an index of refraction must be above zero");
        None
    }

    /// A mirror; real metals need complex indices of refraction.
    fn conductor(&mut self, p: &mut Properties<'_>) -> Option<Sides> {
        let material = p.string("material", &mut self.report);
        p.refuse(&["eta", "k"], &mut self.report);
        let reflectance = p.reflectance("specular_reflectance", &mut self.report).unwrap_or(Rgb::WHITE);
        match material {
            Some(metal) if metal.value != "none" => {
                let message =
                    format!("conductor material \"{}\" is not supported yet, only \"none\"", metal.value);
                self.report.error(metal.place, message);
                None
            }
            _ => Some(Sides::one(Bsdf::Mirror { reflectance })),
        }
    }

    fn twosided(&mut self, p: &mut Properties<'_>) -> Option<Sides> {
        let nested = p.nested("bsdf");
        match nested[..] {
            [both] => {
                let front = self.reflecting(both)?;
                Some(Sides { front, back: Some(front) })
            }
            [front, back] => {
                let (front, back) = (self.reflecting(front), self.reflecting(back));
                Some(Sides { front: front?, back: Some(back?) })
            }
            _ => {
                let message = format!("a twosided bsdf needs one or two bsdfs inside, not {}", nested.len());
                self.report.error(p.place, message);
                None
            }
        }
    }

    /// The front of a BSDF inside a twosided one, which must not transmit light.
    fn reflecting(&mut self, nested: Object<'_>) -> Option<Bsdf> {
        if self.materials.open.contains(&nested.node) || self.materials.open.len() >= LONGEST_CHAIN {
            self.refuse_chain(nested.place);
            return None;
        }
        let front = self.sides(nested.node)?.front;
        if matches!(front, Bsdf::Dielectric { .. }) {
            self.report
                .error(nested.place, "a dielectric transmits light and cannot stand inside a twosided bsdf");
            return None;
        }
        Some(front)
    }

    fn refuse_chain(&mut self, place: Place) {
        self.report.error(place, "this bsdf is made of itself, or of too long a chain of others");
    }
}
