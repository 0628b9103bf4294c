//! `<bsdf>` elements to materials: BSDFs with what may stand around them, two sides and holes.
//!
//! A material that several shapes refer to is read once and stands once in the description.

use foton_math::Rgb;
use foton_scene::description::{Bsdf, Colour, Diffuse, Material};
use foton_scene::plugins::wrappers::OPACITY;

use crate::diagnostic::Place;
use crate::mitsuba::document::NodeId;
use crate::mitsuba::names::BSDFS;
use crate::mitsuba::read::known::Sides;
use crate::mitsuba::read::properties::{Object, Properties};
use crate::mitsuba::read::reader::Reader;

/// References from one BSDF to another may be this long.
const MAX_CHAIN: usize = 16;

impl Reader<'_> {
    /// The index of the material that a `<bsdf>` describes.
    pub(crate) fn material(&mut self, node: NodeId) -> Option<usize> {
        if let Some(&index) = self.materials.indices.get(&node) {
            return Some(index);
        }
        let Sides { front, back, opacity } = self.sides(node)?;
        let element = self.document.element(node)?;
        let index = self.description.materials.len();
        let kind = element.attribute("type").map_or("bsdf", |t| &t.value);
        let name = self.name(element, kind, index + 1);
        self.nodes.materials.push(Some(node));
        self.description.materials.push(Material { name, front, back, opacity });
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
        let front = Bsdf::Diffuse(Diffuse { reflectance: reflectance.into() });
        self.nodes.materials.push(None);
        self.description.materials.push(Material { name: name.to_owned(), front, back: None, opacity: None });
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
            "twosided" => self.twosided(&mut p),
            "mask" => self.mask(&mut p),
            _ => self.bsdf(plugin, &mut p).map(|front| Sides { front, back: None, opacity: None }),
        };
        p.finish(&mut self.report);
        sides
    }

    /// A bsdf with holes.
    fn mask(&mut self, p: &mut Properties<'_>) -> Option<Sides> {
        let opacity = self.share(p, &OPACITY);
        let nested = p.nested("bsdf");
        let [nested] = nested[..] else {
            self.report.error(p.place, format!("a mask needs one bsdf inside, not {}", nested.len()));
            return None;
        };
        let sides = self.nested_sides(nested)?;
        let opacity = match (opacity, sides.opacity) {
            (outer, None) => outer,
            (Colour::Constant(outer), Some(Colour::Constant(inner))) => Colour::Constant(outer * inner),
            _ => {
                self.report
                    .error(nested.place, "a mask with a texture inside another mask is not supported yet");
                return None;
            }
        };
        Some(Sides { opacity: Some(opacity), ..sides })
    }

    fn twosided(&mut self, p: &mut Properties<'_>) -> Option<Sides> {
        let nested = p.nested("bsdf");
        match nested[..] {
            [both] => {
                let front = self.reflecting(both)?;
                Some(Sides { front, back: Some(front), opacity: None })
            }
            [front, back] => {
                let (front, back) = (self.reflecting(front), self.reflecting(back));
                Some(Sides { front: front?, back: Some(back?), opacity: None })
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
        let Sides { front, opacity, .. } = self.nested_sides(nested)?;
        if front.has_two_sides() || opacity.is_some() {
            let kind = nested.element.attribute("type").map_or("bsdf", |t| &t.value);
            let message = format!("a {kind} transmits light and cannot stand inside a twosided bsdf");
            self.report.error(nested.place, message);
            return None;
        }
        Some(front)
    }

    /// A BSDF inside another one.
    fn nested_sides(&mut self, nested: Object<'_>) -> Option<Sides> {
        if self.materials.open.contains(&nested.node) || self.materials.open.len() >= MAX_CHAIN {
            self.refuse_chain(nested.place);
            return None;
        }
        self.sides(nested.node)
    }

    fn refuse_chain(&mut self, place: Place) {
        self.report.error(place, "this bsdf is made of itself, or of too long a chain of others");
    }
}
