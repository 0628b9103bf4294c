//! `<bsdf>` elements to materials of the description. What stands around other BSDFs is in `wrappers.rs`.
//!
//! A material that several shapes refer to is read once and stands once in the description.

use foton_math::Rgb;
use foton_scene::description::{Blend, Bsdf, Diffuse, Material};

use crate::mitsuba::document::NodeId;
use crate::mitsuba::names::BSDFS;
use crate::mitsuba::read::known::Sides;
use crate::mitsuba::read::reader::Reader;

impl Reader<'_> {
    /// The index of the material that a `<bsdf>` describes.
    pub(crate) fn material(&mut self, node: NodeId) -> Option<usize> {
        if let Some(&index) = self.materials.indices.get(&node) {
            return Some(index);
        }
        let sides = self.sides(node)?;
        let element = self.document.element(node)?;
        let kind = element.attribute("type").map_or("bsdf", |t| &t.value);
        let name = self.name(element, kind, self.description.materials.len() + 1);
        let index = self.enter(name, Sides { node: Some(node), ..sides });
        self.materials.indices.insert(node, index);
        Some(index)
    }

    /// Puts a material into the description, and behind it those that are blended with it.
    fn enter(&mut self, name: String, sides: Sides) -> usize {
        let Sides { front, back, coatings, opacity, relief, mixture, node } = sides;
        let index = self.description.materials.len();
        self.nodes.materials.push(node);
        let material =
            Material { name: name.clone(), front, back, coatings, opacity, relief, mixture: Vec::new() };
        self.description.materials.push(material);
        let others = mixture.into_iter().enumerate();
        let blends = others
            .map(|(i, (other, weight))| Blend {
                material: self.enter(format!("{name}/{}", i + 2), other),
                weight,
            })
            .collect();
        self.description.materials[index].mixture = blends;
        index
    }

    /// The material of a shape that names none. Mitsuba 3 takes 50 % grey, and black if the shape emits.
    pub(crate) fn default_material(&mut self, emits: bool) -> usize {
        let slot = usize::from(emits);
        if let Some(index) = self.materials.defaults[slot] {
            return index;
        }
        let (name, reflectance) =
            if emits { ("default-black", Rgb::BLACK) } else { ("default-grey", Rgb::splat(0.5)) };
        let front = Bsdf::Diffuse(Diffuse { reflectance: reflectance.into() });
        let index = self.enter(name.to_owned(), Sides::of(front));
        self.materials.defaults[slot] = Some(index);
        index
    }

    /// What a `<bsdf>` says, read once.
    pub(super) fn sides(&mut self, node: NodeId) -> Option<Sides> {
        if let Some(known) = self.materials.sides.get(&node) {
            return known.clone();
        }
        self.materials.open.push(node);
        let sides = self.read_bsdf(node);
        self.materials.open.pop();
        self.materials.sides.insert(node, sides.clone());
        sides
    }

    fn read_bsdf(&mut self, node: NodeId) -> Option<Sides> {
        let element = self.document.element(node)?;
        let plugin = self.plugin(element, &BSDFS)?;
        let mut p = self.properties(node, plugin);
        let sides = match self.wrapper(plugin, &mut p) {
            Some(around) => around,
            None => self.bsdf(plugin, &mut p).map(Sides::of),
        };
        p.finish(&mut self.report);
        sides
    }
}
