//! `<bsdf>` elements that stand around others: two sides, holes, blends, and normals that a texture perturbs.

use foton_math::Rgb;
use foton_math::glam::DAffine2;
use foton_scene::description::{
    Bsdf, Coating, Colour, Diffuse, Number, Relief, ReliefKind, Texture, TextureKind, Wrap,
};
use foton_scene::plugins::wrappers::{
    BUMPMAP, NORMALMAP, NORMALS, NORMALS_FILE, OPACITY, SCALE, WEIGHT, WEIGHTS,
};

use crate::diagnostic::Place;
use crate::image::{Curve, Purpose, Reading};
use crate::mitsuba::read::known::Sides;
use crate::mitsuba::read::properties::{Object, Properties};
use crate::mitsuba::read::reader::Reader;
use crate::mitsuba::read::textures::TURN;
use crate::mitsuba::read::values;

/// References from one BSDF to another may be this long.
const MAX_CHAIN: usize = 16;

/// What a blend leaves to no BSDF.
const ABSORBED: Bsdf = Bsdf::Diffuse(Diffuse { reflectance: Colour::Constant(Rgb::BLACK) });

impl Reader<'_> {
    /// What a plugin says that stands around others; `None`: it is none of those. The inner `None`: it is not valid.
    #[allow(clippy::option_option, reason = "another plugin is not the same as a fault")]
    pub(super) fn wrapper(&mut self, plugin: &str, p: &mut Properties<'_>) -> Option<Option<Sides>> {
        Some(match plugin {
            "twosided" => self.twosided(p),
            "mask" => self.mask(p),
            "blendbsdf" => self.blend(p),
            "mixturebsdf" => self.mixture(p),
            "bumpmap" => self.bump_map(p),
            "normalmap" => self.normal_map(p),
            "coating" => self.coating(p, false),
            "roughcoating" => self.coating(p, true),
            _ => return None,
        })
    }

    /// A bsdf with holes.
    fn mask(&mut self, p: &mut Properties<'_>) -> Option<Sides> {
        let outer = self.share(p, &OPACITY);
        let nested = self.inner_bsdf(p)?;
        let mut sides = self.nested_sides(nested)?;
        let masked = sides.for_each(&mut |sides| {
            sides.opacity = Some(match (outer, sides.opacity) {
                (outer, None) => outer,
                (Colour::Constant(outer), Some(Colour::Constant(inner))) => Colour::Constant(outer * inner),
                _ => return Err("a mask with a texture inside another mask is not supported yet"),
            });
            Ok(())
        });
        masked.map_err(|message| self.report.error(nested.place, message)).ok()?;
        Some(sides)
    }

    fn twosided(&mut self, p: &mut Properties<'_>) -> Option<Sides> {
        let nested = p.nested("bsdf");
        match nested[..] {
            [both] => {
                let mut sides = self.reflecting(both)?;
                let _ = sides.for_each(&mut |sides| {
                    sides.back = Some(sides.front);
                    sides.coatings[1] = sides.coatings[0];
                    sides.relief.iter_mut().for_each(|relief| relief.same_behind = true);
                    Ok::<_, ()>(())
                });
                Some(sides)
            }
            [first, second] => {
                let (front, back) = (self.reflecting(first), self.reflecting(second));
                let (front, back) = (front?, back?);
                if front.relief != back.relief {
                    let message =
                        "of two sides with different bump or normal maps the back takes that of the front";
                    self.report.warning(second.place, message);
                }
                Some(two_sides(&front, &back))
            }
            _ => {
                let message = format!("a twosided bsdf needs one or two bsdfs inside, not {}", nested.len());
                self.report.error(p.place, message);
                None
            }
        }
    }

    /// A BSDF inside a twosided one, which must not transmit light. Of its sides the front counts.
    fn reflecting(&mut self, nested: Object<'_>) -> Option<Sides> {
        let mut sides = self.nested_sides(nested)?;
        let reflects = sides.for_each(&mut |sides| {
            let transmits = sides.front.has_two_sides() || sides.opacity.is_some();
            (!transmits).then_some(()).ok_or(())
        });
        if reflects.is_err() {
            let kind = nested.element.attribute("type").map_or("bsdf", |t| &t.value);
            let message = format!("a {kind} transmits light and cannot stand inside a twosided bsdf");
            self.report.error(nested.place, message);
            return None;
        }
        Some(sides)
    }

    /// Two BSDFs, the second of which has the weight.
    fn blend(&mut self, p: &mut Properties<'_>) -> Option<Sides> {
        let weight = self.number(p, &WEIGHT);
        let nested = p.nested("bsdf");
        let [first, second] = nested[..] else {
            self.report.error(p.place, format!("a blendbsdf needs two bsdfs inside, not {}", nested.len()));
            return None;
        };
        let (first, second) = (self.nested_sides(first), self.nested_sides(second));
        let (mut sides, second) = (first?, second?);
        sides.mixture.push((second, weight?));
        Some(sides)
    }

    /// Any number of BSDFs, each with a share of its own.
    fn mixture(&mut self, p: &mut Properties<'_>) -> Option<Sides> {
        if !p.has(WEIGHTS.name) {
            self.report.error(p.place, "a mixturebsdf needs \"weights\"");
        }
        let stated = p.string(WEIGHTS.name, &mut self.report)?;
        let weights = values::numbers(&stated.value).map_err(|m| self.report.error(stated.place, m)).ok()?;
        let nested = p.nested("bsdf");
        if nested.is_empty() || nested.len() != weights.len() || weights.iter().any(|w| *w < 0.0) {
            let message =
                format!("a mixturebsdf needs a weight of at least 0 for each of its {} bsdfs", nested.len());
            self.report.error(stated.place, message);
            return None;
        }
        let sum: f64 = weights.iter().sum();
        let all: Vec<_> = nested.into_iter().map(|nested| self.nested_sides(nested)).collect();
        let mut all: Vec<(Sides, f64)> = all
            .into_iter()
            .zip(weights)
            .map(|(sides, weight)| Some((sides?, weight)))
            .collect::<Option<_>>()?;
        if sum < 1.0 {
            all.push((Sides::of(ABSORBED), 1.0 - sum));
        }
        let mut so_far = 0.0;
        let mut mixed: Option<Sides> = None;
        for (sides, weight) in all {
            so_far += weight;
            let share = if so_far > 0.0 { weight / so_far } else { 0.0 };
            match &mut mixed {
                None => mixed = Some(sides),
                #[allow(clippy::cast_possible_truncation, reason = "optics is single precision")]
                Some(mixed) => mixed.mixture.push((sides, Number::Constant(share as f32))),
            }
        }
        mixed
    }

    /// A surface whose normals follow a height.
    fn bump_map(&mut self, p: &mut Properties<'_>) -> Option<Sides> {
        p.leave_out(BUMPMAP.parameters, &mut self.report);
        let scale = self.number(p, &SCALE)?.constant()?;
        let textures = p.nested("texture");
        let [texture] = textures[..] else {
            let message = format!("a bumpmap needs one texture inside, not {}", textures.len());
            self.report.error(p.place, message);
            return None;
        };
        let nested = self.inner_bsdf(p)?;
        let (texture, sides) = (self.texture_for(texture, Purpose::Number), self.nested_sides(nested));
        self.relieved(sides?, nested.place, texture?, ReliefKind::Bump { scale })
    }

    /// A surface whose normals a picture says.
    fn normal_map(&mut self, p: &mut Properties<'_>) -> Option<Sides> {
        p.leave_out(NORMALMAP.parameters, &mut self.report);
        let texture = if p.has(NORMALS_FILE.name) {
            self.picture_of_normals(p)
        } else {
            let named = p.texture(NORMALS.name);
            // Old files give it no name.
            match named.or_else(|| p.nested("texture").first().copied()) {
                Some(object) => self.texture_for(object, Purpose::Number),
                None => {
                    self.report.error(p.place, "a normalmap needs a texture of the name \"normalmap\"");
                    None
                }
            }
        };
        let nested = self.inner_bsdf(p)?;
        let sides = self.nested_sides(nested);
        self.relieved(sides?, nested.place, texture?, ReliefKind::Normal)
    }

    /// The texture of a normal map that names the file itself.
    fn picture_of_normals(&mut self, p: &mut Properties<'_>) -> Option<usize> {
        let filename = p.string(NORMALS_FILE.name, &mut self.report)?;
        let reading =
            Reading { curve: Curve::Power(1.0), channel: None, factor: Rgb::WHITE, purpose: Purpose::Number };
        let bitmap = self.images.read(&filename, reading, &mut self.files, &mut self.report)?;
        let index = self.description.textures.len();
        let kind = TextureKind::Bitmap { bitmap, wrap: Wrap::Repeat, bilinear: true };
        let to_uv = TURN * DAffine2::IDENTITY;
        self.description.textures.push(Texture { name: format!("normals-{}", index + 1), to_uv, kind });
        Some(index)
    }

    /// A clear coat over a BSDF, or over each of a blend.
    fn coating(&mut self, p: &mut Properties<'_>, rough: bool) -> Option<Sides> {
        let mut coating = Coating::default(rough);
        let mut is_complete = true;
        for binding in coating.parameters() {
            is_complete &= self.read_binding(p, binding).is_some();
        }
        let nested = self.inner_bsdf(p)?;
        let mut sides = self.nested_sides(nested)?;
        let [mut has_two, mut has_holes, mut has_rough_coat] = [false; 3];
        let _ = sides.for_each(&mut |sides| {
            let rough_coat =
                |bsdf: Bsdf| matches!(bsdf, Bsdf::Plastic(plastic) if plastic.roughness.is_some());
            has_two |= sides.coatings.iter().any(Option::is_some);
            has_holes |= sides.opacity.is_some();
            has_rough_coat |= rough_coat(sides.front) || sides.back.is_some_and(rough_coat);
            sides.coatings = [Some(coating), sides.back.map(|_| coating)];
            Ok::<_, ()>(())
        });
        for (is_so, message) in [
            (has_two, "of a coating inside another the outer one counts, the inner one is left out"),
            (has_holes, "the holes of a mask inside a coating go through the coating, too"),
            (
                has_rough_coat,
                "what gets through the rough plastic's own coat counts as through a smooth one, inside a coating",
            ),
        ] {
            if is_so {
                self.report.warning(nested.place, message);
            }
        }
        is_complete.then_some(sides)
    }

    /// Gives a material a relief. One that it has already counts alone: a warning says so.
    fn relieved(
        &mut self,
        mut sides: Sides,
        place: Place,
        texture: usize,
        kind: ReliefKind,
    ) -> Option<Sides> {
        let relief = Relief { texture, kind, same_behind: false };
        let mut has_two = false;
        let _ = sides.for_each(&mut |sides| {
            has_two |= sides.relief.is_some();
            sides.relief = sides.relief.or(Some(relief));
            Ok::<_, ()>(())
        });
        if has_two {
            let message =
                "of a bump or normal map inside another the inner one counts, the outer one is left out";
            self.report.warning(place, message);
        }
        Some(sides)
    }

    /// The BSDF that stands alone inside another one.
    fn inner_bsdf<'b>(&mut self, p: &mut Properties<'b>) -> Option<Object<'b>> {
        let nested = p.nested("bsdf");
        if let [nested] = nested[..] {
            return Some(nested);
        }
        let (subject, count) = (p.subject(), nested.len());
        self.report.error(p.place, format!("a {subject} needs one bsdf inside, not {count}"));
        None
    }

    /// A BSDF inside another one.
    fn nested_sides(&mut self, nested: Object<'_>) -> Option<Sides> {
        if self.materials.open.contains(&nested.node) || self.materials.open.len() >= MAX_CHAIN {
            let message = "this bsdf is made of itself, or of too long a chain of others";
            self.report.error(nested.place, message);
            return None;
        }
        let sides = self.sides(nested.node)?;
        // What is referred to, others may use, too: it is not changed in its place.
        let is_here = nested.place == nested.element.place;
        Some(Sides { node: sides.node.or(Some(nested.node)).filter(|_| is_here), ..sides })
    }
}

/// A material that is one in front and another behind: each material that the back is blended of stands behind all that the front is
/// blended of.
fn two_sides(front: &Sides, back: &Sides) -> Sides {
    let mut both = front.clone();
    let _ = both.for_each(&mut |sides| {
        sides.back = Some(back.front);
        sides.coatings[1] = back.coatings[0];
        sides.relief.iter_mut().for_each(|relief| relief.same_behind = true);
        Ok::<_, ()>(())
    });
    both.mixture.extend(back.mixture.iter().map(|(other, weight)| (two_sides(front, other), *weight)));
    both
}
